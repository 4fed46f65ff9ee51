//! The budgets: what the kernel may cost on each target. They only tighten, unless someone says why.
//!
//! What was seen are lines `target kind what number`. More than 2 % above its budget fails, more than 2 % below is told.
//! `lower` takes all that is lower; `raise` takes that and what is above or new, and logs why.

mod table;

use std::fmt::Write;

use table::Table;

/// What a check has to say.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Fails.
    pub over: Vec<String>,
    /// May be lowered.
    pub under: Vec<String>,
}

/// What may be left unsaid: counts and sizes move a little with whatever the compiler does elsewhere.
const SLACK: f64 = 0.02;

/// The most that passes under a budget.
fn above(budget: f64) -> f64 {
    budget + SLACK * budget.abs()
}

/// One number that was seen.
struct Seen<'a> {
    target: &'a str,
    /// Kind and what.
    row: String,
    text: &'a str,
    value: f64,
}

fn seen(text: &str) -> Result<Vec<Seen<'_>>, String> {
    let line = |line: &'_ str| format!("'{line}' is not: target kind what number");
    let read = |all| -> Result<Seen<'_>, String> {
        let words: Vec<&str> = str::split_whitespace(all).collect();
        let [target, kind, what, text] = words.as_slice() else { return Err(line(all)) };
        let value = text.parse().map_err(|_| line(all))?;
        Ok(Seen { target, row: format!("{kind} {what}"), text, value })
    };
    text.lines().map(read).collect()
}

/// The compiler under which the budgets were taken.
pub fn compiler(file: &str) -> Result<String, String> {
    Ok(Table::parse(file)?.compiler().to_owned())
}

/// Compares what was seen with the budgets.
pub fn check(file: &str, numbers: &str) -> Result<Verdict, String> {
    let table = Table::parse(file)?;
    let (mut verdict, numbers) = (Verdict::default(), seen(numbers)?);
    for Seen { target, row, text, value } in &numbers {
        let Some(budget) = table.get(target, row) else {
            verdict.over.push(format!("{target}: {row} is {text}, and has no budget"));
            continue;
        };
        let allowed = table::number(budget)?;
        if *value > above(allowed) {
            verdict.over.push(format!("{target}: {row} is {text}, budget {budget}"));
        } else if *value < allowed - SLACK * allowed.abs() {
            verdict.under.push(format!("{target}: {row} is {text}, budget {budget}"));
        }
    }
    for (target, row) in gone(&table, &numbers) {
        verdict.over.push(format!("{target}: {row} has a budget, but was not seen"));
    }
    Ok(verdict)
}

/// Budgets of the targets seen that nothing was seen for.
fn gone(table: &Table, numbers: &[Seen<'_>]) -> Vec<(String, String)> {
    let known = |target: &str| numbers.iter().any(|seen| seen.target == target);
    let met = |target: &str, row: &str| numbers.iter().any(|seen| seen.target == target && seen.row == row);
    table.cells().filter(|(target, row)| known(target) && !met(target, row)).collect()
}

/// The file with every budget that can be lower; those of what is no more are gone.
pub fn lowered(file: &str, numbers: &str) -> Result<String, String> {
    let mut table = Table::parse(file)?;
    let numbers = seen(numbers)?;
    for (target, row) in gone(&table, &numbers) {
        table.remove(&target, &row);
    }
    for Seen { target, row, text, value } in &numbers {
        if let Some(budget) = table.get(target, row)
            && *value < table::number(budget)?
        {
            table.set(target, row, text);
        }
    }
    Ok(table.write())
}

/// The file with what was seen as its budgets, under this compiler, and a line that says why some are higher or new.
pub fn raised(file: &str, numbers: &str, compiler: &str, why: &str) -> Result<String, String> {
    let why = why.trim();
    if why.is_empty() || why.contains('\n') {
        return Err("say in one line why budgets are raised".into());
    }
    let mut table = Table::parse(&lowered(file, numbers)?)?;
    let (mut first, mut others) = (String::new(), 0);
    for Seen { target, row, text, value } in &seen(numbers)? {
        let before = table.get(target, row).map(str::to_owned);
        if before
            .as_ref()
            .is_some_and(|before| table::number(before).is_ok_and(|before| *value <= above(before)))
        {
            continue;
        }
        if first.is_empty() {
            _ = write!(first, "{target} {row} {} to {text}", before.as_deref().unwrap_or("nothing"));
        } else {
            others += 1;
        }
        table.set(target, row, text);
    }
    if first.is_empty() {
        return Err("nothing is above its budget".into());
    }
    table.log(compiler, &format!("{why} ({first}; {others} more)"));
    Ok(table.write())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> String {
        raised("", "m0 flash minimal 1000\nm4 flash minimal 2000\nm4 stack step -50", "1.95.0", "first")
            .unwrap()
    }

    #[test]
    fn two_percent_above_passes_and_more_fails() {
        let of = |numbers| check(&file(), numbers).unwrap();
        assert_eq!(of("m0 flash minimal 1020"), Verdict::default());
        assert_eq!(of("m0 flash minimal 1021").over, ["m0: flash minimal is 1021, budget 1000"]);
        assert_eq!(of("m0 flash minimal 979").under, ["m0: flash minimal is 979, budget 1000"]);
    }

    #[test]
    fn a_number_without_budget_and_a_budget_without_number_fail() {
        let over = check(&file(), "m4 flash minimal 2000\nm4 flash more 1").unwrap().over;
        assert_eq!(over[0], "m4: flash more is 1, and has no budget");
        assert_eq!(over[1], "m4: stack step has a budget, but was not seen");
    }

    #[test]
    fn lowering_never_raises() {
        let lower =
            lowered(&file(), "m4 flash minimal 1900\nm4 stack step -40\nm0 flash minimal 1001").unwrap();
        let of = |numbers| check(&lower, numbers).unwrap();
        assert_eq!(of("m4 flash minimal 1900\nm4 stack step -50"), Verdict::default());
        assert_eq!(of("m0 flash minimal 1000"), Verdict::default());
    }

    #[test]
    fn raising_needs_a_reason_and_logs_it() {
        assert!(raised(&file(), "m0 flash minimal 1100", "1.95.0", " ").is_err());
        assert!(raised(&file(), "m0 flash minimal 1020", "1.95.0", "hardly").is_err());
        let text = raised(&file(), "m0 flash minimal 1100", "1.95.0", "more features").unwrap();
        assert!(text.contains("change more features (m0 flash minimal 1000 to 1100; 0 more)\n"), "{text}");
    }

    #[test]
    fn a_budget_changed_by_hand_is_refused() {
        let text = file().replace("2000", "3000");
        assert!(check(&text, "m0 flash minimal 1000").unwrap_err().contains("by hand"));
    }
}
