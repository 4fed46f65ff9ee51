//! `hooke stress`, the small form: what must hold of every method on scenes that are hard on it, and that the judge would say
//! so if it did not.

use std::fs;

use hooke::{Report, StepError};
use hooke_harness::run::integrator::INTEGRATORS;
use hooke_harness::scene::{Model, catalog};
use hooke_harness::stress::arguments::Arguments;
use hooke_harness::stress::case::{Case, Size};
use hooke_harness::stress::judge::{Judge, Stepped};
use hooke_harness::stress::method::{METHODS, Method};
use hooke_harness::stress::mirror::{Mirror, Snapshot};
use hooke_harness::stress::suite::Suite;
use hooke_harness::stress::trial::{Ended, Prepared};
use hooke_harness::stress::{cases, row, table};

#[path = "data/scratch.rs"]
mod scratch;
use scratch::Scratch;

#[test]
fn whatever_the_scene_a_step_is_finite_or_a_typed_error_and_what_must_hold_holds() {
    let suite = Suite::new(&Arguments { quick: true, quiet: true, ..Arguments::default() }).unwrap();
    let rows = row::rows(&suite.trials());
    let broken: Vec<&String> = rows.iter().flat_map(|row| &row.broken).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    println!("{}", table::total(&rows, suite.cases.len()));
}

#[test]
fn every_integrator_is_tried_with_equal_steps_and_with_chosen_ones_where_it_can_choose() {
    for (name, integrator) in INTEGRATORS {
        let tried = |chosen| METHODS.iter().any(|m| m.integrator == integrator && m.chosen == chosen);
        // With equal steps auto is one of the others.
        assert!(tried(false) || name == "auto", "{name}");
        assert_eq!(tried(true), integrator.is_embedded(), "{name}");
    }
}

#[test]
fn cases_have_names_of_their_own_and_scenes_that_are_scenes() {
    let all = cases::all();
    for (k, case) in all.iter().enumerate() {
        assert!(all[..k].iter().all(|other| other.name != case.name), "{} twice", case.name);
        for size in [Size::Quick, Size::Full] {
            let model = (case.scene)(size);
            let n = model.position.len();
            let lists = [model.velocity.len(), model.mass.len(), model.pinned.len()];
            assert_eq!(lists, [n; 3], "{}", case.name);
            model.build::<f64>().unwrap();
        }
    }
}

/// A free pair in motion, judged as if it were moved on by this method.
struct Doctored {
    model: Model,
    state: Snapshot,
}

impl Doctored {
    fn new() -> Self {
        let model = catalog::named("pair").unwrap().unwrap();
        let state = Snapshot { position: model.position.clone(), velocity: model.velocity.clone() };
        Self { model, state }
    }

