//! What a scene may have besides springs between free particles, in lanes as without: point springs, pins that move, two springs
//! side by side, damping that comes and goes, answers at the floor.

use hooke::{BandedLdl, BlockJacobi, Ending, IslandReport, Portable, Real, Report, Solver, Wide, WideJacobi};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{MotionData, PointData, SceneData, SpringData};
use hooke_tests::{allowed, direct, generate, lanes};

const H: f64 = 1.0 / 60.0;

/// A step's state, report and island.
fn step<T: Real>(
    data: &SceneData,
    motions: &[MotionData],
    relative: f64,
    solver: impl Solver<T>,
) -> (Vec<[f64; 3]>, Report<T>, Option<IslandReport<T>>) {
    let (mut scene, mut forces, mut seen) = (build::scene::<T>(data), Forces::<T>::new(data), None);
    let mut euler = forces.euler(T::from_f64(H)).tolerance(T::from_f64(relative)).solver(solver);
    let report =
        scene.step_watched(&mut euler, &build::motions(motions), |island| seen = Some(*island)).unwrap();
    ([build::positions(&scene), build::velocities(&scene)].concat(), report, seen)
}

/// A net in runs and one in slots, each with a pin in its midst, moving.
fn nets() -> [SceneData; 2] {
    [generate::cloth(6), generate::blob(4, 1)].map(|mut data| {
        let middle = data.len() / 2;
        data.pinned = vec![false; data.len()];
        data.pinned[middle] = true;
        for (i, velocity) in data.velocity.iter_mut().enumerate() {
            *velocity =
                if i == middle { [0.0; 3] } else { [0.1 * (i % 5) as f64, -0.2, 0.05 * (i % 3) as f64] };
        }
        data
    })
}

/// One step in lanes ends where one of the plain solver does, and tells the same.
fn as_without(data: &SceneData, motions: &[MotionData]) -> Report<f64> {
    let mut wide = lanes::wide::<f64>(data);
    let (found, told, _) = step(data, motions, 1e-13, &mut wide);
    assert!(wide.in_lanes());
    let (expected, report, _) = step::<f64>(data, motions, 1e-13, BlockJacobi);
    assert_eq!((told.clamped, told.certified), (report.clamped, report.certified));
    let off = build::farthest(&found, &expected);
    assert!(off <= allowed::DENSE_STEP, "{off:e}");
    told
}

#[test]
fn point_springs_are_replaced_and_clamped_in_lanes_as_without() {
    for data in nets() {
        let springs = as_without(&data, &[]).clamped;
        // From no distance: there is no direction, and the Hessian is replaced.
        let at = |i: usize, away: f64, k: f64| {
            let [x, y, z] = data.position[i];
            PointData { particle: i, target: [x + away, y, z], k, l0: 1.0 }
        };
        let with = |points: Vec<PointData>| as_without(&SceneData { points, ..data.clone() }, &[]);
        assert_eq!(with(vec![at(0, 0.0, 10.0), at(1, 0.0, 10.0)]).clamped, springs + 2);
        // Pressed hard, which takes the certificate of its row away; pressed a little, which does not.
        let hard = 1e3 * data.mass[0] / (H * H);
        let pressed = with(vec![at(0, 0.01, hard), at(data.len() - 1, 0.9, 1e-6 * hard)]);
        assert!(pressed.clamped > springs, "{pressed:?}");
    }
}

/// Nothing is solved, r = b: what is left of the bounds is their own sum.
#[test]
fn the_lower_bound_of_factors_in_lanes_knows_of_point_springs() {
    let mut data = generate::chain(80);
    data.velocity = vec![[0.0; 3]; data.len()];
    let k = 3.0 * data.mass[1] / (H * H);
    for (particle, l0) in [(5, 0.1), (5, 0.2), (40, 2.0), (79, 0.1)] {
        let [x, y, z] = data.position[particle];
        data.points.push(PointData { particle, target: [x + 0.6, y + 0.8, z], k, l0 });
    }
    let (own, (numbers, words)) = BandedLdl::needs_in_lanes_of(&mut build::scene::<f64>(&data), true);
    let banded = BandedLdl::new(vec![1.0; own]);
    let mut wide = Wide::new(vec![1.0; numbers], vec![7; words], Portable).around(banded);
    let (_, _, found) = step(&data, &[], 1.0, &mut wide);
    assert!(wide.in_lanes());
    let (_, _, expected) = step::<f64>(&data, &[], 1.0, direct::banded::<f64>(&data));
    let [found, expected] = [found, expected].map(|island| island.unwrap().solve);
    assert_eq!([found.ending, expected.ending], [Ending::Untouched; 2]);
    let off = (found.lower / expected.lower - 1.0).abs();
    assert!(expected.lower > 0.0 && off <= allowed::BOUND_OF_PLACES * allowed::U64, "{off:e}");
}

