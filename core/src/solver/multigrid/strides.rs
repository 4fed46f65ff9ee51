//! How far apart the numbers of a block lie: the length of its run's planes.

use super::runs::{Run, length};

/// Lengths of the planes of a level's runs, found by a block's place.
pub(super) struct Strides<'p> {
    runs: &'p [Run],
    numbers: usize,
    /// Places up to which the present run reaches, and its planes' length
    end: usize,
    stride: usize,
    next: usize,
}

impl<'p> Strides<'p> {
    pub(super) fn new(runs: &'p [Run], numbers: usize) -> Self {
        Self { runs, numbers, end: 0, stride: 0, next: 0 }
    }

    /// The length of the planes of the run that `place` is in.
    #[inline(always)]
    pub(super) fn of(&mut self, place: usize) -> usize {
        if place < self.end && place + self.numbers * self.stride >= self.end {
            return self.stride;
        }
        self.find(place)
    }

    fn find(&mut self, place: usize) -> usize {
        if place < self.end {
            (self.end, self.next) = (0, 0);
        }
        while place >= self.end {
            let Some(run) = self.runs.get(self.next) else { return 0 };
            self.stride = length(run[2] as usize);
            self.end += self.numbers * self.stride;
            self.next += 1;
        }
        self.stride
    }
}
