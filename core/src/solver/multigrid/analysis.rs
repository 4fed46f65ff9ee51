//! The hierarchy of one island: what depends only on which springs there are, and on their stiffness when it was made.

use super::block::{FULL, TIED};
use super::level::{Pattern, Size};
use super::matching::{self, aggregate};
use super::record::{RECORD, Shape, remember};
use super::sizes::{DENSE, most_edges, most_numbers, most_rows};
use super::springs::ends_of_springs;
use super::strips::{Edges, LOOSE, SPARSE, arrange, measure, sort};
use super::tile::WIDTH;
use super::words::{NONE, get, set, take};
use crate::parts::Matrix;
use crate::real::Real;

/// Passes of matching: aggregates of up to 2³.
const PASSES: usize = 3;

/// Makes an island's hierarchy from its pattern and each spring's weight, which is spoilt: record, springs' places and levels go to
/// `kept`. `None` if the room is too small.
#[inline(never)]
pub(super) fn analyse<T: Real>(
    matrix: &Matrix<'_, T>,
    fingerprint: [u32; 2],
    mut kept: &mut [u32],
    mut scratch: &mut [u32],
    weight: &mut [f32],
    mut numbers: &mut [f32],
) -> Option<Shape> {
    let (rows, springs) = (matrix.own.len(), matrix.other.len());
    let record = take(&mut kept, RECORD)?;
    let mut places: &mut [[u32; 2]] = take(&mut kept, 2 * springs)?.as_chunks_mut().0;
    let tie = take(&mut numbers, rows)?;
    let joint_weight = take(&mut numbers, springs)?;
    let mut part = |n| take(&mut scratch, n);
    let mut ends = [part(springs)?, part(springs)?];
    let touching = part(2 * springs)?;
    let (mut joint, from) = ([part(springs)?, part(springs)?], part(springs)?);
    let (first, mut lists) = (part(rows + 1)?, [part(rows)?, part(rows)?, part(rows)?]);
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
        // Strips if there is room for them; if not, loose edges, which take least. (A strip should take
        // a third of the time of a loose edge, counted in instructions and not measured, however empty it is; but nothing would be
        // left for the coarser levels if the finest took all.)
        let mut joined = Edges { ends: input, sorted, alone: finest, sparse: SPARSE };
        let (mut count, mut level_numbers) = (0, 0);
        for limit in if finest { [SPARSE, SPARSE, 0] } else { [4 * SPARSE, SPARSE, 0] } {
            joined.sparse = limit;
            (size.extent, count) = measure(joined);
            level_numbers = WIDTH * (per_place * size.extent.strips + FULL * size.extent.loose);
            if all_numbers + level_numbers <= most_numbers(springs) {
                break;
            }
        }
        all_rows += size.rows;
        all_edges += count;
        all_numbers += level_numbers;
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
        let list = Joint { ends: &mut joint, weight: joint_weight, place: from };
        let [next, ..] = &mut lists;
        lay_out(joined, weight, &mut pattern, next, places, list);
        shape.levels += 1;
        let pairs = [joint[0].get(..count)?, joint[1].get(..count)?];
        let coarse = if size.rows <= DENSE {
            size.rows
        } else {
            let touching = touching.get_mut(..2 * count)?;
            group(pairs, joint_weight, pattern.aggregate, touching, first, &mut lists, tie)?
        };
        if 3 * coarse > 2 * size.rows {
            *kept_size = size;
            break;
        }
        edges = between(pairs, joint_weight, pattern.aggregate, &mut ends, weight, from);
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

/// A level's edges, each once.
struct Joint<'j, 's> {
    ends: &'j mut [&'s mut [u32]; 2],
    weight: &'j mut [f32],
    place: &'j mut [u32],
}

/// Writes a level's strips and loose ends, the place of every edge that comes in, and the list of its edges.
fn lay_out(
    edges: Edges<'_>,
    weight: &[f32],
    pattern: &mut Pattern<'_>,
    next: &mut [u32],
    places: &mut [[u32; 2]],
    list: Joint<'_, '_>,
) {
    let Pattern { strips, loose: [loose_a, loose_b], .. } = pattern;
    places.fill([NONE; 2]);
    loose_a.fill(NONE);
    loose_b.fill(NONE);
    let mut last = NONE as usize;
    let [a, b] = edges.ends;
    arrange(edges, strips, next, places, |edge, place, new| {
        let edge = edge as usize;
        let (a, b) = (get(a, edge), get(b, edge));
        last = if last == NONE as usize { 0 } else { last + usize::from(new) };
        let weight = weight.get(edge).copied().unwrap_or(0.0);
        if let Some(sum) = list.weight.get_mut(last) {
            *sum = if new { weight } else { *sum + weight };
        }
        set(list.ends[0], last, a);
        set(list.ends[1], last, b);
        set(list.place, last, place);
        if place & LOOSE != 0 {
            set(loose_a, (place & !LOOSE) as usize, a);
            set(loose_b, (place & !LOOSE) as usize, b);
        }
    });
}

/// Puts rows together; answers how many aggregates there are.
fn group(
    pairs: [&[u32]; 2],
    weight: &[f32],
    aggregates: &mut [u32],
    touching: &mut [u32],
    first: &mut [u32],
    [group, next, taken]: &mut [&mut [u32]; 3],
    tie: &mut [f32],
) -> Option<usize> {
    let rows = aggregates.len();
    let mut lists = matching::Scratch {
        first: first.get_mut(..rows + 1)?,
        touching,
        group: group.get_mut(..rows)?,
        next: next.get_mut(..rows)?,
        taken: taken.get_mut(..rows)?,
        tie: tie.get_mut(..rows)?,
    };
    Some(aggregate(PASSES, pairs, weight, aggregates, &mut lists))
}

/// The edges between aggregates, which are the next level's: their ends and weights, and in front of `from` where they lie.
fn between(
    pairs: [&[u32]; 2],
    joint_weight: &[f32],
    aggregates: &[u32],
    ends: &mut [&mut [u32]; 2],
    weight: &mut [f32],
    from: &mut [u32],
) -> usize {
    let mut edges = 0;
    for (k, (a, b)) in pairs[0].iter().zip(pairs[1]).enumerate() {
        let [a, b] = [*a, *b].map(|row| get(aggregates, row as usize));
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
    edges
}
