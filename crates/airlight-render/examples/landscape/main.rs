//! A landscape with its depth, for trying fog on: real mountains under the sky of Airlight.
//!
//! `cargo run --release -p airlight-render --example landscape -- OUT.exr [--png OUT.png] [--size 1280x720] ...` writes
//! R, G, B (cd/m^2, linear sRGB) and Z (metres along the camera's axis at the middle of each pixel; infinite for the
//! sky). The air between eye and ground is left out unless `--air on` asks for it. The terrain is that of
//! `scenes/landscape`; trees, fields and rocks on it are made up.

mod air;
mod ground;
mod light;
mod march;
mod noise;
mod options;
mod scene;
mod terrain;

use airlight::{
    atmosphere, axes,
    sky::{Sky, SkySettings, SunCoverage},
    spectrum::{RgbSpace, WavelengthGrid},
};
use airlight_image::{
    Camera, Control, Frame, PictureOptions, Projection, Size,
    output::{
        Metadata,
        exr::{self, ExrOptions, SamplePrecision},
    },
    rows::StoredRows,
    tone::{Exposure, Metering, ToneCurve, ToneMapper},
    write_picture,
};
use options::Options;
use std::{error::Error, path::Path, time::Instant};

/// Where the elevation model lies.
const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/landscape");

/// Heights above sea level between which the ground of the scene lies, metres.
const HEIGHTS: [f64; 2] = [236.0, 1076.0];

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse(std::env::args().skip(1))?;
    let [width, height] = options.size;
    let size = Size::new(width, height)?;
    let camera = Camera::with_horizontal_fov(
        options.azimuth,
        options.elevation,
        options.horizontal_fov,
        size,
    );
    let frame = Frame::new(Projection::Perspective(camera), width, height)?;

    let start = Instant::now();
    let terrain = terrain::Terrain::read(Path::new(SCENE), "jacksboro_dem")?;
    let eye = terrain.place(options.latitude, options.longitude);
    let ground = ground::Ground::new(terrain, eye);
    let altitude = ground.terrain(eye[0], eye[1]) + options.height;
    let planted = start.elapsed();

    let sun = axes::direction(options.sun_azimuth, options.sun_elevation);
    let settings = SkySettings {
        suns: SunCoverage::near(options.sun_elevation, altitude),
        ..Default::default()
    };
    let air = atmosphere::preset(&options.atmosphere)?;
    let sky = Sky::prepare(&air, &WavelengthGrid::standard(), &settings)?;
    let view = sky.view(altitude, sun);
    let light = light::Light::new(&view, HEIGHTS.map(|h| (h, sky.view(h, sun))));
    let air = options
        .air
        .then(|| air::Air::new(&view, &frame, scene::FARTHEST));
    let lit = start.elapsed();

    let scene = scene::Scene {
        ground,
        light,
        air,
        eye,
        altitude,
        frame,
        axis: axes::direction(options.azimuth, options.elevation),
        samples: options.samples,
    };
    let pixels = scene.draw(|rows| {
        let tenths = |rows: u32| u64::from(rows) * 10 / u64::from(height);
        if tenths(rows) > tenths(rows - 1) {
            eprintln!("{rows} of {height} rows");
        }
    });
    let drawn = start.elapsed();

    let metadata = describe(&options, &frame, &camera, altitude);
    for (name, text) in &metadata.texts {
        println!("{name}: {text}");
    }
    let depths = || pixels.iter().skip(3).step_by(4).copied();
    let ground_depths = || depths().filter(|z| z.is_finite());
    println!(
        "depth of ground: {:.1} to {:.1} m, sky in {:.1} % of pixels",
        ground_depths().fold(f32::INFINITY, f32::min),
        ground_depths().fold(0.0, f32::max),
        100.0 * depths().filter(|z| z.is_infinite()).count() as f64 / depths().count() as f64
    );
    println!(
        "seconds: ground {:.2}, light {:.2}, picture {:.2}",
        planted.as_secs_f64(),
        (lit - planted).as_secs_f64(),
        (drawn - lit).as_secs_f64()
    );

    if let Some(path) = &options.shown {
        let colours: Vec<f32> = pixels
            .as_chunks::<4>()
            .0
            .iter()
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect();
        let weighed: Vec<(f32, f32)> = colours
            .as_chunks::<3>()
            .0
            .iter()
            .map(|rgb| (RgbSpace::Srgb.luminance(rgb.map(f64::from)) as f32, 1.0))
            .collect();
        let exposure = Exposure::metered(&weighed, Metering::default()).ok_or("nothing is lit")?;
        println!("exposure of the shown picture: EV {:.2}", exposure.ev100());
        let tone = ToneMapper::new(exposure.factor() as f32, ToneCurve::default())?;
        let rows = StoredRows::new(width, 3, colours)?;
        let as_shown = PictureOptions {
            metadata: metadata.clone(),
            ..Default::default()
        };
        write_picture(path, size, &rows, &tone, &as_shown, Control::default())?;
    }
    let written = exr::write(
        &options.exr,
        size,
        &["R", "G", "B", "Z"],
        &StoredRows::new(width, 4, pixels)?,
        &ExrOptions {
            precision: SamplePrecision::Float,
            ..ExrOptions::default()
        },
        &metadata,
        Control::default(),
    )?;
    println!("{}: {} bytes", options.exr.display(), written.bytes);
    Ok(())
}

/// What is to be known of the picture, to lay something over it.
fn describe(options: &Options, frame: &Frame, camera: &Camera, altitude: f64) -> Metadata {
    let fact = |value: f64, unit: &str| format!("{value:.3} {unit}");
    Metadata {
        software: Some("airlight landscape".to_owned()),
        comments: Some(
            "Terrain: SRTM, Jacksboro, Tennessee; what grows on it is made up".to_owned(),
        ),
        latitude_deg: Some(options.latitude as f32),
        longitude_deg: Some(options.longitude as f32),
        altitude_m: Some(altitude as f32),
        white_luminance_cd_m2: Some(1.0),
        chromaticities: Some(RgbSpace::Srgb.into()),
        ..Metadata::default()
    }
    .with_frame(frame)
    .with_text(
        "horizontal field of view",
        fact(options.horizontal_fov, "deg"),
    )
    .with_text(
        "vertical field of view",
        fact(camera.vertical_fov_deg, "deg"),
    )
    .with_text("camera azimuth", fact(options.azimuth, "deg"))
    .with_text("camera elevation", fact(options.elevation, "deg"))
    .with_text("camera height above ground", fact(options.height, "m"))
    .with_text("camera height above sea level", fact(altitude, "m"))
    .with_text("sun azimuth", fact(options.sun_azimuth, "deg"))
    .with_text("sun elevation", fact(options.sun_elevation, "deg"))
    .with_text("atmosphere", options.atmosphere.clone())
    .with_text(
        "air between camera and ground",
        if options.air { "drawn" } else { "left out" },
    )
    .with_text("Z", "metres along the camera's axis, infinite for the sky")
}
