//! Counter-based random numbers: reproducible and independent of the order of use.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Uniform random numbers from a stream of the counter-based generator ChaCha8 (Bernstein 2008), selected by a seed, a
/// stream number and a run number. Streams are independent of each other and of the order in which they are used.
#[derive(Clone, Debug)]
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    /// The random numbers of run `run` in the stream `stream` for `seed`.
    pub fn new(seed: u64, stream: u64, run: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&stream.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(run);
        Self(generator)
    }

    /// A uniform number strictly between 0 and 1.
    #[inline(always)]
    pub fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1u64 << 53) as f64;
        ((self.0.next_u64() >> 11) as f64 + 0.5) * STEP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_uniform_and_differ() {
        let mut first = Vec::new();
        for (seed, stream, run) in [(1, 2, 3), (1, 2, 4), (1, 3, 3), (2, 2, 3)] {
            let mut random = Random::new(seed, stream, run);
            let draws: Vec<f64> = (0..20_000).map(|_| random.unit()).collect();
            assert!(draws.iter().all(|x| *x > 0.0 && *x < 1.0));
            let mean = draws.iter().sum::<f64>() / draws.len() as f64;
            // Four standard errors.
            assert!(
                (mean - 0.5).abs() < 4.0 * (1.0f64 / 12.0 / 20_000.0).sqrt(),
                "{mean}"
            );
            assert!(!first.contains(&draws[0]));
            first.push(draws[0]);
            assert_eq!(Random::new(seed, stream, run).unit(), draws[0]);
        }
    }
}
