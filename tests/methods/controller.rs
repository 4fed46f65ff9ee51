//! The controller of a step's length by itself: a method whose errors are told beforehand, and every length that follows, bit for bit.

use std::cell::RefCell;

use hooke::{
    Adaptive, Course, Embedded, Integrator, IslandReport, LocalError, Memory, Motion, Parts, Report,
    StepError, Verlet,
};
use hooke_tests::build;
use hooke_tests::vec_memory::VecScene;

/// What an attempt ends with: the energy of its error, or an error.
type Told = Result<f64, StepError>;

/// Attempts end as told, the last one for ever; the lengths that are asked for are noted. A step leaves the scene to Verlet.
struct Scripted<'a, const ORDER: u32> {
    told: &'a [Told],
    asked: &'a RefCell<Vec<f64>>,
    inner: Verlet<f64>,
}

impl<const ORDER: u32> Integrator<f64> for Scripted<'_, ORDER> {
    fn advance<M: Memory<Real = f64>>(
        &mut self,
        parts: Parts<'_, M>,
        motion: &[Motion<f64>],
        watch: &mut impl FnMut(&IslandReport<f64>),
    ) -> Result<Report<f64>, StepError> {
        self.inner.advance(parts, motion, watch)
    }
}

impl<const ORDER: u32> Embedded<f64> for Scripted<'_, ORDER> {
    const LOWER_ORDER: u32 = ORDER;

    fn attempt<M: Memory<Real = f64>>(
        &mut self,
        parts: &mut Parts<'_, M>,
        dt: f64,
        course: Course<'_, f64>,
        absolute: f64,
        watch: &mut impl FnMut(&IslandReport<f64>),
    ) -> Result<(Report<f64>, LocalError<f64>), StepError> {
        let mut asked = self.asked.borrow_mut();
        let told = self.told[asked.len().min(self.told.len() - 1)];
        asked.push(dt);
        let (report, _) = self.inner.attempt(parts, dt, course, absolute, watch)?;
        told.map(|energy| (report, LocalError { energy, distance: 0.0 }))
    }

    fn accept<M: Memory<Real = f64>>(
        &mut self,
        parts: Parts<'_, M>,
        course: Course<'_, f64>,
    ) -> Result<(), StepError> {
        self.inner.accept(parts, course)
    }
}

/// A particle at the origin, at rest: there rounding is nothing.
fn still() -> VecScene<f64> {
    let mut scene = VecScene::<f64>::empty();
    scene.particle([0.0; 3], 1.0).unwrap();
    scene
}

const DT: f64 = 0.5;

/// One step of accuracy `j`: what it answers, how it was left, and the lengths that were tried.
fn step<const ORDER: u32>(j: f64, told: &[Told]) -> (Result<(), StepError>, [f64; 4], Vec<f64>) {
    let asked = RefCell::new(Vec::new());
    let method = Scripted::<ORDER> { told, asked: &asked, inner: Verlet::new(1.0) };
    let mut adaptive = Adaptive::new(method, DT, j);
    let mut scene = still();
    let before = build::bits(&scene);
    let answer = scene.step(&mut adaptive).map(|_| ());
    assert_eq!(build::bits(&scene), before);
    let left =
        [adaptive.attained(), adaptive.made().dt, f64::from(adaptive.made().rejections), adaptive.dt()];
    (answer, left, asked.take())
}

/// Lengths that shrink each by its factor.
fn shrinking(factors: &[f64]) -> Vec<f64> {
    let mut all = vec![DT];
    for factor in factors {
        all.push(all[all.len() - 1] * factor);
    }
    all
}

#[test]
fn an_error_of_exactly_j_is_taken_and_one_above_is_not() {
    let (answer, [_, made, rejections, next], asked) = step::<1>(2.0, &[Ok(2.0)]);
    assert_eq!((answer, made, rejections, next), (Ok(()), DT, 0.0, DT * 0.9));
    assert_eq!(asked, [DT]);
    let (answer, [_, made, rejections, _], asked) = step::<1>(2.0, &[Ok(2.0 + 1e-12), Ok(2.0)]);
    assert_eq!((answer, made, rejections), (Ok(()), DT / 2.0, 1.0));
    assert_eq!(asked, [DT, DT / 2.0]);
}

