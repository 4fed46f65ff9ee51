//! A student's first hour: the lecture's equations checked one by one, on one spring and on a small network.
//!
//! `cargo run -p hooke --example check_the_lecture`

use hooke::vec3::{cross, dot, sub};
use hooke::{LinearlyImplicitEuler, Scene, Spring};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    one_spring();
    oscillator()?;
    free_triangle()
}

fn one_spring() {
    let (a, b) = ([0.3_f64, -0.2, 0.9], [1.1, 0.5, 0.4]);
    let spring = Spring { stiffness: 40.0, rest_length: 0.7 };
    let d = sub(a, b);
    let length = dot(d, d).sqrt();

    println!("One spring, V = ½k(l − l₀)²");
    let [g_a, g_b] = spring.gradient(a, b);
    println!("  V = {} J, tension {} N", spring.potential_energy(length), spring.tension(length));
    println!(
        "  ∂V/∂x_A = {g_a:?} N and ∂V/∂x_B is its negative bit for bit: {}",
        g_b == g_a.map(|x: f64| -x)
    );

    // The gradient is the difference quotient of V, to the square of the step.
    let step = 1e-6;
    let value = |x: f64| {
        let d = sub([x, a[1], a[2]], b);
        spring.potential_energy(dot(d, d).sqrt())
    };
    let quotient = (value(a[0] + step) - value(a[0] - step)) / (2.0 * step);
    println!("  first component against a difference quotient: {} and {quotient}", g_a[0]);

    // H = αI + wwᵀ has the eigenvalues k along the spring and α = k(1 − l₀/l) across it.
    let h = spring.hessian(a, b);
    let along = h.mul(d);
    let sideways = cross(d, [0.0, 0.0, 1.0]);
    let across = h.mul(sideways);
    println!(
        "  H d / d = {} (k = 40), across: {} (α = {})",
        along[0] / d[0],
        across[0] / sideways[0],
        h.alpha
    );
}

fn oscillator() -> Result<(), Box<dyn std::error::Error>> {
    println!("\nThe lecture's oscillator: a wall, k = 1 N/m, l₀ = 1 m, 1 kg at x = 1.5 m");
    let mut scene: Scene<f64, 2, 1> = Scene::new();
    let wall = scene.particle([0.0; 3], 1.0)?;
    let mass = scene.particle([1.5, 0.0, 0.0], 1.0)?;
    scene.spring_with(wall, mass, Spring { stiffness: 1.0, rest_length: 1.0 })?;
    scene.pin(wall)?;
    let dt = 0.1;
    let mut euler = LinearlyImplicitEuler::new(dt).tolerance(1e-14);
    let energy =
        |scene: &Scene<f64, 2, 1>| scene.springs().kinetic_energy() + scene.springs().potential_energy();
    let mut before = energy(&scene);
    for n in 1..=4 {
        let report = scene.step(&mut euler)?;
        let now = energy(&scene);
        println!(
            "  step {n}: x = {:.12} m, E falls to {:.15} of itself (theory 1/(1 + h²ω²) = {:.15}), solve exact to {:.0e} J",
            scene.positions()[mass][0],
            now / before,
            1.0 / (1.0 + dt * dt),
            report.upper
        );
        before = now;
    }
    Ok(())
}

fn free_triangle() -> Result<(), Box<dyn std::error::Error>> {
    println!("\nA free triangle: K·1 = 0 and momentum stays");
    let mut triangle: Scene<f64, 3, 3> = Scene::new();
    for (x, v) in
        [([0.0; 3], [0.3, 0.0, 0.1]), ([1.0, 0.0, 0.0], [0.0, 0.5, 0.0]), ([0.2, 0.9, 0.0], [0.0; 3])]
    {
        let i = triangle.particle(x, 0.2)?;
        triangle.set_velocity(i, v)?;
    }
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        triangle.spring_with(i, j, Spring { stiffness: 100.0, rest_length: 0.8 })?;
    }
    let mut y = [[0.0; 3]; 3];
    triangle.springs().stiffness_product(&[[1.0; 3]; 3], &mut y);
    println!("  K·1 = {y:?}");
    println!("  p before {:?}", triangle.state().linear_momentum());
    for _ in 0..100 {
        triangle.step(&mut LinearlyImplicitEuler::new(0.01).max_iterations(1))?;
    }
    println!("  p after 100 steps cut short at 1 iteration {:?}", triangle.state().linear_momentum());
    Ok(())
}
