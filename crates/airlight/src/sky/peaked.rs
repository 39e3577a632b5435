//! Phase functions that are applied for each pixel instead of being tabulated with the light.
//!
//! The light that a constituent with a peaked phase function scatters once is tabulated by stream
//! ([`crate::transfer::residual`]): what a channel stores of it has been divided by the mean phase function of the channel, and a
//! pixel multiplies it by that mean and by the share of the stream.

use crate::math::interpolation::lerp;
use crate::math::parallel;
use crate::transfer::residual::{HalfAngle, STREAMS, cosine_at};
use glam::Vec4;

/// Number of intervals of a sampled phase function.
const SAMPLES: usize = 1024;

/// Light of one stream scattered once by one constituent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    /// Index of the constituent.
    pub constituent: usize,
    /// Place of the constituent among those that are peaked.
    pub peaked: usize,
    /// Index of the stream.
    pub stream: usize,
}

/// Constituents whose phase function is too peaked to be tabulated with the light.
pub(crate) struct Peaked {
    /// The light that is tabulated apart.
    pub parts: Vec<Part>,
    /// Number of values of a part: its channels, padded for vector loads.
    pub width: usize,
    /// Mean phase functions (1/sr): `[sample][constituent][channel]`, padded.
    phases: Vec<f32>,
    /// Mean phase functions times the share of the stream (1/sr): `[sample][part][channel]`, padded.
    factors: Vec<f32>,
}

/// Scattering by a constituent at an angle, for each wavelength.
#[derive(Default)]
pub struct Scattered {
    /// Scattering coefficient at density 1, 1/m.
    pub coefficient: Vec<f32>,
    /// Phase function, 1/sr.
    pub phase: Vec<f32>,
    /// Share of each stream.
    pub shares: [Vec<f32>; STREAMS],
}

/// Place of an angle among the samples.
#[derive(Clone, Copy)]
pub(crate) struct SamplePlace {
    below: i32,
    fraction: f32,
}

/// Places of several angles.
pub(crate) struct SamplePlaces<const N: usize> {
    below: [i32; N],
    fractions: [f32; N],
}

impl<const N: usize> SamplePlaces<N> {
    /// The places of forward scattering.
    pub const FORWARDS: Self = Self {
        below: [0; N],
        fractions: [0.0; N],
    };

    /// Sets the place of an angle.
    #[inline(always)]
    pub fn set(&mut self, index: usize, angle: HalfAngle<f32>) {
        (self.below[index], self.fractions[index]) = angle.among(SAMPLES);
    }

    /// The place at an index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> SamplePlace {
        SamplePlace {
            below: self.below[index],
            fraction: self.fractions[index],
        }
    }
}

impl SamplePlace {
    /// The place of an angle.
    #[inline(always)]
    pub fn of(angle: HalfAngle<f32>) -> Self {
        let (below, fraction) = angle.among(SAMPLES);
        Self { below, fraction }
    }
}

/// Values at an angle, between two samples.
#[derive(Clone, Copy)]
pub(crate) struct Between<'a> {
    below: &'a [f32],
    above: &'a [f32],
    width: usize,
    fraction: f32,
}

impl Between<'_> {
    /// Value of a part or constituent in a channel.
    #[inline(always)]
    pub fn get(&self, part: usize, channel: usize) -> f32 {
        let index = part * self.width + channel;
        lerp(self.below[index], self.above[index], self.fraction)
    }

    /// Four values from an index on.
    #[inline(always)]
    pub fn four(&self, first: usize) -> Vec4 {
        let [below, above] = [self.below, self.above].map(|v| Vec4::from_slice(&v[first..]));
        lerp(below, above, self.fraction)
    }
}