    fn judged(&self, method: &str, at_rest: bool, by: impl FnOnce(&mut Judge<'_>)) -> Vec<String> {
        let mirror = Mirror::new(&self.model).unwrap();
        let mut judge = Judge::new::<f64>(&self.model, named(method), mirror, 100, at_rest);
        by(&mut judge);
        judge.broken
    }

    /// As after a step with this state, these bounds and so many rejections.
    fn after(
        &self,
        method: &str,
        at_rest: bool,
        after: &Snapshot,
        change: impl FnOnce(&mut Stepped<f64>),
    ) -> Vec<String> {
        let mut step = Stepped { dt: 0.01, report: report(), rejections: 0 };
        change(&mut step);
        self.judged(method, at_rest, |judge| judge.made(&self.state, after, &step))
    }
}

fn named(name: &str) -> Method {
    Method::of(&[name.to_string()]).unwrap()[0]
}

/// Of a step of one island.
fn report() -> Report<f64> {
    Report {
        iterations: 3,
        upper: 1e-20,
        lower: 1e-22,
        clamped: 0,
        islands: 1,
        untouched: 0,
        asleep: 0,
        certified: 1,
        at_floor: 0,
        capped: 0,
        stalled: 0,
        fallbacks: 0,
        springs_skipped: 0,
    }
}

/// One line with these words in it.
fn says(broken: &[String], words: &str) {
    assert!(broken.len() == 1 && broken[0].contains(words), "{broken:?} and not '{words}'");
}

#[test]
fn the_judge_says_nothing_of_a_step_that_is_right() {
    let pair = Doctored::new();
    assert_eq!(pair.after("euler", true, &pair.state, |_| {}), [""; 0]);
    assert_eq!(pair.judged("euler", false, |judge| judge.worked(1, 100)), [""; 0]);
    let error = StepError::NotFinite(0);
    assert_eq!(pair.judged("euler", false, |j| j.failed(&pair.state, &pair.state, error)), [""; 0]);
}

#[test]
fn the_judge_sees_a_nan_in_a_position_and_an_infinite_velocity() {
    let pair = Doctored::new();
    let mut after = pair.state.clone();
    after.position[1][2] = f64::NAN;
    says(&pair.after("euler", false, &after, |_| {}), "not finite");
    let mut after = pair.state.clone();
    after.velocity[0][0] = f64::INFINITY;
    says(&pair.after("verlet", false, &after, |_| {}), "not finite");
}

#[test]
fn the_judge_sees_bounds_that_are_none() {
    let pair = Doctored::new();
    for (lower, upper) in [(2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (-1.0, 1.0)] {
        let bounds = |step: &mut Stepped<f64>| (step.report.lower, step.report.upper) = (lower, upper);
        says(&pair.after("euler", false, &pair.state, bounds), "bounds");
    }
}

#[test]
fn the_judge_sees_a_report_that_does_not_fit_the_scene() {
    let pair = Doctored::new();
    says(&pair.after("euler", false, &pair.state, |step| step.report.islands = 2), "2 islands");
    says(&pair.after("euler", false, &pair.state, |step| step.report.certified = 2), "2 certified");
    says(&pair.after("euler", false, &pair.state, |step| step.report.clamped = 2), "2 springs clamped");
}

#[test]
fn the_judge_sees_a_state_that_changed_though_the_step_failed() {
    let pair = Doctored::new();
    let mut after = pair.state.clone();
    // 0 and −0 are equal, but other bits.
    after.position[0][1] = -0.0;
    let failed = |judge: &mut Judge<'_>| judge.failed(&pair.state, &after, StepError::NotFinite(0));
    says(&pair.judged("euler", false, failed), "has changed");
}

#[test]
fn the_judge_sees_an_error_that_is_not_the_methods() {
    let pair = Doctored::new();
    for (method, error) in [
        ("euler", StepError::NotConverged(0)),
        ("ros2", StepError::Accuracy),
        ("newton", StepError::Motion(0)),
        ("verlet", StepError::StepLimit(0)),
        ("ros3-accuracy", StepError::TimeStep),
        ("midpoint", StepError::Workspace { numbers: 1, words: 1 }),
        ("euler", StepError::NotCertified(0)),
    ] {
        let failed = |judge: &mut Judge<'_>| judge.failed(&pair.state, &pair.state, error);
        says(&pair.judged(method, false, failed), "must not end with");
    }
}

#[test]
fn the_judge_sees_momentum_that_comes_from_nowhere() {
    let pair = Doctored::new();
    let mut after = pair.state.clone();
    // Some hundred times what rounding makes of it.
    after.velocity[1][1] += 1e-12;
    says(&pair.after("euler", false, &after, |_| {}), "gains");
}

#[test]
fn the_judge_sees_a_bit_that_changes_at_rest() {
    let pair = Doctored::new();
    let mut after = pair.state.clone();
    after.position[0][0] = after.position[0][0].next_up();
    says(&pair.after("verlet", true, &after, |_| {}), "has moved");
}

#[test]
fn the_judge_sees_newtons_potential_rise() {
    let pair = Doctored::new();
    let mut after = pair.state.clone();
    // Both the same way, so that momentum is kept: 1.2e-2 m of strain more.
    (after.position[0][0], after.position[1][0]) = (0.506, -0.506);
    after.velocity = vec![[0.0; 3]; 2];
    assert_eq!(pair.after("newton", false, &pair.state, |_| {}), [""; 0]);
    let mut faster = pair.state.clone();
    (faster.velocity[0][0], faster.velocity[1][0]) = (9.0, -9.0);
    says(&pair.after("newton", false, &faster, |_| {}), "potential rises");
    assert_eq!(pair.after("midpoint", false, &faster, |_| {}), [""; 0]);
}

#[test]
fn the_judge_sees_a_method_that_goes_on_and_on() {
    let pair = Doctored::new();
    says(&pair.judged("euler", false, |judge| judge.worked(2, 10)), "2 solves");
    says(&pair.judged("newton", false, |judge| judge.worked(201, 10)), "201 solves");
    says(&pair.judged("euler", false, |judge| judge.worked(1, 101)), "101 iterations");
    let rejected = |step: &mut Stepped<f64>| step.rejections = 25;
    says(&pair.after("ros2-accuracy", false, &pair.state, rejected), "25 rejections");
}

#[test]
fn the_judge_sees_an_energy_that_is_no_number() {
    let pair = Doctored::new();
    says(&pair.judged("euler", false, |j| j.energy(&pair.state, f64::NAN, 2.0)), "kinetic");
    says(&pair.judged("euler", false, |j| j.energy(&pair.state, 0.25, f64::INFINITY)), "potential");
}

#[test]
fn a_panic_is_told_and_fails_the_suite() {
    // One velocity too many: no scene that any source makes.
    let scene = |_: Size| {
        let mut model = catalog::named("pair").unwrap().unwrap();
        model.velocity.push([0.0; 3]);
        model
    };
    let prepared = Prepared::new(Case::new("malformed", "", scene), Size::Quick);
    let trial = prepared.tried(METHODS[0], hooke_harness::cli::Precision::F64, "jacobi");
    says(&trial.broken, "panicked");
    let rows = row::rows(&[trial]);
    assert!(table::total(&rows, 1).contains("1 times what must hold broken"));
}

#[test]
fn a_sparse_factor_serves_methods_of_several_solves_on_many_islands() {
    let case = cases::all().into_iter().find(|case| case.name == "two-bodies").unwrap();
    let prepared = Prepared::new(case, Size::Full);
    for method in ["midpoint", "ros2", "ros3", "newton", "energy-momentum", "ros2-accuracy"] {
        for solver in ["ldl", "ldl32", "banded", "multigrid", "wide", "wide32"] {
            let trial = prepared.tried(named(method), hooke_harness::cli::Precision::F64, solver);
            assert_eq!(trial.ended, Ended::Finished, "{method}, {solver}: {:?}", trial.broken);
        }
    }
}

#[test]
fn the_list_names_cases_and_methods_and_a_beginning_of_a_name_is_all_that_begin_so() {
    let folder = Scratch::new();
    let list = folder.ok("stress --list").stdout;
    for word in ["zero-length", "pin-jumps-1e6", "ros2-accuracy", "symplectic-euler"] {
        assert!(list.contains(word), "{list}");
    }
    let said = folder.ok("stress spin- head-on --quick --integrator euler,verlet --precision f64").stdout;
    assert!(said.contains("spin-1e3") && said.contains("spin-block") && said.contains("head-on"), "{said}");
    assert!(!said.contains("head-on-stiff") && said.contains("12 trials of 4 cases"), "{said}");
}

#[test]
fn tables_go_into_a_file_between_the_marks_of_an_earlier_one() {
    let folder = Scratch::new();
    let line = "stress free-pair --quick --integrator verlet --out t.md --json t.json";
    folder.ok(line);
    let first = fs::read_to_string(folder.path("t.md")).unwrap();
    let command =
        "<!-- stress: cargo run --release -- stress free-pair --integrator verlet --quick --out t.md -->\n";
    assert!(first.starts_with(command) && first.ends_with("<!-- end of stress -->\n"), "{first}");
    let trials: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path("t.json")).unwrap()).unwrap();
    assert_eq!(trials.as_array().unwrap().len(), 2);
    assert_eq!(trials[0]["ended"], "finished");
    folder.write("t.md", format!("Before.\n{}After.\n", first.replace("2 finished", "9 finished")));
    folder.ok(line);
    let second = fs::read_to_string(folder.path("t.md")).unwrap();
    assert_eq!(second, format!("Before.\n{first}After.\n"));
}

#[test]
fn wrong_names_are_refused_in_a_line_with_the_nearest() {
    let folder = Scratch::new();
    let refusals = [
        ("zero-lenght", ["'zero-lenght'", "did you mean 'zero-length'?"]),
        ("--integrator eulr", ["--integrator", "did you mean 'euler'?"]),
        ("--solver jacoby", ["'jacoby'", "jacobi"]),
        ("--precision f16", ["--precision", "f16"]),
        ("--out no/such/folder.md", ["no/such/folder.md", "cannot write"]),
        ("--out a --json a", ["a:", "name the same file"]),
        ("--quik", ["--quik", "did you mean '--quick'?"]),
    ];
    let wrong: Vec<String> = refusals
        .iter()
        .filter_map(|(line, words)| folder.refuses(&format!("stress {line}"), words).err())
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

#[test]
fn an_accuracy_that_the_precision_has_no_number_for_is_refused() {
    let folder = Scratch::new();
    let line = "run pair --integrator ros2 --seconds 0.1 --accuracy 1e-50 --precision f32";
    folder.refuses(line, &["--accuracy", "outside the range of f32"]).unwrap();
}
