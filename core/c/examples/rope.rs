//! The rope of `rope.c`, by the kernel itself and in both precisions: what the C interface must reproduce bit for bit.
//!
//! `cargo run --release --example rope`

use hooke::{Drag, LinearlyImplicitEuler, Motion, Real, Scene, SpringDamping};

const LINKS: usize = 23;
const PARTICLES: usize = LINKS + 1;

fn rope<T: Real, const BYTES: usize>(bytes: fn(T) -> [u8; BYTES]) -> Result<u64, Box<dyn std::error::Error>> {
    let real = T::from_f64;
    let mut rope = Box::new(Scene::<T, PARTICLES, LINKS>::new());
    for i in 0..PARTICLES {
        rope.particle([real(i as f64 / 16.0), T::ZERO, T::ZERO], real(0.0078125))?;
        if i > 0 {
            rope.spring(i - 1, i, real(500.0))?;
        }
    }
    rope.pin(0)?;
    let dt = real(0.015625);
    let mut euler = LinearlyImplicitEuler::new(dt)
        .gravity([0.0, -9.8125, 0.0].map(real))
        .with(Drag(real(0.125)))
        .with(SpringDamping(real(0.25)))
        .max_iterations(20);

    let mut hand = Motion { particle: 0, position: [T::ZERO; 3], velocity: [T::ZERO; 3] };
    let mut digest = 0xcbf2_9ce4_8422_2325_u64; // FNV-1a
    for step in 1..=256 {
        hand.velocity[0] = real(if step % 128 < 64 { 0.5 } else { -0.5 });
        hand.position[0] += hand.velocity[0] * dt;
        rope.step_moving(&mut euler, &[hand])?;
        for x in rope.positions().iter().chain(rope.velocities()).flatten() {
            for byte in bytes(*x) {
                digest = (digest ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
        match step {
            64 => rope.impulse(LINKS, [0.0, 0.0, 0.03125].map(real))?,
            128 => rope.set_stiffness(3, real(1000.0))?,
            192 => rope.break_spring(LINKS / 2)?,
            _ => {}
        }
    }
    Ok(digest)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("digest f32 {:016x}", rope(f32::to_le_bytes)?);
    println!("digest f64 {:016x}", rope(f64::to_le_bytes)?);
    Ok(())
}
