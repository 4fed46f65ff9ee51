//! All allowed errors, one table. Exact identities use none of them. u is the unit roundoff, 2⁻⁵³ or 2⁻²⁴.
//!
//! *Derived* means: a bound that follows from the operations counted in the reason. *Measured* means: the largest value
//! seen on these tests' data, with the margin said.

/// Unit roundoff of `f64`.
pub const U64: f64 = f64::EPSILON / 2.0;
/// Unit roundoff of `f32`.
pub const U32: f64 = f32::EPSILON as f64 / 2.0;

/// Axial stiffness k of one spring, units of u·k: α and w² lose 4u and 8u, their sum one more (derived).
pub const SPRING_STIFFNESS: f64 = 16.0;
/// Energy ratio of the one-spring scene, units of u·l₀/amplitude: l − l₀ loses 2u·l₀ absolutely, as do x⁺ and v⁺ (each once
/// rounded, |x| ≤ 1.5 l₀); A is off by 13u; energy is quadratic, which doubles all (derived: below 60).
pub const SPRING_ENERGY: f64 = 60.0;
/// Eigenvalues by the QR method, units of n·u·‖K‖: Higham's γ-type constant, backward stable (derived up to that constant).
pub const EIGENVALUE: f64 = 10.0;
/// Eigenvalues of one 6×6, units of u·k(1 + l₀/l): compression costs 13u in norm √(6·6), the QR method about 6·10u (derived).
pub const EIGENVALUE_6: f64 = 140.0;
/// Energy ratio of one mode, units of N·u/amplitude (masses 1 m apart): each of the N springs loses 2u·l, positions up to
/// N m are rounded to u·N, the solve ends at its floor of some 20u per row (derived: below 100).
pub const MODE_ENERGY: f64 = 100.0;
/// Residual force of the catenary, units of u·k·(its length): positions are off by u each, sums of them in making the scene
/// by 24u at most, l by 3u; two springs meet (derived: below 64).
pub const CATENARY: f64 = 64.0;
/// Energy of rotated positions, units of u·Σk·(1 m)² with lengths and rest lengths below 4 m: a rotation is off by 6u·|x|
/// for both ends, V changes by k|l − l₀|·that (derived: below 100).
pub const ROTATED_ENERGY: f64 = 100.0;
/// One component of a particle's force against a precise derivative, units of u·Σ k(l + l₀): l 3u, u 4u, tension and product
/// 2u, the sum over at most 20 springs 20u (derived).
pub const SPRING_FORCE: f64 = 32.0;
/// Speed along one short clamped spring after a step, units of u·(1 m/s), its speed below 1.8 m/s: its direction 4u, tension 3u,
/// w 9u twice, the right side 4u, a solve of one row 10u (derived: below 64).
pub const SHORT_SPRING_SPEED: f64 = 64.0;
/// Energies, units of u·(T + Σ k·4 max(l₀, 1)²): 8u per term and 20u for the sum (derived).
pub const ENERGY: f64 = 32.0;
/// A row of a force or stiffness product against dense matrices, units of u·Σ k(l + l₀)(1 + l₀/l): 13u from compression, as
/// much from the textbook formula, and both sums of up to 60 terms (derived).
pub const DENSE_ROW: f64 = 150.0;
/// One entry of αI + wwᵀ against the textbook formula, units of u·k(1 + l₀/l): w² 9u, α 5u, one sum; the formula as much
/// (derived).
pub const COMPRESSED_HESSIAN: f64 = 32.0;
/// K(ω×x) − ω×f, units of u·Σ k(1 + l₀/l)|ω||x|: 16u for H times a difference, 8u for ω×f, sums of 20 (derived).
pub const ROTATED_FORCE: f64 = 64.0;
/// Ten tight steps of a gentle scene in a turned, shifted or relabelled frame, m. Measured: below 6e-16 m; margin 16.
pub const EQUIVARIANT_TRAJECTORY: f64 = 1e-14;
/// Momentum of a free island of 12 particles over one step, units of u·(Σm|v| before and after + Σ impulses of the springs).
/// The row sums lose up to u per
/// term; measured below 1.9, margin 4.
pub const MOMENTUM: f64 = 8.0;
/// Velocity after one step of drag, units of u·|v|: m(1 + hd) 3u, the right side 3u, one division and one PCG step 6u, v + Δ
/// one more; |Δ| ≤ |v| (derived).
pub const DRAG: f64 = 16.0;
/// Rounding of one step's assembly, units of u·Σ over rows of what enters them: 13u from compression, as much from the textbook,
/// 20 for sums, and v⁺ = v + Δ; see `assembly_rounding` (derived: below 64 with f64 oracles).
pub const ASSEMBLY: f64 = 64.0;
/// Relative slack of a stopping rule's goal: the reported bound adds the residual's own rounding δ ≈ 10u|r₀| to |r| = R|r₀| and
/// squares the sum, so at R = 1e-8 it is 2·10u/R ≈ 2e-7 above (derived; five times that).
pub const STOPPING: f64 = 1e-6;
/// Error of solves with R = 1e-3 relative to the motion of 0.2 s. Measured: at most 1e-4; margin 10.
pub const LOOSE_TRAJECTORY: f64 = 1e-3;
/// Dense against sparse oracle after ten steps, m (measured below 1e-14; margin 100).
pub const TWO_ORACLES: f64 = 1e-13;
/// Trajectories with R = 1e-12 against an oracle, m. Measured: at most 5.7e-13; margin 17. (The contract is 1e-9.)
pub const TRAJECTORY: f64 = 1e-11;
/// cloth:16, 15 steps of 1/60 s, m: the contract of the reference scene.
pub const CLOTH_16: f64 = 1e-7;
/// cloth:32, steps of 1 ms, m. Measured: 4.4e-16, u at 1 m is 1.1e-16; margin 20.
pub const SMALL_STEPS: f64 = 1e-14;
/// xᵀKy − yᵀKx, units of u·Σ k(1 + l₀/l) with components below 1: 16u per product of |Δx||Δy| ≤ 12, dots of 30 (derived).
pub const SYMMETRIC_FORM: f64 = 12.0 * (2.0 * 16.0 + 2.0 * 46.0);
/// Relative growth of energy where euler cannot gain any: rounding of the sums. Measured: between 1e-16 and 1e-15; margin 10.
pub const ENERGY_GROWTH: f64 = 1e-14;
/// One tight step of a gentle scene in another frame, m. Measured: between 1e-16 and 1e-15; margin 10.
pub const EQUIVARIANT_STEP: f64 = 1e-14;
/// Energy of the dense solve's own error relative to the solution's: (n u κ)² with n = 30 and κ up to 1e3 (derived; none of
/// it is used on these systems, and bounds tighter than this are checked in 62 digits by `oracle bounds`).
pub const DENSE_ENERGY: f64 = 1e-23;
/// A row of the operator against its blocks, units of u·Σ|block·x|: 6u per term, sums of up to 60 (derived).
pub const OPERATOR_ROW: f64 = 80.0;
/// The bunny, 190 m wide, m: the contract of the reference scene.
pub const BUNNY: f64 = 1e-9;
/// Asymmetry of multigrid's cycle, |sᵀBr − rᵀBs|/√(rᵀBr·sᵀBs) in units of u of f32 (measured: 1.9
/// on the nets of `exact/multigrid.rs`, eightfold).
pub const CYCLE: f64 = 16.0;
/// An entry of a level's matrix in f32 against Pᵀ(M + K/ω)P of the level before, in units of u of f32 and the largest entry: sums of
/// at most 8 rows' masses or 64 springs (derived: each addition loses u, most far less).
pub const GALERKIN: f64 = 64.0;
/// One cycle of multigrid against the same in f64, relative to its largest component, in units of u of f32 (measured: 58.5
/// on the nets of `exact/hierarchy.rs`, twofold).
pub const WRITTEN_CYCLE: f64 = 120.0;
/// A row of M z − r, M = (P + L)P⁻¹(P + Lᵀ), in units of u·(|P + L||P⁻¹||P + Lᵀ||z|) of that row
/// (measured: 15.3 on the nets of `exact/preconditioned.rs`, fourfold).
pub const TRIANGULAR: f64 = 64.0;
/// A dense block pivot, in units of u·max|A|: each of up to 12 earlier rows takes away less than max|A|
/// with 8 roundings (derived; an earlier pivot's own error is passed on shrunk).
pub const PIVOT: f64 = 100.0;
/// Free fall by a Rosenbrock method, units of u·n·(|x| + |v|t) after n steps: the products of a step with their coefficients, up
/// to 18·γ of q̇ and 9 of u̇, lose 2u each, and their sums 4u (derived: below 32).
pub const FREE_FALL: f64 = 32.0;
/// A pair that rotates, in units of u a step, relative to radius and speed (measured: at most 9.6, where energy-momentum
/// turns by 1.1 a step; fourfold).
pub const ROTATING: f64 = 40.0;
/// A coefficient of a Rosenbrock method made anew, units of u: products and sums of published numbers below 6, each rounded at
/// u, up to 4 deep (derived: below 64).
pub const COEFFICIENT: f64 = 64.0;
/// Linear momentum of a free island over one step of any method, units of u·(Σm|v| before and after + Σ impulses of the springs)
/// (measured: at most 2.2, under `ros3`, whose later stages have impulses of their own; fourfold).
pub const MOMENTUM_OF_METHODS: f64 = 8.0;
/// Angular momentum about the origin, units of u·(Σm|x||v| before and after + Σ impulses of the springs)
/// (measured: at most 7.6, under energy-momentum, which ends where its equation is solved to rounding; fourfold).
pub const ANGULAR_MOMENTUM: f64 = 32.0;
/// One tight step of a gentle scene against a dense formula, m and m/s (measured: at most 5.2e-14, margin 16; under midpoint 2.5e-13, of
/// the difference in the formula).
pub const DENSE_STEP: f64 = 8e-13;
/// The estimated error of such a step against a dense formula, relative: at 1 ms it is a
/// hundred-millionth of a joule, a difference of numbers near 1 (measured: at most 5.1e-9; margin 16).
pub const DENSE_ESTIMATE: f64 = 8e-8;
/// One step of an explicit method, at most 8 substeps, against its formula, m and m/s below 30 (measured: at most 6.0e-15; margin 16).
pub const EXPLICIT_STEP: f64 = 1e-13;
/// A length of a step against a power of J/E, units of u, up to seven roots in a row and a product of each: each root halves what came
/// before and adds u, products and quotients add u, `powf` two (derived: below 16).
pub const ROOTS: f64 = 16.0;
/// A bound of a solve against the theorem's closed form where nothing rounds but the bound's own arithmetic, units of u of f32
/// (measured: at most 5.5, of a lower bound below the smallest normal number, else 3.0; twofold). The margins that it is to show are
/// 38 and more.
pub const THEOREM: f64 = 11.0;
/// xᵀAx of a difference of answers, relative: a sum of up to 10⁴ terms loses 10⁴u, each term 16u, and those of pressed springs,
/// which are taken away, are below a hundred times what is left (derived: below 2e-10 in `f64`).
pub const FORM: f64 = 1e-9;
/// A direct solver's lower bound where its sum runs over places in place of rows, units of u: n = springs + points + 3 places + 32,
/// here at most 79 + 4 + 3·240 + 32, loses 2nu as a margin in either sum and n u by rounding in each (derived: 4n = 3340).
pub const BOUND_OF_PLACES: f64 = 4096.0;
/// Relative difference of an error's energy between 208 and 416 bits: the pivots lose κ·n·2⁻²⁰⁸ and the energy, a sum of squares
/// over pivots, as much again; κ up to 1e30 in what is generated, so below 1e-62·1e30·100 (derived). The bounds themselves are
/// never nearer to it than 38 u of `f64`, 4e-15.
pub const DIGITS: f64 = 1e-30;
/// Iterations of block Jacobi in `f32` beyond those in `f64` down to R = 1e-6, where at most one residual is renewed on the way: so
/// many, and this share of them. Two rounded ways to one end (measured: at most one).
pub const SINGLE: [f64; 2] = [1.0, 0.0];
/// The same below, where more are renewed: each moves p a little away from what is conjugate (measured: 24 of 162; margin 1.7).
pub const SINGLE_REFINED: [f64; 2] = [1.0, 0.25];
