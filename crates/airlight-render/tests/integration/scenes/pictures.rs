//! Every format is written and read back; the light in it is that of the report and of the probe.

use super::{Exr, Folder, equirectangular, parse, probe, rays_of, render};
use airlight::scene::RadianceView;
use airlight_image::output::spectral::channel_name;
use airlight_image::{Camera, Control, Frame, Projection, Size};
use airlight_render::{Renderer, Solutions};
use image::GenericImageView;

/// Solves quickly.
const QUICK: &str =
    "solver.wavelengths = \"rgb\"\nsolver.scattering = \"single\"\nsun.elevation_deg = 30\n";

#[test]
fn the_disc_of_a_solved_sky_has_the_suns_irradiance() {
    let folder = Folder::new();
    let size = Size::new(200, 100).unwrap();
    let camera = Camera::with_horizontal_fov(180.0, 3.0, 4.0, size);
    for elevation_deg in [20.0, 3.0, 0.0] {
        let scene = format!(
            "{QUICK}sun.elevation_deg = {elevation_deg}\noutput.sun_disc = \"separate\"\n\
             camera.projection = \"perspective\"\ncamera.fov_deg = 4\ncamera.size = [200, 100]\n\
             camera.elevation_deg = {elevation_deg}"
        );
        folder.write("a.exr", &scene);
        let camera = Camera {
            elevation_deg,
            ..camera
        };
        let frame = Frame::new(Projection::Perspective(camera), 200, 100).unwrap();
        let drawn = Exr::read(&folder.file("a.sun.exr")).sum(&frame, |_| 1.0);
        let stated = probe(&scene, &[]).sun.illuminance_normal_lx;
        // At the horizon, half of it.
        assert!(
            (drawn / stated - 1.0).abs() < 2e-3,
            "{elevation_deg}: {drawn} against {stated} lx"
        );
        assert!(folder.exr(&scene).sum(&frame, |_| 1.0) > 0.0);
    }
    // Small panoramas too, with the sun at the zenith, in the sky and on the seam.
    for (width, height, sun) in [(64, 32, (0, 90)), (16, 8, (77, 89)), (3, 2, (180, 20))] {
        let scene = format!(
            "{QUICK}sun.azimuth_deg = {}\nsun.elevation_deg = {}\noutput.sun_disc = \"separate\"\n\
             camera.size = [{width}, {height}]",
            sun.0, sun.1
        );
        folder.write("b.exr", &scene);
        let frame = equirectangular(width, height);
        let drawn = Exr::read(&folder.file("b.sun.exr")).sum(&frame, |_| 1.0);
        let stated = probe(&scene, &[]).sun.illuminance_normal_lx;
        assert!(
            (drawn / stated - 1.0).abs() < 1e-3,
            "{width} x {height}: {drawn} against {stated} lx"
        );
    }
}

#[test]
fn the_whole_picture_has_the_illuminance_that_is_stated() {
    let folder = Folder::new();
    let scene = "sun = { latitude_deg = 48.8584, longitude_deg = 2.2945, time = \"2026-06-21T21:15:00+02:00\" }\n\
        solver.wavelengths = \"fast\"\ncamera.size = [512, 256]";
    let picture = folder.exr(scene);
    let image = render(scene);
    assert!((image.sun.elevation_deg - 5.171).abs() < 0.002);
    assert!((image.sun.azimuth_deg - 300.426).abs() < 0.002);
    let stated = image.light.sun_horizontal_lx + image.light.sky_horizontal_lx;
    let sum = picture.sum(&equirectangular(512, 256), |direction| direction.y.max(0.0));
    assert!(
        (sum / stated - 1.0).abs() < 0.01,
        "{sum} against {stated} lx"
    );
    let rgb = picture.rgb(100, 60);
    assert_eq!(rgb, image.rgb[60 * 512 + 100]);
    // What the file says about itself.
    assert!(picture.texts["units"].contains("cd/m^2"));
    assert!(picture.texts["whitePoint"].contains("0.3127"));
    assert_eq!(picture.texts["time"], "2026-06-21T21:15:00+02:00");
    assert_eq!(picture.attributes.latitude, Some(48.8584));
    assert_eq!(picture.attributes.white_luminance, Some(1.0));
    assert_eq!(picture.attributes.utc_offset, Some(-7200.0));
    let date = picture.attributes.capture_date.as_ref().unwrap();
    assert_eq!(date.to_string(), "2026:06:21 21:15:00");
    assert!(picture.shared.chromaticities.is_some());
}

