//! Time of the kernel's parts: the product A x, the assembly of a step, the preconditioners, a whole step with each solver,
//! many scenes.
//!
//! `cargo bench -p hooke-benches`. Times hold for one machine and one hour; compare ratios within one run.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hooke::{Jacobi, Multigrid, Operator, Preconditioner};
use hooke_benches::{HostScene, moving};
use hooke_harness::batch::{self, Member};
use hooke_harness::host::Host;
use hooke_harness::run::solver::{AnySolver, METHODS};
use hooke_harness::scene::catalog;

const SCENES: [&str; 5] = ["cloth:32", "cloth:64", "chain:1000", "lattice:8x8x8", "curtain"];

fn springs(scene: &HostScene) -> Throughput {
    Throughput::Elements(scene.state().springs() as u64)
}

/// y = A x: time per spring is the figure to watch.
fn operator(c: &mut Criterion) {
    let mut group = c.benchmark_group("operator");
    for name in SCENES {
        let (mut scene, mut euler) = moving(name);
        group.throughput(springs(&scene));
        let parts = scene.parts();
        euler
            .inspect(parts, &[], |system, b, _| {
                let mut y = vec![[0.0; 3]; b.len()];
                group.bench_function(BenchmarkId::from_parameter(name), |bench| {
                    bench.iter(|| black_box(system.apply(black_box(b), &mut y)));
                });
            })
            .expect("a valid step");
    }
}

/// Forces, Hessians, certificate and right side of one step, without the solve.
fn assembly(c: &mut Criterion) {
    let mut group = c.benchmark_group("assembly");
    for name in SCENES {
        let (mut scene, mut euler) = moving(name);
        group.throughput(springs(&scene));
        group.bench_function(BenchmarkId::from_parameter(name), |bench| {
            bench.iter(|| {
                euler.inspect(scene.parts(), &[], |_, b, _| _ = black_box(b)).expect("a valid step")
            });
        });
    }
}

/// Block Jacobi: building the inverses (once a step), and applying them (once an iteration).
fn preconditioner(c: &mut Criterion) {
    for (what, applies) in [("jacobi_build", false), ("jacobi_apply", true)] {
        let mut group = c.benchmark_group(what);
        for name in SCENES {
            let (mut scene, mut euler) = moving(name);
            group.throughput(springs(&scene));
            let parts = scene.parts();
            euler
                .inspect(parts, &[], |system, b, _| {
                    let (mut blocks, mut z) = (vec![[0.0; 6]; b.len()], vec![[0.0; 3]; b.len()]);
                    group.bench_function(BenchmarkId::from_parameter(name), |bench| {
                        if applies {
                            let jacobi = Jacobi::new(system, &mut blocks);
                            bench.iter(|| black_box(jacobi.apply(black_box(b), &mut z)));
                        } else {
                            bench.iter(|| _ = black_box(Jacobi::new(black_box(system), &mut blocks)));
                        }
                    });
                })
                .expect("a valid step");
        }
    }
}

/// Multigrid: what a step has to build (once a step) and one cycle, as an iteration of it applies.
fn multigrid(c: &mut Criterion) {
    let mut group = c.benchmark_group("multigrid_build_and_apply");
    for name in SCENES {
        let (mut scene, mut euler) = moving(name);
        group.throughput(springs(&scene));
        let (numbers, words) = Multigrid::needs(scene.positions().len(), scene.state().springs());
        let mut multigrid = Multigrid::new(vec![0.0; numbers], vec![0; words], Host::new());
        let parts = scene.parts();
        euler
            .inspect(parts, &[], |system, b, _| {
                let mut z = vec![[0.0; 3]; b.len()];
                group.bench_function(BenchmarkId::from_parameter(name), |bench| {
                    bench.iter(|| black_box(multigrid.apply(system, black_box(b), &mut z)));
                });
            })
            .expect("a valid step");
    }
}

/// Puts a scene back where it was; its pins and springs, and what is known of them, stay.
fn put_back(scene: &mut HostScene, [position, velocity]: &[Vec<[f64; 3]>; 2]) {
    for (i, (position, velocity)) in position.iter().zip(velocity).enumerate() {
        scene.set_position(i, *position).expect("a particle");
        if !scene.is_pinned(i) {
            scene.set_velocity(i, *velocity).expect("a free particle");
        }
    }
}

/// One step with each of the solvers, from the same state each time; putting it back is not timed.
fn step(c: &mut Criterion) {
    for (solver, method) in METHODS {
        let mut group = c.benchmark_group(format!("step_{solver}"));
        group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(2));
        for name in SCENES {
            let (mut scene, euler) = moving(name);
            let model = catalog::named(name).expect("a name of the catalogue").expect("a valid size");
            let mut euler = euler.solver(AnySolver::new(method, &mut scene, &model));
            let start = [scene.positions().to_vec(), scene.velocities().to_vec()];
            group.throughput(springs(&scene));
            group.bench_function(BenchmarkId::from_parameter(name), |bench| {
                bench.iter_custom(|times| {
                    let mut spent = Duration::ZERO;
                    for _ in 0..times {
                        put_back(&mut scene, &start);
                        let began = Instant::now();
                        black_box(scene.step(&mut euler).expect("a step"));
                        spent += began.elapsed();
                    }
                    spent
                });
            });
        }
    }
}

/// Independent scenes on threads: steps of a scene per second, on the wall's clock. On an idle machine of two cores, two
/// threads should nearly double it.
fn batch(c: &mut Criterion) {
    const STEPS: u64 = 4;
    let mut group = c.benchmark_group("batch");
    group.sample_size(10);
    for (name, count) in [("chain:40", 256), ("cloth:32", 16)] {
        let mut members: Vec<_> = (0..count)
            .map(|_| {
                let (scene, integrator) = moving(name);
                Member { scene, integrator }
            })
            .collect();
        let start = [members[0].scene.positions().to_vec(), members[0].scene.velocities().to_vec()];
        group.throughput(Throughput::Elements(count * STEPS));
        for threads in [1, 2] {
            group.bench_function(BenchmarkId::new(format!("{count} of {name}, threads"), threads), |bench| {
                bench.iter_custom(|times| {
                    let mut spent = Duration::ZERO;
                    for _ in 0..times {
                        members.iter_mut().for_each(|member| put_back(&mut member.scene, &start));
                        let began = Instant::now();
                        black_box(batch::step(&mut members, STEPS, threads));
                        spent += began.elapsed();
                    }
                    spent
                });
            });
        }
    }
}

criterion_group!(benches, operator, assembly, preconditioner, multigrid, step, batch);
criterion_main!(benches);
