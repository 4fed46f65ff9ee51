//! The C interface as a sequence of calls, beside the same calls to the kernel: statuses, indices and bits must agree. Pointers
//! are null, misaligned or inside the scene where the interface says what it does then, arrays and buffers too small; a refused
//! call leaves the buffer as it was; and a copy of the buffer with damaged contents is never read or written beyond its end.
//!
//! Memory is handed out in pieces of exactly the promised size, so that an address sanitizer sees any access outside.

#![allow(clippy::duplicate_mod)] // The calls are written once and read in for both precisions.

mod memory;

use crate::bytes::Bytes;

/// One precision under the names that `play.rs` and `calls.rs` use.
macro_rules! precision {
    ($name:ident, $module:ident, $real:ty, $scene:ident, $($short:ident = $long:ident),+) => {
        #[path = "."]
        mod $name {
            use crate::$module::{$scene as Handle, $($long as $short),+};
            type Real = $real;
            #[path = "calls.rs"]
            mod calls;
            #[path = "play.rs"]
            pub mod play;
        }
    };
}

precision!(
    f32,
    single,
    f32,
    hooke_f32,
    size = hooke_f32_size,
    alignment = hooke_f32_alignment,
    init = hooke_f32_init,
    defaults = hooke_f32_defaults,
    set_options = hooke_f32_set_options,
    add_particle = hooke_f32_add_particle,
    add_spring = hooke_f32_add_spring,
    add_spring_with = hooke_f32_add_spring_with,
    pin = hooke_f32_pin,
    release = hooke_f32_release,
    set_position = hooke_f32_set_position,
    set_velocity = hooke_f32_set_velocity,
    impulse = hooke_f32_impulse,
    set_mass = hooke_f32_set_mass,
    set_stiffness = hooke_f32_set_stiffness,
    set_rest_length = hooke_f32_set_rest_length,
    break_spring = hooke_f32_break_spring,
    step = hooke_f32_step,
    step_moving = hooke_f32_step_moving,
    particles = hooke_f32_particles,
    springs = hooke_f32_springs,
    position = hooke_f32_position,
    velocity = hooke_f32_velocity,
    positions = hooke_f32_positions,
    velocities = hooke_f32_velocities,
    tension = hooke_f32_tension,
    reaction = hooke_f32_reaction,
    energy = hooke_f32_energy,
    last_index = hooke_f32_last_index
);
precision!(
    f64,
    double,
    f64,
    hooke_f64,
    size = hooke_f64_size,
    alignment = hooke_f64_alignment,
    init = hooke_f64_init,
    defaults = hooke_f64_defaults,
    set_options = hooke_f64_set_options,
    add_particle = hooke_f64_add_particle,
    add_spring = hooke_f64_add_spring,
    add_spring_with = hooke_f64_add_spring_with,
    pin = hooke_f64_pin,
    release = hooke_f64_release,
    set_position = hooke_f64_set_position,
    set_velocity = hooke_f64_set_velocity,
    impulse = hooke_f64_impulse,
    set_mass = hooke_f64_set_mass,
    set_stiffness = hooke_f64_set_stiffness,
    set_rest_length = hooke_f64_set_rest_length,
    break_spring = hooke_f64_break_spring,
    step = hooke_f64_step,
    step_moving = hooke_f64_step_moving,
    particles = hooke_f64_particles,
    springs = hooke_f64_springs,
    position = hooke_f64_position,
    velocity = hooke_f64_velocity,
    positions = hooke_f64_positions,
    velocities = hooke_f64_velocities,
    tension = hooke_f64_tension,
    reaction = hooke_f64_reaction,
    energy = hooke_f64_energy,
    last_index = hooke_f64_last_index
);

/// Plays the bytes as calls, in the precision that the first one says.
pub fn c_api(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    if bytes.byte() & 1 == 0 { f32::play::play(bytes) } else { f64::play::play(bytes) }
}
