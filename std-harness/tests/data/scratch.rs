//! A folder of its own for each test, the program run in it, and what it says.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The folder, removed with the test that made it.
pub struct Scratch(PathBuf);

/// What a run of `hooke` left.
#[derive(Debug)]
pub struct Ran {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Scratch {
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).unwrap();
        path
    }

    /// Everything in the folder and below, hidden files too, sorted.
    pub fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        let mut open = vec![self.0.clone()];
        while let Some(dir) = open.pop() {
            for entry in fs::read_dir(dir).unwrap() {
                let path = entry.unwrap().path();
                let name = path.strip_prefix(&self.0).unwrap().to_str().unwrap().replace('\\', "/");
                names.push(name);
                if path.is_dir() {
                    open.push(path);
                }
            }
        }
        names.sort();
        names
    }

    /// Runs `hooke` in the folder.
    pub fn hooke(&self, args: &[&str]) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_hooke"))
            .args(args)
            .current_dir(&self.0)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        Ran {
            code: output.status.code().unwrap(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs `hooke` with words that hold no space, and expects success.
    pub fn ok(&self, line: &str) -> Ran {
        let ran = self.hooke(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "hooke {line}");
        ran
    }

    /// Expects bad input: exit code 2, one line on stderr with all of these in it, nothing on stdout, nothing written.
    pub fn refuses(&self, line: &str, needles: &[&str]) -> Result<(), String> {
        let before = self.names();
        let ran = self.hooke(&line.split_whitespace().collect::<Vec<_>>());
        let missing: Vec<_> = needles.iter().filter(|needle| !ran.stderr.contains(**needle)).collect();
        let one_line = ran.stderr.ends_with('\n') && ran.stderr.lines().count() == 1;
        let after = self.names();
        if ran.code == 2 && one_line && ran.stdout.is_empty() && missing.is_empty() && before == after {
            return Ok(());
        }
        Err(format!("hooke {line}: {ran:?} lacks {missing:?}; folder {before:?} became {after:?}\n"))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
