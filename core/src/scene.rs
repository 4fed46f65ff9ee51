//! A scene: particles, springs, and the memory that a step needs. [`Scene`] has a fixed capacity and is built in place;
//! [`MassSpring`] is the same over any owner of memory.

use core::marker::PhantomData;

use crate::energy::Energies;
use crate::error::StepError;
use crate::integrator::Integrator;
use crate::islands::Islands;
use crate::law::Hookean;
use crate::memory::{Fixed, Memory, SliceList, Slices};
use crate::network::{Network, State, network};
use crate::parts::Parts;
use crate::pins::Motion;
use crate::real::Real;
use crate::report::{IslandReport, Report};
use crate::vec3::Vec3;

/// Up to `N` particles and `S` springs in arrays, to be placed in a `static`: 152 bytes per particle and 40 per spring in
/// f32, 272 and 64 in f64, and the lengths of the lists.
pub type Scene<T, const N: usize, const S: usize, L = Hookean> = MassSpring<Fixed<T, N, S, L>>;

/// A scene in two borrowed buffers of any size.
pub type SceneIn<'a, T, L = Hookean> = MassSpring<Slices<'a, T, L>>;

/// Particles, springs and the memory of a step, over any owner of memory.
pub struct MassSpring<M: Memory> {
    pub(crate) network: Network<M>,
    pub(crate) islands: Islands<M>,
    pub(crate) work: WorkLists<M>,
}

/// The solver's vectors: a scene holds its state and what PCG needs; other methods own their scratch.
pub(crate) struct WorkLists<M: Memory> {
    pub(crate) x: M::Particles<[M::Real; 3]>,
    pub(crate) r: M::Particles<[M::Real; 3]>,
    pub(crate) b: M::Particles<[M::Real; 3]>,
    pub(crate) p: M::Particles<[M::Real; 3]>,
    pub(crate) y: M::Particles<[M::Real; 3]>,
    pub(crate) inertia: M::Particles<M::Real>,
    pub(crate) mu: M::Particles<M::Real>,
    pub(crate) block: M::Particles<[M::Real; 6]>,
    pub(crate) hessian: M::Springs<[M::Real; 4]>,
}

/// Builds a scene whose lists are all made by the same expression.
macro_rules! scene {
    ($particles:expr, $springs:expr) => {
        MassSpring {
            network: network!($particles, $springs),
            islands: Islands {
                particle: $particles,
                list: $particles,
                own: $particles,
                other: $springs,
                spring: $springs,
                count: 0,
                free: 0,
                edges: 0,
                current: false,
            },
            work: WorkLists {
                x: $particles,
                r: $particles,
                b: $particles,
                p: $particles,
                y: $particles,
                inertia: $particles,
                mu: $particles,
                block: $particles,
                hessian: $springs,
            },
        }
    };
}

impl<T: Real, L: crate::Law, const N: usize, const S: usize> Scene<T, N, S, L> {
    /// An empty scene, all zeros: as a `static` it lies in .bss and never crosses the stack.
    #[allow(clippy::new_without_default)] // A `default()` would build a large value on the stack.
    pub const fn new() -> Self {
        scene!(heapless::Vec::new(), heapless::Vec::new())
    }
}

/// An owner of memory whose lists start empty: what a growable one implements.
pub trait Growable: Memory {
    /// An empty list of something per particle.
    fn particles<X: Copy + 'static>() -> Self::Particles<X>;
    /// An empty list of something per spring.
    fn springs<X: Copy + 'static>() -> Self::Springs<X>;
}

impl<M: Growable> MassSpring<M> {
    /// An empty scene.
    pub fn empty() -> Self {
        scene!(M::particles(), M::springs())
    }
}

/// Cuts room for `n` arrays of `W` off the front of a buffer; the first `len` of them are in use.
fn cut<'a, X, const W: usize>(
    buffer: &mut &'a mut [X],
    n: usize,
    len: usize,
) -> Option<SliceList<'a, [X; W]>> {
    let (front, rest) = core::mem::take(buffer).split_at_mut_checked(n.checked_mul(W)?)?;
    *buffer = rest;
    SliceList::filled(front.as_chunks_mut().0, len)
}

