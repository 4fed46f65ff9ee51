//! Each mutant against the tests that pass it until one fails: first those that noticed other mutants of its file, the last
//! one first; then the quick ones.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;

use crate::mutant::{Result, is_meant, list};
use crate::trace::{Ended, Test, run, tests};

/// Tests of so many seconds together are run at a go.
const GOES: [f64; 4] = [0.2, 2.0, 20.0, f64::INFINITY];
/// Seconds of the tests that noticed others of a file, together.
const NOTICED: f64 = 0.5;
/// A go may take so many times its seconds, and at least so many of a processor, before its mutant counts as one that never ends.
const PATIENCE: (f64, f64) = (5.0, 2.0);

/// Judges mutants of the files that words mean which have no verdict yet; `PLACE/verdicts.tsv` keeps number, verdict, name.
/// Only tests of at most `most` seconds are asked; what they do not notice and a longer test passes has no verdict.
pub fn judge(listed: &Path, place: &Path, most: f64, words: &[&str]) -> Result<()> {
    let mutants = list(listed)?;
    let tests = tests(place, 3.0 * most)?;
    let known = place.join("verdicts.tsv");
    let mut decided: HashSet<usize> = HashSet::new();
    for path in [&known, &place.join("unwoven.tsv")] {
        let text = fs::read_to_string(path).unwrap_or_default();
        decided.extend(text.lines().filter_map(|line| line.split('\t').next()?.parse::<usize>().ok()));
    }
    let mut out = OpenOptions::new().create(true).append(true).open(&known)?;
    let mut noticed: HashMap<&str, Vec<String>> = HashMap::new();
    for (index, mutant) in mutants.iter().enumerate().filter(|(_, mutant)| is_meant(&mutant.file, words)) {
        let before = noticed.entry(&mutant.file).or_default();
        if decided.insert(index + 1)
            && let Some(verdict) = one(index + 1, &tests, most, before)?
        {
            writeln!(out, "{}\t{verdict}\t{}", index + 1, mutant.name)?;
        }
    }
    Ok(())
}

/// What became of one mutant. `noticed`: the tests that noticed one before, the last of them at the end.
fn one(number: usize, tests: &[Test], most: f64, noticed: &mut Vec<String>) -> Result<Option<&'static str>> {
    let mut passing: Vec<&Test> = tests.iter().filter(|test| test.reached.contains(&number)).collect();
    let mut all = tests.iter().all(|test| test.seconds.is_finite());
    if passing.is_empty() {
        return Ok(all.then_some("unreached"));
    }
    all &= passing.iter().all(|test| test.seconds <= most);
    passing.retain(|test| test.seconds <= most);
    passing.reverse(); // Popped from the end, the quickest first.
    let mut first: Vec<&Test> = Vec::new();
    let mut seconds = 0.0;
    for name in noticed.iter().rev() {
        if let Some(k) = passing.iter().position(|test| test.name == *name)
            && seconds + passing[k].seconds <= NOTICED
        {
            seconds += passing[k].seconds;
            first.push(passing.remove(k));
        }
    }
    // One after the other: the last that noticed something mostly notices this too.
    let mut goes: Vec<Vec<&Test>> = first.into_iter().map(|test| vec![test]).collect();
    for go in GOES {
        let (mut taken, mut seconds) = (Vec::new(), 0.0);
        while let Some(test) = passing.pop_if(|test| seconds == 0.0 || seconds + test.seconds <= go) {
            seconds += test.seconds;
            taken.push(test);
        }
        goes.push(taken);
    }
    for go in goes {
        let mut taken: BTreeMap<&Path, Vec<&Test>> = BTreeMap::new();
        go.into_iter().for_each(|test| taken.entry(&test.binary).or_default().push(test));
        for (binary, tests) in taken {
            let names: Vec<&str> = tests.iter().map(|test| test.name.as_str()).collect();
            let all: f64 = tests.iter().map(|test| test.seconds).sum();
            match run(binary, &names, number, (all * PATIENCE.0).max(PATIENCE.1).ceil() as u64)? {
                Ended::Passed => {}
                Ended::Failed(test) => {
                    noticed.retain(|name| *name != test);
                    noticed.push(test);
                    return Ok(Some("caught"));
                }
                Ended::TimedOut => return Ok(Some("timed out")),
            }
        }
    }
    Ok(all.then_some("survived"))
}
