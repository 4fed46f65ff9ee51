//! Any sequence of calls to a scene: none panics, a refused call changes nothing, positions and velocities stay finite,
//! pins stay where they are, and a step's bounds are in order.

use hooke::{
    Adaptive, Drag, EnergyMomentum, Fixed, LinearlyImplicitEuler, Midpoint, Mixed, Newton, PointSpring,
    Rosenbrock2, Rosenbrock3, Scene, Snapshot, Spring, SymplecticEuler, Verlet,
};

type S = Scene<f32, 12, 24, Mixed>;

struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        match self.0.split_first() {
            Some((first, rest)) => {
                self.0 = rest;
                *first
            }
            None => 0,
        }
    }

    /// Mostly tame numbers, sometimes any bits at all.
    fn number(&mut self) -> f32 {
        match self.byte() {
            255 => f32::from_le_bytes(std::array::from_fn(|_| self.byte())),
            b => f32::from(b) / 16.0 - 4.0,
        }
    }

    fn vector(&mut self) -> [f32; 3] {
        std::array::from_fn(|_| self.number())
    }
}

fn bits(scene: &S) -> Vec<u32> {
    let lists = [scene.positions(), scene.velocities()];
    lists.iter().flat_map(|list| list.as_flattened()).map(|x| x.to_bits()).collect()
}

/// Plays the bytes as calls.
pub fn kernel(data: &[u8]) {
    let mut bytes = Bytes(data);
    let mut scene = Box::new(S::new());
    let mut snapshot = Box::new(Snapshot::<Fixed<f32, 12, 24, Mixed>>::new());
    let mut saved = None;
    for _ in 0..64 {
        if bytes.0.is_empty() {
            return;
        }
        let before = bits(&scene);
        let (call, i, j) =
            (bytes.byte() % 16, usize::from(bytes.byte() % 14), usize::from(bytes.byte() % 14));
        let refused = match call {
            0 | 1 => scene.particle(bytes.vector(), bytes.number()).is_err(),
            2 | 3 => scene.spring(i, j, bytes.number()).is_err(),
            4 => {
                let spring = Spring { stiffness: bytes.number(), rest_length: bytes.number() };
                scene.cable(i, j, spring).is_err()
            }
            5 => scene.pin(i).is_err(),
            6 => scene.release(i).is_err(),
            7 => scene.break_spring(j).is_err(),
            8 => scene.set_stiffness(j, bytes.number()).is_err(),
            9 => scene.set_mass(i, bytes.number()).is_err(),
            10 => scene.impulse(i, bytes.vector()).is_err(),
            11 => scene.set_position(i, bytes.vector()).is_err(),
            12 => {
                saved = scene.save(&mut snapshot).is_ok().then(|| bits(&scene));
                false
            }
            13 => match &saved {
                Some(saved) => {
                    assert!(scene.restore(&snapshot).is_ok());
                    assert_eq!(&bits(&scene), saved, "a restored scene is what was saved");
                    false
                }
                None => false,
            },
            _ => {
                let dt = bytes.number().abs() / 16.0;
                let drag = Drag(bytes.number());
                let point = PointSpring::new(i, bytes.vector(), bytes.number());
                let iterations = u32::from(bytes.byte());
                let pinned: Vec<_> = (0..scene.positions().len()).filter(|i| scene.is_pinned(*i)).collect();
                let held: Vec<_> = pinned.iter().map(|i| scene.positions()[*i].map(f32::to_bits)).collect();
                // A step is short of memory where the byte says so; what is in it must not matter.
                let method = bytes.byte();
                let room = if method >= 240 { 1 } else { 5 * scene.positions().len() };
                let memory = vec![[f32::NAN; 3]; room];
                macro_rules! step {
                    ($method:expr) => {{
                        let forces = $method.gravity([0.0, -9.81, 0.0]).with(drag).with(point);
                        scene.step(&mut forces.max_iterations(iterations))
                    }};
                    (adaptive $method:expr) => {{
                        let forces = $method.gravity([0.0, -9.81, 0.0]).with(drag).with(point);
                        scene.step(&mut Adaptive::new(forces.max_iterations(iterations), dt, 1e-3))
                    }};
                }
                let step = match method % 10 {
                    1 => step!(Midpoint::new(dt)),
                    2 => step!(Rosenbrock2::new(dt, memory)),
                    3 => step!(Rosenbrock3::new(dt, memory)),
                    4 => step!(Newton::new(dt, memory)),
                    5 => step!(EnergyMomentum::new(dt, memory)),
                    6 => step!(Verlet::new(dt).substeps_at_most(100)),
                    7 => step!(SymplecticEuler::new(dt)),
                    8 => step!(adaptive Rosenbrock2::new(dt, memory)),
                    9 => step!(adaptive Rosenbrock3::new(dt, memory)),
                    _ => step!(LinearlyImplicitEuler::new(dt)),
                };
                if let Ok(report) = step {
                    assert!(
                        report.lower <= report.upper && report.upper.is_finite(),
                        "bounds in order: {report:?}"
                    );
                    let now = pinned.iter().map(|i| scene.positions()[*i].map(f32::to_bits));
                    assert!(now.eq(held), "pins rest");
                }
                step.is_err()
            }
        };
        if refused {
            assert_eq!(bits(&scene), before, "a refused call changes nothing");
        }
        assert!(bits(&scene).iter().all(|x| f32::from_bits(*x).is_finite()), "the state is finite");
    }
}