fn cut_flat<'a, X>(buffer: &mut &'a mut [X], n: usize, len: usize) -> Option<SliceList<'a, X>> {
    let (front, rest) = core::mem::take(buffer).split_at_mut_checked(n)?;
    *buffer = rest;
    SliceList::filled(front, len)
}

impl<'a, T: Real, L: crate::Law> SceneIn<'a, T, L> {
    /// How many numbers and words [`SceneIn::in_buffers`] needs for so many particles and springs.
    pub const fn needs(particles: usize, springs: usize) -> (usize, usize) {
        (
            particles.saturating_mul(30).saturating_add(springs.saturating_mul(6)),
            particles.saturating_mul(8).saturating_add(springs.saturating_mul(4)),
        )
    }

    /// An empty scene for up to so many particles and springs, in borrowed buffers; `None` if they are too small.
    ///
    /// ```
    /// use hooke::SceneIn;
    /// let (reals, words) = SceneIn::<f64>::needs(2, 1);
    /// let (mut reals, mut words) = (vec![0.0; reals], vec![0; words]);
    /// let mut scene = SceneIn::<f64>::in_buffers(&mut reals, &mut words, 2, 1).ok_or("too small")?;
    /// let a = scene.particle([0.0; 3], 1.0)?;
    /// let b = scene.particle([1.0, 0.0, 0.0], 1.0)?;
    /// scene.spring(a, b, 100.0)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn in_buffers(
        reals: &'a mut [T],
        words: &'a mut [u32],
        particles: usize,
        springs: usize,
    ) -> Option<Self> {
        Self::attach(reals, words, particles, springs, [0; 6])
    }

    /// How far the buffers are filled: particles, springs, islands, free particles, springs with a free end, and
    /// whether the last three belong to the present pins and springs (1) or are to be found anew (0). All that a scene
    /// knows besides what is in its buffers; [`SceneIn::attach`] takes it back.
    pub fn counts(&self) -> [u32; 6] {
        let Islands { count, free, edges, current, .. } = &self.islands;
        [self.network.mass.len(), self.network.ends.len(), *count, *free, *edges, usize::from(*current)]
            .map(|n| n as u32)
    }

    /// The scene that `buffers` held when [`SceneIn::counts`] answered `counts`: for a caller who can keep buffers but
    /// no Rust value between calls. The buffers may have moved meanwhile: a scene keeps indices, never addresses.
    ///
    /// `None` if the buffers are too small or the counts contradict each other. What the buffers hold is not looked
    /// at: other contents make another scene, perhaps a senseless one, whose steps fail or give senseless numbers.
    ///
    /// ```
    /// use hooke::{LinearlyImplicitEuler, SceneIn};
    /// let (mut reals, mut words, mut euler) = ([0.0; 66], [0; 20], LinearlyImplicitEuler::new(0.01));
    /// let mut scene = SceneIn::<f64>::in_buffers(&mut reals, &mut words, 2, 1).ok_or("too small")?;
    /// let (a, b) = (scene.particle([0.0; 3], 1.0)?, scene.particle([1.0, 0.0, 0.0], 1.0)?);
    /// scene.spring(a, b, 100.0)?;
    /// scene.impulse(a, [0.5, 0.0, 0.0])?;
    /// scene.step(&mut euler)?;
    /// let (counts, before) = (scene.counts(), scene.positions().to_vec());
    ///
    /// let (mut reals, mut words) = (reals, words); // elsewhere, later
    /// let mut scene = SceneIn::<f64>::attach(&mut reals, &mut words, 2, 1, counts).ok_or("does not fit")?;
    /// assert_eq!(scene.positions(), before);
    /// scene.step(&mut euler)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn attach(
        mut reals: &'a mut [T],
        mut words: &'a mut [u32],
        particles: usize,
        springs: usize,
        counts: [u32; 6],
    ) -> Option<Self> {
        let (reals, words, n, s) = (&mut reals, &mut words, particles, springs);
        let [p, q, count, free, edges, current] = counts.map(|count| count as usize);
        if count > free || free > p || edges > q || current > 1 {
            return None;
        }
        Some(MassSpring {
            network: Network {
                position: cut(reals, n, p)?,
                velocity: cut(reals, n, p)?,
                mass: cut_flat(reals, n, p)?,
                slot: cut_flat(words, n, p)?,
                ends: cut(words, s, q)?,
                stiffness: cut_flat(reals, s, q)?,
                rest_length: cut_flat(reals, s, q)?,
            },
            islands: Islands {
                particle: cut_flat(words, n, p)?,
                list: cut(words, n, p)?,
                own: cut_flat(words, n, p)?,
                other: cut_flat(words, s, q)?,
                spring: cut_flat(words, s, q)?,
                count,
                free,
                edges,
                current: current == 1,
            },
            work: WorkLists {
                x: cut(reals, n, p)?,
                r: cut(reals, n, p)?,
                b: cut(reals, n, p)?,
                p: cut(reals, n, p)?,
                y: cut(reals, n, p)?,
                inertia: cut_flat(reals, n, p)?,
                mu: cut_flat(reals, n, p)?,
                block: cut(reals, n, p)?,
                hessian: cut(reals, s, q)?,
            },
        })
    }
}

