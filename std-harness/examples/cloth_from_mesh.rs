//! From a mesh to a picture with the library: load, make springs, pin, step, read the certified bound, draw.
//!
//! `cargo run --release -p hooke-harness --example cloth_from_mesh [MESH]`; without a file it makes a small sheet.

use std::error::Error;
use std::path::Path;

use hooke::LinearlyImplicitEuler;
use hooke_harness::mesh::{self, Cell, Mesh};
use hooke_harness::output::Frame;
use hooke_harness::output::picture::Strip;
use hooke_harness::scene::{Model, from_mesh};

const STEPS: usize = 100;
const DT: f64 = 1.0 / 60.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = match std::env::args().nth(1) {
        Some(file) => mesh::load(Path::new(&file))?,
        None => sheet(12),
    };

    // Points become particles and edges springs. The model is plain data: change what you like before it is built.
    let mut model = from_mesh::model("cloth", &mesh);
    for [a, b] in mesh.bending_pairs() {
        model.join(a, b, 1.0);
    }
    // Hold the edge where x is least, however the mesh numbers its points.
    let left = model.position.iter().map(|x| x[0]).fold(f64::INFINITY, f64::min);
    model.pinned = model.position.iter().map(|x| x[0] <= left).collect();

    // From here on the kernel holds the state. `build` checks every number once; a step then has nothing to check.
    let mut scene = model.build::<f64>()?;
    let mut euler = LinearlyImplicitEuler::new(DT).gravity(model.gravity);
    let mut strip = Strip::default();
    let mut worst = 0.0_f64;
    for step in 0..=STEPS {
        if step > 0 {
            // The report bounds how far this step's solve is from the exact solution of its linear system, in joules.
            worst = worst.max(scene.step(&mut euler)?.upper);
        }
        draw(&mut strip, step as f64 * DT, &model, scene.positions(), scene.velocities())?;
    }

    let lowest = scene.positions().iter().map(|x| x[1]).fold(f64::INFINITY, f64::min);
    println!("{} particles, {} springs", model.position.len(), model.springs.len());
    println!("lowest point after {:.2} s: y = {lowest:.4} m", STEPS as f64 * DT);
    println!("error of every solve: at most {worst:.1e} J");
    let picture = std::env::temp_dir().join("cloth_from_mesh.png");
    strip.save(&picture)?;
    println!("picture: {}", picture.display());
    Ok(())
}

/// Adds a moment to the picture; springs are coloured by their strain (l − l₀)/l₀.
fn draw(
    strip: &mut Strip,
    time: f64,
    model: &Model,
    positions: &[[f64; 3]],
    velocities: &[[f64; 3]],
) -> std::io::Result<()> {
    let springs: Vec<[usize; 2]> = model.springs.iter().map(|s| s.ends).collect();
    let (mut strain, mut tension) = (Vec::new(), Vec::new());
    for s in &model.springs {
        let [p, q] = s.ends.map(|i| positions[i]);
        let length = (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>().sqrt();
        strain.push(if s.rest_length > 0.0 { length / s.rest_length - 1.0 } else { 0.0 });
        tension.push(s.stiffness * (length - s.rest_length));
    }
    let (fixed, springs) = (model.pinned.as_slice(), springs.as_slice());
    strip.add(time, &Frame { positions, velocities, fixed, springs, strain: &strain, tension: &tension })
}

/// A flat sheet of n × n quadrilaterals, 1 m wide, each cut into two triangles.
fn sheet(n: usize) -> Mesh {
    let side = n + 1;
    let place = |id: usize| [(id % side) as f64 / n as f64, 0.0, (id / side) as f64 / n as f64];
    let mut cells = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let a = i * side + j;
            cells.push(Cell::Triangle([a, a + 1, a + side]));
            cells.push(Cell::Triangle([a + 1, a + side + 1, a + side]));
        }
    }
    Mesh { points: (0..side * side).map(place).collect(), cells, notes: Vec::new() }
}
