//! A hash of a pattern, by which a hierarchy is known again. Should two patterns share one, the preconditioner is a bad one,
//! and the certificate of PCG says what came of it.

/// Lanes.
const WIDTH: usize = 8;

/// A hash of who is joined to whom, in eight lanes.
pub(super) fn fingerprint(own: &[u32], other: &[u32]) -> [u32; 2] {
    let mut lanes = [0x811C_9DC5_u32; WIDTH];
    for list in [own, other] {
        let (chunks, rest) = list.as_chunks::<WIDTH>();
        let mix = |lane: &mut u32, word: u32| *lane = (*lane ^ word).wrapping_mul(0x0100_0193).rotate_left(5);
        for chunk in chunks {
            for (lane, word) in lanes.iter_mut().zip(chunk) {
                mix(lane, *word);
            }
        }
        for (lane, word) in lanes.iter_mut().zip(rest) {
            mix(lane, *word);
        }
    }
    let mut sum = [0x9E37_79B9, own.len() as u32];
    for lane in lanes {
        for (word, factor) in sum.iter_mut().zip([0x85EB_CA6B, 0xC2B2_AE35]) {
            *word = (*word ^ lane).wrapping_mul(factor).rotate_left(13);
        }
    }
    sum
}
