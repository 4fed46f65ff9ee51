//! The tables on stdout, within 160 columns.

use comfy_table::{CellAlignment, Table, presets};

use crate::bandwidth::Level;
use crate::iteration::Iteration;
use crate::operator::Product;
use crate::row::Row;
use crate::summary::Line;

/// A table whose first `left` columns are text and the others numbers.
pub(crate) fn table(header: &[&str], left: usize, lines: impl Iterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_header(header);
    for line in lines {
        table.add_row(line);
    }
    for (k, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        column.set_cell_alignment(if k < left { CellAlignment::Left } else { CellAlignment::Right });
    }
    let text = table.to_string();
    text.lines().map(|line| line.trim_end().to_string() + "\n").collect()
}

/// About three digits.
pub(crate) fn short(x: f64) -> String {
    let decimals = match x.abs() {
        _ if x.is_nan() => return "NaN".into(),
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        size if size >= 0.1 => 3,
        size if size >= 0.01 => 4,
        _ => 5,
    };
    format!("{x:.decimals$}")
}

fn power(x: f64) -> String {
    if x.is_nan() { "NaN".into() } else { format!("{x:.0e}") }
}

/// A scene's name in a table: a file's without its folders.
fn scene(name: &str) -> String {
    name.rsplit(['/', '\\']).next().unwrap_or(name).chars().take(18).collect()
}

/// A ratio or another number that may not be there.
fn maybe(x: Option<f64>) -> String {
    x.map_or("-".into(), short)
}

/// A direct peer does not iterate: its lines at several tolerances are one, shown at the first.
fn shown(row: &Row, first: Option<f64>) -> bool {
    !row.direct || row.tolerance == first
}

/// The comparison.
pub(crate) fn comparison(rows: &[Row]) -> String {
    let header = [
        "scene",
        "dt",
        "R",
        "method",
        "ms",
        "worst",
        "iter",
        "bound J",
        "worst",
        "error",
        "worst",
        "MB",
        "ratio",
        "to best peer",
    ];
    let first = rows.first().and_then(|row| row.tolerance);
    let lines = rows.iter().filter(|row| shown(row, first)).map(|row| {
        let tolerance = row.tolerance.filter(|_| !row.direct);
        let unfinished = if row.unfinished > 0 { "!" } else { "" };
        vec![
            scene(&row.scene),
            format!("{:.4}", row.dt),
            tolerance.map_or("exact".into(), power),
            row.method.clone(),
            short(row.ms),
            if row.once { "once".into() } else { short(row.ms_worst) },
            if row.direct { "-".into() } else { format!("{}{unfinished}", row.iterations) },
            power(row.bound),
            power(row.bound_worst),
            power(row.error),
            power(row.error_worst),
            short(row.bytes as f64 / 1e6),
            maybe(row.ratio),
            row.best_peer.clone().unwrap_or("-".into()),
        ]
    });
    table(&header, 4, lines)
}

/// What the comparison comes to, at one tolerance.
pub(crate) fn summary(lines: &[Line<'_>], tolerance: f64) -> String {
    let header = [
        "scene",
        "dt",
        "hooke's fastest",
        "ms",
        "error",
        "worst",
        "direct peer",
        "ratio",
        "to faer",
        "peer as exact",
        "ratio",
    ];
    let lines = lines.iter().map(|line| {
        let Line { hooke, direct, faer } = line;
        vec![
            scene(&hooke.scene),
            format!("{:.4}", hooke.dt),
            hooke.method.trim_start_matches("hooke ").into(),
            short(hooke.ms),
            power(hooke.error),
            power(hooke.error_worst),
            direct.map_or("-".into(), |peer| peer.method.clone()),
            maybe(line.ratio(*direct)),
            maybe(line.ratio(*faer)),
            hooke.best_peer.clone().unwrap_or("-".into()),
            maybe(hooke.ratio),
        ]
    });
    format!("R = {tolerance:e}\n{}", table(&header, 3, lines))
}

/// Iterations against the memory bound.
pub(crate) fn iterations(iterations: &[Iteration]) -> String {
    let header =
        ["scene", "dt", "iteration of", "lives in", "µs", "ns/spring", "memory bound ns/spring", "multiple"];
    let lines = iterations.iter().map(|i| {
        let per_spring = |x: f64| x / i.springs.max(1) as f64;
        vec![
            scene(&i.scene),
            format!("{:.4}", i.dt),
            i.method.into(),
            i.level.name.into(),
            maybe(i.time.map(|ns| 1e-3 * ns)),
            maybe(i.time.map(per_spring)),
            short(per_spring(i.allowed)),
            maybe(i.time.map(|ns| ns / i.allowed)),
        ]
    });
    table(&header, 4, lines)
}

/// The operator against the memory bound.
pub(crate) fn products(products: &[Product], levels: &[Level; 4]) -> String {
    let speeds = levels.iter().map(|level| vec![level.name.into(), short(level.read)]);
    let header = [
        "scene",
        "dt",
        "springs",
        "MB",
        "lives in",
        "product ns/spring",
        "memory bound",
        "multiple",
        "assembly ns/spring",
        "peak MB",
    ];
    let lines = products.iter().map(|p| {
        vec![
            scene(&p.scene),
            format!("{:.4}", p.dt),
            p.springs.to_string(),
            short(p.bytes as f64 / 1e6),
            p.level.name.into(),
            short(p.time),
            short(p.allowed),
            short(p.time / p.allowed),
            short(p.assembly),
            maybe(p.peak.map(|bytes| bytes as f64 / 1e6)),
        ]
    });
    table(&["memory", "read GB/s"], 1, speeds) + "\n" + &table(&header, 1, lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::tests::row;

    fn width(text: &str) -> usize {
        text.lines().map(|line| line.chars().count()).max().unwrap()
    }

    #[test]
    fn the_widest_line_fits_160_columns() {
        let mut wide = row("hooke block-Jacobi PCG", Some(1e-10), 123_456.0, 1.23e-10);
        wide.scene = "/some/where/lattice:100x100x100.mesh".into();
        (wide.iterations, wide.bytes, wide.ratio) = (99_999.5, 1 << 33, Some(0.001));
        wide.best_peer = Some("CHOLMOD supernodal".into());
        let line = Line { hooke: &wide, direct: Some(&wide), faer: Some(&wide) };
        let ratios = summary(&[line], 1e-10);
        assert!(width(&ratios) <= 160 && ratios.contains("1.00"), "{}:\n{ratios}", width(&ratios));
        let text = comparison(&[wide]);
        assert!(width(&text) <= 160, "{}:\n{text}", width(&text));
        assert!(!text.contains("/some/where"));
    }
}
