//! Bytes as choices: what a target reads its calls, indices and numbers from. Where they end, everything is 0.

/// The bytes that are left.
#[derive(Debug, Clone, Copy)]
pub struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    /// All of these.
    pub fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    /// Is none left?
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The next one.
    pub fn byte(&mut self) -> u8 {
        match self.0.split_first() {
            Some((first, rest)) => {
                self.0 = rest;
                *first
            }
            None => 0,
        }
    }

    /// A number below `n`, at most 256.
    pub fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n.max(1)
    }

    /// True for so many of 256 bytes, the highest ones: 0 is always false.
    pub fn once_in_a_while(&mut self, of_256: u8) -> bool {
        self.byte() > u8::MAX - of_256
    }

    /// Mostly tame numbers, multiples of 1/16 between −4 and 11.75; some powers of two of any size, and some of any bits
    /// at all.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            255 => f64::from_le_bytes(std::array::from_fn(|_| self.byte())),
            254 => f64::from(f32::from_le_bytes(std::array::from_fn(|_| self.byte()))),
            253 => 2f64.powi(i32::from(self.byte()) - 128),
            252 => -(2f64.powi(i32::from(self.byte()) - 128)),
            b => f64::from(b) / 16.0 - 4.0,
        }
    }

    /// As [`Bytes::number`], without its sign.
    pub fn size(&mut self) -> f64 {
        self.number().abs()
    }

    /// Three numbers.
    pub fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.number())
    }
}
