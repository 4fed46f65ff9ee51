//! An arbitrary small network, solved by an arbitrary solver, changed and solved again: bounds in order and, for the linear
//! system that the kernel shows, true; a refused step changes nothing, and a workspace of the size that it asks for is enough.

mod network;
mod reference;
mod trial;

use hooke::{
    BandedLdl, BlockIlu, BlockJacobi, MassSpring, Multigrid, Portable, Real, Single, SingleJacobi, SparseLdl,
    Ssor, Wide, WideJacobi,
};
use hooke_harness::heap::Heap;

use crate::bytes::Bytes;
use network::Network;
use trial::{ACTIONS, trial, two_stages};

/// A scene that grows.
type Heaped<T> = MassSpring<Heap<T>>;

/// Reads precision, network and solver, and tries them.
pub fn solvers(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let choice = bytes.byte();
    let network = Network::read(&mut bytes);
    if choice & 1 == 0 {
        solve::<f32>(choice >> 1, &network, bytes)
    } else {
        solve::<f64>(choice >> 1, &network, bytes)
    }
}

/// The solver that came last has these choices of 128, so that what was kept of the others' inputs means what it meant.
const LATER: std::ops::Range<u8> = 100..112;

/// Numbers and words of a workspace.
type Size = (usize, usize);

fn solve<T: Real>(choice: u8, network: &Network, bytes: Bytes<'_>) {
    let n = network.particles.len();
    let springs = network.springs.len();
    // An order that holds some particles twice and others never is as good as any.
    let order: Vec<u32> = network.order.iter().map(|i| u32::from(*i)).collect();
    let zeros = |n: usize| vec![T::ZERO; n];
    let lanes = |scene: &mut Heaped<T>| WideJacobi::needs_of(scene, true);
    match if LATER.contains(&choice) { 10 } else { choice % 10 } {
        0 => trial::<T, _>(network, bytes, false, |_| (0, 0), |_| BlockJacobi, Some(two_stages)),
        1 => {
            trial::<T, _>(network, bytes, false, |_| (Ssor::needs(n), 0), |(a, _)| Ssor::new(zeros(a)), None)
        }
        2 => trial::<T, _>(
            network,
            bytes,
            false,
            |_| (BlockIlu::needs(n), 0),
            |(a, _)| BlockIlu::new(zeros(a)),
            None,
        ),
        3 => trial::<T, _>(
            network,
            bytes,
            true,
            lanes,
            |(a, b)| WideJacobi::new(zeros(a), vec![0; b], Portable),
            None,
        ),
        4 => {
            let needs = Multigrid::needs(n, springs);
            trial::<T, _>(
                network,
                bytes,
                false,
                |_| needs,
                |(a, b)| Multigrid::new(vec![0.0; a], vec![0; b], Portable),
                None,
            )
        }
        5 => {
            // Two workspaces, and an error does not tell which of them it is about: the multigrid's is never short.
            let (numbers, words) = Multigrid::needs(n, springs + ACTIONS);
            trial::<T, _>(
                network,
                bytes,
                true,
                lanes,
                |(a, b)| {
                    let multigrid = Multigrid::new(vec![0.0; numbers], vec![0; words], Portable);
                    Wide::new(zeros(a), vec![0; b], Portable).around(multigrid)
                },
                None,
            )
        }
        6 => trial::<T, _>(
            network,
            bytes,
            false,
            |s| (BandedLdl::needs_of(s), 0),
            |(a, _)| BandedLdl::new(zeros(a)),
            Some(two_stages),
        ),
        7 => {
            let banded = BandedLdl::needs(n, n);
            let lanes = |scene: &mut Heaped<T>| BandedLdl::needs_in_lanes_of(scene, true).1;
            trial::<T, _>(
                network,
                bytes,
                true,
                lanes,
                |(a, b)| Wide::new(zeros(a), vec![0; b], Portable).around(BandedLdl::new(zeros(banded))),
                None,
            )
        }
        8 => trial::<T, _>(
            network,
            bytes,
            false,
            |_| (0, 0),
            |(a, b)| SparseLdl::new(order.clone(), zeros(a), vec![0; b]),
            Some(two_stages),
        ),
        9 => trial::<T, _>(
            network,
            bytes,
            false,
            |_| (0, 0),
            |(a, b)| SparseLdl::new(order.clone(), Single(vec![0.0; a]), vec![0; b]),
            None,
        ),
        _ => {
            // Two workspaces, of one size, so that it does not matter which of them an error is about.
            let both = |scene: &mut Heaped<T>| {
                let (numbers, words) = lanes(scene);
                (numbers.max(SingleJacobi::needs_of(scene)), words)
            };
            trial::<T, _>(
                network,
                bytes,
                true,
                both,
                |(a, b)| {
                    Wide::new(zeros(a), vec![0; b], Portable).around(SingleJacobi::new(vec![0.0_f32; a]))
                },
                None,
            )
        }
    }
}
