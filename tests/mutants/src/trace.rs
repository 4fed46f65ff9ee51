//! Which tests pass which mutants, and how long each test takes: every test by itself, once.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

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

/// All tests, each traced once; what is known from before is read. One that takes more than so many seconds of a processor is cut
/// off: its seconds are infinite, and what it reaches is not known.
pub fn tests(place: &Path, most: f64) -> Result<Vec<Test>> {
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
            let known = fs::read_to_string(&done).ok().and_then(|text| text.parse::<f64>().ok());
            if known.is_none_or(|seconds| seconds.is_infinite() && most.is_infinite()) {
                let _ = fs::remove_file(&path);
                let limit =
                    if most.is_finite() { format!("ulimit -t {};", most.ceil()) } else { String::new() };
                // Seconds of a processor: on a machine that is shared the clock says little.
                let timed = "TIMEFORMAT=%U; { time \"$0\" \"$@\" 2>/dev/null; } 2>\"$HOOKE_SECONDS\"";
                let status = Command::new("bash")
                    .args(["-c", &format!("{limit} {timed}")])
                    .arg(&binary)
                    .args([name, "--exact", "--test-threads", "1"])
                    .env("HOOKE_REACHED", &path)
                    .env("HOOKE_SECONDS", &done)
                    .stdout(Stdio::null())
                    .stderr(Stdio::null())
                    .status()?;
                // Of a signal the shell makes a code.
                let cut = matches!(status.code(), Some(152 | 137) | None);
                if cut {
                    let _ = fs::remove_file(&path);
                } else if !status.success() {
                    eprintln!("{name} fails without any mutant: it judges none");
                    let _ = fs::remove_file(&path);
                }
                let text = fs::read_to_string(&done).unwrap_or_default();
                let taken = text.lines().last().and_then(|line| line.parse::<f64>().ok());
                let seconds = taken.filter(|_| !cut).unwrap_or(f64::INFINITY);
                fs::write(&done, seconds.to_string())?;
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
    /// By this test
    Failed(String),
    TimedOut,
}

/// Some tests of one binary with one mutant awake, for so many seconds of a processor; up to the first that fails.
pub fn run(binary: &Path, names: &[&str], mutant: usize, seconds: u64) -> Result<Ended> {
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -t {seconds}; exec \"$0\" \"$@\"")])
        .arg(binary)
        .args(names)
        .args(["--exact", "--test-threads", "1"])
        .env("HOOKE_MUTANT", mutant.to_string())
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    // A test's name is printed before it runs: if the program ends there, the last one it was.
    let (mut name, mut failed) = (String::new(), false);
    for word in BufReader::new(child.stdout.take().ok_or("no output")?).split(b' ') {
        match String::from_utf8_lossy(&word?).split('\n').next() {
            Some("FAILED") => failed = true,
            Some(word) if word.contains("::") => name = word.to_owned(),
            _ => continue,
        }
        if failed {
            child.kill()?;
            break;
        }
    }
    let status = child.wait()?;
    // SIGXCPU, or SIGKILL after it.
    Ok(match status.signal() {
        _ if failed => Ended::Failed(name),
        Some(24 | 9) => Ended::TimedOut,
        _ if status.success() => Ended::Passed,
        _ => Ended::Failed(name),
    })
}