#[test]
fn a_rejected_step_is_shortened_by_nine_tenths_of_j_over_e_to_a_quarter_or_three_sixteenths_but_to_a_tenth_at_least()
 {
    let sixteenth = 1.0 / 65_536.0;
    for (ratio, of_1, of_2) in
        [(1.0 / 16.0, 0.45, None), (sixteenth, 0.1, Some(0.1125)), (1e-12, 0.1, Some(0.1))]
    {
        let (_, _, asked) = step::<1>(1.0, &[Ok(1.0 / ratio), Ok(0.5)]);
        assert_eq!(asked, shrinking(&[of_1]), "{ratio}");
        if let Some(of_2) = of_2 {
            assert_eq!(step::<2>(1.0, &[Ok(1.0 / ratio), Ok(0.5)]).2, shrinking(&[of_2]), "{ratio}");
        }
    }
}

#[test]
fn an_attempt_out_of_range_is_made_anew_a_tenth_as_long_and_any_other_error_is_the_steps() {
    let out = Err(StepError::NotFinite(0));
    let (answer, [attained, made, rejections, _], asked) = step::<1>(1.0, &[out, out, out, Ok(1.0)]);
    assert_eq!((answer, rejections, attained), (Ok(()), 3.0, 0.0));
    assert_eq!((asked.as_slice(), made), (shrinking(&[0.1; 3]).as_slice(), asked[3]));
    let (answer, [attained, ..], asked) = step::<1>(1.0, &[out]);
    assert_eq!((answer, attained), (Err(StepError::Accuracy), 0.0));
    assert_eq!(asked, shrinking(&[0.1; 23]));
    let (answer, _, asked) = step::<1>(1.0, &[Ok(16.0), Err(StepError::NotConverged(0)), Ok(0.0)]);
    assert_eq!((answer, asked.len()), (Err(StepError::NotConverged(0)), 2));
}

#[test]
fn a_step_whose_error_does_not_fall_is_given_up_after_seven_rejections_and_says_the_least_error() {
    // Always as wrong, always halved.
    let (answer, [attained, ..], asked) = step::<1>(0.5, &[Ok(1.0)]);
    assert_eq!((answer, attained), (Err(StepError::Accuracy), 1.0));
    assert_eq!(asked, shrinking(&[0.5; 6]));
    // Up and down: the least counts, wherever it was.
    let told = [8.0, 2.0, 4.0, 16.0, 3.0, 8.0, 4.0].map(Ok);
    let (answer, [attained, ..], asked) = step::<1>(1.0, &told);
    assert_eq!((answer, attained, asked.len()), (Err(StepError::Accuracy), 2.0, 7));
    // What is out of range in between is no error, and what has none is none that falls.
    let out = Err(StepError::NotFinite(0));
    let told = [out, out, out, out, out, out, out, Ok(4.0), Ok(4.0)];
    let (answer, [attained, ..], asked) = step::<1>(1.0, &told);
    assert_eq!((answer, attained, asked.len()), (Err(StepError::Accuracy), 4.0, 9));
}

#[test]
fn a_step_whose_error_halves_each_time_is_tried_twenty_four_times() {
    let told: Vec<Told> = (0..40).map(|k| Ok(0.5f64.powi(k))).collect();
    let (answer, [attained, ..], asked) = step::<1>(1e-9, &told);
    assert_eq!((answer, attained, asked.len()), (Err(StepError::Accuracy), 0.5f64.powi(23), 24));
    // Falling by a little less is stuck, as soon as that may be.
    let told: Vec<Told> = (0..40).map(|k| Ok(0.51f64.powi(k))).collect();
    let (answer, [attained, ..], asked) = step::<1>(1e-9, &told);
    assert_eq!((answer, attained, asked.len()), (Err(StepError::Accuracy), 0.51f64.powi(6), 7));
}

