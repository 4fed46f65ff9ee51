//! Which tests pass which mutants, and how long each test takes: every test by itself, once.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::mutant::Result;

/// One test of one binary.
pub struct Test {
    pub binary: PathBuf,
    pub name: String,
    pub seconds: f64,
    pub reached: BTreeSet<usize>,
}

/// The binaries that a tree's tests are, one a line in `PLACE/binaries`.
fn binaries(place: &Path) -> Result<Vec<PathBuf>> {
    Ok(fs::read_to_string(place.join("binaries"))?.lines().map(PathBuf::from).collect())
}

/// All tests, each traced once; what is known from before is read.
pub fn tests(place: &Path) -> Result<Vec<Test>> {
    let traces = place.join("traces");
    fs::create_dir_all(&traces)?;
    let mut tests = Vec::new();
    for binary in binaries(place)? {
        let listed = Command::new(&binary).args(["--list", "--format", "terse"]).output()?;
        for line in String::from_utf8(listed.stdout)?.lines() {
            let Some(name) = line.strip_suffix(": test") else { continue };
            let stem = binary.file_name().unwrap_or_default().to_string_lossy();
            let path = traces.join(format!("{stem}.{}", name.replace("::", ".")));
            let done = path.with_file_name(format!("{stem}.{}.seconds", name.replace("::", ".")));
            if !done.exists() {
                let _ = fs::remove_file(&path);
                let before = Instant::now();
                let status = Command::new(&binary)
                    .args([name, "--exact", "--test-threads", "1"])
                    .env("HOOKE_REACHED", &path)
                    .stdout(Stdio::null())
                    .stderr(Stdio::null())
                    .status()?;
                if !status.success() {
                    eprintln!("{name} fails without any mutant: it judges none");
                    let _ = fs::remove_file(&path);
                }
                fs::write(&done, before.elapsed().as_secs_f64().to_string())?;
            }
            let text = fs::read_to_string(&path).unwrap_or_default();
            let reached = text.lines().filter_map(|line| line.parse().ok()).collect();
            let seconds = fs::read_to_string(&done)?.parse()?;
            tests.push(Test { binary: binary.clone(), name: name.to_owned(), seconds, reached });
        }
    }
    tests.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    Ok(tests)
}

/// How a run with one mutant awake ended.
#[derive(PartialEq)]
pub enum Ended {
    Passed,
    Failed,
    TimedOut,
}

/// Some tests of one binary with one mutant awake, for a limited time.
pub fn run(binary: &Path, names: &[&str], mutant: usize, limit: Duration) -> Result<Ended> {
    let mut child = Command::new(binary)
        .args(names)
        .args(["--exact", "--test-threads", "1"])
        .env("HOOKE_MUTANT", mutant.to_string())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let before = Instant::now();
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(if status.success() { Ended::Passed } else { Ended::Failed });
        }
        if before.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(Ended::TimedOut);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(50));
    }
}
