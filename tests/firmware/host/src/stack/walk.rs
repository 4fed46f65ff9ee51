//! The deepest chain of frames below a function.
//!
//! A frame is what the compiler states, or what the function's own instructions take, whichever is more; a function of
//! assembly states none. What is reached by a jump at the end of a function counts as if its frame were still there:
//! the bound is from above.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::elf::Stated;
use super::instruction::{Effect, Reader};

/// Why a function has no bound; the name is the one at fault.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unbounded {
    Recursive(String),
    Indirect(String),
    /// The stack pointer is set to what is not known, and the compiler states no frame.
    Frame(String),
    /// A call to what is no function of the file.
    Lost(String),
    /// An instruction that the disassembler does not know.
    Unknown(String),
}

impl Unbounded {
    /// In one word, as the functions of the control are named.
    pub fn kind(&self) -> &str {
        match self {
            Self::Recursive(_) => "recursive",
            Self::Indirect(_) => "indirect",
            Self::Frame(_) => "frame",
            Self::Lost(_) => "lost",
            Self::Unknown(_) => "unknown",
        }
    }
}

impl fmt::Display for Unbounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Recursive(name) => write!(f, "{name} can call itself: its stack has no bound"),
            Self::Indirect(name) => write!(f, "{name} calls what a register points to"),
            Self::Frame(name) => write!(f, "{name} moves the stack pointer by what is not known"),
            Self::Lost(name) => write!(f, "{name} calls what is no function of the program"),
            Self::Unknown(name) => write!(f, "{name} has an instruction that llvm-objdump does not know"),
        }
    }
}

/// A function's part in the walk.
#[derive(Debug, Default)]
struct Function {
    names: Vec<String>,
    end: u64,
    stated: Option<u64>,
    taken: u64,
    sets: bool,
    points: bool,
    unknown: bool,
    goes: BTreeSet<u64>,
    recursive: bool,
}

/// All functions of a program, by address.
#[derive(Debug)]
pub struct Program(BTreeMap<u64, Function>);

impl Program {
    /// From the file's functions and its disassembly.
    pub fn new(stated: BTreeMap<u64, Stated>, disassembly: &str) -> Result<Self, String> {
        let ends: Vec<u64> = stated.keys().copied().skip(1).chain([u64::MAX]).collect();
        let functions = stated.into_iter().zip(ends).map(|((start, Stated { names, size, frame }), next)| {
            let end = if size == 0 { next } else { (start + size).min(next) };
            (start, Function { names, end, stated: frame, ..Function::default() })
        });
        let mut program = Self(functions.collect());
        let mut reader = Reader::default();
        let mut lines = 0;
        for (address, effect) in disassembly.lines().filter_map(|line| reader.read(line)) {
            lines += 1;
            let Some(start) = program.containing(address) else { continue };
            if let Some(function) = program.0.get_mut(&start) {
                function.add(start, effect);
            }
        }
        if lines == 0 { Err("the disassembly is empty".into()) } else { Ok(program) }
    }

    /// Names and addresses of the functions that start with one of `roots`.
    pub fn entries(&self, roots: &[&str]) -> Vec<(String, u64)> {
        let named = |name: &&String| roots.iter().any(|root| name.starts_with(root));
        let of = self.0.iter().flat_map(|(address, function)| {
            function.names.iter().filter(named).map(|name| (name.clone(), *address))
        });
        let sorted: BTreeMap<_, _> = of.collect();
        sorted.into_iter().collect()
    }

    /// Bytes of the deepest chain that begins with the function at `address`, or who has none.
    pub fn depth(&self, address: u64) -> Result<u64, Unbounded> {
        self.below(address, &mut BTreeMap::new())
    }

