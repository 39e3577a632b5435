//! Layers of fog: constituents in RGB and at the wavelengths of N lanes, merged by density profile.

use super::error::FogError;
use super::lighting::FogScattering;
use super::multiple::{DEGREES, ORDERS, PeakScattering, Reduced};
use crate::atmosphere::{Constituent, DensityProfile};
use crate::optics::{PhaseError, PhaseFunction, TabulatedPhase};
use crate::spectrum::rgb::{self, DOMINANT_NM};
use crate::spectrum::{RgbSpace, Spectrum, WavelengthGrid};
use crate::transfer::delta_m::peak_fraction;
use crate::transfer::residual::{ONE_STREAM, Residual, STREAMS, Shares, kept_by_peak};
use std::sync::Arc;

/// A layer of fog in red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct RgbLayer {
    /// Relative density by height.
    pub density: DensityProfile,
    /// Extinction coefficient at density 1, 1/m.
    pub extinction_per_m: [f32; 3],
    /// Ratio of scattering to extinction, 0 to 1.
    pub single_scattering_albedo: [f32; 3],
    /// Phase function; one that depends on wavelength is evaluated at 612, 549 and 465 nm.
    pub phase: PhaseFunction,
}

impl RgbLayer {
    /// A constituent in a linear RGB space, under sunlight. Each channel is the mean over the wavelengths of
    /// [`WavelengthGrid::standard`], weighted by sunlight and the channel's sensitivity; tabulated phase functions are also
    /// weighted by scattering. For single scattering of white sunlight the result equals that of a spectral computation,
    /// while three single wavelengths would make fogbows and glories too saturated.
    ///
    /// # Errors
    /// [`PhaseError`] if the mean of a tabulated phase function is invalid.
    pub fn from_constituent(layer: &Constituent, space: RgbSpace) -> Result<Self, PhaseError> {
        let grid = WavelengthGrid::standard();
        let nm = grid.wavelengths_nm();
        let scattering: Vec<f64> = nm.iter().map(|&nm| layer.scattering_per_m.at(nm)).collect();
        let absorption: Vec<f64> = nm.iter().map(|&nm| layer.absorption_per_m.at(nm)).collect();
        let weights = channel_weights(&grid, space);
        let mean = |weights: &[f64], values: &[f64]| -> f64 {
            weights.iter().zip(values).map(|(w, v)| w * v).sum()
        };
        let channels = weights.each_ref().map(|weights| {
            let scattering = mean(weights, &scattering);
            (scattering, scattering + mean(weights, &absorption).max(0.0))
        });
        Ok(Self {
            density: layer.density.clone(),
            extinction_per_m: channels.map(|(_, extinction)| extinction as f32),
            single_scattering_albedo: channels.map(|(scattering, extinction)| {
                match extinction > 0.0 {
                    true => (scattering / extinction) as f32,
                    false => 1.0,
                }
            }),
            phase: match &layer.phase {
                PhaseFunction::Tabulated(table) => {
                    PhaseFunction::Tabulated(in_channels(table, nm, &scattering, &weights)?)
                }
                phase => phase.clone(),
            },
        })
    }

    /// Checks all values.
    ///
    /// # Errors
    /// [`FogError`] for the first value out of range.
    pub fn validate(&self) -> Result<(), FogError> {
        self.density.validate()?;
        LayerLanes::<3>::rgb(self).validate()
    }
}

/// Share of each wavelength in the red, green and blue of sunlight.
fn channel_weights(grid: &WavelengthGrid, space: RgbSpace) -> [Vec<f64>; 3] {
    let from_xyz = space.from_xyz_matrix();
    let sunlight: Vec<[f64; 3]> = grid
        .xyz_weights()
        .iter()
        .zip(grid.solar_irradiance())
        .map(|(w, e)| rgb::apply(&from_xyz, w.map(|w| w * e)))
        .collect();
    [0, 1, 2].map(|channel| {
        let whole: f64 = sunlight.iter().map(|rgb| rgb[channel]).sum();
        sunlight.iter().map(|rgb| rgb[channel] / whole).collect()
    })
}

