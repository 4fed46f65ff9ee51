//! The networks: any springs between few particles, or a chain or a net of enough of them to fill lanes, with a few springs
//! besides. Numbers are the bytes'.

use hooke::{Real, Spring};

use super::Heaped;
use crate::bytes::Bytes;

/// A particle.
#[derive(Debug)]
pub struct Particle {
    position: [f64; 3],
    velocity: [f64; 3],
    mass: f64,
    pinned: bool,
}

/// A network and how its step is made.
#[derive(Debug)]
pub struct Network {
    /// The particles.
    pub particles: Vec<Particle>,
    /// Ends, k, l₀, and whether it only pulls.
    pub springs: Vec<([usize; 2], f64, f64, bool)>,
    /// An order for elimination: any numbers.
    pub order: Vec<u8>,
}

impl Network {
    /// Reads one: its shape, a table of numbers that particles and springs take in turn, and what is there besides.
    pub fn read(bytes: &mut Bytes<'_>) -> Self {
        let shape = bytes.byte();
        let moving = bytes.byte() & 1 == 1;
        let (n, mut springs) = match shape % 4 {
            0 | 1 => (1 + bytes.below(24), Vec::new()),
            2 => chain(40 + bytes.below(60)),
            _ => net(4 + bytes.below(6), 9),
        };
        let table: Vec<f64> = (0..1 + bytes.below(16)).map(|_| bytes.number()).collect();
        let mut turn = table.iter().copied().cycle();
        let mut next = || turn.next().unwrap_or(0.0);
        let mut more: Vec<[usize; 2]> =
            (0..bytes.below(40)).map(|_| [bytes.below(n), bytes.below(n)]).collect();
        let pins: Vec<usize> = (0..bytes.below(6)).map(|_| bytes.below(n)).collect();
        springs.append(&mut more);
        let place = |i: usize| [i % 9, i / 9, 0].map(|x| x as f64 * if shape & 4 == 0 { 0.5 } else { 0.0 });
        let particles = (0..n)
            .map(|i| {
                let mut position = place(i);
                position.iter_mut().for_each(|x| *x += next());
                let velocity = if moving { [next(), next(), next()] } else { [0.0; 3] };
                Particle { position, velocity, mass: next().abs(), pinned: pins.contains(&i) }
            })
            .collect();
        let springs =
            springs.into_iter().map(|ends| (ends, 16.0 * next().abs(), next().abs(), next() < -2.0));
        let springs = springs.collect();
        let order = (0..bytes.below(2) * n).map(|_| bytes.byte()).collect();
        Self { particles, springs, order }
    }

    /// The scene, without what the kernel refuses: a spring with one end, a mass of 0.
    pub fn build<T: Real>(&self) -> Heaped<T> {
        let real = T::from_f64;
        let mut scene = Heaped::<T>::empty();
        for (i, p) in self.particles.iter().enumerate() {
            if scene.particle(p.position.map(real), real(p.mass)).is_err() {
                // All particles are to be there, for springs name them.
                assert_eq!(scene.particle([T::ZERO; 3], T::ONE), Ok(i), "ones and zeros are accepted");
            }
            _ = scene.set_velocity(i, p.velocity.map(real));
            if p.pinned {
                assert!(scene.pin(i).is_ok());
            }
        }
        for ([a, b], stiffness, rest_length, pulls) in &self.springs {
            let spring = Spring { stiffness: real(*stiffness), rest_length: real(*rest_length) };
            _ = if *pulls { scene.cable(*a, *b, spring) } else { scene.spring_with(*a, *b, spring) };
        }
        scene
    }
}

fn chain(n: usize) -> (usize, Vec<[usize; 2]>) {
    (n, (1..n).map(|i| [i - 1, i]).collect())
}

/// Springs by offset, as the catalogue's nets have them.
fn net(rows: usize, columns: usize) -> (usize, Vec<[usize; 2]>) {
    let n = rows * columns;
    let along = (0..n).filter(|i| i % columns > 0).map(|i| [i - 1, i]);
    let across = (columns..n).map(|i| [i - columns, i]);
    (n, along.chain(across).collect())
}
