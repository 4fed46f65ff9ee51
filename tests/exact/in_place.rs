//! A scene is built where it lies. Its `static` is all zeros, so that it costs no flash, and neither building nor stepping
//! it takes more stack than a thread of 64 KiB has, however large it is.

use std::process::{Command, Output};

use hooke::{LinearlyImplicitEuler, Scene};
use static_cell::ConstStaticCell;

const STACK: usize = 64 * 1024;
const PARTICLES: usize = 20_000;
type Large = Scene<f32, PARTICLES, PARTICLES>;
static LARGE: ConstStaticCell<Large> = ConstStaticCell::new(Scene::new());

/// Large enough to show in the size of this very program, if it were stored there.
type Huge = Scene<f64, 1_000_000, 1_000_000>;
static HUGE: ConstStaticCell<Huge> = ConstStaticCell::new(Scene::new());

const _: () = assert!(size_of::<Large>() > 50 * STACK);

/// One of the tests below in a process of its own, since an overflow of the stack ends the process.
fn alone(test: &str) -> Output {
    let program = std::env::current_exe().unwrap();
    let output =
        Command::new(program).args(["--exact", test, "--ignored", "--test-threads=1"]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("running 1 test"), "there is no {test}: {text}");
    output
}

fn on_a_small_stack(run: fn()) {
    std::thread::Builder::new().stack_size(STACK).spawn(run).unwrap().join().unwrap();
}

#[test]
fn a_scene_fifty_times_larger_than_the_stack_is_built_and_stepped() {
    let output = alone("in_place::in_its_static");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_same_scene_built_by_value_overflows_the_stack_so_that_the_test_above_can_fail() {
    let output = alone("in_place::by_value");
    assert!(!output.status.success());
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(text.contains("overflow"), "{text}");
}

#[test]
#[ignore = "run by a test above"]
fn in_its_static() {
    on_a_small_stack(|| build_and_step(LARGE.take()));
}

#[test]
#[ignore = "run by a test above"]
fn by_value() {
    fn run() {
        let mut scene = Large::new();
        build_and_step(std::hint::black_box(&mut scene));
    }
    on_a_small_stack(run);
}

fn build_and_step(rope: &mut Large) {
    let mut above = rope.particle([0.0; 3], 0.01).unwrap();
    rope.pin(above).unwrap();
    for i in 1..PARTICLES {
        let below = rope.particle([0.1 * i as f32, 0.0, 0.0], 0.01).unwrap();
        rope.spring(above, below, 1_000.0).unwrap();
        above = below;
    }
    let mut euler = LinearlyImplicitEuler::new(0.01).gravity([0.0, -9.81, 0.0]).max_iterations(20);
    for _ in 0..3 {
        assert_eq!(rope.step(&mut euler).unwrap().islands, 1);
    }
}

#[test]
fn the_zeros_of_a_static_scene_are_not_stored_in_the_program() {
    let program = std::env::current_exe().unwrap().metadata().unwrap().len();
    assert!(program < size_of::<Huge>() as u64 / 2, "{program} bytes hold a scene of {}", size_of::<Huge>());
    // In use, so that it is there at all.
    assert_eq!(HUGE.take().particle([0.0; 3], 1.0), Ok(0));
}