/// Several steps: their lengths.
fn steps<const ORDER: u32>(j: f64, told: &[Told], ends: &[f64]) -> Vec<f64> {
    let asked = RefCell::new(Vec::new());
    let method = Scripted::<ORDER> { told, asked: &asked, inner: Verlet::new(1.0) };
    let mut adaptive = Adaptive::new(method, DT, j);
    let mut scene = still();
    let mut lengths = Vec::new();
    for end in ends {
        adaptive.end_after(*end);
        scene.step(&mut adaptive).unwrap();
        lengths.extend([adaptive.made().dt, adaptive.dt()]);
    }
    lengths
}

#[test]
fn the_next_length_goes_with_j_over_e_now_and_against_that_of_the_step_before() {
    // 2^16 times as exact as asked: five times longer at most, and then a fourth of what it would be, or half.
    let told = [1.0, 65_536.0].map(Ok);
    assert_eq!(steps::<1>(65_536.0, &told, &[0.0; 2]), [DT, 5.0 * DT, 5.0 * DT, 5.0 * DT * (0.9 / 4.0)]);
    assert_eq!(steps::<2>(65_536.0, &told, &[0.0; 2]), [DT, 3.6 * DT, 3.6 * DT, 3.6 * DT * (0.9 / 2.0)]);
    // No error at all is as 1e8 times as exact; ten to the eighth to the eighth is ten.
    let [_, first, _, second] = steps::<2>(1.0, &[Ok(0.0), Ok(1.0)], &[0.0; 2])[..] else { unreachable!() };
    assert_eq!(first, 5.0 * DT);
    assert!((second / (first * 0.9 / 10f64.sqrt()) - 1.0).abs() < 1e-15, "{second}");
}

#[test]
fn a_step_that_an_end_cuts_leaves_the_length_unless_it_was_rejected_or_a_longer_one_is_right() {
    let end = DT / 4.0;
    // As exact as asked: the next would be nine tenths of the end; what stands stays.
    assert_eq!(steps::<1>(1.0, &[Ok(1.0)], &[end, 0.0])[..3], [end, DT, DT]);
    // 2^16 times as exact: five times the end is longer than what stands.
    assert_eq!(steps::<1>(65_536.0, &[Ok(1.0)], &[end])[..], [end, 5.0 * end]);
    // Rejected: half the end was right, and nine tenths of that is next.
    assert_eq!(steps::<1>(1.0, &[Ok(2.0), Ok(1.0)], &[end])[..], [end / 2.0, end / 2.0 * 0.9]);
    // An end that is as far as the length is no cut.
    assert_eq!(steps::<1>(1.0, &[Ok(1.0)], &[DT])[..], [DT, 0.9 * DT]);
}

#[test]
fn what_rounding_alone_makes_of_a_step_is_told_bit_for_bit_and_pins_are_not_in_it() {
    let asked = RefCell::new(Vec::new());
    let method = Scripted::<1> { told: &[Ok(0.0)], asked: &asked, inner: Verlet::new(1.0) };
    let mut adaptive = Adaptive::new(method, DT, 1e-40);
    let mut scene = VecScene::<f64>::empty();
    for (x, v, mass) in [([3.0, 0.0, 4.0], [1.0, 2.0, 2.0], 2.0), ([1.0, 2.0, 2.0], [0.0, 3.0, 4.0], 8.0)] {
        let i = scene.particle(x, mass).unwrap();
        scene.set_velocity(i, v).unwrap();
    }
    let pin = scene.particle([1e3, 0.0, 0.0], 1e3).unwrap();
    scene.pin(pin).unwrap();
    // ½u²(Σm|q̇|² + Σm|q|²/h²), h² a quarter.
    let expected =
        0.5 * (f64::EPSILON / 2.0).powi(2) * (2.0 * 9.0 + 8.0 * 25.0 + 4.0 * (2.0 * 25.0 + 8.0 * 9.0));
    assert_eq!(scene.step(&mut adaptive), Err(StepError::Accuracy));
    assert_eq!((adaptive.attained(), asked.borrow().len()), (expected, 0));
    adaptive.set_accuracy(expected);
    scene.step(&mut adaptive).unwrap();
    assert_eq!((adaptive.made().dt, adaptive.attained()), (DT, 0.0));
}
