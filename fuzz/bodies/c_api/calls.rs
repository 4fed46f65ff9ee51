//! The calls themselves, each beside the kernel's (included once for each precision).

use hooke::{Force, Gravity, Motion, SceneIn, Spring};

use super::*;
use crate::bytes::Bytes;
use crate::c_api::memory::{Answer, Kind, Memory};
use crate::options::Options;
use crate::report::{Energies, Report};
use crate::status::hooke_status::{self, *};
use crate::status::Failure;

/// Indices that are tried: some of what does not exist.
const INDICES: usize = 8;

fn index(bytes: &mut Bytes<'_>) -> usize {
    if bytes.once_in_a_while(4) { usize::MAX } else { bytes.below(INDICES) }
}

fn vector(bytes: &mut Bytes<'_>) -> Box<[Real; 3]> {
    Box::new(bytes.vector().map(|x| x as Real))
}

/// A change of the scene.
pub fn edit(
    call: usize,
    handle: *mut Handle,
    kernel: &mut SceneIn<'_, Real>,
    bytes: &mut Bytes<'_>,
) -> (hooke_status, Answer) {
    let (kind, i, j) = (Kind::read(bytes), index(bytes), index(bytes));
    let mut x = vector(bytes);
    let (k, length) = (bytes.number() as Real, bytes.number() as Real);
    let mut added = Box::new(usize::MAX);
    let to = kind.of(&mut *added, handle);
    let from = kind.of(&mut *x, handle).cast::<Real>().cast_const();
    let spring = Spring { stiffness: k, rest_length: length };
    let known = |added: usize, answer: usize| {
        assert!(kind != Kind::Good || added == answer, "the index of what was added: {added}, not {answer}");
    };
    // SAFETY: a handle of `init`; pointers to what they should point to, or refused.
    unsafe {
        match call {
            0..=2 => {
                // Two pointers: the index's is good here, and below the position's.
                let status = add_particle(handle, from, k, &mut *added);
                let answer = kind.answer().and_then(|()| Ok(kernel.particle(*x, k)?));
                (status, answer.map(|answer| known(*added, answer)))
            }
            3 | 4 => {
                let status = add_spring(handle, i, j, k, to);
                let answer = kind.answer_if_any().and_then(|()| Ok(kernel.spring(i, j, k)?));
                (status, answer.map(|answer| known(*added, answer)))
            }
            5 => {
                let status = add_spring_with(handle, i, j, k, length, to);
                let answer = kind.answer_if_any().and_then(|()| Ok(kernel.spring_with(i, j, spring)?));
                (status, answer.map(|answer| known(*added, answer)))
            }
            6 => (pin(handle, i), Ok(()).and_then(|()| Ok(kernel.pin(i)?))),
            7 => (release(handle, i), Ok(()).and_then(|()| Ok(kernel.release(i)?))),
            8 => {
                let answer = kind.answer().and_then(|()| Ok(kernel.set_position(i, *x)?));
                (set_position(handle, i, from), answer)
            }
            9 => {
                let answer = kind.answer().and_then(|()| Ok(kernel.set_velocity(i, *x)?));
                (set_velocity(handle, i, from), answer)
            }
            10 => (impulse(handle, i, from), kind.answer().and_then(|()| Ok(kernel.impulse(i, *x)?))),
            11 => (set_mass(handle, i, k), Ok(()).and_then(|()| Ok(kernel.set_mass(i, k)?))),
            12 if length < 0.0 => (break_spring(handle, j), Ok(()).and_then(|()| Ok(kernel.break_spring(j)?))),
            12 => (set_stiffness(handle, j, k), Ok(()).and_then(|()| Ok(kernel.set_stiffness(j, k)?))),
            _ => (set_rest_length(handle, j, k), Ok(()).and_then(|()| Ok(kernel.set_rest_length(j, k)?))),
        }
    }
}

/// Options: those of a program that says nothing, some of them changed.
pub fn choose_options(bytes: &mut Bytes<'_>) -> Options<Real> {
    let mut options = Box::new(Options { dt: 7.0, ..Options::defaults() });
    let flags = bytes.byte();
    // SAFETY: a place for options.
    assert!(unsafe { defaults(&mut *options) } == HOOKE_OK && options.dt == 0.0);
    let mut number = |bit: u8, other: Real| if flags & bit == 0 { other } else { bytes.number() as Real };
    options.dt = number(1, 1.0) / 64.0;
    options.gravity = [0.0, number(2, 0.0), 0.0];
    options.drag = number(4, 0.0);
    options.damping = number(8, 0.0);
    options.tolerance = number(16, options.tolerance);
    options.absolute = number(32, 0.0);
    options.max_iterations = if flags & 64 == 0 { 1000 } else { u32::from(bytes.byte()) };
    *options
}

