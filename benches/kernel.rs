//! Time of the kernel's parts: the product A x, the assembly of a step, a whole step.
//!
//! `cargo bench -p hooke-benches`. Times hold for one machine and one hour; compare ratios within one run.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hooke::{Operator, Snapshot};
use hooke_benches::{HostScene, moving};
use hooke_harness::heap::Heap;

const SCENES: [&str; 4] = ["cloth:32", "cloth:64", "chain:200", "lattice:8x8x8"];

fn springs(scene: &HostScene) -> Throughput {
    Throughput::Elements(scene.state().springs() as u64)
}

/// y = A x on the largest island: time per spring is the figure to watch.
fn product(c: &mut Criterion) {
    let mut group = c.benchmark_group("product");
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

/// One step from the same state each time.
fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("step");
    group.sample_size(20);
    for name in SCENES {
        let (mut scene, mut euler) = moving(name);
        let mut start = Snapshot::<Heap<f64>>::empty();
        scene.save(&mut start).expect("room");
        group.throughput(springs(&scene));
        group.bench_function(BenchmarkId::from_parameter(name), |bench| {
            bench.iter(|| {
                scene.restore(&start).expect("room");
                black_box(scene.step(&mut euler).expect("a step"))
            });
        });
    }
}

criterion_group!(benches, product, assembly, step);
criterion_main!(benches);
