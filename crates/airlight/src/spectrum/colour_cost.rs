//! Colour error of the wavelength grids against 1 nm: the measurement behind the table in [`super::grid`].

use super::WavelengthGrid;
use super::difference::{D65_WHITE, ciede2000, xyz_to_lab};
use crate::optics::ozone::{DOBSON_UNIT_M2, cross_section_m2};

/// Solar elevation in degrees and air mass.
const SUNS: [(f64, f64); 3] = [(60.0, 1.15), (10.0, 5.6), (2.0, 19.5)];

fn rayleigh(nm: f64) -> f64 {
    0.0973 * (550.0 / nm).powf(4.08)
}

/// Transmittance of clear air with 300 DU of ozone and a little haze.
fn direct(nm: f64, air_mass: f64) -> f64 {
    let haze = 0.1 * (nm / 550.0).powf(-1.3);
    let ozone = 300.0 * DOBSON_UNIT_M2 * cross_section_m2(nm);
    (-air_mass * (rayleigh(nm) + haze + ozone)).exp()
}

/// Singly scattered sky radiance at the ground, up to a constant factor.
fn sky(nm: f64, air_mass: f64) -> f64 {
    rayleigh(nm) * direct(nm, air_mass)
}

fn xyz(grid: &WavelengthGrid, response: impl Fn(f64) -> f64) -> [f64; 3] {
    let spectral: Vec<f32> = grid
        .wavelengths_nm()
        .iter()
        .zip(grid.solar_irradiance())
        .map(|(&nm, e)| (e * response(nm)) as f32)
        .collect();
    grid.to_xyz(&spectral)
}

/// CIEDE2000 of `grid` against 1 nm; both scaled so that the 1 nm colour has Y = 100, under white D65.
fn cost(grid: &WavelengthGrid, fine: &WavelengthGrid, response: impl Fn(f64) -> f64) -> f64 {
    let want = xyz(fine, &response);
    let lab = |xyz: [f64; 3]| xyz_to_lab(xyz.map(|v| v * 100.0 / want[1]), D65_WHITE);
    ciede2000(lab(xyz(grid, &response)), lab(want))
}

/// Also prints the book's table (shown with `--nocapture`).
#[test]
fn colour_errors_of_named_grids_stay_within_bounds() {
    let fine = WavelengthGrid::one_nanometre();
    println!("\n| grid | sun at 60° | 10° | 2° |\n|---|---|---|---|");
    // The measured error plus a quarter; the requirement on the standard grid is 0.5.
    for (name, bound) in [
        ("standard", 0.06),
        ("fast", 0.085),
        ("fine", 0.002),
        ("rgb", 12.2),
    ] {
        let grid = name.parse::<WavelengthGrid>().unwrap();
        let mut cells = String::new();
        for (elevation, air_mass) in SUNS {
            let sun = cost(&grid, &fine, |nm| direct(nm, air_mass));
            let sky = cost(&grid, &fine, |nm| sky(nm, air_mass));
            let digits = if sun < 1.0 { 3 } else { 1 };
            cells += &format!(" {sun:.digits$}, {sky:.digits$} |");
            assert!(sun.max(sky) < bound, "{name} {elevation} {sun} {sky}");
        }
        println!("| `{name}` |{cells}");
    }
}

#[test]
fn standard_grid_keeps_colour_over_ozone_haze_and_air_mass() {
    let fine = WavelengthGrid::one_nanometre();
    let grid = WavelengthGrid::standard();
    let mut worst: f64 = 0.0;
    for dobson in [0.0, 200.0, 300.0, 500.0] {
        for haze in [0.0, 0.05, 0.3] {
            for air_mass in [1.0, 3.0, 8.0, 19.5] {
                let light = |nm: f64| {
                    let ozone = dobson * DOBSON_UNIT_M2 * cross_section_m2(nm);
                    let haze = haze * (nm / 550.0).powf(-1.0);
                    (-air_mass * (rayleigh(nm) + haze + ozone)).exp()
                };
                worst = worst.max(cost(&grid, &fine, light));
                worst = worst.max(cost(&grid, &fine, |nm| light(nm) * rayleigh(nm)));
                worst = worst.max(cost(&grid, &fine, |nm| 1.0 - light(nm)));
            }
        }
    }
    println!("worst {worst:.3}");
    assert!(worst < 0.1, "{worst}");
}
