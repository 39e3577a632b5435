//! Constants of the article, as printed. Red, green, blue; SI units.

use std::f64::consts::TAU;

/// Scale height of molecules and of the article's ozone, m.
pub const RAYLEIGH_SCALE_HEIGHT_M: f64 = 8000.0;
/// Scale height of haze, m.
pub const MIE_SCALE_HEIGHT_M: f64 = 1200.0;
/// Molecular scattering at sea level in 1e-6 per m.
pub const RAYLEIGH_PER_MEGAMETRE: [f64; 3] = [5.8, 13.5, 33.1];
/// Scattering by haze at sea level in 1e-6 per m.
pub const MIE_PER_MEGAMETRE: f64 = 21.0;
/// Ratio of extinction to scattering of haze.
pub const MIE_EXTINCTION: f64 = 1.11;
/// Mean cosine of haze.
pub const MIE_G: f64 = 0.76;
/// Absorption by ozone at sea level in 0.06e-5 per m.
pub const OZONE: [f64; 3] = [3.426, 8.298, 0.356];
/// Radius of the planet, m.
pub const PLANET_RADIUS_M: f64 = 6360e3;
/// Radius of the top of the air, m.
pub const TOP_RADIUS_M: f64 = 6420e3;
/// Altitude of the article's eye, m.
pub const EYE_ALTITUDE_M: f64 = 1.0;
/// Number of steps along each ray in the article.
pub const STEPS: usize = 8;
/// Angular diameter of the sun's disc, degrees.
pub const SUN_WIDTH_DEG: f64 = 0.53;
/// Start and end of the disc's smooth edge, in radii.
pub const SUN_EDGE: [f64; 2] = [0.95, 1.05];
/// Illuminance on the ground from a sun at the zenith, lx.
pub const ZENITH_ILLUMINANCE_LX: f64 = 120_000.0;
/// The article's illuminance for renderers with a limited range: a Lambertian surface of albedo 0.5 then has radiance 1.
pub const UNIT_ILLUMINANCE: f64 = TAU;
