//! Every method of time integration besides linearly-implicit Euler: made, and in a step under all forces.

use hooke::{
    Adaptive, BandedLdl, Course, Embedded, EnergyMomentum, Force, LocalError, Made, Midpoint, Motion, Newton,
    Parts, Probed, Report, Rosenbrock2, Rosenbrock3, StepError, SymplecticEuler, Verlet, force::Rows,
};

use crate::shared::*;

type W<'a, T> = &'a mut [V<T>];
type Ros2<'a, T, F = ()> = Rosenbrock2<T, W<'a, T>, F>;
type Ros3<'a, T, F = ()> = Rosenbrock3<T, W<'a, T>, F>;
type Backward<'a, T, F = ()> = Newton<T, W<'a, T>, F>;
type Conserving<'a, T, F = ()> = EnergyMomentum<T, W<'a, T>, F>;
type Controlled<'a, T, F = ()> = Adaptive<Ros2<'a, T, F>, T>;
type Direct<'a, T> = Rosenbrock3<T, W<'a, T>, All<'a, T>, BandedLdl<&'a mut [T]>>;

crate::entry_point::entry_points! {
    Stepper::new[midpoint](dt: T) -> Midpoint<T> { Midpoint::new(dt) }
    Stepper::new[ros2]<'a>(dt: T, memory: W<'a, T>) -> Ros2<'a, T> { Ros2::new(dt, memory) }
    Stepper::new[ros3]<'a>(dt: T, memory: W<'a, T>) -> Ros3<'a, T> { Ros3::new(dt, memory) }
    Stepper::new[newton]<'a>(dt: T, memory: W<'a, T>) -> Backward<'a, T> { Backward::new(dt, memory) }
    Stepper::new[energy_momentum]<'a>(dt: T, memory: W<'a, T>) -> Conserving<'a, T> { Conserving::new(dt, memory) }
    Stepper::new[verlet](dt: T) -> Verlet<T> { Verlet::new(dt) }
    Stepper::new[symplectic_euler](dt: T) -> SymplecticEuler<T> { SymplecticEuler::new(dt) }
    Stepper::needs[ros2](particles: usize, _x: T) -> usize { Rosenbrock2::<T, ()>::needs(particles) }
    Stepper::needs[ros3](particles: usize, _x: T) -> usize { Rosenbrock3::<T, ()>::needs(particles) }
    Stepper::needs[newton](particles: usize, _x: T) -> usize { Newton::<T, ()>::needs(particles) }
    Stepper::needs[energy_momentum](particles: usize, _x: T) -> usize { EnergyMomentum::<T, ()>::needs(particles) }
    Stepper::substeps_at_most(verlet: Verlet<T>, n: u32) -> Verlet<T> { verlet.substeps_at_most(n) }
    Stepper::limit[verlet](verlet: &mut Verlet<T, All<'_, T>>, s: &mut S<T>) -> T { verlet.limit(s) }
    Stepper::limit[symplectic_euler](euler: &mut SymplecticEuler<T, All<'_, T>>, s: &mut S<T>) -> T { euler.limit(s) }
    MassSpring::step_moving[midpoint](
        s: &mut S<T>, method: &mut Midpoint<T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step_moving[ros2](
        s: &mut S<T>, method: &mut Ros2<'_, T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step_moving[ros3](
        s: &mut S<T>, method: &mut Ros3<'_, T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step[direct](s: &mut S<T>, method: &mut Direct<'_, T>) -> Stepped<T> { s.step(method) }
    MassSpring::step_moving[newton](
        s: &mut S<T>, method: &mut Backward<'_, T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step_moving[energy_momentum](
        s: &mut S<T>, method: &mut Conserving<'_, T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step_moving[verlet](
        s: &mut S<T>, method: &mut Verlet<T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step_moving[symplectic_euler](
        s: &mut S<T>, method: &mut SymplecticEuler<T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    MassSpring::step_moving[adaptive](
        s: &mut S<T>, method: &mut Controlled<'_, T, All<'_, T>>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    Adaptive::new<'a>(method: Ros2<'a, T>, dt: T, joules: T) -> Controlled<'a, T> { Adaptive::new(method, dt, joules) }
    Adaptive::end_after(method: &mut Controlled<'_, T>, seconds: T) { method.end_after(seconds) }
    Adaptive::set_accuracy(method: &mut Controlled<'_, T>, joules: T) { method.set_accuracy(joules) }
    Adaptive::dt(method: &Controlled<'_, T>) -> T { method.dt() }
    Adaptive::made(method: &Controlled<'_, T>) -> Made<T> { method.made() }
    Adaptive::attained(method: &Controlled<'_, T>) -> T { method.attained() }
    Embedded::attempt(
        method: &mut Ros3<'_, T, All<'_, T>>, parts: &mut Parts<'_, Owner<T>>, dt: T, course: Course<'_, T>,
        joules: T, seen: &mut u32,
    ) -> Result<(Report<T>, LocalError<T>), StepError> {
        method.attempt(parts, dt, course, joules, &mut |island| *seen += island.solve.iterations)
    }
    Embedded::accept(
        method: &mut Ros3<'_, T, All<'_, T>>, parts: Parts<'_, Owner<T>>, course: Course<'_, T>,
    ) -> Result<(), StepError> {
        method.accept(parts, course)
    }
    Course::rest<'a>(_x: T) -> Course<'a, T> { Course::rest() }
    Adaptive::probe(
        method: &mut Controlled<'_, T, All<'_, T>>, s: &mut S<T>, motion: &[Motion<T>],
    ) -> Result<Probed<T>, StepError> {
        method.probe(s, motion)
    }
    MassSpring::step_moving[adaptive_verlet](
        s: &mut S<T>, method: &mut Adaptive<Verlet<T, All<'_, T>>, T>, motion: &[Motion<T>],
    ) -> Stepped<T> {
        s.step_moving(method, motion)
    }
    Embedded::longest(method: &mut Verlet<T, All<'_, T>>, parts: &mut Parts<'_, Owner<T>>) -> T {
        method.longest(parts)
    }
    Force::potential(forces: &All<'_, T>, rows: &Rows<'_, T>) -> T { forces.potential(rows) }
}
