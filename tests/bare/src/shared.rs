//! The types that the wrappers share.

use hooke::{
    Drag, Fixed, Gravity, LinearlyImplicitEuler, Mixed, PointForce, PointSpring, Report, Scene, SceneIn,
    Snapshot, SpringDamping, StepError, System, Vec3,
};

/// A rope of 40 particles with room for a spring of each kind between any neighbours.
pub type S<T> = Scene<T, 40, 80, Mixed>;
/// Its owner of memory.
pub type Owner<T> = Fixed<T, 40, 80, Mixed>;
/// The same in borrowed buffers.
pub type Borrowed<'a, T> = SceneIn<'a, T, Mixed>;
/// A copy of it.
pub type Kept<T> = Snapshot<Owner<T>>;
/// A vector.
pub type V<T> = Vec3<T>;
/// A method with the forces `F`.
pub type Euler<T, F = ()> = LinearlyImplicitEuler<T, F>;
/// What a step answers.
pub type Stepped<T> = Result<Report<T>, StepError>;
/// Every force there is.
pub type All<'a, T> =
    ((((((), Gravity<T>), Drag<T>), SpringDamping<&'a [T]>), PointForce<T>), PointSpring<T>);
/// The system that they make.
pub type Whole<'a, T> = System<'a, T, All<'a, T>>;
