//! A step: without a force, with each force alone, with all of them; in arrays and in buffers.

use hooke::{Drag, Gravity, Hookean, Motion, PointForce, PointSpring, Scene, SpringDamping};

use crate::shared::*;

/// The same scene without cables.
type Springs<T> = Scene<T, 40, 80, Hookean>;

crate::entry_point::entry_points! {
    MassSpring::step[no_force](s: &mut Springs<T>, euler: &mut Euler<T>) -> Stepped<T> { s.step(euler) }
    MassSpring::step[gravity](s: &mut Springs<T>, euler: &mut Euler<T, ((), Gravity<T>)>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[drag](s: &mut Springs<T>, euler: &mut Euler<T, ((), Drag<T>)>) -> Stepped<T> { s.step(euler) }
    MassSpring::step[damping](s: &mut Springs<T>, euler: &mut Euler<T, ((), SpringDamping<T>)>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[dampings](s: &mut Springs<T>, euler: &mut Euler<T, ((), SpringDamping<&[T]>)>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[point_force](s: &mut Springs<T>, euler: &mut Euler<T, ((), PointForce<T>)>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[point_spring](s: &mut Springs<T>, euler: &mut Euler<T, ((), PointSpring<T>)>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[point_springs](
        s: &mut Springs<T>, euler: &mut Euler<T, ((), &mut [PointSpring<T>])>,
    ) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step[cables](s: &mut S<T>, euler: &mut Euler<T>) -> Stepped<T> { s.step(euler) }
    MassSpring::step[all](s: &mut S<T>, euler: &mut Euler<T, All<'_, T>>) -> Stepped<T> { s.step(euler) }
    MassSpring::step[in_buffers](s: &mut Borrowed<'_, T>, euler: &mut Euler<T, All<'_, T>>) -> Stepped<T> {
        s.step(euler)
    }
    MassSpring::step_moving(
        s: &mut S<T>, euler: &mut Euler<T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(euler, motion)
    }
    MassSpring::step_watched(
        s: &mut S<T>, euler: &mut Euler<T, All<'_, T>>, motion: &[Motion<T>], seen: &mut u32,
    ) -> Stepped<T> {
        s.step_watched(euler, motion, |island| *seen += island.solve.iterations)
    }
}