impl<M: Memory> MassSpring<M> {
    /// Advances by one step; pins rest. Cost: one assembly and one solve per island; after a change of pins or springs
    /// also the islands, O(particles + springs·log).
    ///
    /// # Errors
    /// [`StepError`], and then nothing has changed but the scratch of forces.
    pub fn step<I: Integrator<M::Real>>(&mut self, integrator: &mut I) -> Result<Report<M::Real>, StepError> {
        integrator.advance(self.parts(), &[], &mut |_| {})
    }

    /// Advances by one step over which some pins move.
    ///
    /// # Errors
    /// [`StepError`], and then nothing has changed but the scratch of forces.
    pub fn step_moving<I: Integrator<M::Real>>(
        &mut self,
        integrator: &mut I,
        motion: &[Motion<M::Real>],
    ) -> Result<Report<M::Real>, StepError> {
        integrator.advance(self.parts(), motion, &mut |_| {})
    }

    /// Advances by one step and shows the report of each island on the way, before it is known whether all of them can
    /// be advanced: after an error the reports seen are of a step that was not made.
    ///
    /// # Errors
    /// [`StepError`], and then nothing has changed but the scratch of forces.
    pub fn step_watched<I: Integrator<M::Real>>(
        &mut self,
        integrator: &mut I,
        motion: &[Motion<M::Real>],
        mut watch: impl FnMut(&IslandReport<M::Real>),
    ) -> Result<Report<M::Real>, StepError> {
        integrator.advance(self.parts(), motion, &mut watch)
    }

    /// All of the scene for an integrator, islands renewed if pins or springs have changed.
    pub fn parts(&mut self) -> Parts<'_, M> {
        self.renew();
        Parts { network: &mut self.network, islands: &self.islands, work: &mut self.work }
    }

    fn renew(&mut self) -> &Islands<M> {
        if !self.islands.current {
            self.islands.renew(&mut self.network);
        }
        &self.islands
    }

    /// A read-only view of particles and springs.
    pub fn state(&self) -> State<'_, M::Real> {
        self.network.state()
    }

    /// Energies, tensions, forces and stiffness of the springs.
    pub fn springs(&self) -> Energies<'_, M::Real, M::Law> {
        Energies { state: self.state(), law: PhantomData }
    }

    /// q: where the particles are, m
    pub fn positions(&self) -> &[Vec3<M::Real>] {
        &self.network.position
    }

    /// q̇: how fast they move, m/s
    pub fn velocities(&self) -> &[Vec3<M::Real>] {
        &self.network.velocity
    }

    /// Number of islands: parts that are solved apart.
    pub fn islands(&mut self) -> usize {
        self.renew().count
    }

    /// Number of free particles, the unknowns of a step.
    pub fn free_particles(&mut self) -> usize {
        self.renew().free
    }

    /// The force that the support of particle `i` must exert to hold it at rest, N: minus all forces on it in the
    /// present state (springs with their damping, and `forces`). These are the rows that P drops. O(springs).
    pub fn reaction<F: crate::Force<M::Real>>(&self, i: usize, forces: &F) -> Option<Vec3<M::Real>> {
        crate::reaction::reaction(&self.springs(), i, forces)
    }
}
