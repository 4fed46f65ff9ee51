//! What a run will do, decided and checked before anything is simulated or written: the scene with its overrides, the
//! step, the method, the outputs. An option wins over the scene file, the scene file over the defaults.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::cli::{Overrides, Precision, Renumber, RunArgs};
use crate::error::InputError;
use crate::nearest;
use crate::output::safe;
use crate::run::integrator::{INTEGRATORS, Integrator};
use crate::run::recorder::FILES;
use crate::run::solver::{METHODS, Method, in_runs};
use crate::run::{auto, choice};
use crate::scene::renumber::Numbering;
use crate::scene::{Model, renumber, source, start};

/// The most steps a run may have.
const MOST_STEPS: f64 = 1e9;

/// A run, decided.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The scene, overrides applied.
    pub model: Model,
    /// How the particles are numbered inside the run, if not as in `model`.
    pub numbering: Option<Numbering>,
    /// Time step, s.
    pub dt: f64,
    /// Number of steps; where steps are chosen, of the moments that are shown, dt apart.
    pub steps: u64,
    /// How the scene is moved on in time.
    pub integrator: Integrator,
    /// Why, if it was left to the program.
    pub integrator_reason: Option<String>,
    /// Error allowed per step, J: then steps are chosen.
    pub accuracy: Option<f64>,
    /// The step that is tried first, where steps are chosen, s.
    pub first: f64,
    /// How long the run is to be, s.
    pub seconds: f64,
    /// At most so many substeps a step of Verlet.
    pub substeps: u32,
    /// Relative tolerance; the kernel's default if none.
    pub tolerance: Option<f64>,
    /// Absolute tolerance, J.
    pub absolute: f64,
    /// Islands with no more kinetic energy than this may sleep, J; none do if none.
    pub sleep: Option<f64>,
    /// At most so many iterations; the kernel's default if none.
    pub max_iterations: Option<u32>,
    /// How the linear systems are solved.
    pub method: Method,
    /// Why, if it was left to the program.
    pub reason: Option<String>,
    /// Precision.
    pub precision: Precision,
    /// Folder for frames, plot and picture.
    pub out: Option<PathBuf>,
    /// Frames a second.
    pub fps: f64,
    /// Final state as CSV.
    pub final_csv: Option<PathBuf>,
    /// Outcome as JSON.
    pub json: Option<PathBuf>,
    /// The files that the scene was read from.
    pub inputs: Vec<PathBuf>,
    /// No progress, no summary.
    pub quiet: bool,
}

/// A number that must be positive and finite.
pub fn positive(name: &str, x: f64) -> Result<f64, InputError> {
    if x.is_finite() && x > 0.0 {
        Ok(x)
    } else {
        Err(InputError::new(format!("{name} {x}: not a positive finite number")))
    }
}

/// A number that must be finite and not negative.
pub fn not_negative(name: &str, x: f64) -> Result<f64, InputError> {
    if x.is_finite() && x >= 0.0 {
        Ok(x)
    } else {
        Err(InputError::new(format!("{name} {x}: negative, infinite or NaN")))
    }
}

/// Which of the names it is.
pub fn known(what: &str, name: &str, names: &[&str]) -> Result<usize, InputError> {
    if let Some(place) = names.iter().position(|known| *known == name) {
        return Ok(place);
    }
    let near = nearest::suggestion(name, names);
    Err(InputError::new(format!("unknown {what} '{name}'{near} (known here: {})", names.join(", "))))
}

impl Plan {
    /// Decides a run from its options.
    pub fn new(args: &RunArgs) -> Result<Self, InputError> {
        let scene = args.scene.as_deref().unwrap_or("curtain");
        Self::of(args, || source::load(scene))
    }

