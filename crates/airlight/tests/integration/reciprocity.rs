//! Reciprocity: plane-parallel air that is lit from one direction and seen along another sends as much light, relative to the
//! irradiance of the horizontal, when the two are exchanged (Chandrasekhar 1960, section 13).

use crate::common::{Slab, scalar_settings};
use crate::properties::draw::Draw;
use airlight::atmosphere::{Atmosphere, presets};
use airlight::axes::direction;
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;
use std::ops::Range;

/// Two directions above the horizon, and the sky under a sun in each.
struct Exchange([(DVec3, Sky); 2]);

impl Exchange {
    /// Random directions 10 to 85 degrees above the horizon; `solved` is the sky under a sun at an elevation in degrees.
    fn new(draw: &mut Draw, solved: impl Fn(f64) -> Sky) -> Self {
        let azimuths = [0.0, draw.between(0.0, 180.0)];
        Self(azimuths.map(|azimuth| {
            let elevation = draw.between(10.0, 85.0);
            (direction(azimuth, elevation), solved(elevation))
        }))
    }

    /// Relative differences of the radiance at each wavelength when the directions to the sun and to the eye are exchanged; `radiance`
    /// takes a sky and both.
    fn differences(&self, radiance: impl Fn(&Sky, DVec3, DVec3) -> Vec<f32>) -> Vec<f64> {
        let [a, b] = &self.0;
        let sent = |(lit, sky): &(DVec3, Sky), (seen, _): &(DVec3, Sky)| {
            let sent = radiance(sky, *lit, *seen).into_iter();
            sent.map(|radiance| f64::from(radiance) / lit.y)
                .collect::<Vec<f64>>()
        };
        let pairs = sent(a, b).into_iter().zip(sent(b, a));
        pairs
            .map(|(there, back)| (back / there - 1.0).abs())
            .collect()
    }

    /// That of light sent up from the top of the air.
    fn of_reflection(&self) -> Vec<f64> {
        self.differences(|sky, sun, eye| {
            let top_m = sky.atmosphere().planet.top_altitude_m;
            sky.view(top_m, sun).along(-eye, None).radiance()
        })
    }

    /// That of light sent down to the ground: reciprocal where the air is the same upside down and the ground is black.
    fn of_transmission(&self) -> Vec<f64> {
        self.differences(|sky, sun, eye| sky.view(0.0, sun).along(eye, None).path_radiance())
    }
}

/// Asserts the limits of the median, the 95th percentile and the largest of relative differences, percent.
fn assert_reciprocal(what: &str, mut differences: Vec<f64>, limits: [f64; 3]) {
    differences.sort_by(f64::total_cmp);
    let last = differences.len() - 1;
    let found =
        [0.5, 0.95, 1.0].map(|share| 100.0 * differences[(share * last as f64).round() as usize]);
    println!(
        "{what}, {}: median {:.3} %, 95th percentile {:.3} %, largest {:.3} %",
        last + 1,
        found[0],
        found[1],
        found[2]
    );
    let within = found
        .iter()
        .zip(limits)
        .all(|(found, limit)| *found < limit);
    assert!(within, "{what}: {found:?} % against {limits:?}");
}

/// Random slabs, seen from above and, over black ground, from below.
fn check_slabs(seeds: Range<u64>) {
    let (mut reflection, mut transmission) = (Vec::new(), Vec::new());
    for seed in seeds {
        let mut draw = Draw::new(seed);
        let slab = Slab {
            depth: draw.scale(0.1, 50.0),
            single_scattering_albedo: draw.pick(&[1.0, 0.99, 0.9]),
            asymmetry: draw.between(-0.3, 0.85),
            ground_albedo: draw.pick(&[0.0, 0.0, 0.3, 1.0]),
        };
        let exchange = Exchange::new(&mut draw, |elevation_deg| {
            slab.sky(elevation_deg, SkySettings::default()).unwrap()
        });
        reflection.extend(exchange.of_reflection());
        if slab.ground_albedo == 0.0 {
            transmission.extend(exchange.of_transmission());
        }
    }
    assert_reciprocal("reflection by slabs", reflection, [0.1, 0.3, 0.6]);
    assert_reciprocal("transmission by slabs", transmission, [0.1, 0.6, 1.0]);
}

/// The air of the Earth at 440, 550 and 680 nm on a planet a thousand times as large, where it is plane-parallel.
fn check_air(name: &str, air: &Atmosphere, seeds: Range<u64>) {
    let mut air = air.clone();
    air.planet.radius_m *= 1e3;
    let grid = WavelengthGrid::from_wavelengths_nm(vec![440.0, 550.0, 680.0]).unwrap();
    let solved = |elevation_deg| {
        let settings = scalar_settings(SunCoverage::near(elevation_deg, 0.0));
        Sky::prepare(&air, &grid, &settings).unwrap()
    };
    let exchanges = seeds.map(|seed| Exchange::new(&mut Draw::new(seed), solved));
    let differences = exchanges
        .flat_map(|exchange| exchange.of_reflection())
        .collect();
    assert_reciprocal(name, differences, [0.1, 0.4, 0.6]);
}

fn desert() -> Atmosphere {
    Atmosphere::from_toml("aerosol = { type = \"desert\", aod_550 = 0.5 }").unwrap()
}

#[test]
fn slabs_are_reciprocal() {
    check_slabs(0..16);
}

#[test]
fn skies_are_reciprocal() {
    check_air("desert", &desert(), 0..4);
}

#[test]
#[ignore = "takes a minute: prints the errors that the book states"]
fn many_airs_are_reciprocal() {
    check_slabs(0..60);
    for (name, air) in [
        ("clear", presets::preset("clear").unwrap()),
        ("hazy", presets::preset("hazy").unwrap()),
        ("desert", desert()),
        ("wildfire", presets::wildfire()),
    ] {
        check_air(name, &air, 0..10);
    }
}
