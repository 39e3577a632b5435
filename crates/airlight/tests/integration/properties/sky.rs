//! Views of prepared skies from random places under random suns.

use super::draw::Draw;
use super::{Failure, equal, light, transmittance};
use crate::common::grey_layer;
use airlight::atmosphere::{Atmosphere, presets};
use airlight::axes;
use airlight::sky::{LineOfSight, Sky, SkySettings, SunCoverage, TableChannels};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use airlight::transfer::RgbPathOptics;
use glam::{DQuat, DVec3};
use std::sync::LazyLock;

/// Rays looked at in one view.
const RAYS: usize = 20;

/// A cut air with an absorber below and a thin layer just below the top.
const LAYERED: &str = r#"
    base = "clear"
    planet.top_altitude_m = 40e3

    [[constituent]]
    name = "smoke"
    density = { kind = "exponential", scale_height_m = 150 }
    absorption_per_m = 1e-3

    [[constituent]]
    name = "cirrus"
    density = { kind = "layer", bottom_m = 39.8e3, top_m = 39.9e3 }
    scattering_per_m = 2e-5
    phase = { kind = "henyey-greenstein", g = 0.7 }
"#;

/// A prepared sky and the elevations of its suns, degrees.
pub struct Prepared {
    sky: Sky,
    suns_deg: [f64; 2],
    /// Relative error of path radiance joined from parts.
    of_parts: f32,
}

/// Skies that the properties are checked in, prepared once.
static SKIES: LazyLock<Vec<Prepared>> = LazyLock::new(|| {
    let prepare = |air: &Atmosphere, suns, suns_deg, of_parts| {
        let settings = SkySettings {
            suns,
            altitudes: 12,
            ..Default::default()
        };
        Prepared {
            sky: Sky::prepare(air, &WavelengthGrid::rgb(), &settings).unwrap(),
            suns_deg,
            of_parts,
        }
    };
    let preset = |name| presets::preset(name).unwrap();
    let mut skies = vec![
        prepare(
            &preset("hazy"),
            SunCoverage::near(4.0, 0.0),
            [-4.0, 90.0],
            0.03,
        ),
        prepare(
            &preset("mars"),
            SunCoverage::near(50.0, 0.0),
            [30.0, 90.0],
            0.03,
        ),
        prepare(
            &Atmosphere::from_toml(LAYERED).unwrap(),
            SunCoverage::near(1.0, 0.0),
            [-3.0, 5.0],
            0.03,
        ),
    ];
    skies.extend((0..RANDOM_AIRS).map(|number| {
        let mut draw = Draw::new(number);
        let air = random_air(&mut draw);
        let sun_deg = draw.pick(&[60.0, 20.0, 5.0, 0.0, -5.0]);
        let suns = SunCoverage::near(sun_deg, 0.0);
        let suns_deg = [sun_deg - 2.0, (sun_deg + 2.0).min(90.0)];
        // Under a sun at the horizon, light in thick haze changes by more than the grid of suns resolves: of 1e3 rays 999 are within
        // 10 %, the worst is off by 80 %.
        let of_parts = if sun_deg.abs() < 5.0 { 1.0 } else { 0.1 };
        prepare(&air, suns, suns_deg, of_parts)
    }));
    skies
});

/// Number of random airs among the skies.
const RANDOM_AIRS: u64 = 12;

/// Air of the Earth or none, with constituents of any profile, each of an optical depth of up to 2: at most six in all.
fn random_air(draw: &mut Draw) -> Atmosphere {
    let base = draw.pick(&["clear", "none"]);
    let mut air = Atmosphere::from_toml(&format!("base = \"{base}\"")).unwrap();
    air.planet.ground_albedo = SpectralCurve::Constant(draw.pick(&[0.0, 0.2, 0.9]));
    let top_m = air.planet.top_altitude_m;
    while air.constituents.is_empty() || draw.chance(0.6) && air.constituents.len() < 6 {
        let density = draw.density();
        let column_m = density.column_m(air.planet.ground_altitude_m, top_m);
        let depth = draw.scale(1e-3, 2.0);
        let albedo = draw.pick(&[1.0, 0.9, 0.5, 0.0]);
        let phase = draw.phase();
        if column_m > 0.0 && (depth / column_m).is_finite() {
            let layer = grey_layer(density, depth / column_m, albedo, phase);
            air.constituents.push(layer);
        }
    }
    air.name = format!("random air {:?}", air.constituents.last().unwrap().density);
    air
}

