//! The pattern of a scene as words, to tell whether it has changed: of each row how many springs it owns, of each spring where
//! its other end is and whether it goes slack. With the number of rows that is all that a numbering says
//! ([`crate::islands`]): what lies past the last row is a pin, and an island ends where none of its rows owns a spring to a
//! later one.

use crate::islands::Islands;
use crate::law::Law;
use crate::memory::Memory;
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
    for (word, own) in rows.iter_mut().zip(&*islands.own).take(islands.free) {
        same &= remember(Some(word), *own);
    }
    let edges = islands.other.iter().zip(&*islands.spring).take(islands.edges);
    for (word, (other, j)) in springs.iter_mut().zip(edges) {
        let cable = state.ends.get(*j as usize).is_some_and(|pair| Ends::unpack(*pair).cable);
        same &= remember(Some(word), *other | if M::Law::slackens(cable) { MARK } else { 0 });
    }
    same
}
