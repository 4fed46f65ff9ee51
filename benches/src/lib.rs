//! What Hooke costs, measured.
