//! Instructions counted, divided by the arithmetic that has to be done: the ratio is what the code costs beyond it.

use std::collections::BTreeMap;

/// The hand counts of a table `| pass | of | flops | loads | stores |`, summed.
fn hand(table: &str) -> Result<BTreeMap<(String, String), f64>, String> {
    let mut counts = BTreeMap::new();
    for line in table.lines().filter(|line| line.starts_with("| ") && !line.contains("---")).skip(1) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [pass, of, numbers @ ..] = cells.as_slice() else { return Err(format!("'{line}' is no count")) };
        let sum = numbers.iter().map(|n| n.parse::<f64>()).sum::<Result<f64, _>>();
        let sum = sum.map_err(|why| format!("'{line}': {why}"))?;
        counts.insert(((*pass).into(), (*of).into()), sum);
    }
    Ok(counts)
}

/// The ratios as lines `ratio what number`, from lines `kind what number` of the measuring program.
pub fn ratios(table: &str, measured: &str) -> Result<String, String> {
    let counts = hand(table)?;
    let count = |pass: &str, of: &str| {
        let key = (pass.to_owned(), of.to_owned());
        counts.get(&key).copied().ok_or(format!("no hand count of {pass} per {of}"))
    };
    let seen = |what: &str| {
        let line =
            measured.lines().find_map(|line| line.split_once(' ')?.1.strip_prefix(what)?.strip_prefix(' '));
        line.and_then(|n| n.parse::<f64>().ok()).ok_or(format!("{what} was not measured"))
    };
    let vectors =
        count("update", "particle")? + count("precondition", "particle")? + count("direction", "particle")?;
    let mut lines = vec![
        ("product-per-spring".to_owned(), seen("product-per-spring")? / count("product", "spring")?),
        ("product-per-particle".to_owned(), seen("product-per-particle")? / count("product", "particle")?),
    ];
    for scene in ["rope40", "cloth8x8"] {
        let of = |what: &str| seen(&format!("{scene}-{what}"));
        lines.push((format!("{scene}-vectors"), of("vectors-per-particle")? / vectors));
        let product = of("pairs")? * count("product", "spring")?
            + of("anchors")? * count("product", "anchor")?
            + of("particles")? * count("product", "particle")?;
        let whole = product + of("particles")? * vectors;
        lines.push((format!("{scene}-product"), of("product")? / product));
        lines.push((format!("{scene}-iteration"), (of("product")? + of("vectors")?) / whole));
    }
    Ok(lines.iter().map(|(what, ratio)| format!("ratio {what} {ratio:.2}\n")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "| pass | of | flops | loads | stores |\n| --- | --- | --: | --: | --: |\n\
        | product | spring | 5 | 3 | 2 |\n| product | anchor | 3 | 1 | 1 |\n| product | particle | 2 | 1 | 1 |\n\
        | update | particle | 3 | 2 | 1 |\n| precondition | particle | 1 | 1 | 1 |\n\
        | direction | particle | 1 | 1 | 1 |\n";

    #[test]
    fn a_ratio_is_what_was_counted_over_what_has_to_be_done() {
        let mut seen =
            "instructions product-per-spring 12.5\ninstructions product-per-particle 6\n".to_owned();
        for scene in ["rope40", "cloth8x8"] {
            for (what, n) in [("vectors-per-particle", 18), ("pairs", 2), ("anchors", 1), ("particles", 3)] {
                seen += &format!("x {scene}-{what} {n}\n");
            }
            seen += &format!("x {scene}-product 74\nx {scene}-vectors 72\n");
        }
        let ratios = ratios(TABLE, &seen).unwrap();
        assert!(
            ratios.starts_with("ratio product-per-spring 1.25\nratio product-per-particle 1.50\n"),
            "{ratios}"
        );
        // The product has to do 2·10 + 5 + 3·4 = 37, the vectors 3·12 = 36.
        assert!(
            ratios.ends_with("vectors 1.50\nratio cloth8x8-product 2.00\nratio cloth8x8-iteration 2.00\n"),
            "{ratios}"
        );
    }

    #[test]
    fn a_missing_count_is_named() {
        assert_eq!(ratios("", "").unwrap_err(), "no hand count of update per particle");
    }
}
