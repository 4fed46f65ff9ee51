//! The product A x against the memory bound: the time that just reading and writing its operands would take.

use cpu_time::ThreadTime;
use hooke::{Force, Operator};

use crate::bandwidth::{self, Level};
use crate::median::median;
use crate::scenario::Scenario;

/// α, w and the index of the other end.
const PER_SPRING: usize = 4 * 8 + 4;
/// The inertia and a count of springs, x and y read, y written.
const PER_PARTICLE: usize = 8 + 4 + 3 * 24;

/// The product on one scene.
pub(crate) struct Product {
    pub(crate) scene: String,
    pub(crate) dt: f64,
    pub(crate) springs: usize,
    pub(crate) bytes: usize,
    pub(crate) level: Level,
    /// ns per spring
    pub(crate) time: f64,
    /// ns per spring that the memory allows
    pub(crate) allowed: f64,
    /// ns per spring of a step's assembly: forces, Hessians, certificate, right side
    pub(crate) assembly: f64,
    /// Bytes that were resident at once while the scene was measured
    pub(crate) peak: Option<usize>,
}

/// Times the products of all islands, and the assembly, at state 0.
pub(crate) fn product<F: Force<f64> + Clone>(scenario: &mut Scenario<F>, levels: &[Level; 4]) -> Product {
    scenario.put(0);
    let springs = scenario.scene.state().springs();
    let bytes = PER_SPRING * springs + PER_PARTICLE * scenario.particle.len();
    let mut nanoseconds = 0.0;
    let shown = scenario.systems(|system, b, _, _| {
        let mut y = vec![[0.0; 3]; b.len()];
        let passes = (200_000 / b.len()).clamp(3, 2000);
        nanoseconds += median((0..11).map(|_| {
            let began = ThreadTime::now();
            for _ in 0..passes {
                std::hint::black_box(system.apply(std::hint::black_box(b), &mut y));
            }
            began.elapsed().as_nanos() as f64 / passes as f64
        }));
    });
    shown.expect("a step that was made before");
    let assembly = median((0..11).map(|_| {
        let began = ThreadTime::now();
        let shown = scenario.systems(|_, b, _, _| _ = std::hint::black_box(b));
        shown.expect("a step that was made before");
        began.elapsed().as_nanos() as f64
    }));
    let level = bandwidth::home(levels, bytes);
    let per_spring = |x: f64| x / springs.max(1) as f64;
    Product {
        scene: scenario.name.clone(),
        dt: scenario.euler.dt(),
        springs,
        bytes,
        level,
        time: per_spring(nanoseconds),
        allowed: per_spring(bytes as f64 / level.read),
        assembly: per_spring(assembly),
        peak: None,
    }
}
