//! The functions of an executable: names, where they lie, and the frame that the compiler states for them.

use std::collections::BTreeMap;

use object::{File, Object, ObjectSection, ObjectSymbol, SymbolKind};

/// What the file says of a function.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub struct Stated {
    /// All its names; identical functions are kept once.
    pub names: Vec<String>,
    /// Bytes, 0 if not said (assembly).
    pub size: u64,
    /// Its frame in bytes, if `-Z emit-stack-sizes` was on when it was compiled.
    pub frame: Option<u64>,
}

/// The functions by address.
pub fn functions(bytes: &[u8]) -> Result<BTreeMap<u64, Stated>, object::Error> {
    let file = File::parse(bytes)?;
    // The lowest bit of an Arm function's address says that it is Thumb.
    let thumb = if file.architecture() == object::Architecture::Arm { 1 } else { 0 };
    let mut functions = BTreeMap::<u64, Stated>::new();
    for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.is_definition())
    {
        let name = symbol.name()?;
        if name.is_empty() || name.starts_with(['$', '.']) {
            continue;
        }
        let function = functions.entry(symbol.address() & !thumb).or_default();
        function.names.push(format!("{:#}", rustc_demangle::demangle(name)));
        function.size = function.size.max(symbol.size());
    }
    if let Some(section) = file.section_by_name(".stack_sizes") {
        let width = if file.is_64() { 8 } else { 4 };
        let mut rest = section.data()?;
        while let Some((address, frame)) = entry(&mut rest, width) {
            functions.entry(address & !thumb).or_default().frame = Some(frame);
        }
    }
    functions.retain(|_, function| !function.names.is_empty());
    Ok(functions)
}

/// One entry of .stack_sizes: an address (little-endian) and a size (LEB128).
fn entry(rest: &mut &[u8], width: usize) -> Option<(u64, u64)> {
    let (address, mut tail) = rest.split_at_checked(width)?;
    let address = address.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
    let (mut size, mut shift) = (0, 0);
    loop {
        let (byte, after) = tail.split_first()?;
        tail = after;
        size |= u64::from(byte & 0x7f) << shift;
        shift += 7;
        if byte & 0x80 == 0 {
            break;
        }
    }
    *rest = tail;
    Some((address, size))
}

#[cfg(test)]
mod tests {
    use super::entry;

    #[test]
    fn a_size_of_two_bytes_is_read() {
        let mut rest: &[u8] = &[0x10, 0x20, 0, 0, 0x98, 0x02, 0xff];
        assert_eq!(entry(&mut rest, 4), Some((0x2010, 280)));
        assert_eq!(entry(&mut rest, 4), None);
    }
}
