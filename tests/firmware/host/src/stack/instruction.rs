//! What one line of a disassembly does to the stack and to the flow, on Arm, AArch64 and RISC-V, as LLVM prints it.

/// What an instruction does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Effect {
    /// Takes so many bytes of stack.
    Takes(u64),
    /// Sets the stack pointer to something that cannot be read off the line.
    Sets,
    /// Takes registers back from the stack, as a function does when it ends.
    Pops,
    /// Goes to this address; `linked`: and comes back.
    Goes { to: u64, linked: bool },
    /// Goes where a register points, and it is not a return.
    Points,
    /// Not understood by the disassembler: what follows cannot be trusted.
    Unknown,
    /// Nothing that matters here.
    Other,
}

/// Reads lines; RISC-V's long calls are two of them, so the first is remembered.
#[derive(Debug, Default)]
pub struct Reader {
    /// Register and value of an `auipc` on the line before.
    upper: Option<(String, u64)>,
}

impl Reader {
    /// Address and effect of the instruction on a line, or `None` if there is none.
    pub fn read(&mut self, line: &str) -> Option<(u64, Effect)> {
        let (address, text) = line.trim_start().split_once(':')?;
        let address = u64::from_str_radix(address, 16).ok()?;
        let text = text.trim();
        let (mnemonic, operands) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let upper = self.upper.take();
        if let ("auipc", Some((register, pages))) = (mnemonic, operands.split_once(", ")) {
            // 20 bits, signed, of 4096 bytes each.
            let bytes = i64::from((number(pages)? as i32) << 12);
            self.upper = Some((register.into(), address.wrapping_add_signed(bytes)));
        }
        Some((address, effect(mnemonic, operands, upper)))
    }
}

fn effect(mnemonic: &str, operands: &str, upper: Option<(String, u64)>) -> Effect {
    let plain = mnemonic.split('.').next().unwrap_or_default();
    match plain {
        "push" => return Effect::Takes(4 * registers(operands)),
        "pop" | "vpop" => return Effect::Pops,
        "<unknown>" => return Effect::Unknown,
        "vpush" => return Effect::Takes(if operands.contains('d') { 8 } else { 4 } * registers(operands)),
        "stmdb" if operands.starts_with("sp!") => return Effect::Takes(4 * registers(operands)),
        _ => {}
    }
    if let Some((_, bytes)) = operands.split_once("[sp, #-").filter(|(_, rest)| rest.ends_with("]!")) {
        return Effect::Takes(number(bytes).unwrap_or(0).unsigned_abs());
    }
    if let Some(value) = operands.strip_prefix("sp, ").filter(|_| !plain.starts_with("st")) {
        return moved(plain, value);
    }
    if let Some(to) = target(operands).filter(|_| branches(mnemonic)) {
        return Effect::Goes { to, linked: matches!(plain, "bl" | "blx" | "jal" | "call") };
    }
    match (plain, operands) {
        ("bx", "lr") | ("ret", _) => Effect::Other,
        ("blr" | "blx" | "bx" | "br" | "jalr" | "jr", _) => {
            long(plain, operands, upper).unwrap_or(Effect::Points)
        }
        ("tbb" | "tbh", _) => Effect::Points,
        _ if operands.starts_with("pc, ") => Effect::Points,
        _ => Effect::Other,
    }
}

/// An instruction whose result is the stack pointer.
fn moved(mnemonic: &str, value: &str) -> Effect {
    let last = value.rsplit(", ").next().unwrap_or_default();
    let of_sp = !value.contains(", ") || value.starts_with("sp, ");
    match (mnemonic, number(last)) {
        ("sub" | "subw", Some(bytes)) if of_sp => Effect::Takes(bytes.unsigned_abs()),
        ("addi", Some(bytes)) if of_sp && bytes < 0 => Effect::Takes(bytes.unsigned_abs()),
        ("add" | "addw" | "addi", Some(_)) if of_sp => Effect::Other,
        ("cmp" | "ldr" | "ldm" | "tst", _) => Effect::Other,
        _ => Effect::Sets,
    }
}

/// The second half of a long call on RISC-V: `jalr 466(ra)`, `jalr ra` or `jr 466(t1)` after an `auipc` of that register.
fn long(mnemonic: &str, operands: &str, upper: Option<(String, u64)>) -> Option<Effect> {
    let last = operands.rsplit(", ").next()?;
    let (offset, register) =
        last.strip_suffix(')').and_then(|last| last.split_once('(')).unwrap_or(("0", last));
    let (_, value) = upper.filter(|(name, _)| name == register)?;
    let to = value.wrapping_add_signed(number(offset)?);
    Some(Effect::Goes { to, linked: mnemonic == "jalr" })
}