    /// Decides a run from its options and a scene, which is asked for when the names among them are known to be right.
    pub fn of(
        args: &RunArgs,
        scene: impl FnOnce() -> Result<source::Loaded, InputError>,
    ) -> Result<Self, InputError> {
        let integrators: Vec<&str> = INTEGRATORS.iter().map(|(name, _)| *name).collect();
        let integrator = known("integrator", &args.integrator, &integrators)?;
        let integrator = INTEGRATORS.get(integrator).map_or(Integrator::Euler, |(_, integrator)| *integrator);
        let solvers: Vec<&str> = METHODS.iter().map(|(name, _)| *name).chain(["auto"]).collect();
        let solver = known("solver", &args.solver, &solvers)?;
        let loaded = scene()?;
        let (mut model, wanted, mut inputs) = (loaded.model, loaded.outputs, loaded.files);
        if let Some(file) = &args.overrides.from {
            start::from_file(&mut model, file)?;
            inputs.push(file.clone());
        }
        override_model(&mut model, &args.overrides)?;

        let fps = positive("--fps", args.fps.or(wanted.fps).unwrap_or(60.0))?;
        let first = positive("--dt", args.dt.unwrap_or(model.dt))?;
        let accuracy = args.accuracy.map(|joules| positive("--accuracy", joules)).transpose()?;
        fits(integrator, accuracy, args)?;
        let dt = if accuracy.is_some() { 1.0 / fps } else { first };
        let steps = match (args.steps, args.seconds) {
            (Some(steps), _) => steps as f64,
            // A hair below a whole number of steps is that number, not one more.
            (None, seconds) => {
                (not_negative("--seconds", seconds.unwrap_or(model.seconds))? / dt - 1e-9).ceil().max(0.0)
            }
        };
        if steps > MOST_STEPS {
            return Err(InputError::new(format!(
                "{steps:e} steps of {dt:?} s are too many; the most is {MOST_STEPS:e}"
            )));
        }
        if let (None, Some(seconds)) = (args.steps, args.seconds)
            && accuracy.is_none()
            && steps * dt > seconds * (1.0 + 1e-6)
        {
            let end = steps * dt;
            model
                .notes
                .push(format!("{seconds} s is no whole number of steps: the last one ends at {end} s"));
        }
        let numbering = match args.renumber {
            Renumber::None => None,
            Renumber::Rcm => renumbered(&mut model),
        };
        let tolerance = args.tolerance.map(|r| not_negative("--tolerance", r)).transpose()?;
        let sleep = args.sleep.map(|joules| not_negative("--sleep", joules)).transpose()?;
        let absolute = not_negative("--absolute", args.absolute.or(args.sleep).unwrap_or(0.0))?;
        let seconds = accuracy.and(args.seconds).unwrap_or(steps * dt);

        let (final_csv, json) =
            (args.final_csv.clone().or(wanted.final_csv), args.json.clone().or(wanted.json));
        let only_files = final_csv.is_some() || json.is_some();
        let out = args.out.clone().or(wanted.dir).or_else(|| (!only_files).then(|| PathBuf::from("out")));
        let mut plan = Self {
            model,
            numbering,
            dt,
            steps: steps as u64,
            integrator,
            integrator_reason: None,
            accuracy,
            first,
            seconds,
            substeps: args.substeps.unwrap_or(1),
            tolerance,
            absolute,
            sleep,
            max_iterations: args.max_iterations,
            method: METHODS.get(solver).map_or(Method::Jacobi, |(_, method)| *method),
            reason: None,
            precision: args.precision,
            out,
            fps,
            final_csv,
            json,
            inputs,
            quiet: args.quiet,
        };
        if plan.integrator == Integrator::Auto && accuracy.is_none() {
            let (chosen, substeps, reason) =
                choice::fixed(&plan.ordered(), first, plan.tolerance, plan.precision);
            (plan.integrator, plan.substeps, plan.integrator_reason) = (chosen, substeps, Some(reason));
        }
        if solver == METHODS.len() {
            let choice = auto::choose(&plan.ordered(), first, plan.tolerance, plan.precision);
            (plan.method, plan.reason) = (choice.method, Some(choice.reason));
        }
        Ok(plan)
    }

    /// The scene in the order that the kernel gets it.
    pub fn ordered(&self) -> Cow<'_, Model> {
        match &self.numbering {
            Some(numbering) => Cow::Owned(numbering.model(&self.model)),
            None => Cow::Borrowed(&self.model),
        }
    }

    /// The time after so many steps, s.
    pub fn time(&self, step: u64) -> f64 {
        let time = step as f64 * self.dt;
        if self.accuracy.is_some() && time > self.seconds { self.seconds } else { time }
    }

    /// Makes sure that every output can be written, before the first step.
    pub fn prepare_outputs(&self) -> Result<(), InputError> {
        let files: Vec<&Path> = [&self.final_csv, &self.json].into_iter().flatten().map(|f| &**f).collect();
        self.no_output_takes_anothers_place(&files)?;
        // A file may lie in the folder that --out is about to make; everything else is checked before it is made.
        let dir = self.out.as_deref();
        let (inside, beside): (Vec<&Path>, Vec<&Path>) =
            files.into_iter().partition(|file| dir.is_some() && file.parent() == dir);
        beside.into_iter().try_for_each(safe::prepare_file)?;
        dir.map_or(Ok(()), safe::prepare_dir)?;
        inside.into_iter().try_for_each(safe::prepare_file)
    }

    /// Refuses two outputs in one file, and an output in the place of an input.
    fn no_output_takes_anothers_place(&self, files: &[&Path]) -> Result<(), InputError> {
        let mut taken: Vec<(PathBuf, &str)> =
            self.inputs.iter().map(|input| (resolved(input), "the run reads this file")).collect();
        let own = self.out.iter().flat_map(|dir| FILES.map(|name| dir.join(name)));
        taken.extend(own.map(|file| (resolved(&file), "--out writes this file itself")));
        for file in files {
            let place = resolved(file);
            if let Some((_, why)) = taken.iter().find(|(path, _)| *path == place) {
                return Err(InputError::in_file(
                    file,
                    format!("cannot write here: {why}; choose another name"),
                ));
            }
            taken.push((place, "--final and --json name the same file"));
        }
        Ok(())
    }

    /// Is there a frame after this step?
    pub fn is_frame(&self, step: u64) -> bool {
        if self.accuracy.is_some() {
            return true;
        }
        let frames = |step: u64| (step as f64 * self.dt * self.fps + 1e-6).floor();
        step == self.steps || step == 0 || frames(step) > frames(step - 1)
    }
}

