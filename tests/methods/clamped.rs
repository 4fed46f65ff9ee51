//! Observed orders where springs are clamped in every step.

use std::f64::consts::PI;

use hooke_tests::build;
use hooke_tests::data::{SceneData, SpringData};
use hooke_tests::methods::{IMPLICIT, options};

use super::orders::{ORDERS, order_of, state};

/// A prestressed string of 400 particles whose links are two springs side by side, one that pulls and one that pushes with nine
/// tenths of that; swinging in its lowest modes. Transversally it is stable, and its own motion that of single springs, but in
/// each link a spring is pressed to an eighth of its rest length.
fn pushed() -> SceneData {
    let n = 400;
    let (links, mass) = ((n - 1) as f64, 1.0 / n as f64);
    let mut string = SceneData::default();
    for i in 0..n {
        let [x, swing, twice] = [1.0, PI, 2.0 * PI].map(|turn| turn * i as f64 / links);
        let (swing, twice) = (0.02 * swing.sin(), 0.02 * twice.sin());
        string.particle([x + 0.3 * twice, swing, 0.5 * twice], mass);
        string.velocity[i] = [0.0, 0.0, swing];
    }
    for end in [0, n - 1] {
        (string.position[end], string.velocity[end]) = ([end as f64 / links, 0.0, 0.0], [0.0; 3]);
        string.pinned[end] = true;
    }
    for i in 1..n {
        // Together links N/m (1 N for a strain of 1), and a fifth of that as tension.
        let (pull, push) = (0.9 * links, 0.1 * links);
        let rest = 0.8 / links * (links / push);
        string.springs.push(SpringData { a: i - 1, b: i, k: pull, l0: 0.0, c: 0.0 });
        string.springs.push(SpringData { a: i - 1, b: i, k: push, l0: rest, c: 0.0 });
    }
    string
}

/// What is clamped is what resists how *differently* neighbours move: that the order can be seen takes a motion of long waves, at a
/// step that is long for short ones.
#[test]
fn where_every_step_clamps_a_spring_of_every_link_methods_have_their_order() {
    let string = pushed();
    let mut off = Vec::new();
    for (method, order) in ORDERS.into_iter().filter(|(method, _)| IMPLICIT.contains(method)) {
        let steps = if order < 1.5 { 64 } else { 16 };
        let ends = [1, 2, 4].map(|n| {
            let mut scene = build::scene::<f64>(&string);
            let h = 0.5 / f64::from(n * steps);
            for step in 0..n * steps {
                let made = method.step(&mut scene, options(h, 1e-12), (), &[]).unwrap();
                assert_eq!(made.clamped, 399, "{method:?}, step {step} of {h} s");
            }
            state(&scene)
        });
        let found = order_of(&ends);
        println!("{method:?}, 399 of 798 springs clamped: {found:.2}");
        if (found - order).abs() > 0.1 {
            off.push((method, found));
        }
    }
    assert!(off.is_empty(), "{off:?}");
}
