//! [`Jump`]: how extinction and light change across a jump of density, such as the top of a layer of dust.

use crate::wavelengths::WAVELENGTHS_NM;
use airlight::atmosphere::{Atmosphere, ConstituentKind};
use airlight::axes;
use airlight::sky::{SplitView, TableCoordinates};
use glam::Vec4;
use std::f64::consts::FRAC_PI_2;

/// What a metre of air does just above a jump of density relative to one just below it, at the four wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// Height above the ground, m.
    pub height_m: f32,
    /// Extinction.
    pub extinction: Vec4,
    /// Light scattered into a ray, other than that of `haze`.
    pub smooth: Vec4,
    /// Light that haze scatters once.
    pub haze: Vec4,
}

impl Jump {
    /// Air without a jump.
    pub const NONE: Self = Self {
        height_m: 0.0,
        extinction: Vec4::ONE,
        smooth: Vec4::ONE,
        haze: Vec4::ONE,
    };
    /// Largest ratio, and the inverse of the smallest.
    const MOST: f32 = 1e4;

    /// The jump that is nearest to the eye of a view. From deep below, light is relative to the extinction alone.
    pub fn nearest(split: &SplitView, coordinates: &TableCoordinates) -> Self {
        /// Distance below a jump from which on the source function hardly changes where a ray leaves the layer, m.
        const DEEP_M: f64 = 1.5e3;
        let (ground_radius_m, _) = split.view().bounds_m();
        let eye_m = split.view().radius_m() - ground_radius_m;
        let Some(height_m) = coordinates.jump_height_m else {
            return Self::NONE;
        };
        let air = split.view().sky().atmosphere();
        let altitude_m = air.planet.ground_altitude_m + height_m;
        let extinction = across(altitude_m, |m, nm| air.extinction_per_m(m, nm));
        let [smooth, haze] = match height_m - eye_m < DEEP_M {
            true => [
                smooth(split, coordinates.horizon_rad, height_m),
                across(altitude_m, |m, nm| haze_scattering_per_m(air, m, nm)),
            ],
            false => [extinction; 2],
        };
        Self {
            height_m: height_m as f32,
            extinction,
            smooth,
            haze,
        }
    }

    /// Whether there is haze on one side of the jump alone.
    pub fn bounds_haze(&self) -> bool {
        self.haze.min_element() <= 1.0 / Self::MOST || self.haze.max_element() >= Self::MOST
    }
}

/// Scattering coefficient of haze at an altitude (m) and a wavelength (nm), 1/m.
fn haze_scattering_per_m(air: &Atmosphere, altitude_m: f64, wavelength_nm: f64) -> f64 {
    let is_haze = |kind: &ConstituentKind| {
        !matches!(kind, ConstituentKind::Molecules | ConstituentKind::Ozone)
    };
    let parts = air.constituents.iter().filter(|part| is_haze(&part.kind));
    parts
        .map(|part| part.density.at(altitude_m) * part.scattering_per_m.at(wavelength_nm))
        .sum()
}

/// Ratio of a quantity by altitude (m) and wavelength (nm) just above an altitude to that just below it.
fn across(altitude_m: f64, quantity: impl Fn(f64, f64) -> f64) -> Vec4 {
    /// Distance from the jump, m.
    const BESIDE_M: f64 = 1e-3;
    let at = |altitude_m: f64| {
        Vec4::from_array(WAVELENGTHS_NM.map(|nm| quantity(altitude_m, nm) as f32))
    };
    ratio(at(altitude_m + BESIDE_M), at(altitude_m - BESIDE_M))
}

