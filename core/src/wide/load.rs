//! A step's givens into planes: q and q̇ of all places, M̃ and b of the rows, k, l₀ and c of the springs. On the way every
//! spring is compared with its word, so a layout is used only while it is the island's. The rest length of a spring that
//! goes slack is written with a minus.

use crate::force::Force;
use crate::law::Law;
use crate::memory::part;
use crate::parts::IslandParts;
use crate::real::Real;
use crate::selection::Ends;
use crate::vec3::Vec3;
use crate::wide::eight::Planes;
use crate::wide::layout::Layout;
use crate::wide::work::{Front, Workshop};

/// Answers whether the layout still fits; if not, what was written is of no use.
#[inline(never)]
pub(crate) fn load<T: Real, F: Force<T>, L: Law>(
    island: &IslandParts<'_, T>,
    forces: &F,
    layout: &Layout,
    words: &[u32],
    front: &mut Front<'_, T>,
    workshop: &mut Workshop<'_, T>,
) -> bool {
    let matrix = &island.matrix;
    if matrix.other.len() != layout.springs || !within(island, layout) {
        return false;
    }
    let state = matrix.rows.state;
    let there = layout.base..core::cmp::min(layout.base + layout.places, state.position.len());
    fill(&mut workshop.position, layout, part(state.position, there.clone()));
    fill(&mut workshop.velocity, layout, part(state.velocity, there));
    front.inertia.fill(T::ZERO);
    for plane in &mut front.b.0 {
        plane.fill(T::ZERO);
    }
    for ((row, m), b) in matrix.rows.particle.iter().zip(matrix.inertia.iter()).zip(island.vectors.b.iter()) {
        let at = layout.place(*row);
        if let Some(place) = front.inertia.get_mut(at) {
            *place = *m;
        }
        front.b.put(at, *b);
    }
    let rows = matrix.own.len();
    let n = layout.plane();
    let constants = if F::DAMPS { 3 } else { 2 };
    let mut springs = words.iter().zip(matrix.other).zip(island.spring);
    for (row, own) in matrix.own.iter().enumerate() {
        for ((word, other), j) in springs.by_ref().take(*own as usize) {
            let (other, j) = (*other as usize, *j as usize);
            let Some(pair) = island.pair(row, other) else { return false };
            let Some(run) = layout.run_of(*word, &pair) else { return false };
            let spring = state.spring(j);
            let at = constants * run * n + layout.place(pair.low);
            set(front.springs, at, spring.stiffness);
            let cable = state.ends.get(j).is_some_and(|pair| Ends::unpack(*pair).cable);
            let rest = if L::slackens(cable) { -spring.rest_length } else { spring.rest_length };
            set(front.springs, at + n, rest);
            if F::DAMPS {
                set(front.springs, at + 2 * n, forces.damping(j));
            }
            if other >= rows {
                let pin = if pair.turned { pair.low } else { pair.low + pair.distance };
                workshop.velocity.put(layout.place(pin), island.end(other).velocity);
            }
        }
    }
    true
}

/// Do all rows have a place?
fn within<T: Real>(island: &IslandParts<'_, T>, layout: &Layout) -> bool {
    let rows = island.matrix.rows.particle;
    let has =
        |row: Option<&u32>| row.is_some_and(|row| (*row as usize).wrapping_sub(layout.base) < layout.places);
    has(rows.first()) && has(rows.last())
}

/// Vectors from the first place on; zeros where there are none.
fn fill<T: Real>(planes: &mut Planes<'_, T>, layout: &Layout, from: &[Vec3<T>]) {
    for (c, plane) in planes.0.iter_mut().enumerate() {
        let (before, rest) = plane.split_at_mut_checked(layout.pad).unwrap_or_default();
        let (there, behind) = rest.split_at_mut_checked(from.len()).unwrap_or_default();
        before.fill(T::ZERO);
        behind.fill(T::ZERO);
        for (to, from) in there.iter_mut().zip(from) {
            *to = from.get(c).copied().unwrap_or(T::ZERO);
        }
    }
}

#[inline(always)]
fn set<T: Real>(plane: &mut [T], at: usize, value: T) {
    if let Some(place) = plane.get_mut(at) {
        *place = value;
    }
}
