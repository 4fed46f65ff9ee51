//! What a run writes into its folder while it goes on: the ParaView series, the energies, the moments of the picture.
//! A run without a folder pays for none of it.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use hooke::Real;

use super::plan::Plan;
use super::simulation::Simulation;
use crate::output::picture::Strip;
use crate::output::vtk::Series;
use crate::output::{Energy, Frame, plot, table};

/// What a folder holds besides the frames.
pub const FILES: [&str; 4] = ["motion.pvd", "energy.svg", "energy.csv", "picture.png"];

/// Moments in the picture strip.
const MOMENTS: usize = 6;

/// The outputs of a folder.
pub struct Recorder<'a> {
    plan: &'a Plan,
    open: Option<Open>,
    /// Files written, for the summary.
    pub written: Vec<PathBuf>,
    /// Frames written.
    pub frames: usize,
}

struct Open {
    dir: PathBuf,
    series: Series,
    strip: Strip,
    energies: Vec<Energy>,
    /// The steps that the picture shows.
    moments: Vec<u64>,
}

impl<'a> Recorder<'a> {
    /// Opens the folder and records the start.
    pub fn new<T: Real + Display>(plan: &'a Plan, simulation: &Simulation<T>) -> io::Result<Self> {
        let open = match &plan.out {
            None => None,
            Some(dir) => Some(Open {
                dir: dir.clone(),
                series: Series::create(dir)?.with_mass(&plan.model.mass),
                strip: Strip::default(),
                energies: Vec::new(),
                moments: (0..MOMENTS as u64).map(|k| k * plan.steps / (MOMENTS as u64 - 1)).collect(),
            }),
        };
        let mut recorder = Self { plan, open, written: Vec::new(), frames: 0 };
        recorder.after(0, simulation)?;
        Ok(recorder)
    }

    /// Records what there is to record after a step.
    pub fn after<T: Real + Display>(&mut self, step: u64, simulation: &Simulation<T>) -> io::Result<()> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let time = self.plan.time(step);
        open.energies.push(simulation.energy(time));
        let (frame, moment) = (self.plan.is_frame(step), open.moments.contains(&step));
        if !frame && !moment {
            return Ok(());
        }
        let lists = Lists::new(self.plan, simulation);
        if frame {
            open.series.frame(time, &lists.frame())?;
            self.frames += 1;
        }
        if moment {
            open.strip.add(time, &lists.frame())?;
        }
        Ok(())
    }

    /// Writes plot, table and picture. Also after a failed step: what there was is kept.
    pub fn finish(&mut self) -> io::Result<()> {
        let Some(open) = &self.open else { return Ok(()) };
        let [series, plot_file, table_file, picture] = FILES.map(|name| open.dir.join(name));
        plot::write(&plot_file, &self.plan.model.name, &open.energies)?;
        table::write_energy(&table_file, &open.energies)?;
        open.strip.save(&picture)?;
        self.written = vec![series, plot_file, table_file, picture];
        Ok(())
    }

    /// The folder, if any.
    pub fn dir(&self) -> Option<&Path> {
        self.open.as_ref().map(|open| open.dir.as_path())
    }
}

/// A frame's lists in f64.
struct Lists<'a> {
    positions: Vec<[f64; 3]>,
    velocities: Vec<[f64; 3]>,
    fixed: &'a [bool],
    springs: Vec<[usize; 2]>,
    strain: Vec<f64>,
    tension: Vec<f64>,
}

impl<'a> Lists<'a> {
    fn new<T: Real + Display>(plan: &'a Plan, simulation: &Simulation<T>) -> Self {
        let scene = &simulation.scene;
        let wide = |list: &[[T; 3]]| list.iter().map(|x| x.map(T::to_f64)).collect();
        let (state, springs) = (scene.state(), scene.springs());
        let mut lists = Self {
            positions: wide(&simulation.positions()),
            velocities: wide(&simulation.velocities()),
            fixed: &plan.model.pinned,
            springs: Vec::with_capacity(state.springs()),
            strain: Vec::with_capacity(state.springs()),
            tension: Vec::with_capacity(state.springs()),
        };
        for j in (0..state.springs()).map(|j| simulation.place_of_spring(j)) {
            let (Some((a, b)), Some(length)) = (state.ends(j), springs.length_of(j)) else { continue };
            let rest = state.spring(j).rest_length.to_f64();
            lists.springs.push([a, b].map(|end| simulation.users_particle(end)));
            lists.strain.push(if rest > 0.0 { (length.to_f64() - rest) / rest } else { 0.0 });
            lists.tension.push(springs.tension_of(j).to_f64());
        }
        lists
    }

    fn frame(&self) -> Frame<'_> {
        Frame {
            positions: &self.positions,
            velocities: &self.velocities,
            fixed: self.fixed,
            springs: &self.springs,
            strain: &self.strain,
            tension: &self.tension,
        }
    }
}