/// Ratio of the smooth light that a metre of air scatters above a jump to that below it: the geometric mean along rays on all sides of the
/// eye.
fn smooth(split: &SplitView, horizon_rad: f64, height_m: f64) -> Vec4 {
    /// Thickness of the air on each side, m.
    const SIDE_M: f64 = 50.0;
    /// Angle of the rays above the horizontal, or below the horizon, rad.
    const SLANT_RAD: f64 = 0.2;
    let (ground_radius_m, _) = split.view().bounds_m();
    let (radius_m, jump_m) = (split.view().radius_m(), ground_radius_m + height_m);
    let down_rad = horizon_rad - SLANT_RAD.min(0.5 * (horizon_rad + FRAC_PI_2));
    let is_above = radius_m >= jump_m;
    let [across_rad, away_rad] = match is_above {
        true => [down_rad, SLANT_RAD],
        false => [SLANT_RAD, down_rad],
    };
    // The nearer of the two crossings, without cancellation.
    let b = radius_m * across_rad.sin();
    let power = (radius_m - jump_m) * (radius_m + jump_m);
    let crossing_m = power.abs() / ((b * b - power).sqrt() + b.abs());
    let length_m = SIDE_M / across_rad.sin().abs();
    let beyond = gained(split, across_rad, [crossing_m, crossing_m + length_m]);
    let before = match crossing_m < length_m {
        true => gained(split, away_rad, [0.0, SIDE_M / away_rad.sin().abs()]),
        false => gained(split, across_rad, [crossing_m - length_m, crossing_m]),
    };
    let [above, below] = match is_above {
        true => [before, beyond],
        false => [beyond, before],
    };
    let logarithms = above
        .iter()
        .zip(&below)
        .map(|(a, b)| ratio(*a, *b).map(f32::ln));
    let mean = logarithms.sum::<Vec4>() / AZIMUTHS_DEG.len() as f32;
    mean.map(f32::exp)
}

/// Angles of rays from the azimuth of the sun, degrees.
const AZIMUTHS_DEG: [f64; 5] = [20.0, 60.0, 100.0, 140.0, 180.0];

/// Smooth light that rays of an elevation gain between two distances, by metre of the distance.
fn gained(split: &SplitView, elevation_rad: f64, [from_m, to_m]: [f64; 2]) -> Vec<Vec4> {
    let sun_deg = axes::azimuth_deg(split.view().sun());
    let directions = AZIMUTHS_DEG
        .map(|azimuth_deg| axes::direction(sun_deg + azimuth_deg, elevation_rad.to_degrees()));
    // Up to the eye itself nothing is gained.
    let stops_m: Vec<f64> = [from_m, to_m].into_iter().filter(|m| *m > 0.0).collect();
    let paths = split.paths(&directions, &stops_m);
    let gains = paths.iter().map(|path| {
        let [first, last] = [0, path.len() - 1].map(|k| Vec4::from_slice(&path[k].smooth));
        let from = if path.len() > 1 { first } else { Vec4::ZERO };
        (last - from) / (to_m - from_m) as f32
    });
    gains.collect()
}

/// Ratios of what is not negative: 1 between nothing and nothing.
fn ratio(above: Vec4, below: Vec4) -> Vec4 {
    let lane = |k: usize| match above[k].max(below[k]) > 0.0 {
        true => (above[k].max(0.0) / below[k].max(0.0)).clamp(1.0 / Jump::MOST, Jump::MOST),
        false => 1.0,
    };
    Vec4::from_array(std::array::from_fn(lane))
}

#[cfg(test)]
mod guards {
    use super::Jump;
    use crate::twins::colour::rgb_from_spectrum;
    use crate::{ColourFit, SkyTables, wavelength_grid};
    use airlight::atmosphere::{AerosolMixture, AerosolType, Atmosphere, Ingredient, Preset};
    use airlight::axes;
    use airlight::sky::{Sky, SkySettings, SunCoverage, View};
    use airlight::spectrum::RgbSpace;
    use glam::{Vec3, Vec4};