#[test]
fn pixel_and_probe_agree_in_colours_and_spectra() {
    let folder = Folder::new();
    let scene = "solver.wavelengths = \"fast\"\nsun.elevation_deg = 25\nsun.azimuth_deg = 140\n\
        camera.size = [64, 32]\noutput.sun_disc = \"out\"\n";
    let picture = folder.exr(scene);
    folder.write("a.spectral.exr", scene);
    let spectral = Exr::read(&folder.file("a.spectral.exr"));
    let pixels = [(10, 3), (40, 14), (57, 13), (5, 20), (31, 8)];
    let answer = probe(scene, &rays_of(&equirectangular(64, 32), &pixels));
    for (view, &(x, y)) in answer.views.iter().zip(&pixels) {
        let close = |got: f32, want: f64, what: &str| {
            assert!(
                (f64::from(got) / want - 1.0).abs() < 0.01,
                "{what} at {x}, {y}: {got} against {want}"
            );
        };
        for (c, value) in picture.rgb(x, y).into_iter().enumerate() {
            close(value, view.rgb_cd_m2[c], "RGB");
        }
        for (nm, radiance) in answer.wavelengths_nm.iter().zip(&view.radiance_w_m2_sr_nm) {
            let name = channel_name(*nm);
            let value = spectral.channels[&name][(y * 64 + x) as usize];
            close(value, f64::from(*radiance), &name);
        }
        for (a, b) in spectral.rgb(x, y).iter().zip(picture.rgb(x, y)) {
            assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        }
    }
}

#[test]
fn display_pictures_are_neither_black_nor_white() {
    let folder = Folder::new();
    for elevation in [50.0, 2.0, -8.0] {
        for name in ["a.png", "a.jpg", "a.hdr"] {
            let bits = match (name, elevation) {
                ("a.png", 2.0) => "output.bits = 16",
                _ => "",
            };
            let scene =
                format!("{QUICK}sun.elevation_deg = {elevation}\ncamera.size = [64, 32]\n{bits}");
            folder.write(name, &scene);
            let picture = image::open(folder.file(name)).unwrap();
            assert_eq!(picture.dimensions(), (64, 32));
            if name == "a.hdr" {
                continue;
            }
            let grey: Vec<f64> = picture
                .to_rgb8()
                .pixels()
                .map(|p| p.0.map(f64::from).iter().sum::<f64>() / 3.0)
                .collect();
            let sky = grey[..grey.len() / 2].iter().sum::<f64>() / (grey.len() / 2) as f64;
            assert!((40.0..220.0).contains(&sky), "{elevation} {name}: {sky}");
        }
    }
    // A camera's exposure: three stops more are darker.
    let mean = |ev: f64| {
        let scene = format!("{QUICK}camera.size = [32, 16]\noutput.exposure = {ev}");
        folder.write("e.png", &scene);
        let picture = image::open(folder.file("e.png")).unwrap().to_rgb8();
        picture.pixels().map(|p| f64::from(p.0[2])).sum::<f64>()
    };
    assert!(mean(13.0) > 1.3 * mean(16.0));
}

#[test]
fn half_precision_counts_the_samples_that_it_cuts_off() {
    let folder = Folder::new();
    let scene = format!("{QUICK}camera.size = [64, 32]\noutput.precision = \"half\"\n");
    let written = folder.write("a.exr", &scene);
    assert!(written[0].written.clamped_samples > 0);
    let picture = Exr::read(&folder.file("a.exr"));
    assert!(picture.is_half);
    let most = picture.channels["R"].iter().copied().fold(0.0, f32::max);
    assert_eq!(most, 65504.0);
    let scene = format!("{scene}output.scale = 1e-5\noutput.compression = \"piz\"");
    assert_eq!(folder.write("b.exr", &scene)[0].written.clamped_samples, 0);
    let scaled = Exr::read(&folder.file("b.exr"));
    assert!((scaled.attributes.white_luminance.unwrap() / 1e5 - 1.0).abs() < 1e-6);
    assert!((scaled.rgb(9, 4)[1] / picture.rgb(9, 4)[1] * 1e5 - 1.0).abs() < 0.01);
}

#[test]
fn colour_spaces_hold_the_same_light() {
    let folder = Folder::new();
    let mut luminances = Vec::new();
    for (space, weights) in [
        ("srgb", [0.212_639, 0.715_169, 0.072_192]),
        ("rec2020", [0.262_700, 0.677_998, 0.059_302]),
        ("acescg-unadapted", [0.272_229, 0.674_082, 0.053_690]),
    ] {
        let scene = format!("{QUICK}camera.size = [16, 8]\noutput.color_space = \"{space}\"");
        let rgb = folder.exr(&scene).rgb(3, 2).map(f64::from);
        luminances.push(rgb.iter().zip(weights).map(|(c, w)| c * w).sum::<f64>());
    }
    assert!(
        luminances
            .iter()
            .all(|l| (l / luminances[0] - 1.0).abs() < 1e-4),
        "{luminances:?}"
    );
}

