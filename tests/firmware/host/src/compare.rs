//! Compares a target's trace with the golden one, and says where they first part.

use std::collections::BTreeMap;

/// One job's trace.
#[derive(Debug, Default, PartialEq, Eq)]
struct Trace<'a> {
    steps: Vec<&'a str>,
    end: &'a str,
}

/// The traces in a text, by job and precision.
fn parse(text: &str) -> BTreeMap<(&str, &str), Trace<'_>> {
    let mut jobs = BTreeMap::new();
    let mut job = ("", "");
    for line in text.lines() {
        if let Some((name, precision)) = line.strip_prefix("job ").and_then(|rest| rest.split_once(' ')) {
            job = (name, precision);
            jobs.insert(job, Trace::default());
        } else if let Some(trace) = jobs.get_mut(&job) {
            match line.strip_prefix("end ") {
                Some(end) => trace.end = end,
                None => trace.steps.extend(line.split_whitespace()),
            }
        }
    }
    jobs
}

/// Compares; answers how many jobs agree, or the first job and step that differs. With `only`, no other job is
/// expected.
pub fn compare(golden: &str, trace: &str, only: Option<(&str, &str)>) -> Result<usize, String> {
    let mut golden = parse(golden);
    if let Some(only) = only {
        golden.retain(|job, _| *job == only);
    }
    if golden.is_empty() {
        return Err("the golden file has no such job".into());
    }
    let found = parse(trace);
    if let Some((name, precision)) = found.keys().find(|job| !golden.contains_key(*job)) {
        return Err(format!("job {name} {precision} is not in the golden file"));
    }
    for ((name, precision), golden) in &golden {
        let found = found.get(&(*name, *precision)).ok_or(format!("job {name} {precision} is missing"))?;
        let differs = golden.steps.iter().zip(&found.steps).position(|(a, b)| a != b);
        if let Some(step) = differs {
            return Err(format!("job {name} {precision} differs at step {}", step + 1));
        }
        if golden.steps.len() > found.steps.len() {
            return Err(format!("job {name} {precision} stops after step {}", found.steps.len()));
        }
        if golden != found {
            return Err(format!("job {name} {precision}: expected '{}', found '{}'", golden.end, found.end));
        }
    }
    Ok(golden.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOLDEN: &str = "job a f32\n 1111 2222\n 3333\nend 3 steps 5\njob b f32\n 4444\nend 1 steps 1\n";

    #[test]
    fn equal_traces_agree() {
        assert_eq!(compare(GOLDEN, GOLDEN, None), Ok(2));
    }

    #[test]
    fn the_first_step_that_differs_is_named() {
        let why = compare(GOLDEN, &GOLDEN.replace("2222", "2223"), None).unwrap_err();
        assert_eq!(why, "job a f32 differs at step 2");
    }

    #[test]
    fn a_trace_that_stops_is_caught() {
        let why = compare(GOLDEN, "job a f32\n 1111", None).unwrap_err();
        assert_eq!(why, "job a f32 stops after step 1");
    }

    #[test]
    fn a_missing_job_is_caught_unless_only_another_is_expected() {
        let first = "job a f32\n 1111 2222\n 3333\nend 3 steps 5\n";
        assert_eq!(compare(GOLDEN, first, None).unwrap_err(), "job b f32 is missing");
        assert_eq!(compare(GOLDEN, first, Some(("a", "f32"))), Ok(1));
    }

    #[test]
    fn other_totals_are_caught() {
        let why = compare(GOLDEN, &GOLDEN.replace("3 steps 5", "3 steps 6"), None).unwrap_err();
        assert_eq!(why, "job a f32: expected '3 steps 5', found '3 steps 6'");
    }
}