fn lists(line: &LineOfSight) -> Result<(), Failure> {
    transmittance(&line.transmittance)?;
    light("single", &line.single)?;
    light("multiple", &line.multiple)?;
    light("ground", &line.ground)
}

fn optics(line: &LineOfSight) -> RgbPathOptics {
    RgbPathOptics {
        transmittance: line.transmittance.as_slice().try_into().unwrap(),
        path_radiance: line.path_radiance().try_into().unwrap(),
    }
}

/// One view.
pub fn view(draw: &mut Draw) -> Result<(), Failure> {
    let Prepared {
        sky,
        suns_deg,
        of_parts,
    } = &SKIES[draw.below(SKIES.len())];
    let planet = &sky.atmosphere().planet;
    let altitude_m = match draw.below(5) {
        0 => planet.top_altitude_m,
        1 => planet.top_altitude_m - draw.scale(1e-3, 5e3),
        2 => planet.ground_altitude_m + draw.scale(1e-3, 1e3),
        3 => planet.top_altitude_m + draw.scale(1e-3, 1e7),
        _ => draw.between(planet.ground_altitude_m, planet.top_altitude_m),
    };
    let sun = axes::direction(180.0, draw.between(suns_deg[0], suns_deg[1]));
    let view = sky.view(altitude_m, sun);
    let name = &sky.atmosphere().name;
    let place = format!("{name} from {altitude_m} m, sun {sun}");
    let sunlight = view.sun_irradiance();
    light("sunlight", &sunlight).map_err(|f| format!("{f}\n    {place}"))?;
    if draw.chance(0.02) {
        let irradiance = view.table(TableChannels::Spectral).irradiance(DVec3::Y);
        light("irradiance by the sky", &irradiance).map_err(|f| format!("{f}\n    {place}"))?;
    }
    for _ in 0..RAYS {
        let direction = draw.direction();
        let length_m = draw.scale(1.0, 3e5);
        let part = draw.unit();
        let checked = || {
            lists(&view.along(direction, None))?;
            transmittance(&view.transmittance_to_space(direction))?;
            let line = view.along(direction, Some(length_m));
            lists(&line)?;
            // From the far end back, and from a point between: turned so that the zenith there is up.
            let seen_from = |at_m: f64, toward: DVec3, length_m: f64| {
                let point = DVec3::Y * view.radius_m() + direction * at_m;
                let turn = DQuat::from_rotation_arc(point.normalize(), DVec3::Y);
                let there = sky.view(point.length() - planet.radius_m, turn * sun);
                there.along(turn * toward, Some(length_m))
            };
            if line.meets_ground {
                return Ok(());
            }
            let back = seen_from(length_m, -direction, length_m);
            equal(
                "transmittance back",
                &back.transmittance,
                &line.transmittance,
                1e-5,
                1e-6,
            )?;
            let near = view.along(direction, Some(part * length_m));
            let far = seen_from(part * length_m, direction, (1.0 - part) * length_m);
            let (joined, whole) = (optics(&near).then(optics(&far)), optics(&line));
            equal(
                "transmittance of parts",
                &joined.transmittance,
                &whole.transmittance,
                1e-5,
                1e-6,
            )?;
            // The field is interpolated between suns, which differ along the ray: in the airs that are not random, of 1e3 rays 999 are
            // within 0.4 %; the worst, through a thin layer in twilight, are off by 2.7 %.
            equal(
                "path radiance of parts",
                &joined.path_radiance,
                &whole.path_radiance,
                *of_parts,
                1e-7,
            )
        };
        checked().map_err(|f: Failure| {
            format!("{f}\n    {place}, along {direction}, {length_m} m, split at {part}")
        })?;
    }
    Ok(())
}
