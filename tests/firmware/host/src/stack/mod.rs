//! How deep the stack can get, from the machine code: frames of functions, the calls between them, the deepest chain
//! below each entry point. Recursion and calls through a pointer have no bound: they are refused, naming the function.

mod elf;
mod instruction;
mod walk;

use walk::Program;

/// The deepest chain below each function whose name starts with one of `roots`: name and bytes.
pub fn bounds(file: &str, listing: &str, roots: &[&str]) -> Result<Vec<(String, u64)>, String> {
    let program = read(file, listing)?;
    let mut bounds = Vec::new();
    for (name, address) in program.entries(roots) {
        let bytes = program.depth(address).map_err(|why| format!("{name}: {why}"))?;
        bounds.push((name, bytes));
    }
    if bounds.is_empty() { Err(format!("{file}: no function is named like {roots:?}")) } else { Ok(bounds) }
}

/// The control: each function that starts with `root` must be refused for the reason that stands in its name. Answers how
/// many.
pub fn refused(file: &str, listing: &str, root: &str) -> Result<usize, String> {
    let program = read(file, listing)?;
    let entries = program.entries(&[root]);
    for (name, address) in &entries {
        match program.depth(*address) {
            Ok(bytes) => return Err(format!("{name} has no bound, but {bytes} bytes were found")),
            Err(why) if name.ends_with(why.kind()) => {}
            Err(why) => return Err(format!("{name} was refused for another reason: {why}")),
        }
    }
    Ok(entries.len())
}

/// `listing` is what `llvm-objdump -d --no-show-raw-insn` printed of it.
fn read(file: &str, listing: &str) -> Result<Program, String> {
    let bytes = std::fs::read(file).map_err(|why| format!("{file}: {why}"))?;
    let functions = elf::functions(&bytes).map_err(|why| format!("{file}: {why}"))?;
    let listing = std::fs::read_to_string(listing).map_err(|why| format!("{listing}: {why}"))?;
    Program::new(functions, &listing)
}
