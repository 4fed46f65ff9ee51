//! A scene in a caller's buffer whose words somebody damages: wrong numbers or an error, never a panic, and never beyond the buffer.
//!
//! The C interface's checksum holds counts and capacities; lists it believes. Here every word of the lists is damaged in turn,
//! with overflow checked where tests are built so.

use hooke::{LinearlyImplicitEuler, SceneIn};
use hooke_tests::side_by_side::side_by_side;
use hooke_tests::{build, generate};

/// Two chains and a pin, stepped once so that the lists are those of the scene, then damaged.
fn buffer(damage: impl Fn(usize, &mut [u32])) -> (Vec<f32>, Vec<u32>, [u32; 6], usize, usize) {
    let (mut data, _) = side_by_side(&generate::chain(4), &generate::chain(5));
    data.pinned[4] = true;
    let (n, s) = (data.len(), data.springs.len());
    let (reals, words) = SceneIn::<f32>::needs(n, s);
    let (mut reals, mut words) = (vec![0.0; reals], vec![0; words]);
    let counts = {
        let mut scene = SceneIn::<f32>::in_buffers(&mut reals, &mut words, n, s).expect("just enough");
        build::fill(&mut scene, &data).unwrap();
        scene.step(&mut LinearlyImplicitEuler::new(0.01)).unwrap();
        scene.counts()
    };
    damage(n, &mut words);
    (reals, words, counts, n, s)
}

/// Attaches to the buffer again and calls what reads its lists.
fn survives((mut reals, mut words, counts, n, s): (Vec<f32>, Vec<u32>, [u32; 6], usize, usize)) {
    let mut scene = SceneIn::<f32>::attach(&mut reals, &mut words, n, s, counts).expect("counts are good");
    let mut euler = LinearlyImplicitEuler::new(0.01).gravity([0.0, -9.81, 0.0]);
    _ = scene.step(&mut euler);
    for i in 0..n {
        _ = scene.reaction(i, &euler.forces);
    }
    for j in 0..s {
        _ = scene.springs().tension_of(j);
    }
    _ = (scene.release(4), scene.pin(0), scene.break_spring(1), scene.spring(0, n - 1, 1.0));
    _ = scene.step(&mut euler);
}

#[test]
fn whichever_word_of_a_callers_buffer_is_damaged_every_call_ends() {
    let (_, words, _, n, s) = buffer(|_, _| {});
    let wrong = [0, 1, n as u32 - 1, n as u32, s as u32, 1 << 30, 1 << 31, u32::MAX - 1, u32::MAX];
    for place in 0..words.len() {
        for value in wrong {
            survives(buffer(|_, words| words[place] = value));
        }
        survives(buffer(|_, words| words[place] ^= 0xff));
    }
}

/// Where the lists lie: slot and ends of the network, the rows' particles, then five words an island, the first its first row.
#[test]
fn an_island_that_begins_behind_the_free_rows_of_a_damaged_buffer_is_no_overflow() {
    for behind in 1..=9 {
        survives(buffer(|n, words| {
            let springs = (words.len() - 8 * n) / 4;
            let islands = n + 2 * springs + n;
            assert!(words[islands] == 0 && words[islands + 1] > 0, "the first island and its rows");
            words[islands] = n as u32 - 1 + behind;
        }));
    }
}

/// Its other end then has no slot, and 0 − first once overflowed for an island that is not the first.
#[test]
fn a_spring_that_a_damaged_buffer_ties_to_no_particle_is_no_overflow_when_islands_are_found_anew() {
    for end in [1 << 20, (1 << 31) - 1] {
        let (_, words, _, n, s) = buffer(|_, _| {});
        for place in n..n + 2 * s {
            survives(buffer(|_, words| words[place] = end));
        }
        assert!(words.len() == 8 * n + 4 * s);
    }
}
