//! Weaves all mutants in and lets the compiler say which cannot be: those have no type (unviable), or stand where no choice at
//! run time can stand, such as in a `const fn` (left to cargo-mutants itself).

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::find::{Site, sites};
use crate::mutant::{Mutant, Result, is_meant, list};
use crate::weave::{Manner, Weaver};

/// One source file.
struct File {
    source: String,
    woven: String,
    sites: Vec<Site>,
    manners: Vec<Manner>,
}

/// Mutants that the compiler refused, with the code of its error.
type Refused = HashMap<usize, String>;

/// Errors of types: the mutant would not compile by itself either.
const OF_TYPES: [&str; 12] = [
    "E0277", "E0369", "E0368", "E0599", "E0308", "E0433", "E0282", "E0283", "E0600", "E0614", "E0423",
    "E0425",
];

/// Writes the woven sources over those of a tree, and beside them in `place` the number and fate of each that is not woven.
pub fn weave(tree: &Path, listed: &Path, place: &Path, words: &[&str]) -> Result<()> {
    let mutants = list(listed)?;
    let mut files = read(tree, &mutants, words)?;
    let mut refused = Refused::new();
    for round in 1.. {
        for (name, file) in &mut files {
            let weaver = Weaver {
                source: &file.source,
                sites: &file.sites,
                manners: &file.manners,
                refused: &|number| refused.contains_key(&number),
            };
            file.woven = weaver.text();
            if name == "core/src/lib.rs" {
                let module = include_str!("mutation.rs.in").replace("MUTANTS", &mutants.len().to_string());
                file.woven += &module;
            }
            fs::write(tree.join(name), &file.woven)?;
        }
        let errors = check(tree)?;
        eprintln!("round {round}: {} errors", errors.len());
        if errors.is_empty() {
            break;
        }
        let before = (refused.len(), manners(&files));
        for (name, byte, code) in &errors {
            blame(
                files.get_mut(name).ok_or_else(|| format!("an error in {name}"))?,
                *byte,
                code,
                &mut refused,
            );
        }
        if before == (refused.len(), manners(&files)) {
            return Err(format!("errors that are no mutant's: {errors:?}").into());
        }
    }
    record(&mutants, &files, &refused, place)
}

fn manners(files: &BTreeMap<String, File>) -> usize {
    files.values().flat_map(|file| &file.manners).map(|manner| *manner as usize).sum()
}

fn read(tree: &Path, mutants: &[Mutant], words: &[&str]) -> Result<BTreeMap<String, File>> {
    let mut files = BTreeMap::new();
    let named = mutants.iter().map(|mutant| &mutant.file).filter(|file| is_meant(file, words));
    let names = named.cloned().chain(["core/src/lib.rs".to_owned()]);
    for name in names {
        if let Entry::Vacant(free) = files.entry(name) {
            let (source, name) = (fs::read_to_string(tree.join(free.key()))?, free.key());
            let sites = sites(&source, name, mutants).map_err(|error| format!("{name}: {error}"))?;
            let manners = vec![Manner::Reference; sites.len()];
            free.insert(File { source, woven: String::new(), sites, manners });
        }
    }
    Ok(files)
}

/// The compiler's errors: file, byte, code.
fn check(tree: &Path) -> Result<Vec<(String, usize, String)>> {
    let output = Command::new("cargo")
        .args(["check", "--quiet", "-p", "hooke", "--lib", "--features", "std", "--message-format", "json"])
        .env("RUSTFLAGS", "--cap-lints warn")
        .current_dir(tree)
        .output()?;
    let mut errors = Vec::new();
    for line in String::from_utf8(output.stdout)?.lines() {
        let message: Value = serde_json::from_str(line)?;
        let message = &message["message"];
        if message["level"] != "error" {
            continue;
        }
        let code = message["code"]["code"].as_str().unwrap_or_default();
        for span in
            message["spans"].as_array().into_iter().flatten().filter(|span| span["is_primary"] == true)
        {
            let name = span["file_name"].as_str().unwrap_or_default();
            let byte = span["byte_start"].as_u64().unwrap_or_default() as usize;
            errors.push((name.to_owned(), byte, code.to_owned()));
        }
    }
    if errors.is_empty() && !output.status.success() {
        return Err(format!("cargo check: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    Ok(errors)
}

/// The mutant, or else the site, in which an error is takes the blame.
fn blame(file: &mut File, byte: usize, code: &str, refused: &mut Refused) {
    // Marks that are open at this byte: the last opened is the innermost.
    let mut open: Vec<&str> = Vec::new();
    for (at, _) in file.woven[..=byte].match_indices("/*").filter(|(at, _)| *at < byte) {
        let Some(end) = file.woven[at..].find("*/") else { continue };
        let mark = &file.woven[at + 2..at + end];
        match (mark.strip_prefix('<'), mark.strip_suffix('>')) {
            (Some(mark), _) => open.push(mark),
            (_, Some(mark)) if open.last() == Some(&mark) => {
                open.pop();
            }
            _ => {}
        }
    }
    match open.last() {
        Some(mark) if mark.starts_with('A') => {
            if let Ok(number) = mark[1..].parse() {
                refused.entry(number).or_insert_with(|| code.to_owned());
            }
        }
        Some(mark) => {
            if let Ok(index) = mark[1..].parse::<usize>() {
                let manner = &mut file.manners[index];
                *manner = if *manner == Manner::Reference { Manner::Value } else { Manner::Left };
            }
        }
        None => {}
    }
}

/// Number, and why it is not woven.
fn record(mutants: &[Mutant], files: &BTreeMap<String, File>, refused: &Refused, place: &Path) -> Result<()> {
    let mut woven = vec![false; mutants.len() + 1];
    for file in files.values() {
        for (site, manner) in file.sites.iter().zip(&file.manners) {
            for (number, _) in &site.mutants {
                woven[*number] = *manner != Manner::Left;
            }
        }
    }
    let known = fs::read_to_string(place.join("unwoven.tsv")).unwrap_or_default();
    let mut fates: BTreeMap<usize, String> = BTreeMap::new();
    for line in known.lines() {
        fates.insert(line.split('\t').next().unwrap_or_default().parse()?, line.to_owned());
    }
    for (index, mutant) in mutants.iter().enumerate().filter(|(_, mutant)| files.contains_key(&mutant.file)) {
        let fate = match refused.get(&(index + 1)) {
            Some(code) if OF_TYPES.contains(&code.as_str()) => "unviable",
            Some(_) => "left",
            None if woven[index + 1] => continue,
            None => "left",
        };
        fates.insert(index + 1, format!("{}\t{fate}\t{}", index + 1, mutant.name));
    }
    fs::create_dir_all(place)?;
    let lines: Vec<String> = fates.into_values().collect();
    fs::write(place.join("unwoven.tsv"), lines.join("\n") + "\n")?;
    Ok(())
}
