//! One part of a step, once, inside a function that callgrind can find: `instructions PART SCENE`. See
//! `benches/instructions.sh`.

use std::hint::black_box;
use std::process::ExitCode;

use hooke::{Jacobi, Operator, Preconditioner};
use hooke_benches::moving;

/// What happens in here is counted. (Inlined, it would vanish, and with it every count.)
#[inline(never)]
fn counted<R>(job: impl FnOnce() -> R) -> R {
    job()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, part, name] = arguments.as_slice() else {
        eprintln!("instructions: say which part of which scene, as in: instructions product cloth:16");
        return ExitCode::from(2);
    };
    let (mut scene, mut euler) = moving(name);
    scene.parts();
    match part.as_str() {
        "product" => euler.inspect(scene.parts(), &[], |system, b, _| {
            let mut y = vec![[0.0; 3]; b.len()];
            black_box(counted(|| system.apply(black_box(b), &mut y)));
        }),
        "assembly" => {
            counted(|| euler.inspect(black_box(scene.parts()), &[], |_, b, mu| _ = black_box((b, mu))))
        }
        "preconditioner" => euler.inspect(scene.parts(), &[], |system, b, _| {
            let (mut blocks, mut z) = (vec![[0.0; 6]; b.len()], vec![[0.0; 3]; b.len()]);
            black_box(counted(|| Jacobi::new(system, &mut blocks).apply(black_box(b), &mut z)));
        }),
        "step" => counted(|| scene.step(&mut euler).map(|report| _ = black_box(report))),
        _ => {
            eprintln!("instructions: '{part}' is none of product, assembly, preconditioner, step");
            return ExitCode::from(2);
        }
    }
    .expect("a step");
    ExitCode::SUCCESS
}
