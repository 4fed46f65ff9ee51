//! A scene as a TOML file: where its particles come from, and what is changed about them.
//!
//! Keys that are left out keep the value of the source: a generator's own, or for a mesh and for particles written
//! out the defaults of `hooke run` (0.01 kg, 1e3 N/m, gravity (0, −9.81, 0), dt 1/60 s, 1 s). Options of the command
//! line win over the file. Ids are 0-based, in the order of the mesh, the generator or the `[[particle]]` entries.
//!
//! ```toml
//! # Exactly one source:
//! mesh = "sail.obj"                 # relative to this file
//! generator = "cloth:32"            # a name of the catalogue
//! [[particle]]                      # or each particle written out
//! position = [0.0, 0.0, 0.0]        # m
//! velocity = [0.0, 0.0, 0.0]        # m/s; wins over the `velocity` of all
//! mass = 0.01                       # kg; wins over [mass] each
//! pinned = true
//!
//! dt = 0.01                         # s
//! seconds = 2.0                     # s
//! gravity = [0.0, -9.81, 0.0]       # m/s²
//! drag = 0.1                        # 1/s
//! damping = 0.02                    # N·s/m along every spring
//! velocity = [0.0, 0.0, 1.0]        # m/s, of all free particles at the start
//! cables = true                     # every spring only pulls
//! pin = "min-y:0.1"                 # a rule as in --pin; replaces the source's pins,
//! pins = [0, 31]                    # and so do ids; both together pin both
//!
//! [mass]                            # exactly one of:
//! each = 0.01                       # kg per particle
//! values = [0.01, 0.02]             # kg, one per particle
//! total = 0.3                       # kg, shared equally, pinned particles included
//! density = 1000.0                  # kg/m³ × the point's share of the mesh's volume
//! area_density = 0.2                # kg/m² × the point's share of the mesh's area
//!
//! [stiffness]                       # exactly one of:
//! each = 1e3                        # N/m
//! ea = 50.0                         # N: k = EA/l₀
//!
//! [bending]                         # a mesh's springs across the edges that two faces share
//! stiffness = 1.0                   # N/m
//!
//! [[spring]]                        # changes the spring of that pair, or adds one
//! a = 0
//! b = 1
//! stiffness = 1e3                   # N/m, or ea = 50.0; else that of [stiffness], else 1e3 N/m
//! rest_length = 0.1                 # m; else as placed
//! damping = 0.02                    # N·s/m
//! cable = true
//!
//! [[moving]]                        # pins that move; displacements are from where they start
//! particles = [0]
//! linear = { velocity = [0.1, 0.0, 0.0] }                        # exactly one of these three
//! oscillate = { amplitude = [0.0, 0.1, 0.0], frequency = 2.0 }
//! through = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.5, 0.0]]         # t, x, y, z; times increase
//!
//! [output]                          # relative to the working directory, as on the command line
//! dir = "out"
//! fps = 60
//! final = "final.csv"
//! json = "run.json"
//! ```
//!
//! Springs are ordered: the source's, then bending, then those that `[[spring]]` adds. A pair may stand in one
//! `[[spring]]` only: two springs between the same particles are not expressible.

mod masses;
mod moving;
mod pins;
mod place;
mod schema;
mod springs;
mod value;

use std::path::{Path, PathBuf};

use super::source::{Loaded, Outputs};
use super::{Model, catalog, from_mesh};
use crate::error::InputError;
use crate::mesh::{self, Mesh};
use place::Source;
use schema::SceneFile;

/// Reads and checks a scene file; `name` is what the scene is called in summaries.
pub fn load(name: &str, file: &Path) -> Result<Loaded, InputError> {
    let bytes = std::fs::read(file).map_err(|e| InputError::in_file(file, format!("cannot read: {e}")))?;
    parse(name, file, &bytes)
}

/// The scene that these bytes of a file describe; errors name the file, and a mesh is looked for beside it.
pub fn parse(name: &str, file: &Path, bytes: &[u8]) -> Result<Loaded, InputError> {
    let source = Source::new(file, bytes)?;
    let scene = source.parse()?;
    let (mut model, mesh) = particles(name, &scene, &source)?;

    masses::set(&mut model, mesh.as_ref(), &scene, &source)?;
    springs::set(&mut model, mesh.as_ref(), &scene, &source)?;
    pins::set(&mut model, &scene, &source)?;
    velocities(&mut model, &scene);
    moving::set(&mut model, &scene, &source)?;
    model.gravity = scene.gravity.map_or(model.gravity, |g| g.0);
    model.drag = scene.drag.map_or(model.drag, |d| d.0);
    model.dt = scene.dt.map_or(model.dt, |h| h.0);
    model.seconds = scene.seconds.map_or(model.seconds, |t| t.0);

    let mut files = vec![file.to_path_buf()];
    files.extend(scene.mesh.as_ref().map(|mesh| beside(file, mesh.get_ref())));
    let wanted = scene.output;
    let outputs = Outputs {
        dir: wanted.dir,
        fps: wanted.fps.map(|f| f.0),
        final_csv: wanted.final_csv,
        json: wanted.json,
    };
    Ok(Loaded { model, outputs, files })
}

/// The particles and, where the source has them, springs; the mesh too, if that is the source.
fn particles(
    name: &str,
    scene: &SceneFile,
    source: &Source<'_>,
) -> Result<(Model, Option<Mesh>), InputError> {
    match (&scene.mesh, &scene.generator, scene.particle.as_slice()) {
        (Some(mesh), None, []) => {
            // The line here and the mesh's own file and line are both of use.
            let path = beside(source.file, mesh.get_ref());
            let mesh = mesh::load(&path).map_err(|e| source.error(&mesh.span(), e.to_string()))?;
            Ok((from_mesh::model(name, &mesh), Some(mesh)))
        }
        (None, Some(generator), []) => {
            let unknown = || Err(catalog::unknown(generator.get_ref()));
            let model = catalog::named(generator.get_ref()).unwrap_or_else(unknown);
            let mut model = model.map_err(|e| source.error(&generator.span(), e.message))?;
            model.name = name.into();
            Ok((model, None))
        }
        (None, None, [_, ..]) => {
            let position = scene.particle.iter().map(|p| p.get_ref().position.0).collect();
            Ok((Model::at_rest(name, position, from_mesh::MASS), None))
        }
        (None, None, []) => {
            Err(InputError::in_file(source.file, "no particles: say mesh, generator or [[particle]]"))
        }
        (mesh, generator, particles) => {
            let spans = [mesh.as_ref().map(|m| m.span()), generator.as_ref().map(|g| g.span())];
            let given = spans.into_iter().flatten().chain(particles.first().map(|p| p.span()));
            let last = given.max_by_key(|span| span.start).unwrap_or_default();
            Err(source.error(&last, "a second source: say only one of mesh, generator and [[particle]]"))
        }
    }
}

/// A path that stands in a file: relative to that file's folder.
fn beside(file: &Path, path: &str) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(path)
}

/// The velocity of all free particles, and over it a particle's own.
fn velocities(model: &mut Model, scene: &SceneFile) {
    if let Some(v) = scene.velocity {
        model.velocity.fill(v.0);
    }
    for (velocity, particle) in model.velocity.iter_mut().zip(&scene.particle) {
        if let Some(own) = particle.get_ref().velocity {
            *velocity = own.0;
        }
    }
    for (velocity, pinned) in model.velocity.iter_mut().zip(&model.pinned) {
        if *pinned {
            *velocity = [0.0; 3];
        }
    }
}