/// Means of a phase function over wavelengths (nm), by channel.
///
/// The weights of a channel are negative at some wavelengths, as its primary lies inside the spectral locus. Phase functions
/// vary too little with wavelength for a mean to become negative; it is bounded by a thousandth of the unweighted mean.
fn in_channels(
    table: &TabulatedPhase,
    wavelengths_nm: &[f64],
    scattering: &[f64],
    weights: &[Vec<f64>; 3],
) -> Result<TabulatedPhase, PhaseError> {
    let angles = table.angles_rad();
    let count = wavelengths_nm.len() as f64;
    let by_angle: Vec<Vec<f64>> = angles
        .iter()
        .map(|angle| {
            let evaluate = |&nm: &f64| table.evaluate(angle.cos(), nm);
            wavelengths_nm.iter().map(evaluate).collect()
        })
        .collect();
    let mut values = Vec::new();
    // Tables are in the order of increasing wavelength: blue first.
    for weights in weights.iter().rev() {
        let whole: f64 = weights.iter().zip(scattering).map(|(w, s)| w * s).sum();
        for phase in &by_angle {
            let terms = weights.iter().zip(scattering).zip(phase);
            let weighted: f64 = terms.map(|((w, s), p)| w * (s * p)).sum::<f64>() / whole;
            values.push(weighted.max(1e-3 * phase.iter().sum::<f64>() / count));
        }
    }
    let degrees = |(i, angle): (usize, &f64)| match i + 1 == angles.len() {
        true => 180.0,
        false => angle.to_degrees(),
    };
    let angles_deg = angles.iter().enumerate().map(degrees).collect();
    let [red, green, blue] = DOMINANT_NM;
    TabulatedPhase::new(angles_deg, vec![blue, green, red], values)
}

/// A constituent at the wavelengths of N lanes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LayerLanes<const N: usize> {
    pub density: DensityProfile,
    /// Extinction coefficient at density 1, 1/m.
    pub extinction_per_m: Spectrum<N>,
    /// Scattering coefficient at density 1, 1/m.
    pub scattering_per_m: Spectrum<N>,
    pub phase: PhaseFunction,
    /// Wavelength of each lane, nm.
    pub wavelengths_nm: [f64; N],
}

impl<const N: usize> LayerLanes<N> {
    /// A layer in red, green and blue; further lanes repeat the last.
    pub fn rgb(layer: &RgbLayer) -> Self {
        let lanes = |rgb: &[f32; 3]| Spectrum::from_fn(|lane| rgb[lane.min(2)]);
        let extinction = lanes(&layer.extinction_per_m);
        Self {
            density: layer.density.clone(),
            extinction_per_m: extinction,
            scattering_per_m: extinction * lanes(&layer.single_scattering_albedo),
            phase: layer.phase.clone(),
            wavelengths_nm: std::array::from_fn(|lane| DOMINANT_NM[lane.min(2)]),
        }
    }

    /// A constituent at wavelengths, nm.
    pub fn new(layer: &Constituent, wavelengths_nm: &[f64; N]) -> Self {
        let lanes =
            |of: &dyn Fn(f64) -> f64| Spectrum::from_fn(|lane| of(wavelengths_nm[lane]) as f32);
        Self {
            density: layer.density.clone(),
            extinction_per_m: lanes(&|nm| layer.extinction_per_m(nm)),
            scattering_per_m: lanes(&|nm| layer.scattering_per_m.at(nm)),
            phase: layer.phase.clone(),
            wavelengths_nm: *wavelengths_nm,
        }
    }

