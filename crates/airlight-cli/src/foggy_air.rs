//! Fog as a constituent of the air, for Monte Carlo.

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
    /// The constituent over a ground at an altitude (m), known at wavelengths (nm, rising).
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
        let profile = self.profile.raised(ground_m).ok_or_else(endless)?;
        let (extinction, droplets) = (self.extinction_per_m, self.droplets);
        Ok(Constituent::fog(
            extinction,
            droplets,
            profile,
            wavelengths_nm,
        )?)
    }
}
