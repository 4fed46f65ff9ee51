//! The hierarchy of one island: what depends only on which springs there are, and on their stiffness when it was made.

use super::block::{FULL, TIED};
use super::level::{Pattern, Size};
use super::matching::{self, aggregate};
use super::record::{RECORD, Shape, remember};
use super::runs::{LOOSE, SPARSE, arrange, sort};
use super::sizes::{DENSE, most_edges, most_numbers, most_rows};
use super::tile::WIDTH;
use super::words::{NONE, get, set, take};
use crate::hessian::Hessian;
use crate::parts::Matrix;
use crate::real::Real;
use crate::vec3;

/// Passes of matching: aggregates of up to 2³.
const PASSES: usize = 3;

/// Makes an island's hierarchy: record, springs' places and levels go to `kept`. `None` if the room is too small.
#[inline(never)]
pub(super) fn analyse<T: Real>(
    matrix: &Matrix<'_, T>,
    fingerprint: [u32; 2],
    mut kept: &mut [u32],
    mut scratch: &mut [u32],
    mut numbers: &mut [f32],
) -> Option<Shape> {
    let (rows, springs) = (matrix.own.len(), matrix.other.len());
    let record = take(&mut kept, RECORD)?;
    let mut places = take(&mut kept, springs)?;
    let tie = take(&mut numbers, rows)?;
    let (weight, joint_weight) = (take(&mut numbers, springs)?, take(&mut numbers, springs)?);
    let mut part = |n| take(&mut scratch, n);
    let mut ends = [part(springs)?, part(springs)?];
    let touching = part(2 * springs)?;
    let (mut joint, from) = ([part(springs)?, part(springs)?], part(springs)?);
    let (first, mut lists) = (part(rows + 1)?, [part(rows)?, part(rows)?, part(rows)?]);
    weigh(matrix, weight);
    ends_of_springs(matrix, &mut ends);
    let mut shape = Shape::default();
    let mut size = Size { rows, ..Size::default() };
    let (mut edges, mut all_rows, mut all_edges, mut all_numbers) = (springs, 0, 0, 0);
    for (level, kept_size) in shape.size.iter_mut().enumerate() {
        let finest = level == 0;
        let [a, b] = &ends;
        let input = [a.get(..edges)?, b.get(..edges)?];
        let (order, other) = touching.split_at_mut_checked(springs)?;
        let sorted = sort(size.rows, input, order, other, first);
        let per_place = if finest { TIED } else { FULL };
        let mut count = 0;
        size.extent =
            arrange(input, sorted, per_place, finest, SPARSE, |_| (), |_, _, new| count += usize::from(new));
        all_rows += size.rows;
        all_edges += count;
        all_numbers += per_place * size.extent.places + FULL * WIDTH * size.extent.loose;
        if all_rows > most_rows(rows)
            || all_edges > most_edges(springs)
            || all_numbers > most_numbers(springs)
        {
            break;
        }
        // The edges, each once, with where it lies, and the springs' or the finer level's places.
        size.cross = 0;
        let mut whole = &mut *kept;
        let mut pattern = Pattern::carve(&mut whole, size)?;
        places.fill(NONE);
        let [loose_a, loose_b] = &mut pattern.loose;
        loose_a.fill(NONE);
        loose_b.fill(NONE);
        let mut runs = pattern.runs.iter_mut();
        let mut last = 0;
        arrange(
            input,
            sorted,
            per_place,
            finest,
            SPARSE,
            |run| {
                if let Some(place) = runs.next() {
                    *place = run;
                }
            },
            |edge, place, new| {
                let edge = edge as usize;
                let (a, b) = (get(input[0], edge), get(input[1], edge));
                last += usize::from(new);
                let weight = weight.get(edge).copied().unwrap_or(0.0);
                if let Some(sum) = joint_weight.get_mut(last - 1) {
                    *sum = if new { weight } else { *sum + weight };
                }
                set(joint[0], last - 1, a);
                set(joint[1], last - 1, b);
                set(from, last - 1, place);
                set(places, edge, place);
                if place & LOOSE != 0 {
                    set(loose_a, (place & !LOOSE) as usize, a);
                    set(loose_b, (place & !LOOSE) as usize, b);
                }
            },
        );
        shape.levels += 1;
        let pairs = [joint[0].get(..count)?, joint[1].get(..count)?];
        let coarse = if size.rows <= DENSE {
            size.rows
        } else {
            let [group, next, taken] = &mut lists.each_mut();
            let mut lists = matching::Scratch {
                first: first.get_mut(..size.rows + 1)?,
                touching: touching.get_mut(..2 * count)?,
                group: group.get_mut(..size.rows)?,
                next: next.get_mut(..size.rows)?,
                taken: taken.get_mut(..size.rows)?,
                tie: tie.get_mut(..size.rows)?,
            };
            aggregate(PASSES, pairs, joint_weight, pattern.aggregate, &mut lists)
        };
        if 3 * coarse > 2 * size.rows {
            *kept_size = size;
            break;
        }
        // Edges between aggregates, which are the next level's.
        edges = 0;
        for (k, (a, b)) in pairs[0].iter().zip(pairs[1]).enumerate() {
            let [a, b] = [*a, *b].map(|row| get(pattern.aggregate, row as usize));
            if a != b {
                let (low, high) = if a < b { (a, b) } else { (b, a) };
                set(ends[0], edges, low);
                set(ends[1], edges, high);
                if let Some(place) = weight.get_mut(edges) {
                    *place = joint_weight.get(k).copied().unwrap_or(0.0);
                }
                set(from, edges, get(from, k));
                edges += 1;
            }
        }
        size.cross = edges;
        *kept_size = size;
        let pattern = Pattern::carve(&mut kept, size)?;
        for (place, from) in pattern.from.iter_mut().zip(from.iter()) {
            *place = *from;
        }
        places = pattern.to;
        size.rows = coarse;
    }
    remember(record, fingerprint, springs, &shape);
    Some(shape)
}

/// The ends of the springs between two rows, the lower first; NONE where a spring ends at a pin.
fn ends_of_springs<T: Real>(matrix: &Matrix<'_, T>, [a, b]: &mut [&mut [u32]; 2]) {
    let (rows, mut others) = (matrix.own.len() as u32, matrix.other.iter().enumerate());
    for (row, own) in matrix.own.iter().enumerate() {
        for (spring, other) in others.by_ref().take(*own as usize) {
            let (row, other) = (row as u32, *other);
            let (low, high) = if row < other { (row, other) } else { (other, row) };
            let none = low == high || high >= rows;
            set(a, spring, if none { NONE } else { low });
            set(b, spring, if none { NONE } else { high });
        }
    }
}

/// α + |w|², relative to the largest.
fn weigh<T: Real>(matrix: &Matrix<'_, T>, weight: &mut [f32]) {
    let of = |h: &[T; 4]| {
        let Hessian { alpha, w } = Hessian::unpack(*h);
        alpha + vec3::dot(w, w)
    };
    let largest = matrix.hessian.iter().map(of).fold(T::ZERO, crate::real::larger);
    for (weight, h) in weight.iter_mut().zip(matrix.hessian.iter()) {
        let relative = (of(h) / largest).to_f64() as f32;
        *weight = if relative.is_finite() { relative } else { 0.0 };
    }
}