    /// Checks all values.
    pub fn validate(&self) -> Result<(), FogError> {
        for channel in 0..N {
            let extinction = f64::from(self.extinction_per_m[channel]);
            if !(extinction.is_finite() && extinction >= 0.0) {
                return Err(FogError::Extinction {
                    channel,
                    got_per_m: extinction,
                });
            }
            // Allow for rounding of both.
            let scattering = f64::from(self.scattering_per_m[channel]);
            if !(scattering >= 0.0 && scattering <= extinction * (1.0 + 1e-6)) {
                return Err(FogError::Albedo {
                    channel,
                    got: scattering / extinction,
                });
            }
        }
        self.density.validate()?;
        Ok(self.phase.validate()?)
    }

    /// Phase function of all lanes at a cosine of the scattering angle, 1/sr.
    #[inline]
    pub fn phase_lanes(&self, cos_angle: f64) -> Spectrum<N> {
        self.phase.in_lanes(cos_angle, &self.wavelengths_nm)
    }

    /// Layers whose sum is this one: one for each term of its density.
    pub fn terms(&self) -> Vec<Self> {
        let term = |(factor, density): (f64, &DensityProfile)| Self {
            density: density.clone(),
            extinction_per_m: self.extinction_per_m * factor as f32,
            scattering_per_m: self.scattering_per_m * factor as f32,
            ..self.clone()
        };
        self.density.terms().into_iter().map(term).collect()
    }
}

/// All constituents that share one density profile.
#[derive(Clone, Debug)]
pub(super) struct MergedLayer<const N: usize> {
    pub density: DensityProfile,
    pub extinction_per_m: Spectrum<N>,
    pub scattering_per_m: Spectrum<N>,
    /// Scattering by forward peaks, 1/m: all of it counts as unscattered in the solver, the narrow part along rays.
    pub peak: PeakScattering<N>,
    parts: Vec<Part<N>>,
}

/// One constituent of a merged layer.
#[derive(Clone, Debug)]
struct Part<const N: usize> {
    layer: LayerLanes<N>,
    /// `None` if no forward peak is split off.
    peak: Option<Peak<N>>,
}

/// The forward peak of a phase function.
#[derive(Clone, Debug)]
struct Peak<const N: usize> {
    /// Fraction of the scattering that counts as unscattered.
    fraction: Spectrum<N>,
    /// Legendre moments of the whole phase function.
    moments: [Spectrum<N>; DEGREES],
    /// Its moments, per scattering.
    scattering: PeakScattering<N>,
    /// Streams of singly scattered light; `None` if the peak is negligible.
    residual: Option<Arc<Residual<N>>>,
}

/// Smallest fraction of the scattering in the resolved part of a forward peak.
const MIN_RESOLVED: f32 = 1e-3;

impl<const N: usize> Peak<N> {
    fn new(layer: &LayerLanes<N>, depth: f64) -> Self {
        let (phase, nm) = (&layer.phase, &layer.wavelengths_nm);
        let by_lane = nm.map(|nm| phase.legendre_moments(ORDERS + 1, nm));
        let moment = |l: usize| Spectrum::from_fn(|lane| by_lane[lane][l] as f32);
        let fraction = moment(DEGREES).map(peak_fraction);
        // A peak that is narrow, or weak, is not resolved.
        let narrow = Spectrum::from_fn(|lane| {
            let (narrow, all) = (moment(ORDERS)[lane], fraction[lane]);
            if all - narrow < MIN_RESOLVED {
                all
            } else {
                narrow.max(0.0)
            }
        });
        let resolved = |lane: usize| fraction[lane] > narrow[lane];
        let scattered = |l: usize| if l < DEGREES { fraction } else { moment(l) };
        Self {
            fraction,
            scattering: PeakScattering {
                moments: (0..ORDERS)
                    .map(|l| {
                        let moment = scattered(l) - narrow;
                        Spectrum::from_fn(|lane| if resolved(lane) { moment[lane] } else { 0.0 })
                    })
                    .collect(),
                narrow,
            },
            moments: std::array::from_fn(moment),
            residual: Residual::new(phase, nm, DEGREES - 1, depth).map(Arc::new),
        }
    }
}