#[test]
fn the_end_of_a_spring_that_moves_as_told_drags_in_lanes_as_without() {
    for mut data in nets() {
        let middle = data.len() / 2;
        for spring in &mut data.springs {
            spring.c = 0.5;
        }
        let [x, y, z] = data.position[middle];
        for velocity in [[0.0; 3], [3.0, -1.0, 2.0]] {
            let position = [x + H * velocity[0], y + H * velocity[1], z + H * velocity[2]];
            as_without(&data, &[MotionData { particle: middle, position, velocity }]);
        }
    }
}

#[test]
fn a_net_with_two_springs_side_by_side_has_no_runs_and_the_answer_of_the_plain_solver() {
    let [data, _] = nets();
    let middle = data.len() / 2;
    let at_the_pin = |s: &SpringData| s.a == middle || s.b == middle;
    let firsts = [0, 1, 7, data.springs.len() - 1].into_iter();
    for j in firsts.chain(data.springs.iter().enumerate().filter(|(_, s)| at_the_pin(s)).map(|(j, _)| j)) {
        for turned in [false, true] {
            let mut data = data.clone();
            let SpringData { a, b, k, l0, c } = data.springs[j];
            let (a, b) = if turned { (b, a) } else { (a, b) };
            data.springs.push(SpringData { a, b, k: 0.5 * k, l0: 1.1 * l0, c });
            let mut wide = lanes::wide::<f64>(&data);
            let (found, ..) = step(&data, &[], 1e-13, &mut wide);
            assert!(!wide.in_lanes(), "spring {j}");
            let (expected, ..) = step::<f64>(&data, &[], 1e-13, BlockJacobi);
            assert_eq!(found, expected, "spring {j}");
        }
    }
}

#[test]
fn a_layout_that_was_found_with_damping_is_found_anew_without_it_and_the_other_way_round() {
    for data in nets() {
        let mut kept = lanes::wide::<f64>(&data);
        let run = |damps: bool, solver: &mut WideJacobi<Vec<f64>, Vec<u32>>| {
            let mut scene = build::scene::<f64>(&data);
            let euler = hooke::LinearlyImplicitEuler::new(H).gravity(data.gravity).tolerance(1e-10);
            let c = vec![0.5; data.springs.len()];
            if damps {
                scene.step(&mut euler.with(hooke::SpringDamping(c.as_slice())).solver(&mut *solver)).unwrap();
            } else {
                scene.step(&mut euler.solver(&mut *solver)).unwrap();
            }
            build::bits(&scene)
        };
        let mut ends = Vec::new();
        for damps in [true, false, true] {
            let found = run(damps, &mut kept);
            assert!(kept.in_lanes());
            assert_eq!(found, run(damps, &mut lanes::wide::<f64>(&data)));
            ends.push(found);
        }
        assert!(ends[0] == ends[2] && ends[0] != ends[1]);
    }
}

#[test]
fn runs_are_where_springs_join_particles_at_few_distances() {
    let [cloth, mesh] = nets().map(|data| WideJacobi::runs_of(&mut build::scene::<f64>(&data)));
    assert!(cloth && !mesh);
}

/// No tolerance at all: what rounding leaves is the end, and both say so.
fn ends_at_the_floor<T: Real>(data: &SceneData) {
    let (_, _, found) = step::<T>(data, &[], 0.0, lanes::wide::<T>(data));
    let (_, _, expected) = step::<T>(data, &[], 0.0, BlockJacobi);
    let [found, expected] = [found, expected].map(|island| island.unwrap().solve);
    assert_eq!([found.ending, expected.ending], [Ending::Floor; 2]);
    let (few, many) = (expected.iterations / 2, 2 * expected.iterations + 10);
    assert!((few..=many).contains(&found.iterations), "{found:?}, {expected:?}");
}

#[test]
fn where_no_tolerance_is_given_the_floor_is_the_end_in_lanes_as_without() {
    for data in nets() {
        for weight in [1.0, 1e3, 1e-3] {
            let mut data = data.clone();
            for (i, mass) in data.mass.iter_mut().enumerate() {
                *mass *= if i % 3 == 0 { weight } else { 1.0 };
            }
            ends_at_the_floor::<f64>(&data);
            ends_at_the_floor::<f32>(&data);
        }
    }
}

#[test]
fn springs_without_a_length_are_replaced_in_lanes_as_without() {
    for data in nets() {
        for l0 in [0.0, 0.2] {
            let mut data = data.clone();
            for j in [2, 9, data.springs.len() - 3] {
                let SpringData { a, b, .. } = data.springs[j];
                data.position[b] = data.position[a];
                data.springs[j].l0 = l0;
            }
            // From rest at their lengths otherwise, so that nothing else is clamped.
            for j in 0..data.springs.len() {
                let SpringData { a, b, .. } = data.springs[j];
                let away = hooke_tests::data::distance(data.position[a], data.position[b]);
                if away > 0.0 {
                    data.springs[j].l0 = away;
                }
            }
            let report = as_without(&data, &[]);
            let replaced = data.springs.iter().filter(|s| data.position[s.a] == data.position[s.b]).count();
            let counted = if l0 > 0.0 { replaced as u32 } else { 0 };
            assert_eq!((report.clamped, report.certified), (counted, u32::from(counted == 0)), "l0 = {l0}");
        }
    }
}
