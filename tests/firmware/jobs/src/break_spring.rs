//! A spring breaks: what hung below it falls as an island of its own.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, hang};
use crate::trace::Trace;

crate::job::both_precisions!("break-spring", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for tick in 0..48 {
        if tick == 20 {
            scene.break_spring(5)?;
        }
        let report = scene.step(&mut euler)?;
        trace.step(scene, &report)?;
        expect(report.islands == if tick < 20 { 1 } else { 2 }, "two islands once the spring is broken")?;
    }
    Ok(())
}