/// Validates layers and merges those of one density profile. Streams are made for light that passes a scattering optical depth,
/// `sun_depth`.
///
/// # Errors
/// [`FogError`] for the first value out of range.
pub(super) fn merge_layers<const N: usize>(
    layers: &[LayerLanes<N>],
    scattering: FogScattering,
    sun_depth: f64,
) -> Result<Vec<MergedLayer<N>>, FogError> {
    let mut merged: Vec<MergedLayer<N>> = Vec::new();
    for layer in layers {
        let solved = scattering == FogScattering::Multiple;
        let whole = (solved && !layer.density.is_uniform()).then(|| Peak::new(layer, sun_depth));
        for layer in layer.terms() {
            let peak = whole.clone().filter(|_| !layer.density.is_uniform());
            let index = merged.iter().position(|m| m.density == layer.density);
            let index = index.unwrap_or_else(|| {
                merged.push(MergedLayer {
                    density: layer.density.clone(),
                    extinction_per_m: Spectrum::ZERO,
                    scattering_per_m: Spectrum::ZERO,
                    peak: PeakScattering::none(),
                    parts: Vec::new(),
                });
                merged.len() - 1
            });
            let into = &mut merged[index];
            into.extinction_per_m += layer.extinction_per_m;
            into.scattering_per_m += layer.scattering_per_m;
            if let Some(peak) = &peak {
                into.peak.add(&peak.scattering, layer.scattering_per_m);
            }
            into.parts.push(Part { layer, peak });
        }
    }
    Ok(merged)
}

/// A phase function of layers, and its streams.
#[derive(Clone, Debug)]
pub(super) struct StreamedPhase<const N: usize> {
    part: Part<N>,
}

impl<const N: usize> StreamedPhase<N> {
    /// The phase functions of layers, each once.
    pub fn of(layers: &[MergedLayer<N>]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for part in layers.iter().flat_map(|layer| &layer.parts) {
            if all.iter().all(|known| *known.phase() != part.layer.phase) {
                all.push(Self { part: part.clone() });
            }
        }
        all
    }

    pub fn phase(&self) -> &PhaseFunction {
        &self.part.layer.phase
    }

    /// The phase function at a cosine of the scattering angle by stream, 1/sr; the sum is all of it.
    pub fn towards_eye(&self, cos_sun: f64) -> [Spectrum<N>; STREAMS] {
        let whole = self.part.layer.phase_lanes(cos_sun);
        self.part.shares(cos_sun).map(|share| whole * share)
    }
}

impl<const N: usize> MergedLayer<N> {
    /// Scattering coefficient times phase function towards the eye, summed over constituents, 1/(m sr).
    #[inline]
    pub fn towards_eye(&self, cos_sun: f64) -> Spectrum<N> {
        self.sum(|part| part.layer.phase_lanes(cos_sun))
    }

    /// [`MergedLayer::towards_eye`] for several rays: for each lane, the values of the rays.
    #[inline(always)]
    pub fn towards_eye_along<const R: usize>(&self, cos_sun: &[f64; R]) -> [Spectrum<R>; N] {
        let mut sums = [Spectrum::ZERO; N];
        for part in &self.parts {
            let phase = part
                .layer
                .phase
                .along_rays(cos_sun, &part.layer.wavelengths_nm);
            for lane in 0..N {
                sums[lane] = sums[lane].scale_acc(phase[lane], part.layer.scattering_per_m[lane]);
            }
        }
        sums
    }

    /// [`MergedLayer::streams_towards_eye`] for several rays.
    #[inline(always)]
    pub fn streams_towards_eye_along<const R: usize>(
        &self,
        cos_sun: &[f64; R],
    ) -> [[Spectrum<R>; N]; STREAMS] {
        let mut sums = [[Spectrum::ZERO; N]; STREAMS];
        for part in &self.parts {
            let phase = part
                .layer
                .phase
                .along_rays(cos_sun, &part.layer.wavelengths_nm);
            let scattering = part.layer.scattering_per_m;
            let shares = part.shares_along(cos_sun);
            for k in 0..STREAMS {
                for lane in 0..N {
                    let whole = phase[lane] * scattering[lane];
                    sums[k][lane] = sums[k][lane].mul_acc(whole, shares[k][lane]);
                }
            }
        }
        sums
    }

