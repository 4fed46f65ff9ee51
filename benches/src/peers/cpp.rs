//! Peers in C++: compiled on first use, beside the binary that asks for them, and run as a process that is fed the same
//! matrices and right sides through a pipe. It times itself; reading and writing are not counted.

use std::collections::hash_map::DefaultHasher;
use std::env;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use super::{Peer, Solved};
use crate::pattern::Pattern;

const SERVE: &str = include_str!("serve.hpp");

/// A source, what it must be linked with, and where to get what it includes.
struct Program {
    name: &'static str,
    source: &'static str,
    link: &'static [&'static str],
    needs: &'static str,
}

const EIGEN: Program = Program {
    name: "eigen",
    source: include_str!("eigen.cpp"),
    link: &[],
    needs: "Eigen needs libeigen3-dev",
};
const CHOLMOD: Program = Program {
    name: "cholmod",
    source: include_str!("cholmod.cpp"),
    link: &["-lcholmod"],
    needs: "CHOLMOD needs libsuitesparse-dev (and libopenblas0-serial, or its BLAS is slow)",
};

/// Fast on this machine, which is all that is asked of a peer. (Loops aligned: else where the linker happens to put
/// Eigen's product makes it a third slower.)
const FLAGS: [&str; 8] = [
    "-std=c++17",
    "-O3",
    "-march=native",
    "-falign-loops=64",
    "-falign-functions=64",
    "-DNDEBUG",
    "-I/usr/include/eigen3",
    "-I/usr/include/suitesparse",
];

pub(crate) fn eigen_ldlt(pattern: &Pattern, _: f64) -> Result<Box<dyn Peer>, String> {
    serve(&EIGEN, &["ldlt".into()], pattern)
}

pub(crate) fn eigen_cg(pattern: &Pattern, tolerance: f64) -> Result<Box<dyn Peer>, String> {
    serve(&EIGEN, &["cg".into(), format!("{tolerance:e}")], pattern)
}

pub(crate) fn cholmod(pattern: &Pattern, _: f64) -> Result<Box<dyn Peer>, String> {
    serve(&CHOLMOD, &[], pattern)
}

/// The compiled program; an error says what is missing.
fn compiled(program: &Program) -> Result<PathBuf, String> {
    let compiler = env::var("CXX").unwrap_or_else(|_| "c++".into());
    let mut hash = DefaultHasher::new();
    (SERVE, program.source, &compiler, FLAGS).hash(&mut hash);
    let beside = env::current_exe().map_err(|error| error.to_string())?;
    let dir =
        beside.parent().unwrap_or(Path::new(".")).join(format!("peer-{}-{:x}", program.name, hash.finish()));
    let (binary, source) = (dir.join(program.name), dir.join("main.cpp"));
    if binary.exists() {
        return Ok(binary);
    }
    let write = || {
        fs::create_dir_all(&dir)?;
        fs::write(dir.join("serve.hpp"), SERVE)?;
        fs::write(&source, program.source)
    };
    write().map_err(|error| format!("{}: {error}", dir.display()))?;
    // Under another name until it is whole: a second run may compile the same.
    let part = dir.join(format!("{}.{}", program.name, std::process::id()));
    let mut command = Command::new(&compiler);
    command.args(FLAGS).arg(&source).arg("-o").arg(&part).args(program.link);
    let output = command.output().map_err(|_| format!("needs a C++ compiler ('{compiler}' does not run)"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let why = said
            .lines()
            .find_map(|line| line.split_once("error: "))
            .map_or("it does not link", |said| said.1);
        return Err(format!("{} ({})", program.needs, why.trim()));
    }
    fs::rename(&part, &binary).map_err(|error| error.to_string())?;
    Ok(binary)
}

/// A running program that solves.
struct Served {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    bytes: usize,
}

fn serve(program: &Program, arguments: &[String], pattern: &Pattern) -> Result<Box<dyn Peer>, String> {
    let mut command = Command::new(compiled(program)?);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
    // One thread, as everybody else; CHOLMOD asks for four by number, whatever OMP_NUM_THREADS says.
    command.env("OMP_THREAD_LIMIT", "1").env("OPENBLAS_NUM_THREADS", "1");
    let mut child = command.spawn().map_err(|error| error.to_string())?;
    let (Some(to), Some(from)) = (child.stdin.take(), child.stdout.take()) else {
        return Err("no pipe to the program".into());
    };
    let mut served = Served { child, to, from: BufReader::new(from), bytes: 0 };
    served.begin(pattern).map_err(|error| error.to_string())?;
    Ok(Box::new(served))
}

impl Served {
    /// Sends the pattern.
    fn begin(&mut self, pattern: &Pattern) -> io::Result<()> {
        let sizes = [pattern.column.len() - 1, pattern.entries()];
        let mut bytes: Vec<u8> = sizes.iter().flat_map(|n| (*n as i64).to_le_bytes()).collect();
        let indices = pattern.column.iter().chain(&pattern.row);
        bytes.extend(indices.flat_map(|i| (*i as i32).to_le_bytes()));
        self.to.write_all(&bytes)?;
        self.to.flush()
    }

    /// Sends one system; answers seconds, iterations and bytes.
    fn ask(&mut self, values: &[f64], b: &[f64], x: &mut [f64]) -> io::Result<[f64; 3]> {
        let numbers = values.iter().chain(b);
        self.to.write_all(&numbers.flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())?;
        self.to.flush()?;
        let mut answer = vec![0; 8 * (3 + x.len())];
        self.from.read_exact(&mut answer)?;
        let mut answer = answer.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let head = std::array::from_fn(|_| answer.next().unwrap_or(f64::NAN));
        for (x, value) in x.iter_mut().zip(answer) {
            *x = value;
        }
        Ok(head)
    }
}

impl Peer for Served {
    fn solve(&mut self, values: &[f64], b: &[f64], x: &mut [f64]) -> Result<Solved, String> {
        let [seconds, iterations, bytes] =
            self.ask(values, b, x).map_err(|error| format!("the program stopped: {error}"))?;
        if !(seconds >= 0.0) {
            return Err("the factorisation failed".into());
        }
        self.bytes = bytes as usize;
        Ok(Solved { time: Duration::from_secs_f64(seconds), iterations: iterations as u32 })
    }

    fn bytes_elsewhere(&self) -> Option<usize> {
        Some(self.bytes)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // It waits for input between solves; ended here, it leaves nothing behind.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
