//! FNV-1a in 64 bits: h ← (h ⊕ byte)·p for each byte. Not a cryptographic digest; a few instructions on any core, and
//! any changed bit changes all later values.
//!
//! Source: Fowler, Noll, Vo, "The FNV Non-Cryptographic Hash Algorithm" (offset basis and prime for 64 bits).

use hooke::{MassSpring, Memory, Real};

/// A running digest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digest(u64);

impl Digest {
    /// Of nothing.
    pub const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Its value so far.
    pub fn value(self) -> u64 {
        self.0
    }

    /// Adds bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Adds a number's bits. Through `f64`, which is exact and keeps the sign of zero; NaN never gets here, since no
    /// step ends with one.
    pub fn number<T: Real>(&mut self, x: T) {
        self.bytes(&x.to_f64().to_bits().to_le_bytes());
    }

    /// Adds all positions and velocities of a scene.
    pub fn scene<M: Memory>(&mut self, scene: &MassSpring<M>) {
        for vector in scene.positions().iter().chain(scene.velocities()) {
            for x in vector {
                self.number(*x);
            }
        }
    }
}

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}