impl Peaked {
    /// The phase functions of constituents, of which each is given with its number of streams, in the channels that `convert` makes
    /// of a value at each wavelength. `scattered` is evaluated at a constituent and the cosine of an angle.
    pub fn new(
        constituents: &[(usize, usize)],
        scattered: impl Fn(usize, f64) -> Scattered + Sync,
        channels: usize,
        convert: impl Fn(&[f32]) -> Vec<f32> + Sync,
    ) -> Self {
        let parts: Vec<Part> = constituents
            .iter()
            .enumerate()
            .flat_map(|(peaked, &(constituent, streams))| {
                (0..streams).map(move |stream| Part {
                    constituent,
                    peaked,
                    stream,
                })
            })
            .collect();
        let samples = parallel::map(SAMPLES + 1, |sample| {
            let nu = cosine_at(sample as f64 / SAMPLES as f64);
            let (mut phases, mut factors) = (Vec::new(), Vec::new());
            for (peaked, &(constituent, _)) in constituents.iter().enumerate() {
                let Scattered {
                    coefficient,
                    phase,
                    shares,
                } = scattered(constituent, nu);
                let scale = convert(&coefficient);
                let means = |values: &[f32]| Means::new(&coefficient, &scale, values, &convert);
                phases.push(means(&phase));
                for part in parts.iter().filter(|part| part.peaked == peaked) {
                    let shares = &shares[part.stream];
                    let product: Vec<f32> = phase.iter().zip(shares).map(|(p, s)| p * s).collect();
                    factors.push(means(&product));
                }
            }
            (phases, factors)
        });
        // A channel of saturated light has negative weights, whose mean of a phase function may be none.
        let own: Vec<Vec<bool>> = (0..constituents.len())
            .map(|peaked| {
                (0..channels)
                    .map(|channel| {
                        samples.iter().all(|(phases, _)| {
                            let Means { channels, all } = &phases[peaked];
                            (0.25 * all..=4.0 * all).contains(&channels[channel])
                        })
                    })
                    .collect()
            })
            .collect();
        let values = |means: &Means, peaked: usize| -> Vec<f32> {
            let channels = means.channels.iter().zip(&own[peaked]);
            channels
                .map(|(mean, own)| if *own { *mean } else { means.all })
                .collect()
        };
        let width = channels.next_multiple_of(4);
        let append = |all: &mut Vec<f32>, values: Vec<f32>| {
            all.extend(values);
            all.resize(all.len().next_multiple_of(width), 0.0);
        };
        let (mut phases, mut factors) = (Vec::new(), Vec::new());
        for (at_sample, by_part) in &samples {
            for (peaked, means) in at_sample.iter().enumerate() {
                append(&mut phases, values(means, peaked));
            }
            for (part, means) in parts.iter().zip(by_part) {
                append(&mut factors, values(means, part.peaked));
            }
        }
        Self {
            parts,
            width,
            phases,
            factors,
        }
    }

    /// Mean phase functions of the constituents at an angle.
    #[inline(always)]
    pub fn phases(&self, angle: HalfAngle<f32>) -> Between<'_> {
        self.between(&self.phases, SamplePlace::of(angle))
    }

    /// What pixels multiply the parts by, at an angle.
    #[inline(always)]
    pub fn factors(&self, angle: HalfAngle<f32>) -> Between<'_> {
        self.factors_at(SamplePlace::of(angle))
    }

    /// As [`Peaked::factors`], at the place of the angle.
    #[inline(always)]
    pub fn factors_at(&self, place: SamplePlace) -> Between<'_> {
        self.between(&self.factors, place)
    }

    #[inline(always)]
    fn between<'a>(&self, values: &'a [f32], place: SamplePlace) -> Between<'a> {
        let stride = values.len() / (SAMPLES + 1);
        let (below, above) = values[place.below as usize * stride..][..2 * stride].split_at(stride);
        Between {
            below,
            above,
            width: self.width,
            fraction: place.fraction,
        }
    }
}

/// Means of a spectrum, weighted by scattering coefficients.
struct Means {
    /// In each channel.
    channels: Vec<f32>,
    /// Over all wavelengths.
    all: f32,
}

impl Means {
    fn new(
        weights: &[f32],
        scale: &[f32],
        spectrum: &[f32],
        convert: &impl Fn(&[f32]) -> Vec<f32>,
    ) -> Self {
        let weighted: Vec<f32> = weights.iter().zip(spectrum).map(|(w, v)| w * v).collect();
        let whole: f32 = weights.iter().sum();
        let channels = convert(&weighted);
        Self {
            channels: channels.iter().zip(scale).map(|(v, s)| v / s).collect(),
            all: weighted.iter().sum::<f32>() / whole.max(f32::MIN_POSITIVE),
        }
    }
}
