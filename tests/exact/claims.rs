//! `CLAIMS.md` is held to the tree: every test and file that it names is there, every figure that it quotes stands where it says.

use std::fs;
use std::path::PathBuf;

fn here(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn page() -> String {
    fs::read_to_string(here("CLAIMS.md")).expect("the page is checked in")
}

/// What stands between two marks, with what follows it.
fn between<'a>(text: &'a str, open: &'a str, close: &'a str) -> impl Iterator<Item = (&'a str, &'a str)> {
    text.split(open).skip(1).filter_map(move |rest| rest.split_once(close))
}

#[test]
fn every_test_that_claims_name_exists() {
    let page = page();
    let mut named = 0;
    // What stands in backquotes is every other part between them.
    for name in page.split('`').skip(1).step_by(2).filter(|name| name.contains("::")) {
        let parts: Vec<&str> = name.split("::").collect();
        let file = here(&format!("{}/{}.rs", parts[0], parts[1]));
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{name}: {file:?}: {error}"));
        if let Some(test) = parts.get(2) {
            assert!(text.contains(&format!("#[test]\nfn {test}()")), "no test {name}");
        }
        named += 1;
    }
    assert!(named > 20, "{named}");
}

#[test]
fn every_file_that_claims_point_to_exists() {
    let page = page();
    let mut links = 0;
    for (target, _) in between(&page, "](", ")") {
        assert!(here(target).exists(), "{target}");
        links += 1;
    }
    assert!(links > 20, "{links}");
}

#[test]
fn every_figure_in_quotes_stands_in_the_generated_file_beside_it() {
    let page = page();
    let mut quotes = 0;
    for (figure, rest) in between(&page, "“", "”").filter(|(figure, _)| *figure != "quotes") {
        let (file, _) = between(rest, "](", ")").next().expect("a file beside the figure");
        let text = fs::read_to_string(here(file)).expect("a file that exists");
        assert!(text.contains(figure), "{figure} is not in {file}");
        quotes += 1;
    }
    assert!(quotes > 2, "{quotes}");
}
