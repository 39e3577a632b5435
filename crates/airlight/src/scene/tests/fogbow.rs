//! Fogbow and glory, seen from above the fog with the sun behind.

use crate::atmosphere::{Constituent, presets};
use crate::axes::direction;
use crate::control::Control;
use crate::fog::{DensityProfile, FogScattering};
use crate::optics::mie::droplets::Drops;
use crate::scene::foggy::FoggySky;
use crate::scene::lane_channels::LaneChannels;
use crate::sky::{Sky, SkySettings, SunCoverage};
use crate::spectrum::{RgbSpace, WavelengthGrid};
use std::sync::LazyLock;

const SUN_DEG: f64 = 32.0;
const EYE_M: f64 = 150.0;
const EXTINCTION_PER_M: f64 = 0.03;
const PROFILE: DensityProfile = DensityProfile::slab(100.0);

type Seen = Result<Vec<[[f64; 3]; 2]>, Box<dyn std::error::Error>>;

/// Linear sRGB at angles below the antisolar point (degrees), computed in RGB and spectrally.
fn seen(drops: Drops, angles: &[f64]) -> Seen {
    let settings = SkySettings {
        suns: SunCoverage::near(SUN_DEG, EYE_M),
        ..Default::default()
    };
    let air = presets::preset("average").unwrap();
    let sky = Sky::prepare(&air, &WavelengthGrid::standard(), &settings).unwrap();
    let view = sky.view(EYE_M, direction(180.0, SUN_DEG));
    let ground = FoggySky::<3>::round_ground(&view);
    let space = RgbSpace::Srgb;
    let nm = sky.grid().wavelengths_nm();
    let layers = [Constituent::fog(
        EXTINCTION_PER_M,
        drops.into(),
        PROFILE,
        nm,
    )?];
    let many = FogScattering::Multiple;
    let (channels, control) = (LaneChannels::Rgb(space), Control::default());
    let rgb = FoggySky::new(&view, channels, &layers, ground, many, control)?;
    let spectral = FoggySky::<16>::spectral(&view, &layers, ground, many, control)?;
    assert_eq!(spectral.len(), 1);
    let look = |&angle: &f64| {
        let towards = direction(0.0, -SUN_DEG - angle);
        let few = rgb.sky(towards).0.map(f64::from);
        let all = sky.grid().to_xyz(&spectral[0].sky(towards).0);
        [few, space.from_xyz(all)]
    };
    Ok(angles.iter().map(look).collect())
}

/// [`seen`] for moderate advection fog, in steps of one degree.
fn moderate() -> &'static [[[f64; 3]; 2]] {
    static SEEN: LazyLock<Vec<[[f64; 3]; 2]>> = LazyLock::new(|| {
        let angles: Vec<f64> = (0..=58).map(f64::from).collect();
        seen(Drops::ModerateAdvectionFog, &angles).unwrap()
    });
    &SEEN
}

/// The fogbow is nearly white and brightest at 36 to 41 degrees from the antisolar point, which has a glory.
#[test]
fn fog_has_a_fogbow_and_a_glory() {
    let seen = moderate();
    let green = |degrees: usize| seen[degrees][1][1];
    let bow = (30..50)
        .max_by(|&a, &b| green(a).total_cmp(&green(b)))
        .unwrap();
    let over = |a: usize, b: usize| green(a) / green(b);
    let [inside, outside, glory] = [over(bow, 28), over(bow, 50), over(0, 8)];
    println!(
        "bow at {bow} degrees: {inside:.2} of inside, {outside:.2} of outside; glory {glory:.2}"
    );
    assert!((36..=41).contains(&bow), "{bow}");
    assert!(inside > 1.1 && outside > 1.4 && glory > 1.5);
    for (degrees, [_, all]) in seen.iter().enumerate() {
        for channel in 0..3 {
            // Colour relative to that between fogbow and glory.
            let tint = all[channel] / all[1] * seen[20][1][1] / seen[20][1][channel];
            assert!((0.8..1.25).contains(&tint), "{degrees} {channel}: {tint}");
        }
    }
}

mod guards {
    use super::*;

    #[test]
    fn rgb_matches_16_wavelengths() {
        let errors = moderate()
            .iter()
            .flat_map(|[few, all]| (0..3).map(|channel| (few[channel] / all[channel] - 1.0).abs()));
        let worst = errors.fold(0.0, f64::max);
        println!("RGB against 16 wavelengths, worst: {:.2} %", 100.0 * worst);
        assert!(worst < 0.04, "{worst}");
    }
}
