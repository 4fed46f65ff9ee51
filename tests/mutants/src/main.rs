//! Every mutant of core that cargo-mutants lists, in one build: README.md tells how.
//!
//!     hooke-mutants weave TREE LIST PLACE [WORD…]   mutants of the files that words mean, into TREE, each asleep
//!     hooke-mutants judge LIST PLACE SECONDS [WORD…]   which of them a test of so many seconds notices
//!     hooke-mutants page TREE LIST PLACE REASONS    the page's tables

mod find;
mod judge;
mod mutant;
mod page;
mod settle;
mod trace;
mod weave;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["weave", tree, list, place, words @ ..] => {
            settle::weave(Path::new(tree), Path::new(list), Path::new(place), words)
        }
        ["judge", list, place, most, words @ ..] => match most.parse() {
            Ok(most) => judge::judge(Path::new(list), Path::new(place), most, words),
            Err(error) => Err(format!("{most}: {error}").into()),
        },
        ["page", tree, list, place, reasons] => {
            page::page(Path::new(tree), Path::new(list), Path::new(place), Path::new(reasons))
        }
        _ => Err(
            "weave TREE LIST PLACE [WORD…] | judge LIST PLACE SECONDS [WORD…] | page TREE LIST PLACE REASONS"
                .into(),
        ),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("hooke-mutants: {error}");
            ExitCode::FAILURE
        }
    }
}