/// Refuses options that do not go together.
fn fits(integrator: Integrator, accuracy: Option<f64>, args: &RunArgs) -> Result<(), InputError> {
    let refuse = |message: String| Err(InputError::new(message));
    let name = integrator.name();
    if args.sleep.is_some() && integrator != Integrator::Euler {
        return refuse(format!("--sleep: only with --integrator euler, not with {name}"));
    }
    if args.substeps.is_some() && (integrator != Integrator::Verlet || accuracy.is_some()) {
        return refuse("--substeps: only with --integrator verlet and without --accuracy".into());
    }
    if args.substeps == Some(0) {
        return refuse("--substeps 0: at least 1".into());
    }
    if accuracy.is_none() {
        return Ok(());
    }
    if !integrator.is_embedded() {
        let able: Vec<&str> =
            INTEGRATORS.iter().filter(|(_, i)| i.is_embedded()).map(|(name, _)| *name).collect();
        let able = able.join(", ");
        return refuse(format!("--accuracy: {name} has no estimate of its error; take one of {able}"));
    }
    if args.seconds.is_none() {
        return refuse("--accuracy: say how long with --seconds".into());
    }
    Ok(())
}

/// A path that is the same for all spellings of one file, which need not exist.
pub fn resolved(path: &Path) -> PathBuf {
    if let Ok(path) = path.canonicalize() {
        return path;
    }
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (parent.canonicalize(), path.file_name()) {
        (Ok(parent), Some(name)) => parent.join(name),
        _ => path.to_path_buf(),
    }
}

/// Reverse Cuthill–McKee where it brings springs' ends closer together, and a note of what became of it. A numbering of
/// few distances (a grid's) is kept: lanes live on it, and what they gain is more.
fn renumbered(model: &mut Model) -> Option<Numbering> {
    if in_runs(model) {
        model.notes.push("not renumbered: springs join particles at few distances already".into());
        return None;
    }
    let numbering = Numbering::reverse_cuthill_mckee(model);
    let (old, new) = (renumber::reach(model), renumber::reach(&numbering.model(model)));
    let reach = |(mean, most): (f64, usize)| format!("{mean:.1} rows on average and {most} at most");
    let better = new.0 < old.0;
    model.notes.push(if better {
        format!("renumbered: springs reach {}, not {}", reach(new), reach(old))
    } else {
        format!("not renumbered: springs reach {} already; rcm would make it {}", reach(old), reach(new))
    });
    better.then_some(numbering)
}

fn override_model(model: &mut Model, to: &Overrides) -> Result<(), InputError> {
    if let Some(k) = to.stiffness {
        let k = not_negative("--stiffness", k)?;
        model.springs.iter_mut().for_each(|spring| spring.stiffness = k);
    }
    if let Some(m) = to.mass {
        model.mass.fill(positive("--mass", m)?);
    }
    if let Some(g) = to.gravity {
        model.gravity = g;
    }
    if let Some(rule) = &to.pin {
        model.pinned =
            rule.apply(&model.position).map_err(|e| InputError::new(format!("--pin: {}", e.message)))?;
        // A path belongs to pins; those that the new rule lets go have none.
        for moving in &mut model.moving {
            moving.particles.retain(|i| model.pinned[*i]);
        }
    }
    if let Some(v) = to.velocity {
        for (velocity, pinned) in model.velocity.iter_mut().zip(&model.pinned) {
            *velocity = if *pinned { [0.0; 3] } else { v };
        }
    }
    Ok(())
}
