//! How fast this machine reads memory, level by level, with one thread: the bound that no sparse product can beat.
//!
//! A sum over an array that fits the level, in as wide registers as there are; the best of several passes.

use std::fs;
use std::hint::black_box;

use cpu_time::ThreadTime;
use pulp::{Arch, Simd, WithSimd};

/// A level of the memory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level {
    pub(crate) name: &'static str,
    /// Bytes that fit.
    pub(crate) size: usize,
    /// GB/s (bytes per ns).
    pub(crate) read: f64,
}

struct Sum<'a>(&'a [f64]);

impl WithSimd for Sum<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        // Eight sums hide the latency of the addition.
        let (vectors, rest) = S::as_simd_f64s(self.0);
        let (chunks, tail) = vectors.as_chunks::<8>();
        let mut sums = [simd.splat_f64s(0.0); 8];
        for chunk in chunks {
            for (sum, x) in sums.iter_mut().zip(chunk) {
                *sum = simd.add_f64s(*sum, *x);
            }
        }
        let all = sums.into_iter().chain(tail.iter().copied());
        let sum = all.fold(simd.splat_f64s(0.0), |a, b| simd.add_f64s(a, b));
        simd.reduce_sum_f64s(sum) + rest.iter().sum::<f64>()
    }
}

/// Reading speed of an array of so many bytes, in bytes per ns.
fn read(bytes: usize) -> f64 {
    let numbers = vec![1.0; bytes / size_of::<f64>()];
    let arch = Arch::new();
    let passes = ((1 << 25) / bytes).max(1);
    let mut best = f64::INFINITY;
    for _ in 0..30 {
        let began = ThreadTime::now();
        for _ in 0..passes {
            black_box(arch.dispatch(Sum(black_box(&numbers))));
        }
        best = best.min(began.elapsed().as_nanos() as f64 / passes as f64);
    }
    (numbers.len() * size_of::<f64>()) as f64 / best
}

/// Size of the data cache of a level, as the system says it, or a usual one.
fn cache(level: &str, usual: usize) -> usize {
    let of_level = |index: usize| {
        let get = |file: &str| {
            let path = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{file}");
            fs::read_to_string(path).ok().map(|text| text.trim().to_string())
        };
        let fits = get("level")? == level && get("type")? != "Instruction";
        let size = get("size")?;
        let (digits, unit) = size.split_at(size.len().checked_sub(1)?);
        let unit = match unit {
            "K" => 1 << 10,
            "M" => 1 << 20,
            _ => return None,
        };
        if fits { digits.parse::<usize>().ok().map(|n| n * unit) } else { None }
    };
    (0..8).find_map(of_level).unwrap_or(usual)
}

/// Measures all levels.
pub(crate) fn levels() -> [Level; 4] {
    let [l1, l2, l3] =
        [("1", 32 << 10), ("2", 1 << 20), ("3", 16 << 20)].map(|(level, usual)| cache(level, usual));
    let level = |name, size, array: usize| Level { name, size, read: read(array) };
    [
        level("L1", l1, l1 / 2),
        level("L2", l2, l2 / 2),
        // The last level is shared: others use some of it.
        level("L3", l3, (l3 / 4).max(2 * l2).min(l3)),
        level("DRAM", usize::MAX, (4 * l3).clamp(64 << 20, 512 << 20)),
    ]
}

/// The first level that so many bytes fit.
pub(crate) fn home(levels: &[Level; 4], bytes: usize) -> Level {
    levels.iter().copied().find(|level| bytes <= level.size).unwrap_or(levels[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_reads_every_number() {
        for n in [0, 1, 7, 64, 1000, 1037] {
            let numbers: Vec<f64> = (0..n).map(|i| i as f64).collect();
            assert_eq!(Arch::new().dispatch(Sum(&numbers)), numbers.iter().sum::<f64>(), "{n}");
        }
    }

    #[test]
    fn a_scene_lives_in_the_first_level_that_it_fits() {
        let level = |name, size| Level { name, size, read: 1.0 };
        let levels = [level("L1", 10), level("L2", 20), level("L3", 30), level("DRAM", usize::MAX)];
        assert_eq!(
            [5, 10, 11, 30, 31].map(|bytes| home(&levels, bytes).name),
            ["L1", "L1", "L2", "L3", "DRAM"]
        );
    }
}
