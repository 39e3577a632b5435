//! Layers gathered by profile.

use super::layer::{FogError, Layer, Medium};
use super::lighting::FogScattering;
use super::multiple::{Peak, Reduced, STREAMS};
use crate::atmosphere::DensityProfile;
use crate::spectrum::Spectrum;

/// All matter that shares one profile.
#[derive(Clone, Debug)]
pub(super) struct MergedLayer<const N: usize> {
    pub profile: DensityProfile,
    pub extinction_per_m: Spectrum<N>,
    pub scattering_per_m: Spectrum<N>,
    /// Extinction without the forward peak.
    pub reduced_extinction_per_m: Spectrum<N>,
    parts: Vec<Part<N>>,
}

/// One matter of a stratum.
#[derive(Clone, Debug)]
struct Part<const N: usize> {
    medium: Medium<N>,
    wavelengths_nm: [f64; N],
    /// Its phase function without the forward peak: one for all lanes, one for each, or none where the peak is kept.
    peaks: Vec<Peak>,
}

/// Checks layers and gathers those of one profile.
///
/// # Errors
/// [`FogError`] for the first number that cannot be.
pub(super) fn merge_layers<const N: usize>(
    layers: &[Layer<N>],
    scattering: FogScattering,
    wavelengths_nm: [f64; N],
) -> Result<Vec<MergedLayer<N>>, FogError> {
    let mut merged: Vec<MergedLayer<N>> = Vec::new();
    for layer in layers {
        layer.validate()?;
    }
    let terms = layers.iter().flat_map(|layer| {
        let terms = layer.profile.terms().into_iter();
        terms.map(move |(factor, profile)| (factor, profile, &layer.medium))
    });
    for (factor, profile, medium) in terms {
        let medium = Medium {
            extinction_per_m: medium.extinction_per_m * factor as f32,
            ..medium.clone()
        };
        let peaks = if scattering != FogScattering::Multiple || profile.is_uniform() {
            Vec::new()
        } else if medium.phase.depends_on_wavelength() {
            let peak = |&nm: &f64| Peak::new(&medium.phase, nm);
            wavelengths_nm.iter().map(peak).collect()
        } else {
            vec![Peak::new(&medium.phase, wavelengths_nm[0])]
        };
        let index = merged.iter().position(|m| m.profile == *profile);
        let index = index.unwrap_or_else(|| {
            merged.push(MergedLayer {
                profile: profile.clone(),
                extinction_per_m: Spectrum::ZERO,
                scattering_per_m: Spectrum::ZERO,
                reduced_extinction_per_m: Spectrum::ZERO,
                parts: Vec::new(),
            });
            merged.len() - 1
        });
        let into = &mut merged[index];
        into.extinction_per_m += medium.extinction_per_m;
        into.scattering_per_m += medium.scattering_per_m();
        into.reduced_extinction_per_m += medium.extinction_per_m
            - medium.scattering_per_m() * lanes(&peaks, |peak| peak.fraction as f32);
        into.parts.push(Part {
            medium,
            wavelengths_nm,
            peaks,
        });
    }
    Ok(merged)
}

impl<const N: usize> MergedLayer<N> {
    /// `sum over j of sigma_s,j p_j`: sunlight scattered towards the eye, 1/(m sr).
    #[inline]
    pub fn towards_eye(&self, cos_sun: f64) -> Spectrum<N> {
        self.sum(|part| part.medium.phase_lanes(cos_sun, &part.wavelengths_nm))
    }

    /// The part of [`MergedLayer::towards_eye`] that the solver's moments hold; all of it where peaks are kept.
    pub fn smooth_towards_eye(&self, cos_sun: f64) -> Spectrum<N> {
        self.sum(|part| match &part.peaks[..] {
            [] => part.medium.phase_lanes(cos_sun, &part.wavelengths_nm),
            peaks => lanes(peaks, |peak| peak.smooth(cos_sun) as f32),
        })
    }

    /// Extinction of light that the residual of the peak scatters, 1/m.
    #[inline]
    pub fn residual_extinction(&self, cos_sun: f64) -> Spectrum<N> {
        let fraction = |part: &Part<N>| lanes(&part.peaks, |peak| peak.residual_fraction(cos_sun));
        self.extinction_per_m - self.sum(fraction)
    }

    /// Whether the residual matters at an angle to the sun.
    #[inline]
    pub fn in_peak(&self, cos_sun: f64) -> bool {
        let mut peaks = self.parts.iter().flat_map(|part| &part.peaks);
        peaks.any(|peak| peak.in_lobe(cos_sun))
    }

    /// What the solver needs; none of a fog without an upper end.
    pub fn reduced(&self) -> Option<Reduced<N>> {
        (!self.profile.is_uniform()).then(|| Reduced {
            profile: self.profile.clone(),
            extinction_per_m: self.reduced_extinction_per_m,
            scattering_per_m: std::array::from_fn::<_, STREAMS, _>(|l| {
                self.sum(|part| lanes(&part.peaks, |p| (p.moments[l] - p.fraction) as f32))
            }),
        })
    }

    /// The sum over all matter of scattering times something.
    #[inline]
    fn sum(&self, of: impl Fn(&Part<N>) -> Spectrum<N>) -> Spectrum<N> {
        self.parts.iter().fold(Spectrum::ZERO, |sum, part| {
            sum.mul_acc(part.medium.scattering_per_m(), of(part))
        })
    }
}

/// A value of each lane's peak: 0 where none is kept.
#[inline]
fn lanes<const N: usize>(peaks: &[Peak], of: impl Fn(&Peak) -> f32) -> Spectrum<N> {
    match peaks {
        [] => Spectrum::ZERO,
        [peak] => Spectrum::splat(of(peak)),
        _ => Spectrum::from_fn(|lane| of(&peaks[lane])),
    }
}
