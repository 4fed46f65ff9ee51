//! A case: a scene that is hard on methods, and what must hold of it besides what must always hold.

use crate::scene::Model;

/// How large the suite is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// `--quick`: what the tests run.
    Quick,
    /// All of it.
    Full,
}

impl Size {
    /// One number or the other.
    pub fn pick<X>(self, quick: X, full: X) -> X {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// What must hold of a case besides what must always hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fact {
    /// Nothing.
    None,
    /// No force acts and nothing moves: no bit may change.
    AtRest,
    /// So far from the origin, m, along every axis: how much of the motion at the origin is lost is told.
    Offset(f64),
}

/// A case of the table.
#[derive(Clone, Copy)]
pub struct Case {
    /// What it is called.
    pub name: &'static str,
    /// What is hard about it.
    pub what: &'static str,
    /// What must hold of it.
    pub fact: Fact,
    /// Its scene, with the step in it; before it is moved by [`Fact::Offset`].
    pub scene: fn(Size) -> Model,
}

impl Case {
    /// A case of which nothing special must hold.
    pub const fn new(name: &'static str, what: &'static str, scene: fn(Size) -> Model) -> Self {
        Self { name, what, fact: Fact::None, scene }
    }

    /// A case of which this must hold.
    pub const fn with(name: &'static str, what: &'static str, fact: Fact, scene: fn(Size) -> Model) -> Self {
        Self { name, what, fact, scene }
    }
}

/// More particles than this make few steps, and few iterations each.
const LARGE: usize = 10_000;

/// How many steps a scene makes.
pub fn steps(model: &Model, size: Size) -> u64 {
    if model.position.len() >= LARGE { 2 } else { size.pick(3, 50) }
}

/// How many iterations a solve of it may take: ten for each unknown, but not more than a thousand.
pub fn most_iterations(model: &Model) -> u32 {
    match model.position.len() {
        LARGE.. => 100,
        n => (30 * n as u32).clamp(100, 1000),
    }
}
