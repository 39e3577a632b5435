//! Descriptions of scenes and formatting of numbers, for metadata and reports.

use airlight::Named;
use airlight::atmosphere::DensityProfile;
use airlight::axes;
use airlight::fog::FogScattering;
use airlight::night::MoonState;
use airlight::scene::FogLayers;

/// Formats a number with 4 significant digits.
pub fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => value.to_string(),
        0.0 => "0".to_owned(),
        s if !(1e-3..1e7).contains(&s) => format!("{value:.3e}"),
        s => {
            let decimals = (3 - s.log10().floor() as i32).clamp(0, 6) as usize;
            format!("{value:.decimals$}")
        }
    }
}

/// Describes a fog: its layers, and orders of scattering unless all are computed.
pub fn fog(fog: &FogLayers) -> String {
    let layers = fog.layers.iter().map(|layer| {
        let extent = match layer.profile {
            DensityProfile::Layer { top_m, .. } => format!("up to {} m", short(top_m)),
            DensityProfile::Clamped {
                base_height_m,
                scale_height_m,
            }
            | DensityProfile::Exponential {
                reference_height_m: base_height_m,
                scale_height_m,
            } => {
                let from = match base_height_m {
                    0.0 => String::new(),
                    base_m => format!(" from {} m", short(base_m)),
                };
                format!("scale height {} m{from}", short(scale_height_m))
            }
            _ => "constant density".to_owned(),
        };
        format!(
            "extinction {} 1/m, {extent}, droplets {} ({})",
            short(layer.extinction_per_m),
            layer.droplets.name(),
            layer.droplets.summary()
        )
    });
    let mut text = layers.collect::<Vec<_>>().join("; ");
    text.push_str(match fog.scattering {
        FogScattering::Single => "; single scattering",
        FogScattering::Undimmed => "; single scattering of unattenuated sunlight",
        _ => "",
    });
    if let Some(patches) = &fog.patches {
        text.push_str(&format!(
            "; patches of strength {}, {} m wide and {} m high, seed {}",
            short(patches.strength),
            short(patches.size_m),
            short(patches.height_m),
            patches.seed
        ));
    }
    text
}

/// Describes a moon: where it is, and how much of it is lit.
pub fn moon(moon: &MoonState) -> String {
    format!(
        "elevation {:.3} deg, azimuth {:.3} deg, {:.0} % lit",
        axes::elevation_deg(moon.direction),
        axes::azimuth_deg(moon.direction),
        100.0 * moon.lit_fraction()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_four_digits() {
        for (value, text) in [
            (0.0, "0"),
            (123_456.7, "123457"),
            (1234.6, "1235"),
            (5.0, "5.000"),
            (-0.012_346, "-0.01235"),
            (1.5e9, "1.500e9"),
            (1e-7, "1.000e-7"),
        ] {
            assert_eq!(short(value), text);
        }
        assert_eq!(short(f64::NAN), "NaN");
    }
}