    /// [`MergedLayer::towards_eye`] by stream; the sum is all of it.
    #[inline]
    pub fn streams_towards_eye(&self, cos_sun: f64) -> [Spectrum<N>; STREAMS] {
        let mut sums = [Spectrum::ZERO; STREAMS];
        for part in &self.parts {
            let whole = part.layer.scattering_per_m * part.layer.phase_lanes(cos_sun);
            for (sum, share) in sums.iter_mut().zip(part.shares(cos_sun)) {
                *sum = sum.mul_acc(whole, share);
            }
        }
        sums
    }

    /// Extinction without forward peaks, 1/m.
    #[inline]
    pub fn reduced_extinction(&self) -> Spectrum<N> {
        self.extinction_per_m - self.peak.whole()
    }

    /// Extinction along rays of light scattered several times, 1/m.
    #[inline]
    pub fn seen_extinction(&self) -> Spectrum<N> {
        self.extinction_per_m - self.peak.narrow
    }

    /// Extinction of each stream of singly scattered light, along rays and of sunlight on the way to them: that without the part
    /// that the peak keeps.
    #[inline]
    pub fn stream_extinctions(&self) -> [[Spectrum<N>; STREAMS]; 2] {
        let extinction = |unscattered: Spectrum<N>| {
            std::array::from_fn(|k| self.extinction_per_m - unscattered * kept_by_peak(k))
        };
        [self.peak.narrow, self.peak.whole()].map(extinction)
    }

    /// Scattering with a phase function, 1/m.
    pub fn scattering_with(&self, phase: &PhaseFunction) -> Spectrum<N> {
        let parts = self.parts.iter().filter(|part| part.layer.phase == *phase);
        parts.fold(Spectrum::ZERO, |sum, part| {
            sum + part.layer.scattering_per_m
        })
    }

    /// Input of the solver; `None` for uniform density, which has no upper end.
    pub fn reduced(&self) -> Option<Reduced<N>> {
        (!self.density.is_uniform()).then(|| Reduced {
            density: self.density.clone(),
            extinction_per_m: self.reduced_extinction(),
            scattering_per_m: std::array::from_fn(|l| {
                self.sum(|part| match &part.peak {
                    Some(peak) => peak.moments[l] - peak.fraction,
                    None => Spectrum::ZERO,
                })
            }),
            whole_scattering_per_m: self.scattering_per_m,
            peak: self.peak.clone(),
        })
    }

    /// Sum over constituents of scattering coefficient times a factor.
    #[inline]
    fn sum(&self, factor: impl Fn(&Part<N>) -> Spectrum<N>) -> Spectrum<N> {
        self.parts.iter().fold(Spectrum::ZERO, |sum, part| {
            sum.mul_acc(part.layer.scattering_per_m, factor(part))
        })
    }
}

impl<const N: usize> Part<N> {
    /// [`Part::shares`] for several rays: by stream and lane.
    #[inline(always)]
    fn shares_along<const R: usize>(&self, cos_sun: &[f64; R]) -> [[Spectrum<R>; N]; STREAMS] {
        match self.peak.as_ref().and_then(|peak| peak.residual.as_ref()) {
            Some(residual) => residual.shares_along(cos_sun),
            None => ONE_STREAM.map(|share| [Spectrum::splat(share); N]),
        }
    }

