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
use crate::wide::eight::{Planes, WIDTH};
use crate::wide::layout::Layout;
use crate::wide::slots::Slots;
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
    workshop.springs.fill(T::ZERO);
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
    let mut springs = words.iter().zip(matrix.other).zip(island.spring);
    for (row, own) in matrix.own.iter().enumerate() {
        for ((word, other), j) in springs.by_ref().take(*own as usize) {
            let (other, j) = (*other as usize, *j as usize);
            let Some(pair) = island.pair(row, other) else { return false };
            let Some(run) = layout.run_of(*word, &pair) else { return false };
            let at = constants::<F, T>() * run * n + layout.place(pair.low);
            put_constants::<T, F, L>(island, forces, j, workshop.springs, [at, n]);
            if other >= rows {
                let pin = if pair.turned { pair.low } else { pair.low + pair.distance };
                workshop.velocity.put(layout.place(pin), island.end(other).velocity);
            }
        }
    }
    true
}

/// The same in slots.
#[inline(never)]
pub(crate) fn load_slots<T: Real, F: Force<T>, L: Law>(
    island: &IslandParts<'_, T>,
    forces: &F,
    layout: &Layout,
    slots: &Slots<'_>,
    front: &mut Front<'_, T>,
    workshop: &mut Workshop<'_, T>,
) -> bool {
    let matrix = &island.matrix;
    let rows = matrix.own.len();
    workshop.springs.fill(T::ZERO);
    if matrix.other.len() != layout.springs || rows != slots.places.len() {
        return false;
    }
    let lists = slots.places.iter().zip(matrix.inertia.iter()).zip(island.vectors.b.iter()).enumerate();
    for (row, ((at, m), b)) in lists {
        let (at, end) = (*at as usize, island.end(row));
        if let Some(place) = front.inertia.get_mut(at) {
            *place = *m;
        }
        front.b.put(at, *b);
        workshop.position.put(at, end.position);
        workshop.velocity.put(at, end.velocity);
    }
    // Behind the rows lie the places without, and the ends that are pins.
    for at in rows..layout.plane() {
        if let Some(place) = front.inertia.get_mut(at) {
            *place = T::ZERO;
        }
        front.b.put(at, [T::ZERO; 3]);
        workshop.position.put(at, [T::ZERO; 3]);
        workshop.velocity.put(at, [T::ZERO; 3]);
    }
    let mut pin = layout.places;
    let mut springs = matrix.other.iter().zip(island.spring);
    for (own, at) in matrix.own.iter().zip(slots.places) {
        let (lane, range) = (*at as usize % WIDTH, slots.range(*at as usize / WIDTH, 0));
        if *own as usize > range.len() {
            return false;
        }
        for (slot, (other, j)) in range.zip(springs.by_ref().take(*own as usize)) {
            let other = *other as usize;
            let far = if other < rows {
                slots.places.get(other).map_or(0, |place| *place as usize)
            } else {
                let end = island.end(other);
                workshop.position.put(pin, end.position);
                workshop.velocity.put(pin, end.velocity);
                pin += 1;
                pin - 1
            };
            let end = slots.own.get(slot).and_then(|ends| ends.get(lane));
            if end.is_none_or(|end| *end as usize != far) {
                return false;
            }
            let at = constants::<F, T>() * slot * WIDTH + lane;
            put_constants::<T, F, L>(island, forces, *j as usize, workshop.springs, [at, WIDTH]);
        }
    }
    true
}

/// Numbers that are kept of a spring.
const fn constants<F: Force<T>, T: Real>() -> usize {
    if F::DAMPS { 3 } else { 2 }
}

/// k, l₀ and c of a spring, the first at a place and each of the others so much further.
#[inline(always)]
fn put_constants<T: Real, F: Force<T>, L: Law>(
    island: &IslandParts<'_, T>,
    forces: &F,
    j: usize,
    to: &mut [T],
    [at, further]: [usize; 2],
) {
    let state = island.matrix.rows.state;
    let spring = state.spring(j);
    set(to, at, spring.stiffness);
    let cable = state.ends.get(j).is_some_and(|pair| Ends::unpack(*pair).cable);
    let rest = if L::slackens(cable) { -spring.rest_length } else { spring.rest_length };
    set(to, at + further, rest);
    if F::DAMPS {
        set(to, at + 2 * further, forces.damping(j));
    }
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