    /// The same; `seen` holds `None` for what is being walked, so that recursion is met, and the answer for the rest.
    fn below(&self, address: u64, seen: &mut BTreeMap<u64, Option<u64>>) -> Result<u64, Unbounded> {
        let Some(function) = self.0.get(&address) else {
            return Err(Unbounded::Lost(format!("{address:#x}")));
        };
        let name = || function.names.first().cloned().unwrap_or_default();
        match seen.get(&address) {
            Some(Some(bytes)) => return Ok(*bytes),
            Some(None) => return Err(Unbounded::Recursive(name())),
            None => _ = seen.insert(address, None),
        }
        if function.recursive {
            return Err(Unbounded::Recursive(name()));
        }
        if function.unknown {
            return Err(Unbounded::Unknown(name()));
        }
        if function.points {
            return Err(Unbounded::Indirect(name()));
        }
        if function.sets && function.stated.is_none() {
            return Err(Unbounded::Frame(name()));
        }
        let mut deepest = 0;
        for to in &function.goes {
            let callee = self.containing(*to).ok_or_else(|| Unbounded::Lost(name()))?;
            deepest = deepest.max(self.below(callee, seen)?);
        }
        let bytes = function.stated.unwrap_or(0).max(function.taken) + deepest;
        seen.insert(address, Some(bytes));
        Ok(bytes)
    }

    /// The function that holds an address.
    fn containing(&self, address: u64) -> Option<u64> {
        let (start, function) = self.0.range(..=address).next_back()?;
        if address < function.end { Some(*start) } else { None }
    }
}

impl Function {
    fn add(&mut self, start: u64, effect: Effect) {
        match effect {
            Effect::Takes(bytes) => self.taken += bytes,
            Effect::Sets => self.sets = true,
            // `mov sp, r4; pop` gives a frame back.
            Effect::Pops => self.sets = false,
            Effect::Points => self.points = true,
            Effect::Unknown => self.unknown = true,
            Effect::Goes { to, linked } if (start..self.end).contains(&to) => {
                self.recursive |= linked && to == start
            }
            Effect::Goes { to, .. } => _ = self.goes.insert(to),
            Effect::Other => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A program of functions 0x10 bytes long that take 8 bytes each, from pairs of a name and what it does last.
    fn program(functions: &[(&str, &str)]) -> Program {
        let mut stated = BTreeMap::new();
        let mut text = String::new();
        for (k, (name, last)) in functions.iter().enumerate() {
            let at = 0x100 + 0x10 * k as u64;
            stated.insert(at, Stated { names: vec![(*name).into()], size: 0x10, frame: None });
            text += &format!("  {at:x}: \tpush\t{{r4, lr}}\n  {:x}: \t{last}\n", at + 2);
        }
        Program::new(stated, &text).unwrap()
    }

    #[test]
    fn a_chain_adds_up_and_the_deeper_branch_counts() {
        let chain = program(&[("a", "bl\t0x110 <b>"), ("b", "bl\t0x120 <c>"), ("c", "pop\t{r4, pc}")]);
        assert_eq!(chain.entries(&["a"]), [("a".to_string(), 0x100)]);
        assert_eq!(chain.depth(0x100), Ok(24));
        assert_eq!(chain.depth(0x120), Ok(8));
    }

    #[test]
    fn recursion_is_refused_and_named_near_and_far() {
        let near = program(&[("a", "bl\t0x100 <a>")]);
        assert_eq!(near.depth(0x100), Err(Unbounded::Recursive("a".into())));
        let far = program(&[("a", "bl\t0x110 <b>"), ("b", "b.w\t0x100 <a>")]);
        assert_eq!(far.depth(0x110), Err(Unbounded::Recursive("b".into())));
    }

    #[test]
    fn a_call_through_a_pointer_is_refused_and_named_where_it_can_be_reached() {
        let calls = program(&[("a", "bl\t0x110 <b>"), ("b", "blx\tr3"), ("c", "pop\t{r4, pc}")]);
        assert_eq!(calls.depth(0x100), Err(Unbounded::Indirect("b".into())));
        assert_eq!(calls.depth(0x120), Ok(8));
    }

    #[test]
    fn a_loop_is_no_recursion() {
        let walk = program(&[("a", "bne\t0x100 <a>"), ("b", "bl\t0x100 <a>")]);
        assert_eq!(walk.depth(0x110), Ok(16));
    }

    #[test]
    fn a_stack_pointer_set_to_what_is_not_known_is_refused() {
        let walk = program(&[("a", "sub\tsp, sp, a0")]);
        assert_eq!(walk.depth(0x100), Err(Unbounded::Frame("a".into())));
    }
}