/// A question.
pub fn ask(
    call: usize,
    handle: *mut Handle,
    kernel: &mut SceneIn<'_, Real>,
    options: Option<&Options<Real>>,
    bytes: &mut Bytes<'_>,
) -> (hooke_status, Answer) {
    let (kind, which, i) = (Kind::read(bytes), bytes.byte() & 1, index(bytes));
    let mut x = Box::new([0.0; 3]);
    let to = kind.of(&mut *x, handle).cast::<Real>();
    let bits = |x: [Real; 3]| x.map(Real::to_bits);
    let here = |list: &[[Real; 3]]| list.get(i).copied().ok_or(Failure { status: HOOKE_NO_PARTICLE, index: i });
    // SAFETY: a handle of `init`; pointers to what they should point to, or refused.
    unsafe {
        match call {
            14 => {
                let (list, status) = if which == 0 {
                    (kernel.positions(), position(handle, i, to))
                } else {
                    (kernel.velocities(), velocity(handle, i, to))
                };
                let answer = kind.answer().and_then(|()| here(list));
                (status, answer.map(|answer| assert_eq!(bits(*x), bits(answer))))
            }
            15 => {
                let springs = kernel.state().springs();
                let there = if i < springs { Ok(()) } else { Err(Failure { status: HOOKE_NO_SPRING, index: i }) };
                let mut force = Box::new(0.0);
                let status = tension(handle, i, kind.of(&mut *force, handle));
                let same = |()| assert_eq!(force.to_bits(), kernel.springs().tension_of(i).to_bits());
                (status, kind.answer().and(there).map(same))
            }
            16 => {
                let status = reaction(handle, i, to);
                // The place is looked at first, then the options.
                let answer = kind.answer().and_then(|()| {
                    let euler = options.ok_or(HOOKE_NO_OPTIONS)?.integrator()?;
                    let force = kernel.reaction(i, &euler.forces);
                    force.ok_or(Failure { status: HOOKE_NO_PARTICLE, index: i })
                });
                (status, answer.map(|answer| assert_eq!(bits(*x), bits(answer))))
            }
            _ if which == 0 => {
                let zero = Energies { kinetic: 0.0, springs: 0.0, gravity: 0.0 };
                let mut found = Box::new(zero);
                let status = energy(handle, kind.of(&mut *found, handle));
                let gravity = Gravity(options.map_or([0.0; 3], |options| options.gravity));
                let springs = kernel.springs();
                let same = |()| {
                    let exact = [
                        springs.kinetic_energy(),
                        springs.potential_energy(),
                        gravity.potential_energy(kernel.state()),
                    ];
                    let found = [found.kinetic, found.springs, found.gravity];
                    assert_eq!(bits(found), bits(exact), "energies");
                };
                (status, kind.answer().map(same))
            }
            _ => {
                let n = kernel.positions().len();
                let short = usize::from(n > 0 && bytes.once_in_a_while(128));
                let mut list = vec![[0.0; 3]; n - short].into_boxed_slice();
                let to = kind.of(list.as_mut_ptr(), handle).cast::<Real>();
                let fits = if short == 0 { Ok(()) } else { Err(Failure { status: HOOKE_TOO_SMALL, index: n }) };
                // No vectors are nowhere: not inside the scene either.
                let kind = if n == 0 && kind == Kind::Inside { Kind::Good } else { kind };
                (positions(handle, to, n - short), kind.answer().and(fits))
            }
        }
    }
}

/// A step: pins at rest, or moved; the report wanted or not.
pub fn advance(
    handle: *mut Handle,
    kernel: &mut SceneIn<'_, Real>,
    options: Option<&Options<Real>>,
    bytes: &mut Bytes<'_>,
) -> (hooke_status, Answer) {
    let (kind, list, moved) = (Kind::read(bytes), Kind::read(bytes), bytes.below(3));
    let mut motions: Box<[Motion<Real>]> = (0..moved)
        .map(|_| Motion { particle: index(bytes), position: *vector(bytes), velocity: *vector(bytes) })
        .collect();
    let mut report = Box::new(core::mem::MaybeUninit::<Report<Real>>::uninit());
    let to = kind.of(report.as_mut_ptr(), handle);
    // SAFETY: a handle of `init`; pointers to what they should point to, or refused.
    let status = unsafe {
        if moved == 0 && list == Kind::Good {
            step(handle, to)
        } else {
            let from = list.of(motions.as_mut_ptr(), handle);
            step_moving(handle, from.cast(), moved, to)
        }
    };
    // An empty list may be anywhere.
    let listed = if moved == 0 { Ok(()) } else { list.answer() };
    let answer = kind.answer_if_any().and(listed).and_then(|()| {
        let mut euler = options.ok_or(HOOKE_NO_OPTIONS)?.integrator()?;
        Ok(kernel.step_moving(&mut euler, &motions)?)
    });
    let same = |answer: hooke::Report<Real>| {
        assert!(answer.lower <= answer.upper && answer.upper.is_finite(), "bounds in order: {answer:?}");
        if kind == Kind::Good {
            // SAFETY: written by the call, which has succeeded.
            let found = unsafe { report.assume_init_ref() };
            assert_eq!(found.upper.to_bits(), answer.upper.to_bits());
            assert_eq!(found.lower.to_bits(), answer.lower.to_bits());
            assert_eq!((found.iterations, found.islands), (answer.iterations, answer.islands));
        }
    };
    (status, answer.map(same))
}

/// A copy of the buffer with some bytes changed: every call ends, and none goes beyond the copy.
pub fn damaged(memory: &Memory, bytes: &mut Bytes<'_>) {
    let copy = memory.copy();
    for _ in 0..1 + bytes.below(4) {
        let place = bytes.below(256) + 256 * bytes.below(16);
        copy.damage(place, bytes.byte());
    }
    let handle = copy.at().cast::<Handle>();
    let mut x = vector(bytes);
    let i = index(bytes);
    // SAFETY: what was a buffer of `init`, damaged behind its checksum or refused.
    unsafe {
        _ = (step(handle, core::ptr::null_mut()), position(handle, i, x.as_mut_ptr()));
        _ = (release(handle, i), break_spring(handle, i), pin(handle, i), add_spring(handle, 0, i, 1.0, core::ptr::null_mut()));
        _ = (tension(handle, i, x.as_mut_ptr()), reaction(handle, i, x.as_mut_ptr()));
        _ = (step(handle, core::ptr::null_mut()), last_index(handle));
    }
}
