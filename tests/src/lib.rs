//! Oracles and helpers that the tests share; none of it shares code with the kernel.
