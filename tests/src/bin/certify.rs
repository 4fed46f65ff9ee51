//! The certificate of a solve over 10⁵ systems: every solver, cut short or not, against 62 digits. Writes the table between
//! the marks of `CERTIFIED.md`, and `certified.csv` and `certified.svg`. Ends with code 1 if anything is violated.
//!
//! `cargo run --release -p hooke-tests --bin certify [-- --systems N --seed S --out DIR]`; with `--out` all three are put
//! there instead, the table as `certified.md`.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, process, thread};

use hooke_tests::certified::{case::Case, judge, picture, seen::Seen, table};
use hooke_tests::random::Random;

const BEGIN: &str = "<!-- table: cargo run --release -p hooke-tests --bin certify -->\n";
const END: &str = "<!-- end of table -->";

/// Cases of one random stream: what is seen does not depend on how many threads there are.
const BATCH: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut systems, mut seed, mut out) = (100_000, 62, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or(format!("{name} needs a value"))?;
        match name.as_str() {
            "--systems" => systems = value.parse()?,
            "--seed" => seed = value.parse()?,
            "--out" => out = Some(PathBuf::from(value)),
            _ => return Err(format!("unknown option {name}").into()),
        }
    }
    let seen = run(systems, seed);
    let (text, csv, svg) = (table::markdown(&seen), table::csv(&seen), picture::svg(&seen)?);
    print!("{text}");
    match out {
        Some(dir) => {
            fs::create_dir_all(&dir)?;
            fs::write(dir.join("certified.md"), text)?;
            fs::write(dir.join("certified.csv"), csv)?;
            fs::write(dir.join("certified.svg"), svg)?;
        }
        None => {
            let here = Path::new(env!("CARGO_MANIFEST_DIR"));
            let page = here.join("CERTIFIED.md");
            let old = fs::read_to_string(&page)?;
            let (head, rest) = old.split_once(BEGIN).ok_or("CERTIFIED.md has lost its first mark")?;
            let (_, tail) = rest.split_once(END).ok_or("CERTIFIED.md has lost its second mark")?;
            fs::write(&page, format!("{head}{BEGIN}{text}{END}{tail}"))?;
            fs::create_dir_all(here.join("pictures"))?;
            fs::write(here.join("pictures/certified.csv"), csv)?;
            fs::write(here.join("pictures/certified.svg"), svg)?;
        }
    }
    let loose = seen.solves.iter().filter(|record| record.loose).count();
    let uncertified: usize = seen.projection.iter().map(|bin| bin.wrong).sum();
    for wrong in seen.wrong.iter().take(10) {
        eprintln!("{wrong}");
    }
    if !seen.wrong.is_empty() || loose + uncertified > 0 {
        eprintln!("{} violations, {loose} loose, {uncertified} wrongly certified", seen.wrong.len());
        process::exit(1);
    }
    Ok(())
}

/// Batches until there are so many systems. A batch is used or left out as a whole, in the order of their numbers.
fn run(systems: usize, seed: u64) -> Seen {
    let (next, done, found) = (AtomicUsize::new(0), AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while done.load(Ordering::Relaxed) < systems {
            let batch = next.fetch_add(1, Ordering::Relaxed);
            let mut random = Random::new(seed ^ (batch as u64) << 32);
            let mut seen = Seen::default();
            for number in 0..BATCH {
                let case = Case::new(&mut random);
                judge::judge(&case, &mut random, number, &mut seen);
            }
            let so_far = done.fetch_add(seen.count(), Ordering::Relaxed) + seen.count();
            eprintln!("{so_far} systems");
            if let Ok(mut found) = found.lock() {
                found.push((batch, seen));
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let mut found = found.into_inner().unwrap_or_default();
    found.sort_by_key(|(batch, _)| *batch);
    let mut all = Seen::default();
    for (_, seen) in found {
        if all.count() < systems {
            all.merge(seen);
        }
    }
    all
}
