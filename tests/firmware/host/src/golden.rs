//! The golden file: a log of changes, one line each that says why, then the values. Each line of the log carries the
//! digest of the values that it brought, so that a value cannot change without a new line.

use firmware_jobs::Digest;

const HEAD: &str = "\
# Golden bits: what every target must compute. Positions and velocities of every job, digested after every step (the
# upper 32 of 64 bits), and the totals. Written by `check.sh bless WHY`; one line of the log per change of a value.
";

/// The lines of the log.
pub fn log(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| line.starts_with("change "))
}

/// All that comes from the first job on.
pub fn values(text: &str) -> &str {
    text.find("\njob ").and_then(|at| text.get(at + 1..)).unwrap_or_default()
}

fn digest(values: &str) -> String {
    let mut digest = Digest::new();
    digest.bytes(values.as_bytes());
    format!("{:016x}", digest.value())
}

/// Does the last change that the log names bring the values that the file holds?
pub fn check_log(text: &str) -> Result<(), String> {
    let named =
        log(text).last().and_then(|line| line.split(' ').nth(1)).ok_or("the golden file has no log")?;
    if named == digest(values(text)) {
        return Ok(());
    }
    Err("a golden value was changed without a line in the log that says why (use `check.sh bless WHY`)"
        .into())
}

/// The file with new values and a line that says why they changed.
pub fn blessed(old: &str, values: &str, why: &str) -> Result<String, String> {
    if why.trim().is_empty() || why.contains('\n') {
        return Err("say in one line why the golden values change".into());
    }
    let digest = digest(values);
    if log(old).last().is_some_and(|line| line.contains(&digest)) {
        return Err("no golden value has changed".into());
    }
    let log: String = log(old).map(|line| format!("{line}\n")).collect();
    Ok(format!("{HEAD}\n{log}change {digest} {}\n\n{values}", why.trim()))
}
