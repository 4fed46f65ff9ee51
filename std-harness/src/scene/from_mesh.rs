//! A mesh becomes a scene: every point a particle under its own id, every edge a spring at rest as loaded.
//!
//! Points that no cell uses stay particles without springs; points at the same place stay apart; an edge of length 0
//! is a spring of rest length 0. Each is said in a note.

use super::Model;
use crate::mesh::Mesh;

/// Stiffness of a mesh's springs unless said otherwise, N/m.
pub const STIFFNESS: f64 = 1e3;
/// Mass of a mesh's particles unless said otherwise, kg.
pub const MASS: f64 = 0.01;

/// The mesh as a scene with the defaults of this file.
pub fn model(name: &str, mesh: &Mesh) -> Model {
    let mut model = Model::at_rest(name, mesh.points.clone(), MASS);
    for [a, b] in mesh.edges() {
        model.join(a, b, STIFFNESS);
    }
    model.notes = mesh.notes.clone();
    let mut note = |count: usize, what: &str| {
        if count > 0 {
            model.notes.push(format!("{count} {what}"));
        }
    };
    note(
        mesh.isolated().len(),
        "points belong to no cell: particles without springs, they fall freely unless pinned",
    );
    note(mesh.repeated().len(), "points lie exactly on another one: each stays a particle of its own");
    note(mesh.zero_length().len(), "edges have length 0: springs of rest length 0");
    model
}
