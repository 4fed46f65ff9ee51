//! The interface in single precision; `double.rs` is this file with another precision, written by `header.sh`.
//!
//! Each function passes the caller's pointers to [`call`], which does all the checking. Their promises stand in `hooke.h`.

use hooke::Spring;

use crate::buffer::{self, Layout};
use crate::call::{self, Handle, call, last_index, vector};
use crate::motion::Motion;
use crate::options::Options;
use crate::report::{Energies, Report};
use crate::status::hooke_status::{self, *};

/// A scene in single precision: the front of the caller's buffer.
pub struct hooke_f32 {
    _opaque: [u8; 0],
}

impl Handle for hooke_f32 {
    type Real = f32;
}

#[allow(missing_docs)] // Documented where they are defined; `header.sh` gives those the names that these have.
pub type hooke_f32_options = Options<f32>;
#[allow(missing_docs)]
pub type hooke_f32_report = Report<f32>;
#[allow(missing_docs)]
pub type hooke_f32_motion = Motion<f32>;
#[allow(missing_docs)]
pub type hooke_f32_energies = Energies<f32>;

/// Bytes that a buffer for up to so many particles and springs must have; 0 if no memory has so many.
#[unsafe(no_mangle)]
pub extern "C" fn hooke_f32_size(particles: usize, springs: usize) -> usize {
    Layout::new::<f32>(particles, springs).map_or(0, |layout| layout.bytes)
}

/// What the address of a buffer must be a multiple of.
#[unsafe(no_mangle)]
pub extern "C" fn hooke_f32_alignment() -> usize {
    align_of::<buffer::Header<f32>>()
}

/// Makes an empty scene for up to so many particles and springs in a buffer of so many bytes, whatever it held before.
/// The handle that goes to *scene is the buffer's own address. On an error nothing is written, to *scene neither.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_init(
    buffer: *mut core::ffi::c_void,
    bytes: usize,
    particles: usize,
    springs: usize,
    scene: *mut *mut hooke_f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call::init(buffer.cast(), bytes, particles, springs, scene) }
}

/// The values that hold for a program that says nothing: no forces, the kernel's tolerance. dt is left 0, to be given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_defaults(options: *mut hooke_f32_options) -> hooke_status {
    if options.is_null() {
        return HOOKE_NULL;
    }
    if !options.is_aligned() {
        return HOOKE_MISALIGNED;
    }
    // SAFETY: not null, aligned, writable as the caller promises.
    unsafe { options.write(Options::defaults()) };
    HOOKE_OK
}

/// Sets how the scene is stepped; refused as a whole if a value is no good. Before the first step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_set_options(
    scene: *mut hooke_f32,
    options: *const hooke_f32_options,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            let options = c.read(options)?;
            options.check()?;
            *c.options() = options;
            Ok(())
        })
    }
}

/// Adds a free particle at rest at position[3], m, with mass, kg. Its index, counted from 0, goes to *index if that is
/// not null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_add_particle(
    scene: *mut hooke_f32,
    position: *const f32,
    mass: f32,
    index: *mut usize,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            let place = c.place_if_any(index)?;
            let x = c.read(position.cast())?;
            place.put(c.scene.particle(x, mass)?);
            Ok(())
        })
    }
}

/// Joins two particles by a spring of stiffness, N/m, whose rest length is their present distance. Its index goes to *index
/// if that is not null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_add_spring(
    scene: *mut hooke_f32,
    a: usize,
    b: usize,
    stiffness: f32,
    index: *mut usize,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            let place = c.place_if_any(index)?;
            place.put(c.scene.spring(a, b, stiffness)?);
            Ok(())
        })
    }
}

/// As hooke_f32_add_spring with a given rest length, m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_add_spring_with(
    scene: *mut hooke_f32,
    a: usize,
    b: usize,
    stiffness: f32,
    rest_length: f32,
    index: *mut usize,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            let place = c.place_if_any(index)?;
            place.put(c.scene.spring_with(a, b, Spring { stiffness, rest_length })?);
            Ok(())
        })
    }
}

/// Pins a particle where it is: it rests unless a step is told its motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_pin(scene: *mut hooke_f32, particle: usize) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.pin(particle)?)) }
}

/// Releases a pinned particle; it goes on with the velocity it had as a pin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_release(scene: *mut hooke_f32, particle: usize) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.release(particle)?)) }
}

/// Puts a particle, pinned or free, at position[3], m, at once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_set_position(
    scene: *mut hooke_f32,
    particle: usize,
    position: *const f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.set_position(particle, c.read(position.cast())?)?)) }
}

