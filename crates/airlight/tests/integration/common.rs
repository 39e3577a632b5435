//! Skies and fog that several tests look at.

use airlight::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, presets};
use airlight::fog::{DirectionalLight, Fog, FogLighting, FogScattering, Ground};
use airlight::optics::PhaseFunction;
use airlight::sky::{LineOfSight, Sky, SkyError, SkySettings, SunCoverage, View};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use airlight::transfer::RgbPathOptics;
use glam::{DQuat, DVec3};

/// The sky of a preset in red, green and blue.
pub fn sky(preset: &str, suns: SunCoverage) -> Sky {
    sky_of(&presets::preset(preset).unwrap(), suns)
}

/// The sky of an air in red, green and blue.
pub fn sky_of(air: &Atmosphere, suns: SunCoverage) -> Sky {
    let settings = SkySettings {
        suns,
        ..Default::default()
    };
    Sky::prepare(air, &WavelengthGrid::rgb(), &settings).unwrap()
}

/// Height of the top of a [`Slab`], m.
pub const SLAB_TOP_M: f64 = 1000.0;

/// A uniform layer of the Earth's air, 1 km high, under a sun of unit irradiance.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    pub depth: f64,
    pub single_scattering_albedo: f64,
    pub asymmetry: f64,
    pub ground_albedo: f64,
}

impl Slab {
    pub fn sky(&self, sun_elevation_deg: f64, settings: SkySettings) -> Result<Sky, SkyError> {
        let mut air = Atmosphere::from_toml("base = \"none\"").unwrap();
        air.planet.top_altitude_m = SLAB_TOP_M;
        air.planet.ground_albedo = SpectralCurve::Constant(self.ground_albedo);
        air.solar_irradiance = SpectralCurve::Constant(1.0);
        air.constituents = vec![grey_layer(
            DensityProfile::slab(2.0 * SLAB_TOP_M),
            self.depth / SLAB_TOP_M,
            self.single_scattering_albedo,
            PhaseFunction::HenyeyGreenstein { g: self.asymmetry },
        )];
        let settings = SkySettings {
            suns: SunCoverage::near(sun_elevation_deg, 0.0),
            ..settings
        };
        let grid = WavelengthGrid::from_wavelengths_nm(vec![550.0]).unwrap();
        Sky::prepare(&air, &grid, &settings)
    }
}

/// Settings for scalar light, as paths of light without polarisation have it.
pub fn scalar_settings(suns: SunCoverage) -> SkySettings {
    SkySettings {
        suns,
        polarisation_correction: false,
        ..Default::default()
    }
}

/// Path optics at the three wavelengths of a sky over `length_m`, along the whole line and joined from two parts.
pub fn whole_and_joined(
    near_view: &View,
    eye: DVec3,
    split_m: f64,
    length_m: f64,
) -> (RgbPathOptics, RgbPathOptics) {
    let optics = |line: &LineOfSight| RgbPathOptics {
        transmittance: line.transmittance.as_slice().try_into().unwrap(),
        path_radiance: line.path_radiance().try_into().unwrap(),
    };
    let whole = optics(&near_view.along(eye, Some(length_m)));
    let near = optics(&near_view.along(eye, Some(split_m)));
    // The place of the split, turned so that its zenith is up.
    let place = DVec3::Y * near_view.radius_m() + eye * split_m;
    let turn = DQuat::from_rotation_arc(place.normalize(), DVec3::Y);
    let sky = near_view.sky();
    let altitude = place.length() - sky.atmosphere().planet.radius_m;
    let far_view = sky.view(altitude, turn * near_view.sun());
    let far = optics(&far_view.along(turn * eye, Some(length_m - split_m)));
    (whole, near.then(far))
}

/// The wavelength of fog at one wavelength, nm.
pub const GREEN_NM: f64 = 550.0;

/// A layer of the same extinction (1/m) and single-scattering albedo at all wavelengths.
pub fn grey_layer(
    density: DensityProfile,
    extinction_per_m: f64,
    albedo: f64,
    phase: PhaseFunction,
) -> Constituent {
    Constituent {
        kind: ConstituentKind::Fog,
        density,
        scattering_per_m: SpectralCurve::Constant(extinction_per_m * albedo),
        absorption_per_m: SpectralCurve::Constant(extinction_per_m * (1.0 - albedo)),
        phase,
    }
}

/// A layer of fog at one wavelength under a sun of unit irradiance, or else a uniform sky of unit radiance.
pub fn green_fog(
    layer: Constituent,
    ground: Ground,
    sun: Option<DVec3>,
    ground_albedo: f64,
    scattering: FogScattering,
) -> Fog {
    let ambient = if sun.is_some() { 0.0 } else { 1.0 };
    let lighting = FogLighting {
        sun: sun.map(|direction| DirectionalLight {
            direction,
            irradiance: SpectralCurve::Constant(1.0),
        }),
        ambient: SpectralCurve::Constant(ambient),
        ground_albedo: SpectralCurve::Constant(ground_albedo),
    };
    let grid = WavelengthGrid::from_wavelengths_nm(vec![GREEN_NM]).unwrap();
    Fog::new(&[layer], ground, &lighting, scattering, &grid).unwrap()
}

/// Transmittance and path radiance of fog at one wavelength.
pub fn green_path(fog: &Fog, eye_height_m: f64, view: DVec3, distance_m: f64) -> [f64; 2] {
    let (mut transmittance, mut path_radiance) = ([0.0], [0.0]);
    fog.path(
        eye_height_m,
        view,
        distance_m,
        &mut transmittance,
        &mut path_radiance,
    );
    [transmittance[0], path_radiance[0]].map(f64::from)
}

/// Rows of a CSV table without comments and header.
pub fn rows(table: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').collect())
}

/// Rows of a CSV table of numbers.
pub fn numbers<const N: usize>(table: &'static str) -> impl Iterator<Item = [f64; N]> {
    rows(table).map(|row| std::array::from_fn(|column| row[column].parse().unwrap()))
}
