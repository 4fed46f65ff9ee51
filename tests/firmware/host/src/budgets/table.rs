//! The file of the budgets: a compiler, a log, a digest of the numbers, and a table with a column per target.

use firmware_jobs::Digest;

const HEAD: &str = "\
# What may not grow unnoticed, by target: bytes of flash, RAM and stack, instructions. Written by `check.sh lower` and
# `check.sh raise WHY`, never by hand; one `change` per raise. See README.md for what each number is.
";

/// Its contents.
#[derive(Debug, Default)]
pub struct Table {
    compiler: String,
    log: Vec<String>,
    targets: Vec<String>,
    /// Kind and what; a cell per target, `-` where there is no budget.
    rows: Vec<(String, Vec<String>)>,
}

/// A cell's number.
pub fn number(cell: &str) -> Result<f64, String> {
    cell.parse().map_err(|_| format!("'{cell}' in the budgets is no number"))
}

impl Table {
    /// Reads the file; refuses numbers that its digest does not know.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut table = Self::default();
        let mut digest = "";
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let words: Vec<&str> = line.split_whitespace().collect();
            let owned = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
            match words.as_slice() {
                ["rustc", version @ ..] => table.compiler = version.concat(),
                ["change", ..] => table.log.push(line.into()),
                ["digest", value] => digest = value,
                ["kind", "what", targets @ ..] => table.targets = owned(targets),
                [kind, what, cells @ ..] if cells.len() == table.targets.len() => {
                    table.rows.push((format!("{kind} {what}"), owned(cells)));
                }
                _ => return Err(format!("'{line}' is no line of the budgets")),
            }
        }
        if text.is_empty() || digest == table.digest() {
            return Ok(table);
        }
        Err("a budget was changed by hand: use `check.sh lower` or `check.sh raise WHY`".into())
    }

    /// The compiler they were taken under.
    pub fn compiler(&self) -> &str {
        &self.compiler
    }

    /// The budget of a target, if it has one.
    pub fn get(&self, target: &str, row: &str) -> Option<&str> {
        let column = self.targets.iter().position(|name| name == target)?;
        let (_, cells) = self.rows.iter().find(|(name, _)| name == row)?;
        cells.get(column).map(String::as_str).filter(|cell| *cell != "-")
    }

    /// Targets and rows that have a budget.
    pub fn cells(&self) -> impl Iterator<Item = (String, String)> {
        self.rows.iter().flat_map(|(row, cells)| {
            let budgeted = self.targets.iter().zip(cells).filter(|(_, cell)| *cell != "-");
            budgeted.map(|(target, _)| (target.clone(), row.clone()))
        })
    }

    /// Sets a budget; new rows stand after the last one of their kind.
    pub fn set(&mut self, target: &str, row: &str, value: &str) {
        if !self.targets.iter().any(|name| name == target) {
            self.targets.push(target.into());
            self.rows.iter_mut().for_each(|(_, cells)| cells.push("-".into()));
        }
        let kind = |row: &str| row.split(' ').next().map(str::to_owned);
        if !self.rows.iter().any(|(name, _)| name == row) {
            let last = self.rows.iter().rposition(|(name, _)| kind(name) == kind(row));
            let at = last.map_or(self.rows.len(), |last| last + 1);
            self.rows.insert(at, (row.into(), vec!["-".into(); self.targets.len()]));
        }
        let column = self.targets.iter().position(|name| name == target);
        let cells = self.rows.iter_mut().find(|(name, _)| name == row);
        if let Some(cell) = column.zip(cells).and_then(|(column, (_, cells))| cells.get_mut(column)) {
            *cell = value.into();
        }
    }

    /// Forgets a budget, and a row that has none left.
    pub fn remove(&mut self, target: &str, row: &str) {
        self.set(target, row, "-");
        self.rows.retain(|(_, cells)| cells.iter().any(|cell| cell != "-"));
    }

    /// Adds a line to the log.
    pub fn log(&mut self, compiler: &str, why: &str) {
        self.compiler = compiler.into();
        self.log.push(format!("change {why}"));
    }

    /// The file.
    pub fn write(&self) -> String {
        let log: String = self.log.iter().map(|line| format!("{line}\n")).collect();
        format!("{HEAD}\nrustc {}\n{log}digest {}\n\n{}", self.compiler, self.digest(), self.numbers())
    }

    fn digest(&self) -> String {
        let mut digest = Digest::new();
        digest.bytes(self.numbers().as_bytes());
        format!("{:016x}", digest.value())
    }

    fn numbers(&self) -> String {
        let wide = self.rows.iter().map(|(row, _)| row.len()).max().unwrap_or(0) + 4;
        let line = |(row, cells): (&String, &Vec<String>)| {
            let (kind, what) = row.split_once(' ').unwrap_or((row, ""));
            let cells: String = cells.iter().map(|cell| format!(" {cell:>9}")).collect();
            format!("{:wide$}{cells}\n", format!("{kind:<12} {what}"))
        };
        let head = line((&"kind what".into(), &self.targets));
        let rows = self.rows.iter().map(|(row, cells)| line((row, cells)));
        std::iter::once(head).chain(rows).collect()
    }
}
