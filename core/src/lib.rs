//! Hooke core (being laid).
#![no_std]
#![forbid(unsafe_code)]
