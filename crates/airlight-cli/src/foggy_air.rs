//! Fog of the options as a constituent of the air.

use crate::error::CliError;
use airlight::atmosphere::{Constituent, DensityProfile};
use airlight::fog::droplets::DropletKind;

/// A layer of fog before its optics are computed.
#[derive(Clone, Debug, PartialEq)]
pub struct FogInAir {
    /// How it thins; heights are from the ground.
    pub profile: DensityProfile,
    /// Its drops.
    pub droplets: DropletKind,
    /// Extinction at density 1 at 550 nm, 1/m.
    pub extinction_per_m: f64,
}

impl FogInAir {
    /// The constituent, known at wavelengths (nm, rising), with heights from the ground.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is refused.
    pub fn layer(&self, wavelengths_nm: &[f64]) -> Result<Constituent, CliError> {
        let (extinction, density) = (self.extinction_per_m, self.profile.clone());
        Ok(Constituent::fog(
            extinction,
            self.droplets,
            density,
            wavelengths_nm,
        )?)
    }

    /// The constituent over a ground at an altitude (m), for Monte Carlo.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that has no upper end or is refused.
    pub fn constituent(
        &self,
        ground_m: f64,
        wavelengths_nm: &[f64],
    ) -> Result<Constituent, CliError> {
        let endless =
            || CliError::usage("fog that random paths go through has a top or a scale height");
        if self.profile.is_uniform() {
            return Err(endless());
        }
        self.profile
            .validate()
            .map_err(|error| CliError::usage(format!("the fog: {error}")))?;
        let layer = self.layer(wavelengths_nm)?;
        layer.raised(ground_m).ok_or_else(endless)
    }
}