/// Sets the velocity[3], m/s, of a free particle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_set_velocity(
    scene: *mut hooke_f32,
    particle: usize,
    velocity: *const f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.set_velocity(particle, c.read(velocity.cast())?)?)) }
}

/// Gives a free particle an impulse[3], N s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_impulse(
    scene: *mut hooke_f32,
    particle: usize,
    impulse: *const f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.impulse(particle, c.read(impulse.cast())?)?)) }
}

/// Changes the mass of a particle, kg. Its velocity stays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_set_mass(
    scene: *mut hooke_f32,
    particle: usize,
    mass: f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.set_mass(particle, mass)?)) }
}

/// Changes the stiffness of a spring, N/m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_set_stiffness(
    scene: *mut hooke_f32,
    spring: usize,
    stiffness: f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.set_stiffness(spring, stiffness)?)) }
}

/// Changes the rest length of a spring, m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_set_rest_length(
    scene: *mut hooke_f32,
    spring: usize,
    rest_length: f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.set_rest_length(spring, rest_length)?)) }
}

/// Breaks a spring for good. The indices of the others stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_break_spring(scene: *mut hooke_f32, spring: usize) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| Ok(c.scene.break_spring(spring)?)) }
}

/// Advances by one time step; pins rest. What the step says of itself goes to *report if that is not null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_step(
    scene: *mut hooke_f32,
    report: *mut hooke_f32_report,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            let place = c.place_if_any(report)?;
            place.put(c.step(&[])?);
            Ok(())
        })
    }
}

/// As hooke_f32_step while some pins move. Of two motions of one particle the later counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_step_moving(
    scene: *mut hooke_f32,
    motions: *const hooke_f32_motion,
    count: usize,
    report: *mut hooke_f32_report,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            let place = c.place_if_any(report)?;
            let motions = c.list(motions.cast(), count)?;
            let answer = c.step(motions)?;
            place.put(answer);
            Ok(())
        })
    }
}

/// How many particles there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_particles(scene: *mut hooke_f32, count: *mut usize) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(count)?.put(c.scene.positions().len());
            Ok(())
        })
    }
}

/// How many springs there are, broken ones included.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_springs(scene: *mut hooke_f32, count: *mut usize) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(count)?.put(c.scene.state().springs());
            Ok(())
        })
    }
}

/// Where a particle is, m, to position[3].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_position(
    scene: *mut hooke_f32,
    particle: usize,
    position: *mut f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(position.cast())?.put(vector(c.scene.positions(), particle)?);
            Ok(())
        })
    }
}

/// How fast a particle is, m/s, to velocity[3].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_velocity(
    scene: *mut hooke_f32,
    particle: usize,
    velocity: *mut f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(velocity.cast())?.put(vector(c.scene.velocities(), particle)?);
            Ok(())
        })
    }
}

/// All positions, m, as x, y, z of particle 0, then of particle 1, ..., to an array with room for so many particles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_positions(
    scene: *mut hooke_f32,
    array: *mut f32,
    particles: usize,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| c.copy(c.scene.positions(), array.cast(), particles)) }
}

/// As hooke_f32_positions for the velocities, m/s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_velocities(
    scene: *mut hooke_f32,
    array: *mut f32,
    particles: usize,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe { call(scene, |c| c.copy(c.scene.velocities(), array.cast(), particles)) }
}

/// The tension of a spring, N, to *tension: positive pulls; 0 for a broken one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_tension(
    scene: *mut hooke_f32,
    spring: usize,
    tension: *mut f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(tension)?.put(c.tension(spring)?);
            Ok(())
        })
    }
}

/// The force that would hold a particle at rest in the present state, N, to force[3]: at a pin, what its support carries.
/// Takes time proportional to the number of springs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_reaction(
    scene: *mut hooke_f32,
    particle: usize,
    force: *mut f32,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(force.cast())?.put(c.reaction(particle)?);
            Ok(())
        })
    }
}

/// The energies of the present state, J; that in gravity is 0 until options are set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_energy(
    scene: *mut hooke_f32,
    energies: *mut hooke_f32_energies,
) -> hooke_status {
    // SAFETY: the caller's promise, passed on.
    unsafe {
        call(scene, |c| {
            c.place(energies)?.put(c.energies()?);
            Ok(())
        })
    }
}

/// The particle or spring that the last failed call on this scene was about, HOOKE_NO_INDEX if none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hooke_f32_last_index(scene: *mut hooke_f32) -> usize {
    // SAFETY: the caller's promise, passed on.
    unsafe { last_index(scene) }
}
