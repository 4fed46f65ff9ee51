//! Every public entry point of the kernel behind a C symbol, in both precisions, so that a linker can be asked what
//! they reach: no allocator (there is none to link), no std, and no panic (its handler calls a symbol that must not be
//! left in the library).
#![no_std]

use hooke::force::SpringDamping;
use hooke::{
    Drag, LinearlyImplicitEuler, Mixed, Motion, PointForce, PointSpring, Scene, SceneIn, Snapshot, Spring,
    Stretched,
};

unsafe extern "C" {
    fn hooke_panicked() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: never linked; the check fails if this symbol is reachable.
    unsafe { hooke_panicked() }
}

macro_rules! entry_points {
    ($t:ty, $edit:ident, $step:ident, $measure:ident, $slices:ident, $equations:ident) => {
        type S = Scene<$t, 40, 80, Mixed>;
        type V = [$t; 3];

        /// Building and changing a scene.
        #[unsafe(no_mangle)]
        pub extern "C" fn $edit(s: &'static mut S, call: u32, i: usize, j: usize, x: &V, k: $t) -> bool {
            let spring = Spring { stiffness: k, rest_length: x[0] };
            match call {
                0 => s.particle(*x, k).is_ok(),
                1 => s.spring(i, j, k).is_ok(),
                2 => s.spring_with(i, j, spring).is_ok(),
                3 => s.cable(i, j, spring).is_ok(),
                4 => s.pin(i).is_ok(),
                5 => s.release(i).is_ok(),
                6 => s.break_spring(j).is_ok(),
                7 => s.set_stiffness(j, k).is_ok(),
                8 => s.set_rest_length(j, k).is_ok(),
                9 => s.set_mass(i, k).is_ok(),
                10 => s.set_position(i, *x).is_ok(),
                11 => s.set_velocity(i, *x).is_ok(),
                12 => s.impulse(i, *x).is_ok(),
                _ => s.is_pinned(i),
            }
        }

        /// A step with every force, watched, with a moving pin; and looking at the system it solves.
        #[unsafe(no_mangle)]
        pub extern "C" fn $step(
            s: &'static mut S,
            x: &V,
            c: &'static [$t; 80],
            i: usize,
            k: $t,
            blocks: &mut [$t; 9],
        ) -> $t {
            let mut euler = LinearlyImplicitEuler::new(k)
                .gravity(*x)
                .with(Drag(k))
                .with(SpringDamping(c.as_slice()))
                .with(PointForce { particle: i, force: *x })
                .with(PointSpring::new(i, *x, k).rest_length(k))
                .tolerance(k)
                .absolute(k)
                .max_iterations(i as u32);
            let motion = [Motion { particle: i, position: *x, velocity: *x }];
            let mut seen = 0;
            let mut sum = k;
            match s.step_watched(&mut euler, &motion, |island| seen += island.solve.iterations) {
                Ok(report) => {
                    sum += report.upper + report.lower + seen as $t + report.is_certified() as u8 as $t
                }
                Err(_) => return -k,
            }
            _ = euler.inspect(s.parts(), &motion, |system, b, mu| {
                system.blocks(|row, column, block| {
                    if (row, column) == (0, 1) {
                        *blocks = [
                            block[0][0],
                            block[0][1],
                            block[0][2],
                            block[1][0],
                            block[1][1],
                            block[1][2],
                            block[2][0],
                            block[2][1],
                            block[2][2],
                        ];
                    }
                });
                sum += b.iter().fold(k, |a, b| a + b[0]) + mu.iter().fold(k, |a, b| a + *b);
                sum += system.particles() as $t + system.particle(i).unwrap_or(0) as $t;
            });
            if let Some(r) = s.reaction(i, &euler.forces) {
                sum += r[0] + r[1] + r[2];
            }
            let mut plain = LinearlyImplicitEuler::new(k);
            if let Ok(report) = s.step(&mut plain) {
                sum += report.upper;
            }
            sum
        }

        /// Energies, momenta, forces, stiffness, snapshots.
        #[unsafe(no_mangle)]
        pub extern "C" fn $measure(
            s: &'static mut S,
            snapshot: &'static mut Snapshot<hooke::Fixed<$t, 40, 80, Mixed>>,
            x: &'static [V; 40],
            y: &'static mut [V; 40],
            j: usize,
        ) -> $t {
            let springs = s.springs();
            let mut sum = springs.kinetic_energy() + springs.potential_energy() + springs.lagrangian();
            sum += springs.kinetic_energy_of(j) + springs.potential_energy_of(j) + springs.tension_of(j);
            sum += springs.length_of(j).unwrap_or(0.0) + springs.strain_of(j).unwrap_or(0.0);
            sum += springs.stretch_factor_of(j).unwrap_or(0.0);
            springs.add_force(y);
            springs.stiffness_product(x, y);
            springs.stiffness_blocks(|_, _, block| sum += block[0][0]);
            let state = s.state();
            sum += state.linear_momentum()[0] + state.angular_momentum()[1] + state.centre_of_mass()[2];
            sum += state.ends(j).map_or(0.0, |(a, b)| (a + b) as $t) + state.spring(j).stiffness;
            sum += s.springs().hessian_of(j).map_or(0.0, |h| h.alpha);
            sum += (s.islands() + s.free_particles() + s.positions().len() + s.velocities().len()) as $t;
            let saved = s.save(snapshot).is_ok() && s.restore(snapshot).is_ok();
            sum + saved as u8 as $t
        }

        /// A scene in borrowed buffers.
        #[unsafe(no_mangle)]
        pub extern "C" fn $slices(
            reals: &'static mut [$t; 4096],
            words: &'static mut [u32; 1024],
            n: usize,
            m: usize,
            dt: $t,
        ) -> bool {
            let Some(mut s) = SceneIn::<$t>::in_buffers(reals, words, n, m) else { return false };
            let (Ok(a), Ok(b)) = (s.particle([0.0; 3], 1.0), s.particle([1.0; 3], 1.0)) else { return false };
            s.spring(a, b, 1.0).is_ok() && s.step(&mut LinearlyImplicitEuler::new(dt)).is_ok()
        }

        /// The lecture's equations, one spring at a time.
        #[unsafe(no_mangle)]
        pub extern "C" fn $equations(a: &V, b: &V, k: $t, out: &mut [$t; 36]) -> $t {
            let spring = Spring { stiffness: k, rest_length: a[0] };
            let [g, _] = spring.gradient(*a, *b);
            let dense = spring.dense_hessian(*a, *b);
            let mut each = out.iter_mut();
            for entry in dense.as_flattened().as_flattened().as_flattened() {
                if let Some(out) = each.next() {
                    *out = *entry;
                }
            }
            let h = spring.hessian(*a, *b);
            let stretched = Stretched::new(*a);
            spring.potential_energy(stretched.length) + g[0] + h.mul(*b)[0]
        }
    };
}

mod single {
    use super::*;
    entry_points!(f32, edit_f32, step_f32, measure_f32, slices_f32, equations_f32);
}

mod double {
    use super::*;
    entry_points!(f64, edit_f64, step_f64, measure_f64, slices_f64, equations_f64);
}

/// What must be caught: an index that the compiler cannot show to be in range.
#[cfg(feature = "sabotage")]
#[unsafe(no_mangle)]
pub extern "C" fn sabotage(list: &[f64; 8], i: usize) -> f64 {
    list[i]
}
