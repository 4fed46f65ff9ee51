//! One step of a scene as bytes choose it: the method, its options, the forces and the pins' motion; and what must hold of it.

use hooke::{
    Adaptive, Drag, EnergyMomentum, Force, LinearlyImplicitEuler, MassSpring, Memory, Midpoint, Motion,
    Newton, PointSpring, Real, Report, Rest, Rosenbrock2, Rosenbrock3, Sleep, SpringDamping, StepError,
    SymplecticEuler, Verlet,
};

use crate::bytes::Bytes;

/// Islands with less than so many joules of motion may be brought to rest.
pub const REST: f64 = 1e-3;

/// A step, to be made as often as needed.
#[derive(Debug, Clone)]
pub struct Step {
    method: usize,
    dt: f64,
    drag: f64,
    damping: f64,
    point: (usize, [f64; 3], f64),
    /// At most two; of particles that need be neither pinned nor there
    motion: Vec<(usize, [f64; 3], [f64; 3])>,
    tolerance: f64,
    iterations: u32,
    /// How many vectors fewer than it needs a method gets
    short: usize,
    accuracy: f64,
    /// Are islands brought to rest?
    rests: bool,
    absolute: f64,
}

impl Step {
    /// Reads one.
    pub fn read(bytes: &mut Bytes<'_>, indices: usize) -> Self {
        let flags = bytes.byte();
        let method = bytes.below(11);
        let dt = bytes.size() / 16.0;
        let on = |bit: u8| flags & bit != 0;
        let mut number = |on: bool| if on { bytes.number() } else { 0.0 };
        let (drag, damping) = (number(on(1)), number(on(2)));
        let motions = usize::from(on(4)) + usize::from(on(8));
        let motion = (0..motions).map(|_| (bytes.below(indices), bytes.vector(), bytes.vector())).collect();
        let point =
            if on(16) { (bytes.below(indices), bytes.vector(), bytes.number()) } else { (0, [0.0; 3], 0.0) };
        let tolerance = if on(32) { bytes.number() } else { 1e-4 };
        let iterations = if on(64) { u32::from(bytes.byte()) } else { 1000 };
        let (short, accuracy) = if on(128) { (bytes.below(4), bytes.number()) } else { (0, 1e-3) };
        let rests = method == 0 && on(128);
        // Of one that is 0, the default, nothing comes to rest that moves.
        let absolute = if rests { accuracy.abs() } else { 0.0 };
        Self {
            method,
            dt,
            drag,
            damping,
            point,
            motion,
            tolerance,
            iterations,
            short,
            accuracy,
            rests,
            absolute,
        }
    }

    /// Are islands brought to rest?
    pub fn rests(&self) -> bool {
        self.rests
    }

    /// Makes it, by [`Rest`] where islands are brought to rest.
    pub fn make<M: Memory>(&self, scene: &mut MassSpring<M>) -> Result<Report<M::Real>, StepError> {
        self.make_with(scene, self.rests.then_some(Rest(M::Real::from_f64(REST))))
    }

    /// Makes it, and brings islands to rest as one says.
    pub fn make_with<M: Memory>(
        &self,
        scene: &mut MassSpring<M>,
        sleep: impl Sleep<M::Real>,
    ) -> Result<Report<M::Real>, StepError> {
        let real = M::Real::from_f64;
        let (i, target, stiffness) = self.point;
        let n = scene.positions().len();
        // A point spring on a particle that is not there is refused; without particles there would be no other step.
        let mut points = [PointSpring::new(i, target.map(real), real(stiffness))];
        let points = if stiffness == 0.0 { &mut points[..0] } else { &mut points[..] };
        let forces = (((), Drag(real(self.drag))), (SpringDamping(real(self.damping)), points));
        let needs = [
            Rosenbrock2::<f64, ()>::needs(n),
            Rosenbrock3::<f64, ()>::needs(n),
            Newton::<f64, ()>::needs(n),
            EnergyMomentum::<f64, ()>::needs(n),
        ];
        let most = needs.into_iter().max().unwrap_or(0);
        self.with(scene, forces, sleep, |method| {
            let needs = if (2..6).contains(&method) { needs[method - 2] } else { most };
            // What is in the memory must not matter.
            vec![[real(f64::NAN); 3]; needs.saturating_sub(self.short)]
        })
    }