/// The fast way along rows is the way along single directions.
#[test]
fn rows_are_sampled_as_single_directions_are() {
    for more in ["", "fog = { visibility_m = 500, top_m = 30 }\n"] {
        let scene = format!("{QUICK}{more}camera.size = [32, 16]");
        let renderer = airlight_render::Renderer::new(&super::parse(&scene)).unwrap();
        let sun = renderer.sun(None).unwrap();
        let prepared = renderer
            .prepare(renderer.suns_near(&sun), airlight_image::Control::default())
            .unwrap();
        let frame = renderer.frame(prepared.as_ref(), None).unwrap();
        let view: &dyn RadianceView = frame.view().as_ref();
        let frame = equirectangular(32, 16);
        let rows = frame.rows();
        let mut directions = vec![glam::DVec3::ZERO; 32];
        let azimuths: Vec<f64> = (0..32)
            .map(|i| (360.0 * ((f64::from(i) + 0.5) / 32.0 - 0.5)).to_radians())
            .collect();
        let sampler = view.row_sampler(&azimuths).unwrap();
        for y in [0, 3, 7, 8, 15] {
            rows.fill(y, &mut directions);
            let (mut fast, mut slow) = (vec![0.0; 96], vec![0.0; 96]);
            sampler.sample_row(frame.row_elevation_rad(y).unwrap(), &mut fast);
            view.radiance(&directions, &mut slow);
            for (a, b) in fast.iter().zip(&slow) {
                assert!((a - b).abs() <= 1e-4 * b.abs(), "{more} {y}: {a} {b}");
            }
        }
    }
}

#[test]
fn odd_sizes_and_places_are_drawn() {
    let folder = Folder::new();
    for scene in [
        "camera.size = [1, 1]",
        "camera.size = [1, 65]",
        "camera.size = [65536, 1]",
        "camera = { size = [9, 9], projection = \"fisheye\", fov_deg = 360 }\nsun.elevation_deg = -30",
        "camera = { size = [9, 9], projection = \"perspective\", fov_deg = 0.001, elevation_deg = 30 }",
        "camera = { size = [9, 9], projection = \"perspective\", fov_deg = 179.9 }",
        "camera.size = [32, 16]\nsun.elevation_deg = -90",
        "camera.size = [32, 16]\nobserver.altitude_m = 400e3",
        "camera.size = [32, 16]\nobserver.altitude_m = 1e9",
        "camera.size = [32, 16]\nobserver.altitude_m = -12000",
        "camera.size = [32, 16]\nair.atmosphere = \"reference-rayleigh\"",
    ] {
        for name in ["a.exr", "a.png"] {
            let written = folder.write(name, &format!("{QUICK}{scene}"));
            assert_eq!(written[0].written.nan_samples, 0, "{scene}");
        }
    }
}

#[test]
fn pictures_of_equal_air_and_suns_share_a_solution() {
    let mut solutions = Solutions::default();
    let fog = "fog.visibility_m = 300\nfog.top_m = 50";
    let model = "solver.name = \"klassen1987\"";
    for (overrides, count) in [
        ("", 1),
        (
            "camera.projection = \"perspective\"\nsun.azimuth_deg = 250",
            1,
        ),
        (fog, 1),
        ("observer.altitude_m = 20", 2),
        ("sun.elevation_deg = 4", 3),
        ("air.aod_550 = 0.3", 4),
        (
            "air.aod_550 = 0.3\nfog.visibility_m = 80\nfog.top_m = 50",
            4,
        ),
        ("solver.scattering = \"all\"", 5),
        (model, 6),
        (&format!("{model}\n{fog}"), 7),
    ] {
        let base = match overrides.contains("klassen") {
            true => "sun.elevation_deg = 30",
            false => QUICK,
        };
        let scene = parse(&format!("{base}\ncamera.size = [24, 12]\n{overrides}"));
        let renderer = Renderer::new(&scene).unwrap();
        let shared = renderer.render_sharing(&mut solutions, Control::default());
        assert_eq!(solutions.len(), count, "{overrides}");
        let alone = renderer.render(Control::default()).unwrap();
        assert_eq!(shared.unwrap().rgb, alone.rgb, "{overrides}");
    }
}
