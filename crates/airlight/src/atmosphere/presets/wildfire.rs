//! The Earth under smoke.

use super::earth::{EARTH_TOP_M, Earth};
use crate::atmosphere::aerosol::AerosolLoad;
use crate::atmosphere::aerosol_types::{AerosolMixture, AerosolType, Smoke};
use crate::atmosphere::{Atmosphere, DensityProfile};

/// Height of the top of the smoke of [`wildfire`], m.
const SMOKE_TOP_M: f64 = 3750.0;

/// Under the smoke of forest fires.
///
/// - Smoke: sizes and refractive index of the smoke of boreal forest ([`Smoke::Boreal`]), optical depth 4 at 550 nm. In
///   August 2010 the smoke over Moscow often had more than 4 (van Donkelaar et al., Atmos. Environ. 45, 6225, 2011), and
///   up to 6.4 at 500 nm (Chubarova et al., Atmos. Meas. Tech. 5, 557, 2012).
/// - Height: uniform up to 3750 m, the middle of the tops of uniform smoke layers, 1.6 to 5.9 km, that a lidar in space
///   saw over fires in eastern Europe (Amiridis et al., Atmos. Chem. Phys. 10, 11567, 2010).
/// - Gases, ground and sun: those of the other Earths.
pub fn wildfire() -> Atmosphere {
    let mut atmosphere = Earth::with_aerosol(0.0).gases("wildfire");
    let smoke = AerosolMixture::of(
        AerosolType::Biomass(Smoke::Boreal),
        AerosolMixture::USUAL_HUMIDITY,
    )
    .and_then(|smoke| {
        let load = Some(AerosolLoad::OpticalDepth550(4.0));
        let layer = Some(DensityProfile::slab(SMOKE_TOP_M));
        smoke.constituent(load, layer, atmosphere.clear_air(), 0.0, EARTH_TOP_M)
    })
    .expect("constant parameters are valid");
    atmosphere.constituents.push(smoke);
    atmosphere
}
