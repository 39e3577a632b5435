//! Fog as a constituent of the air, for random paths.

use crate::error::CliError;
use airlight::atmosphere::{AltitudeTable, Constituent, DensityProfile, Interpolation};
use airlight::fog::Profile;
use airlight::fog::droplets::DropletKind;
use airlight::optics::PhaseFunction;
use airlight::optics::mie::BulkOptics;
use airlight::spectrum::SpectralCurve;

/// A layer of fog before its optics are worked out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogInAir {
    /// How it thins; heights are from the ground.
    pub profile: Profile,
    /// Its drops.
    pub droplets: DropletKind,
    /// Extinction at density 1 at 550 nm, 1/m.
    pub extinction_per_m: f64,
}

impl FogInAir {
    /// The constituent "fog" over a ground at an altitude (m), known at wavelengths (nm, rising).
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that has no upper end or is none.
    pub fn constituent(
        &self,
        ground_m: f64,
        wavelengths_nm: &[f64],
    ) -> Result<Constituent, CliError> {
        let extinction = self.extinction_per_m;
        let (scattering_per_m, absorption_per_m, phase) = match self.droplets {
            DropletKind::Analytic(drops) => (
                SpectralCurve::Constant(extinction),
                SpectralCurve::Constant(0.0),
                drops.phase(),
            ),
            DropletKind::Isotropic => (
                SpectralCurve::Constant(extinction),
                SpectralCurve::Constant(0.0),
                PhaseFunction::Isotropic,
            ),
            DropletKind::Published(drops) => {
                let table = drops.table(wavelengths_nm)?;
                let number = extinction / table.green.extinction_um2();
                let curve = |of: &dyn Fn(&BulkOptics) -> f64| {
                    let values = table.bulk.iter().map(|bulk| number * of(bulk)).collect();
                    SpectralCurve::table(wavelengths_nm.to_vec(), values)
                        .map_err(|error| CliError::usage(format!("the fog: {error}")))
                };
                (
                    curve(&|bulk| bulk.scattering_um2)?,
                    curve(&|bulk| bulk.absorption_um2)?,
                    PhaseFunction::Tabulated(table.phase.clone()),
                )
            }
        };
        Ok(Constituent {
            name: "fog".into(),
            density: density(self.profile, ground_m)?,
            scattering_per_m,
            absorption_per_m,
            phase,
        })
    }
}

/// A fog's profile by altitude, from the ground up.
fn density(profile: Profile, ground_m: f64) -> Result<DensityProfile, CliError> {
    /// Scale heights after which nothing is left that could be seen.
    const LAST: f64 = 12.0;
    // Up to the base the density is 1; from the base, or the ground where that is higher, it falls.
    let (base_m, from_m, scale_height_m) = match profile {
        Profile::Clamped {
            base_height_m,
            scale_height_m,
        } => (base_height_m, base_height_m.max(0.0), scale_height_m),
        Profile::Exponential {
            reference_height_m,
            scale_height_m,
        } => (reference_height_m, 0.0, scale_height_m),
        Profile::Slab { top_height_m } => {
            return Ok(DensityProfile::Layer {
                bottom_m: ground_m - 1.0,
                top_m: ground_m + top_height_m,
            });
        }
        _ => {
            return Err(CliError::usage(
                "fog that random paths go through has a top or a scale height",
            ));
        }
    };
    let left = |height_m: f64| ((base_m - height_m) / scale_height_m).exp();
    let top_m = from_m + LAST * scale_height_m;
    let (mut altitudes, mut densities) = (
        vec![ground_m + from_m, ground_m + top_m],
        vec![left(from_m), left(top_m)],
    );
    if from_m > 0.0 {
        altitudes.insert(0, ground_m);
        densities.insert(0, 1.0);
    }
    AltitudeTable::new(altitudes, densities, Interpolation::LogLinear)
        .map(DensityProfile::Tabulated)
        .map_err(|error| CliError::usage(format!("the fog: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constituent's density is the fog's own.
    #[test]
    fn a_fog_in_the_air_is_as_dense_as_the_fog() {
        let ground_m = 300.0;
        let clamped = |base_height_m| Profile::Clamped {
            base_height_m,
            scale_height_m: 20.0,
        };
        for profile in [
            clamped(15.0),
            clamped(0.0),
            clamped(-30.0),
            Profile::Exponential {
                reference_height_m: 0.0,
                scale_height_m: 40.0,
            },
            Profile::Exponential {
                reference_height_m: 7.0,
                scale_height_m: 40.0,
            },
            Profile::Slab { top_height_m: 60.0 },
        ] {
            let density = density(profile, ground_m).unwrap();
            for height_m in [0.0, 3.0, 14.0, 16.0, 59.0, 61.0, 150.0] {
                let (want, got) = (profile.density(height_m), density.at(ground_m + height_m));
                assert!(
                    (got - want).abs() < 1e-12 + 1e-9 * want,
                    "{profile:?} {height_m}: {got} for {want}"
                );
            }
        }
        assert!(density(Profile::Uniform, ground_m).is_err());
    }
}