    /// `average` with desert dust up to 6 km instead of its haze.
    fn desert() -> Atmosphere {
        let mut air = Preset::Average.atmosphere();
        let (ground_m, top_m) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
        let dust = vec![(1.0, Ingredient::Type(AerosolType::Desert))];
        let dust = AerosolMixture::new(dust, 0.8).unwrap();
        let dust = dust.constituent(None, None, air.clear_air(), ground_m, top_m);
        air.put(dust.unwrap());
        air
    }

    /// Errors of the luminance of sky and ground, and of grey walls as bright as the sky, 100 m to 100 km away: root mean square and largest.
    fn errors(view: &View, tables: &SkyTables) -> [[f64; 2]; 2] {
        const COUNT: usize = 400;
        let luminance = |rgb: Vec3| RgbSpace::Srgb.luminance(rgb.to_array().map(f64::from));
        let of =
            |weights, light: &[f32]| luminance(rgb_from_spectrum(weights, Vec4::from_slice(light)));
        let sun_deg = axes::azimuth_deg(view.sun());
        let sky = view.along(axes::direction(sun_deg + 20.0, 30.0), None);
        let wall = of(tables.radiance_weights, &sky.radiance());
        let horizon_deg = view.horizon_elevation_rad().to_degrees();
        let mut all = [[0.0f64; 2]; 2];
        for k in 0..COUNT {
            // Multiples of the powers of a root of x^4 = x + 1 fill a cube evenly.
            let [x, y, z] = [0.819_172_513, 0.671_043_607, 0.549_700_478]
                .map(|step: f64| (k as f64 * step).fract());
            let end_deg = [-90.0, 90.0, 10.0][k % 3];
            let elevation_deg = horizon_deg + (end_deg - horizon_deg) * y * y;
            let direction = axes::direction(360.0 * x, elevation_deg);
            let distance_m = 100.0 * 1e3f64.powf(z);
            let sky = luminance(tables.rgb_radiance(direction.as_vec3()));
            let right_sky = view.along(direction, None).radiance();
            let path = tables.rgb_path(direction.as_vec3(), distance_m as f32);
            let right = view.along(direction, Some(distance_m));
            let behind = luminance(path.path_radiance + path.transmittance * wall as f32);
            let right_behind = of(tables.radiance_weights, &right.path_radiance())
                + wall * of(tables.transmittance_weights, &right.transmittance);
            let right_sky = of(tables.radiance_weights, &right_sky);
            for (of, ratio) in all.iter_mut().zip([sky / right_sky, behind / right_behind]) {
                of[0] += (ratio - 1.0).powi(2) / COUNT as f64;
                of[1] = of[1].max((ratio - 1.0).abs());
            }
        }
        all.map(|[squares, worst]| [100.0 * squares.sqrt(), 100.0 * worst])
    }

    /// Sky and walls seen by eyes below and above the edge of dust, where rays enter and leave it.
    #[test]
    fn light_beside_the_edge_of_dust_is_that_of_the_solver() {
        let air = desert();
        let suns = SunCoverage::near(2.0, 6e3);
        let settings = SkySettings {
            suns,
            ..Default::default()
        };
        let sky = Sky::prepare(&air, &wavelength_grid(), &settings).unwrap();
        let fit = ColourFit::new(&air, suns).unwrap();
        for height_m in [5e3, 5.5e3, 5.99e3, 6.01e3, 6.5e3] {
            let view = sky.view(height_m, axes::direction(200.0, 2.0));
            let split = view.split();
            let jump = Jump::nearest(&split, &view.table_coordinates());
            assert!((jump.height_m - 6e3).abs() < 1.0 && jump.bounds_haze());
            let tables = SkyTables::of(&split, &fit, RgbSpace::Srgb).unwrap();
            let [sky, walls] = errors(&view, &tables);
            println!("eye at {height_m} m, %: sky {sky:.2?}, walls {walls:.2?}");
            assert!(sky[0] < 0.3 && sky[1] < 2.0, "{height_m}: {sky:?}");
            assert!(walls[0] < 0.15 && walls[1] < 1.5, "{height_m}: {walls:?}");
        }
    }
}
