//! What a run comes to: per scene, time step and tolerance Hooke's fastest method, and how many times longer the fastest
//! direct peer, faer, and the fastest peer that is about as exact (see [`crate::row`]) take.

use crate::row::Row;

/// A scene, solved at one time step to one tolerance.
pub(crate) struct Line<'a> {
    /// Hooke's fastest
    pub(crate) hooke: &'a Row,
    /// The fastest direct peer
    pub(crate) direct: Option<&'a Row>,
    pub(crate) faer: Option<&'a Row>,
}

impl Line<'_> {
    /// How many times Hooke's time a peer takes.
    pub(crate) fn ratio(&self, peer: Option<&Row>) -> Option<f64> {
        peer.map(|peer| peer.ms / self.hooke.ms)
    }
}

/// The lines of one tolerance, scenes in their order. Rows are rated: a direct peer has one per tolerance.
pub(crate) fn lines(rows: &[Row], tolerance: f64) -> Vec<Line<'_>> {
    let mut scenes: Vec<(&str, f64)> = Vec::new();
    for row in rows {
        let scene = (row.scene.as_str(), row.dt);
        if !scenes.contains(&scene) {
            scenes.push(scene);
        }
    }
    let line = |(scene, dt): (&str, f64)| {
        let here =
            || rows.iter().filter(|r| r.scene == scene && r.dt == dt && r.tolerance == Some(tolerance));
        let fastest =
            |counts: fn(&Row) -> bool| here().filter(|row| counts(row)).min_by(|a, b| a.ms.total_cmp(&b.ms));
        // An answer that is NaN, or that was not finished, is none.
        let hooke = fastest(|row| !row.peer && row.unfinished == 0 && (row.error + row.bound).is_finite())?;
        let faer = here().find(|row| row.method.starts_with("faer"));
        Some(Line { hooke, direct: fastest(|row| row.peer && row.direct), faer })
    };
    scenes.into_iter().filter_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::{rate, tests::row};

    #[test]
    fn the_fastest_of_hooke_stands_beside_the_fastest_of_each_kind_of_peer() {
        let mut rows = vec![
            row("faer LLT", None, 8.0, 1e-14),
            row("CHOLMOD", None, 6.0, 1e-14),
            row("Eigen CG", Some(1e-3), 4.0, 1e-3),
            row("hooke a", Some(1e-3), 3.0, 1e-3),
            row("hooke b", Some(1e-3), 2.0, 1e-3),
            row("hooke c", Some(1e-3), 1.0, f64::NAN),
            row("hooke a", Some(1e-6), 5.0, 1e-6),
        ];
        let given_up = Row { unfinished: 1, ..row("hooke d", Some(1e-3), 0.5, 1e-3) };
        rows.push(given_up);
        rate(&mut rows, &[1e-3, 1e-6]);
        let lines = lines(&rows, 1e-3);
        assert_eq!(lines.len(), 1);
        let line = &lines[0];
        assert_eq!(line.hooke.method, "hooke b");
        assert_eq!(line.direct.map(|row| row.method.as_str()), Some("CHOLMOD"));
        assert_eq!((line.ratio(line.direct), line.ratio(line.faer)), (Some(3.0), Some(4.0)));
        assert_eq!((line.hooke.best_peer.as_deref(), line.hooke.ratio), (Some("Eigen CG"), Some(2.0)));
    }

    #[test]
    fn the_same_scene_at_two_time_steps_is_two_lines() {
        let mut rows = vec![row("faer LLT", None, 8.0, 1e-14), row("hooke", Some(1e-3), 2.0, 1e-3)];
        let mut finer: Vec<_> = rows.iter().map(|r| Row { dt: 0.001, ms: 0.5 * r.ms, ..r.clone() }).collect();
        rate(&mut rows, &[1e-3]);
        rate(&mut finer, &[1e-3]);
        rows.extend(finer);
        let lines = lines(&rows, 1e-3);
        assert_eq!(
            lines.iter().map(|l| (l.hooke.dt, l.hooke.ms)).collect::<Vec<_>>(),
            [(0.01, 2.0), (0.001, 1.0)]
        );
    }
}
