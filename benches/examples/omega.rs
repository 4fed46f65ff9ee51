//! x
use hooke::{Ssor, BlockIlu, BlockJacobi, LinearlyImplicitEuler, Solver};
use hooke_harness::scene::{Model, catalog};

fn count<S: Solver<f64>>(m: &Model, dt: f64, r: f64, g: [f64;3], solver: S, states:&[(Vec<[f64;3]>,Vec<[f64;3]>)]) -> (u32, f64) {
    let mut scene = m.build::<f64>().unwrap();
    let mut euler = LinearlyImplicitEuler::new(dt).gravity(g).tolerance(r).solver(solver);
    let mut sum = 0;
    let t = cpu_time::ThreadTime::now();
    for (x, v) in states {
        for i in 0..x.len() { scene.set_position(i, x[i]).unwrap(); if !scene.is_pinned(i) { scene.set_velocity(i, v[i]).unwrap(); } }
        sum += scene.step(&mut euler).unwrap().iterations;
    }
    (sum, t.elapsed().as_secs_f64()*1e3)
}
fn main() {
    for (name, dt) in [("cloth:32", 1.0/60.0), ("cloth:64", 1.0/60.0), ("lattice:8x8x8", 1.0/60.0), ("bunny", 0.005)] {
        let (m, g) = if name == "bunny" {
            let loaded = hooke_harness::scene::source::load("../shared/meshes/coarse_bunny.mesh").unwrap();
            let mut m = loaded.model;
            m.springs.iter_mut().for_each(|s| s.stiffness = 1e5);
            m.mass.iter_mut().for_each(|x| *x = 1.0);
            let low = m.position.iter().map(|x| x[1]).fold(f64::MAX, f64::min);
            for i in 0..m.position.len() { m.pinned[i] = m.position[i][1] <= low + 3.0; if !m.pinned[i] { m.velocity[i] = [50.0, 0.0, 0.0]; } }
            (m, [0.0, -9.8, 0.0])
        } else {
            let m = catalog::named(name).unwrap().unwrap();
            (m, if name.starts_with("lat") { [0.0;3] } else { [0.0,-9.81,0.0] })
        };
        let mut scene = m.build::<f64>().unwrap();
        let mut euler = LinearlyImplicitEuler::new(dt).gravity(g).tolerance(1e-8);
        let mut states = vec![];
        let n = (0.5 / dt) as usize;
        for k in 0..n { scene.step(&mut euler).unwrap(); if k >= n / 2 && k % (n/12).max(1) == 0 { states.push((scene.positions().to_vec(), scene.velocities().to_vec())); } }
        let best = |f: &dyn Fn() -> (u32, f64)| { let mut b = f(); for _ in 0..8 { let c = f(); if c.1 < b.1 { b = c; } } b };
        for r in [1e-6] {
            let n = m.position.len();
            let j = best(&|| count(&m, dt, r, g, BlockJacobi, &states));
            print!("{name} dt {dt:.4} R {r:e} states {}: jacobi {:.1?} {:.1} us", states.len(), j, 1e3 * j.1 / f64::from(j.0));
            for w in [120] {
            
            let s = best(&|| count(&m, dt, r, g, Ssor::new(vec![0.0; 9 * n]), &states));
            print!(" {w} {:.1?} {:.1} us, ratio {:.3}", s, 1e3 * s.1 / f64::from(s.0), j.1 / s.1);
            }
            let i = best(&|| count(&m, dt, r, g, BlockIlu::new(vec![0.0; 15 * n]), &states));
            println!(" ilu {:.1?} {:.1} us, ratio {:.3}", i, 1e3 * i.1 / f64::from(i.0), j.1 / i.1);
        }
    }
}
