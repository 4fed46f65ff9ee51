//! From plain data to a scene of the kernel with its forces, and back. Bits for comparing.

use hooke::{
    Drag, EditError, Gravity, Hookean, LinearlyImplicitEuler, MassSpring, Memory, Motion, Operator,
    PointSpring, Real, Spring, SpringDamping, System,
};

use crate::data::{MotionData, SceneData};
use crate::vec_memory::VecScene;

/// Every kind of force at once.
pub type Everything<'a, T> =
    (((((), Gravity<T>), Drag<T>), SpringDamping<&'a [T]>), &'a mut [PointSpring<T>]);

/// The forces of a scene, to be borrowed by an integrator.
#[derive(Debug, Clone)]
pub struct Forces<T> {
    gravity: [T; 3],
    drag: T,
    damping: Vec<T>,
    points: Vec<PointSpring<T>>,
}

/// Three numbers in the precision of the scene.
pub fn real3<T: Real>(x: [f64; 3]) -> [T; 3] {
    x.map(T::from_f64)
}

impl<T: Real> Forces<T> {
    /// Those of the data.
    pub fn new(data: &SceneData) -> Self {
        let real = T::from_f64;
        let point = |p: &crate::data::PointData| {
            PointSpring::new(p.particle, real3(p.target), real(p.k)).rest_length(real(p.l0))
        };
        Self {
            gravity: real3(data.gravity),
            drag: real(data.drag),
            damping: data.springs.iter().map(|s| real(s.c)).collect(),
            points: data.points.iter().map(point).collect(),
        }
    }

    /// All of them, for one step.
    pub fn all(&mut self) -> Everything<'_, T> {
        let damping = SpringDamping(self.damping.as_slice());
        (((((), Gravity(self.gravity)), Drag(self.drag)), damping), self.points.as_mut_slice())
    }

    /// Linearly-implicit Euler under these forces.
    pub fn euler(&mut self, dt: T) -> LinearlyImplicitEuler<T, Everything<'_, T>> {
        LinearlyImplicitEuler::new(dt)
            .gravity(self.gravity)
            .with(Drag(self.drag))
            .with(SpringDamping(self.damping.as_slice()))
            .with(self.points.as_mut_slice())
    }
}

/// Adds the particles and springs of the data to a scene.
pub fn fill<M: Memory>(scene: &mut MassSpring<M>, data: &SceneData) -> Result<(), EditError> {
    let real = M::Real::from_f64;
    for i in 0..data.len() {
        scene.particle(real3(data.position[i]), real(data.mass[i]))?;
        scene.set_velocity(i, real3(data.velocity[i]))?;
        if data.pinned[i] {
            scene.pin(i)?;
        }
    }
    for s in &data.springs {
        scene.spring_with(s.a, s.b, Spring { stiffness: real(s.k), rest_length: real(s.l0) })?;
    }
    Ok(())
}

/// A growable scene of the data.
pub fn scene<T: Real>(data: &SceneData) -> VecScene<T> {
    let mut scene = VecScene::<T, Hookean>::empty();
    fill(&mut scene, data).expect("the data are valid");
    scene
}

/// Pins' motions in the precision of the scene.
pub fn motions<T: Real>(motion: &[MotionData]) -> Vec<Motion<T>> {
    motion
        .iter()
        .map(|m| Motion { particle: m.particle, position: real3(m.position), velocity: real3(m.velocity) })
        .collect()
}

/// Positions and velocities as bits (a number in `f32` has the bits of its exact value in `f64`).
pub fn bits<M: Memory>(scene: &MassSpring<M>) -> Vec<[u64; 6]> {
    let both = scene.positions().iter().zip(scene.velocities());
    both.map(|(x, v)| [x[0], x[1], x[2], v[0], v[1], v[2]].map(|x| x.to_f64().to_bits())).collect()
}

/// Positions in `f64`.
pub fn positions<M: Memory>(scene: &MassSpring<M>) -> Vec<[f64; 3]> {
    scene.positions().iter().map(|x| x.map(Real::to_f64)).collect()
}

/// Velocities in `f64`.
pub fn velocities<M: Memory>(scene: &MassSpring<M>) -> Vec<[f64; 3]> {
    scene.velocities().iter().map(|x| x.map(Real::to_f64)).collect()
}

/// Writes a scene's present state back into its data.
pub fn read_back<M: Memory>(scene: &MassSpring<M>, data: &mut SceneData) {
    data.position = positions(scene);
    data.velocity = velocities(scene);
}

/// So many steps of linearly-implicit Euler in `f64`, after which the data are the scene's state.
pub fn walk_on(data: &mut SceneData, h: f64, steps: usize) {
    let (mut scene, mut forces) = (scene::<f64>(data), Forces::<f64>::new(data));
    let mut euler = forces.euler(h);
    (0..steps).for_each(|_| assert!(scene.step(&mut euler).is_ok()));
    read_back(&scene, data);
}

/// ‖a − b‖_A of two answers to the next step of a scene.
pub fn apart(data: &SceneData, h: f64, a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let (mut scene, mut forces, mut form) = (scene::<f64>(data), Forces::<f64>::new(data), 0.0);
    let see = |system: &System<'_, f64, Everything<'_, f64>>, _: &[[f64; 3]], _: &[f64]| {
        let particles = (0..system.particles()).filter_map(|row| system.particle(row));
        let e: Vec<_> = particles.map(|i| [0, 1, 2].map(|k| a[i][k] - b[i][k])).collect();
        form += system.apply(&e, &mut vec![[0.0; 3]; e.len()]);
    };
    assert!(forces.euler(h).inspect(scene.parts(), &[], see).is_ok());
    form.sqrt()
}

/// The largest |a − b| of corresponding vectors.
pub fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| crate::data::distance(*a, *b))
        .fold(0.0, |m, d| if d > m || d.is_nan() { d } else { m })
}

/// Σ over springs of the impulses that pass through both their ends in a step: h|tension| + |H Δq̇|, with
/// |H| ≤ h²k(1 + l₀/l) + hc. What the rounding of momentum is relative to.
pub fn impulses<T: Real>(scene: &VecScene<T>, h: f64, damping: f64) -> f64 {
    let (state, springs) = (scene.state(), scene.springs());
    let velocity = velocities(scene);
    let one = |j: usize| {
        let Some((a, b)) = state.ends(j) else { return 0.0 };
        let (k, l0) = (state.spring(j).stiffness.to_f64(), state.spring(j).rest_length.to_f64());
        let l = springs.length_of(j).map_or(0.0, Real::to_f64);
        let stiffness = h * h * k * (1.0 + l0 / l) + h * damping;
        h * springs.tension_of(j).to_f64().abs() + stiffness * crate::data::distance(velocity[a], velocity[b])
    };
    (0..state.springs()).map(one).sum()
}