    /// Shares of the streams in the light scattered at an angle to the sun.
    #[inline]
    fn shares(&self, cos_sun: f64) -> Shares<N> {
        match self.peak.as_ref().and_then(|peak| peak.residual.as_ref()) {
            Some(residual) => residual.shares(cos_sun),
            None => ONE_STREAM.map(Spectrum::splat),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::droplets::DropletKind;
    use crate::optics::mie::droplets::Drops;

    /// Extinction is given at 550 nm, and RGB is the mean over wavelengths. Mist, as its table is fast to compute.
    #[test]
    fn rgb_of_published_droplets_is_a_mean_over_wavelengths() {
        let mist = |wavelengths_nm: &[f64]| {
            let slab = DensityProfile::slab(100.0);
            Constituent::fog(0.01, DropletKind::from(Drops::HazeH), slab, wavelengths_nm).unwrap()
        };
        let green = LayerLanes::new(&mist(&[550.0]), &[550.0]);
        assert!((green.extinction_per_m[0] / 0.01 - 1.0).abs() < 1e-6);
        let layer = LayerLanes::new(&mist(&[450.0, 650.0]), &[650.0, 450.0, 450.0]);
        layer.validate().unwrap();
        let [red, blue, again] = layer.extinction_per_m.0;
        assert!(
            red < 0.0095 && blue > 0.0105 && again == blue,
            "{red} {blue}"
        );
        assert!(layer.scattering_per_m[0] > 0.9999 * red);
        let spectral = mist(WavelengthGrid::standard().wavelengths_nm());
        let rgb = RgbLayer::from_constituent(&spectral, RgbSpace::Srgb).unwrap();
        rgb.validate().unwrap();
        let [red, green, blue] = rgb.extinction_per_m;
        assert!(red < green && green < blue, "{red} {green} {blue}");
        assert!((green / 0.01 - 1.0).abs() < 0.02, "{green}");
        // Red and blue lie between the values at the ends of their bands.
        let at = |nm: f64, mu: f64| mist(&[nm]).phase.evaluate(mu, nm);
        for mu in [-1.0, -0.5, 0.5, 0.99] {
            let p = LayerLanes::<3>::rgb(&rgb).phase_lanes(mu);
            for (lane, [from, to]) in [(0, [570.0, 680.0]), (2, [420.0, 490.0])] {
                let ends = [at(from, mu), at(to, mu)];
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                let got = f64::from(p[lane]);
                assert!(
                    got > 0.98 * low && got < 1.02 * high,
                    "{mu} {lane}: {got} {ends:?}"
                );
            }
        }
        let slab = DensityProfile::slab(100.0);
        assert!(Constituent::fog(0.01, Drops::HazeH.into(), slab, &[f64::NAN]).is_err());
    }

    #[test]
    fn invalid_layers_are_rejected() {
        let good = RgbLayer {
            density: DensityProfile::slab(50.0),
            extinction_per_m: [0.01; 3],
            single_scattering_albedo: [1.0; 3],
            phase: PhaseFunction::Isotropic,
        };
        good.validate().unwrap();
        let refused = |change: &dyn Fn(&mut RgbLayer)| {
            let mut layer = good.clone();
            change(&mut layer);
            layer.validate().unwrap_err()
        };
        assert!(matches!(
            refused(&|layer| layer.extinction_per_m[1] = -0.1),
            FogError::Extinction { channel: 1, .. }
        ));
        assert!(matches!(
            refused(&|layer| layer.extinction_per_m[2] = f32::INFINITY),
            FogError::Extinction { channel: 2, .. }
        ));
        for albedo in [1.1, -0.1, f32::NAN] {
            assert!(matches!(
                refused(&|layer| layer.single_scattering_albedo[0] = albedo),
                FogError::Albedo { channel: 0, .. }
            ));
        }
        assert!(matches!(
            refused(&|layer| layer.density = DensityProfile::exponential(0.0)),
            FogError::Density(_)
        ));
        assert!(matches!(
            refused(&|layer| layer.phase = PhaseFunction::HenyeyGreenstein { g: 2.0 }),
            FogError::Phase(_)
        ));
    }
}
