//! Time to prepare and draw a sky: `cargo bench -p airlight --bench sky`.
//!
//! The picture is the one of the README: 2048 x 1024 directions of the whole sphere, linear sRGB, at the wavelengths of pictures (the grid
//! `fast`) but where another grid is named.

use airlight::atmosphere::{Atmosphere, presets};
use airlight::axes::direction;
use airlight::sky::{Scattering, Sky, SkySettings, SkyTable, SunCoverage, TableChannels, View};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use divan::{Bencher, black_box};
use rayon::prelude::*;

const WIDTH: usize = 2048;
const HEIGHT: usize = 1024;
const RGB: TableChannels = TableChannels::Rgb(RgbSpace::Srgb);

fn main() {
    divan::main();
}

fn air() -> Atmosphere {
    presets::preset("average").expect("a preset")
}

fn prepare(grid: &WavelengthGrid, suns: SunCoverage, scattering: Scattering) -> Sky {
    let settings = SkySettings {
        suns,
        scattering,
        ..Default::default()
    };
    Sky::prepare(&air(), grid, &settings).expect("a sky")
}

/// The sky of a picture.
fn solved(elevation_deg: f64) -> Sky {
    let suns = SunCoverage::near(elevation_deg, 0.0);
    prepare(&WavelengthGrid::fast(), suns, Scattering::All)
}

/// The sky at 16 wavelengths.
fn standard(elevation_deg: f64) -> Sky {
    let suns = SunCoverage::near(elevation_deg, 0.0);
    prepare(&WavelengthGrid::standard(), suns, Scattering::All)
}

fn view(sky: &Sky, elevation_deg: f64) -> View {
    sky.view(2.0, direction(180.0, elevation_deg))
}

/// Draws every pixel of the panorama by rows of equal elevation.
fn draw(table: &SkyTable, picture: &mut [f32]) {
    let azimuths =
        (0..WIDTH).map(|x| ((x as f64 + 0.5) / WIDTH as f64 * 360.0 - 180.0).to_radians());
    let columns = table.columns(azimuths);
    picture
        .par_chunks_mut(3 * WIDTH)
        .enumerate()
        .for_each(|(y, row)| {
            let elevation_deg = 90.0 - (y as f64 + 0.5) / HEIGHT as f64 * 180.0;
            table.sample_row(elevation_deg.to_radians(), &columns, row);
        });
}

/// From scratch to the whole picture in memory, at an elevation of the sun (degrees).
#[divan::bench(args = [60.0, 10.0, 2.0, -4.0, -10.0], sample_count = 10)]
fn panorama_from_scratch(bencher: Bencher, elevation_deg: f64) {
    bencher.bench(|| panorama(&solved(elevation_deg), elevation_deg));
}

/// The same at 16 wavelengths.
#[divan::bench(args = [60.0, 10.0, 2.0, -4.0, -10.0], sample_count = 10)]
fn panorama_of_16_wavelengths(bencher: Bencher, elevation_deg: f64) {
    bencher.bench(|| panorama(&standard(elevation_deg), elevation_deg));
}

fn panorama(sky: &Sky, elevation_deg: f64) -> Vec<f32> {
    let mut picture = vec![0.0f32; 3 * WIDTH * HEIGHT];
    draw(&view(sky, elevation_deg).table(RGB), &mut picture);
    picture
}

#[divan::bench(args = ["rgb", "fast", "standard", "fine"], sample_count = 5)]
fn solve_one_sun(bencher: Bencher, grid: &str) {
    let grid = grid.parse::<WavelengthGrid>().expect("a grid");
    bencher.bench(|| prepare(&grid, SunCoverage::near(30.0, 0.0), Scattering::All));
}

#[divan::bench(args = ["fast", "standard"], sample_count = 3)]
fn solve_all_suns(bencher: Bencher, grid: &str) {
    let grid = grid.parse::<WavelengthGrid>().expect("a grid");
    bencher.bench(|| prepare(&grid, SunCoverage::All, Scattering::All));
}

#[divan::bench(sample_count = 5)]
fn solve_single_scattering(bencher: Bencher) {
    bencher.bench(|| {
        prepare(
            &WavelengthGrid::standard(),
            SunCoverage::near(30.0, 0.0),
            Scattering::Single,
        )
    });
}

#[divan::bench(args = [30.0, -6.0], sample_count = 10)]
fn tabulate(bencher: Bencher, elevation_deg: f64) {
    let sky = solved(elevation_deg);
    bencher.bench(|| view(&sky, elevation_deg).table(RGB));
}

/// Two megapixels along rows of equal elevation.
#[divan::bench(sample_count = 10)]
fn draw_by_rows(bencher: Bencher) {
    let sky = solved(30.0);
    let table = view(&sky, 30.0).table(RGB);
    let mut picture = vec![0.0f32; 3 * WIDTH * HEIGHT];
    bencher.bench_local(|| draw(&table, black_box(&mut picture)));
}

/// Two megapixels in arbitrary directions.
#[divan::bench(sample_count = 10)]
fn draw_by_directions(bencher: Bencher) {
    let sky = solved(30.0);
    let table = view(&sky, 30.0).table(RGB);
    let directions: Vec<_> = (0..WIDTH * HEIGHT)
        .map(|i| {
            direction(
                0.2 * (i % WIDTH) as f64,
                90.0 - 180.0 * (i / WIDTH) as f64 / HEIGHT as f64,
            )
        })
        .collect();
    let mut picture = vec![0.0f32; 3 * WIDTH * HEIGHT];
    bencher.bench_local(|| table.samples(&directions, black_box(&mut picture)));
}

/// One view ray, all parts, 16 wavelengths.
#[divan::bench]
fn trace_one_ray(bencher: Bencher) {
    let sky = standard(30.0);
    let view = view(&sky, 30.0);
    bencher.bench(|| view.along(black_box(direction(70.0, 12.0)), None));
}