    fn with<M: Memory, F: Force<M::Real>>(
        &self,
        scene: &mut MassSpring<M>,
        forces: F,
        sleep: impl Sleep<M::Real>,
        memory: impl Fn(usize) -> Vec<[M::Real; 3]>,
    ) -> Result<Report<M::Real>, StepError> {
        let real = M::Real::from_f64;
        let dt = real(self.dt);
        let motion: Vec<_> = self
            .motion
            .iter()
            .map(|(i, x, v)| Motion { particle: *i, position: x.map(real), velocity: v.map(real) })
            .collect();
        let memory = memory(self.method);
        macro_rules! method {
            ($method:expr) => {
                $method
                    .gravity([0.0, -9.81, 0.0].map(real))
                    .with(forces)
                    .tolerance(real(self.tolerance))
                    .max_iterations(self.iterations)
            };
        }
        macro_rules! step {
            ($method:expr) => {
                scene.step_moving(&mut method!($method), &motion)
            };
            (adaptive $method:expr) => {{
                let mut method = Adaptive::new(method!($method), dt, real(self.accuracy));
                let made = scene.step_moving(&mut method, &motion);
                if made.is_ok() {
                    assert!(method.made().dt > M::Real::ZERO, "a step takes time");
                }
                made
            }};
        }
        match self.method {
            0 => step!(LinearlyImplicitEuler::new(dt).sleeping(sleep).absolute(real(self.absolute))),
            1 => step!(Midpoint::new(dt)),
            2 => step!(Rosenbrock2::new(dt, memory)),
            3 => step!(Rosenbrock3::new(dt, memory)),
            4 => step!(Newton::new(dt, memory)),
            5 => step!(EnergyMomentum::new(dt, memory)),
            6 => step!(Verlet::new(dt).substeps_at_most(100)),
            7 => step!(SymplecticEuler::new(dt)),
            8 => step!(adaptive Rosenbrock2::new(dt, memory)),
            9 => step!(adaptive Rosenbrock3::new(dt, memory)),
            _ => step!(adaptive Verlet::new(dt).substeps_at_most(100)),
        }
    }

    /// What must hold of a step that was made or refused.
    pub fn judge<M: Memory>(
        &self,
        scene: &MassSpring<M>,
        report: &Result<Report<M::Real>, StepError>,
        before: &[u64],
        now: &[u64],
    ) {
        let n = scene.positions().len();
        let r = match report {
            Ok(report) => report,
            Err(error) => return self.may_end_with(*error, n),
        };
        let zero = M::Real::ZERO;
        assert!(zero <= r.lower && r.lower <= r.upper && r.upper.is_finite(), "bounds in order: {r:?}");
        let islands = r.islands as usize;
        assert!(islands <= n && r.certified <= r.islands && r.untouched <= r.islands, "counts: {r:?}");
        assert!(r.capped + r.stalled + r.at_floor + r.untouched <= r.islands, "an island ends once: {r:?}");
        assert!(r.clamped as usize <= scene.state().springs() + 1, "springs and the point: {r:?}");
        let bits = |x: [f64; 3]| x.map(|x| M::Real::from_f64(x).to_f64().to_bits());
        for i in (0..n).filter(|i| scene.is_pinned(*i)) {
            let (at, v) = (3 * i..3 * i + 3, 3 * (n + i)..3 * (n + i) + 3);
            match self.motion.iter().rfind(|motion| motion.0 == i) {
                Some((_, x, rate)) => {
                    assert_eq!(now[at], bits(*x), "a pin is where it is told to be");
                    assert_eq!(now[v], bits(*rate), "and as fast");
                }
                None => {
                    assert_eq!(now[at.clone()], before[at], "pins rest");
                    assert!(now[v].iter().all(|v| f64::from_bits(*v) == 0.0), "and do not move");
                }
            }
        }
        let constant = 6 * n..;
        assert_eq!(now[constant.clone()], before[constant], "a step changes positions and velocities alone");
    }

    /// An error must have a cause in what the step was asked.
    fn may_end_with(&self, error: StepError, n: usize) {
        let (i, _, stiffness) = self.point;
        let adaptive = self.method >= 8;
        let caused = match error {
            // Which numbers are fit for T is the kernel's to say: 2⁻¹⁰⁰ is no step in f32.
            StepError::TimeStep | StepError::Tolerance | StepError::NotFinite(_) => true,
            StepError::Field => !(self.drag >= 0.0 && self.drag <= f64::from(f32::MAX)),
            StepError::Damping(_) => !(self.damping >= 0.0 && self.damping <= f64::from(f32::MAX)),
            StepError::Force(_) => stiffness != 0.0,
            StepError::NoParticle(p) => p == i && p >= n && stiffness != 0.0,
            StepError::NotPinned(_) | StepError::Motion(_) => !self.motion.is_empty(),
            StepError::StepLimit(_) => self.method == 6 || self.method == 7 || self.method == 10,
            StepError::NotConverged(_) => self.method == 4 || self.method == 5,
            StepError::Accuracy => adaptive,
            StepError::Workspace { .. } => self.short > 0,
            StepError::NotCertified(_) => false,
        };
        assert!(caused, "{error:?} after {self:?}");
    }
}
