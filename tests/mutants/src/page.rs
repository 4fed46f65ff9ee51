//! The page: by file what became of its mutants, and every survivor with its reason, or without one.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::Path;

use crate::mutant::{Mutant, Result, list};

/// Why some survivors may live: `file | part of what is changed | part of the line | reason`, an empty field matches all.
struct Reason {
    file: String,
    what: String,
    line: String,
    why: String,
}

fn reasons(path: &Path) -> Result<Vec<Reason>> {
    let mut reasons = Vec::new();
    for (number, line) in fs::read_to_string(path)?.lines().enumerate() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line.split(" | ").map(str::trim).collect();
        let [file, what, line, why] = fields[..] else {
            return Err(
                format!("{}:{}: not `file | what | line | reason`", path.display(), number + 1).into()
            );
        };
        reasons.push(Reason { file: file.into(), what: what.into(), line: line.into(), why: why.into() });
    }
    Ok(reasons)
}

/// What is counted of a file.
#[derive(Default, Clone)]
struct Count {
    unviable: usize,
    caught: usize,
    timed_out: usize,
    reasoned: usize,
    survived: usize,
    unreached: usize,
    left: usize,
    waiting: usize,
}

impl Count {
    fn add(&mut self, other: &Count) {
        self.unviable += other.unviable;
        self.caught += other.caught;
        self.timed_out += other.timed_out;
        self.reasoned += other.reasoned;
        self.survived += other.survived;
        self.unreached += other.unreached;
        self.left += other.left;
        self.waiting += other.waiting;
    }

    fn judged(&self) -> usize {
        self.caught + self.timed_out + self.reasoned + self.survived + self.unreached
    }

    fn row(&self, name: &str) -> String {
        // What is to do counts as not noticed.
        let (found, judged) = (self.caught + self.timed_out, self.judged() + self.waiting);
        let score =
            if found == 0 { "–".into() } else { format!("{:.1} %", 100.0 * found as f64 / judged as f64) };
        format!(
            "| {name} | {judged} | {} | {} | {score} | {} | {} | {} | {} | {} | {} |\n",
            self.caught,
            self.timed_out,
            self.reasoned,
            self.survived,
            self.unreached,
            self.unviable,
            self.left,
            self.waiting
        )
    }
}

const HEAD: &str = "| file | viable | caught | timed out | score | live for a reason | live without | passed by no test | unviable | left | to do |\n\
                    | --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |\n";

/// Writes the page's generated part to standard output.
pub fn page(tree: &Path, listed: &Path, place: &Path, why: &Path) -> Result<()> {
    let mutants = list(listed)?;
    let reasons = reasons(why)?;
    let mut verdicts: HashMap<usize, String> = HashMap::new();
    for name in ["unwoven.tsv", "verdicts.tsv", "by_cargo.tsv"] {
        for line in fs::read_to_string(place.join(name)).unwrap_or_default().lines() {
            let mut fields = line.split('\t');
            if let (Some(number), Some(verdict)) = (fields.next(), fields.next()) {
                verdicts.insert(number.parse()?, verdict.to_owned());
            }
        }
    }
    let mut sources: HashMap<&str, Vec<String>> = HashMap::new();
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    let mut live: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut bare: Vec<String> = Vec::new();
    for (index, mutant) in mutants.iter().enumerate() {
        let count = counts.entry(&mutant.file).or_default();
        let verdict = verdicts.get(&(index + 1)).map_or("", String::as_str);
        match verdict {
            "unviable" => count.unviable += 1,
            "left" => count.left += 1,
            "caught" => count.caught += 1,
            "timed out" => count.timed_out += 1,
            "survived" | "unreached" => {
                if !sources.contains_key(mutant.file.as_str()) {
                    let text = fs::read_to_string(tree.join(&mutant.file))?;
                    sources.insert(&mutant.file, text.lines().map(str::to_owned).collect());
                }
                let line =
                    sources[mutant.file.as_str()].get(mutant.start.0 - 1).map_or("", |line| line.trim());
                match reasons.iter().find(|reason| reason.fits(mutant, line)) {
                    Some(reason) => {
                        count.reasoned += 1;
                        live.entry(format!("{}: {}", short(&mutant.file), reason.why))
                            .or_default()
                            .push(told(mutant, line));
                    }
                    None => {
                        *(if verdict == "survived" { &mut count.survived } else { &mut count.unreached }) +=
                            1;
                        bare.push(format!("- `{}` {}", short(&mutant.file), told(mutant, line)));
                    }
                }
            }
            _ => count.waiting += 1,
        }
    }
    let mut all = Count::default();
    for count in counts.values() {
        all.add(count);
    }
    let found = all.caught + all.timed_out;
    println!(
        "Noticed: **{found}** of {} that are or may be viable, {} of them to do; {} listed.\n",
        all.judged() + all.waiting,
        all.waiting,
        mutants.len()
    );
    print!("{HEAD}");
    for (file, count) in &counts {
        print!("{}", count.row(&format!("`{}`", short(file))));
    }
    print!("{}", all.row("**all**"));
    println!("\n## Live for a reason\n");
    for (why, mutants) in live {
        println!("- **{why}**");
        for mutant in mutants {
            println!("  - {mutant}");
        }
    }
    println!("\n## Live without a reason yet\n");
    for line in bare {
        println!("{line}");
    }
    Ok(())
}

fn short(file: &str) -> &str {
    file.strip_prefix("core/src/").unwrap_or(file)
}

fn told(mutant: &Mutant, line: &str) -> String {
    format!("{}:{} {}: `{line}`", mutant.start.0, mutant.start.1, mutant.what())
}

impl Reason {
    fn fits(&self, mutant: &Mutant, line: &str) -> bool {
        mutant.file.contains(&self.file) && mutant.what().contains(&self.what) && line.contains(&self.line)
    }
}
