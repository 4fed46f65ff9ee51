//! The errors of the kernel's scalar quantities, seen against allowed, on more inputs than the test takes. Writes the table
//! between the marks of `ULPS.md`. Ends with code 1 if one is larger than allowed.
//!
//! `cargo run --release -p hooke-tests --bin ulps [-- --check]`; with `--check` only says whether the page is what the code gives.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, process};

use hooke::Real;
use hooke_tests::ulps::inputs::{KINDS, inputs};
use hooke_tests::ulps::{COUNT, Known, QUANTITIES, quantities, rows};

const BEGIN: &str = "<!-- table: cargo run --release -p hooke-tests --bin ulps -->\n";
const END: &str = "<!-- end of table -->";

/// Springs of each kind, and networks.
const SPRINGS: usize = 100_000;
const NETWORKS: usize = 5_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut text = String::from(
        "| quantity | in units of u times | | allowed | known | random | neighbours | huge, tiny | edge | scenes | margin |\n\
         | --- | --- | --- | --: | --- | --: | --: | --: | --: | --: | --: |\n",
    );
    let mut wrong = 0;
    let seen = [("f64", measure::<f64>()), ("f32", measure::<f32>())];
    for (place, quantity) in QUANTITIES.iter().enumerate() {
        for (name, seen) in &seen {
            let of: Vec<f64> = seen.iter().map(|errors| errors[place]).collect();
            let most = of.iter().copied().fold(0.0, |a, b| if a >= b { a } else { b });
            wrong += usize::from(!(most <= quantity.allowed));
            let known = match quantity.known {
                Known::Proved(file) => format!("proved, [`{file}`](gappa/{file})"),
                Known::Derived => "derived".into(),
                Known::Measured => "measured".into(),
            };
            let cells: String =
                of.iter().map(|e| if *e == 0.0 { " |".into() } else { format!(" {e:.2} |") }).collect();
            let margin = quantity.allowed / most;
            _ = writeln!(
                text,
                "| {} | {} | {name} | {} | {known} |{cells} {margin:.1} |",
                quantity.name.replace('|', "\\|"),
                quantity.unit.replace('|', "\\|"),
                quantity.allowed
            );
        }
    }
    print!("{text}");
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("ULPS.md");
    let old = fs::read_to_string(&page)?;
    let (head, rest) = old.split_once(BEGIN).ok_or("ULPS.md has lost its first mark")?;
    let (_, tail) = rest.split_once(END).ok_or("ULPS.md has lost its second mark")?;
    let new = format!("{head}{BEGIN}{text}{END}{tail}");
    if std::env::args().any(|argument| argument == "--check") {
        if new != old {
            eprintln!("the table in ULPS.md is not that of the code; run the command in its mark");
            process::exit(1);
        }
    } else {
        fs::write(&page, new)?;
    }
    if wrong > 0 {
        eprintln!("{wrong} errors are larger than allowed");
        process::exit(1);
    }
    Ok(())
}

/// Per kind of input; rows count as random.
fn measure<T: Real>() -> Vec<[f64; COUNT]> {
    let mut seen: Vec<[f64; COUNT]> = Vec::new();
    for (k, kind) in KINDS.into_iter().enumerate() {
        seen.push(quantities::errors(kind, &inputs::<T>(kind, SPRINGS, 17 + k as u64)));
    }
    let rows = rows::errors::<T>(NETWORKS, 5);
    for (seen, row) in seen[0].iter_mut().zip(rows) {
        *seen = if row > *seen { row } else { *seen };
    }
    seen
}
