//! The pattern of a scene as words, to tell whether it has changed: of each row how many springs it owns and whether an
//! island begins there, of each spring where its other end is and whether it goes slack. With the numbers of rows and springs
//! that is all that a numbering says ([`crate::islands`]): two scenes of one pattern have the same islands in the same places.

use crate::islands::{Island, Islands};
use crate::law::Law;
use crate::memory::{Memory, part, part_mut};
use crate::network::State;
use crate::selection::{Ends, MARK};

/// Remembers `now`; answers whether it was that already. (A NaN is never what it was.)
#[inline(always)]
pub(super) fn remember<X: PartialEq>(place: Option<&mut X>, now: X) -> bool {
    match place {
        Some(place) if *place == now => true,
        Some(place) => {
            *place = now;
            false
        }
        None => false,
    }
}

/// Remembers a scene's pattern in words for its rows and springs; answers whether they were its words already.
pub(super) fn is_as_before<M: Memory>(
    (rows, springs): (&mut [u32], &mut [u32]),
    islands: &Islands<M>,
    state: &State<'_, M::Real>,
) -> bool {
    let mut same = true;
    for island in islands.islands() {
        let island = Island::unpack(*island);
        let mut begins = MARK;
        for (word, own) in part_mut(rows, island.slots()).iter_mut().zip(part(&islands.own, island.slots())) {
            same &= remember(Some(word), *own | begins);
            begins = 0;
        }
    }
    let edges = islands.other.iter().zip(&*islands.spring).take(islands.edges);
    for (word, (other, j)) in springs.iter_mut().zip(edges) {
        let cable = state.ends.get(*j as usize).is_some_and(|pair| Ends::unpack(*pair).cable);
        same &= remember(Some(word), *other | if M::Law::slackens(cable) { MARK } else { 0 });
    }
    same
}
