//! Pinning and releasing while the rope swings.

use hooke::{Hookean, LinearlyImplicitEuler, MassSpring, Memory};

use crate::outcome::{Outcome, expect};
use crate::scenes::{dt, gravity, hang};
use crate::trace::Trace;

crate::job::both_precisions!("pin-release", 12, 11, Hookean);

fn run<M: Memory>(scene: &mut MassSpring<M>, trace: &mut Trace<'_>) -> Outcome {
    hang(scene, 12)?;
    let mut euler = LinearlyImplicitEuler::new(dt()).gravity(gravity());
    for tick in 0..60 {
        match tick {
            15 => scene.pin(6)?,
            30 => scene.release(0)?,
            45 => {
                scene.release(6)?;
                scene.pin(11)?;
            }
            _ => {}
        }
        let report = scene.step(&mut euler)?;
        // A rope pinned at its end and in its middle is two islands.
        expect(
            report.islands == if (15..30).contains(&tick) { 2 } else { islands_of_one_rope(tick) },
            "islands",
        )?;
        trace.step(scene, &report)?;
    }
    Ok(())
}

/// Pinned in the middle alone, the rope has a part on either side.
fn islands_of_one_rope(tick: u32) -> u32 {
    if (30..45).contains(&tick) { 2 } else { 1 }
}