/// Branches, conditional ones too.
fn branches(mnemonic: &str) -> bool {
    mnemonic.starts_with(['b', 'j']) || ["cbz", "cbnz", "tbz", "tbnz", "call", "tail"].contains(&mnemonic)
}

/// The address in `… 0x1234 <name+0x8>`.
fn target(operands: &str) -> Option<u64> {
    let (before, _) = operands.split_once(" <")?;
    u64::from_str_radix(before.rsplit(' ').next()?.strip_prefix("0x")?, 16).ok()
}

/// How many registers a list in braces names.
fn registers(list: &str) -> u64 {
    let inside = list.split_once('{').map_or("", |(_, rest)| rest).split('}').next().unwrap_or_default();
    inside.split(',').map(|one| one.trim().split_once('-').map_or(1, |(from, to)| span(from, to))).sum()
}

fn span(from: &str, to: &str) -> u64 {
    let of = |register: &str| register.trim_start_matches(char::is_alphabetic).parse::<u64>().unwrap_or(0);
    of(to).saturating_sub(of(from)) + 1
}

/// A number as it stands in operands: `#0x10`, `#-8`, `466`, `16]!`.
fn number(text: &str) -> Option<i64> {
    let text = text.trim().trim_start_matches('#').trim_end_matches("]!");
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |digits| (-1, digits));
    let value = match digits.strip_prefix("0x") {
        Some(hex) => i64::from_str_radix(hex, 16),
        None => digits.parse(),
    };
    value.ok().map(|value| sign * value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(lines: &str) -> Vec<Effect> {
        let mut reader = Reader::default();
        lines.lines().filter_map(|line| reader.read(line)).map(|(_, effect)| effect).collect()
    }

    #[test]
    fn what_takes_stack_on_arm() {
        let lines = "  10: \tpush.w\t{r4, r5, lr}\n  12: \tvpush\t{d8, d9}\n  14: \tsub.w\tsp, sp, #520\n  \
                     18: \tsub\tsp, #0x10\n  1a: \tstr\tr7, [sp, #-4]!\n  1c: \tmov\tsp, r4\n  1e: \tadd\tsp, #16";
        let takes = [12, 16, 520, 16, 4].map(Effect::Takes);
        assert_eq!(of(lines), [&takes[..], &[Effect::Sets, Effect::Other]].concat());
    }

    #[test]
    fn what_takes_stack_on_aarch64_and_riscv() {
        let lines = "  10: \tstp\tx29, x30, [sp, #-96]!\n  14: \tsub\tsp, sp, #272\n  18: \taddi\tsp, sp, -64\n  \
                     1c: \taddi\tsp, sp, 64\n  1e: \tadd\tx0, sp, #8\n  20: \tsub\tsp, sp, a0";
        let takes = [96, 272, 64].map(Effect::Takes);
        assert_eq!(of(lines), [&takes[..], &[Effect::Other, Effect::Other, Effect::Sets]].concat());
    }

    #[test]
    fn calls_and_branches_go_somewhere_and_returns_do_not() {
        let lines = "  10: \tbl\t0x40 <f> @ imm = #44\n  12: \tbne\t0x20 <g+0x8> @ imm = #4\n  14: \tbx\tlr\n  \
                     16: \tb.eq\t0x60 <h>\n  18: \tldr\tr0, [pc, #4]  @ 0x20 <g+0x10>\n  1a: \tret";
        let goes = |to, linked| Effect::Goes { to, linked };
        let expected = [
            goes(0x40, true),
            goes(0x20, false),
            Effect::Other,
            goes(0x60, false),
            Effect::Other,
            Effect::Other,
        ];
        assert_eq!(of(lines), expected);
    }

    #[test]
    fn a_long_call_of_riscv_is_two_lines() {
        let lines = "  135f8: \tauipc\tra, 29\n  135fc: \tjalr\t466(ra)\n  13600: \tauipc\tt1, 1048575\n  \
                     13604: \tjr\t16(t1)\n  13608: \tjalr\ta0\n  1360a: \tauipc\tra, 1\n  1360e: \tjalr\tra";
        let effects = of(lines);
        assert_eq!(effects[1], Effect::Goes { to: 0x135f8 + 29 * 4096 + 466, linked: true });
        assert_eq!(effects[3], Effect::Goes { to: 0x13600 - 4096 + 16, linked: false });
        assert_eq!(effects[4], Effect::Points);
        assert_eq!(effects[6], Effect::Goes { to: 0x1460a, linked: true });
    }

    #[test]
    fn a_call_through_a_register_points() {
        let points =
            of("  10: \tblx\tr3\n  12: \tblr\tx8\n  14: \tbr\tx1\n  16: \tmov\tpc, r0\n  18: \tjr\ta5");
        assert!(points.iter().all(|effect| *effect == Effect::Points));
    }
}
