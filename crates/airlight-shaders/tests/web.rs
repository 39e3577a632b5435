//! The page `examples/web/sky-article.html`: up to date, and drawn by a browser as the library computes it.

use airlight::axes;
use airlight::glam::DVec3;
use airlight::models::single_scattering::{Settings, SkyArticle, Variant};
use airlight_image::read_picture;
use airlight_shaders::twins::{colour::srgb_encode, tone::camera_tone};
use glam::Vec3;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[path = "../examples/web/page.rs"]
mod page;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/web/sky-article.html");

#[test]
fn page_is_up_to_date() {
    let text = std::fs::read_to_string(FILE).unwrap_or_default();
    assert!(
        text.replace("\r\n", "\n") == page::assembled().unwrap(),
        "{FILE}: run cargo run -p airlight-shaders --example translate"
    );
}

/// Name of an installed Chromium.
fn chromium() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let runs = |name: &&str| {
        let version = Command::new(name).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    };
    names.into_iter().find(runs)
}

/// Draws the page without a screen.
fn draw(browser: &str, fragment: &str, folder: &Path) -> airlight_image::Picture {
    let picture = folder.join("page.png");
    let mut run = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--disable-quic",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--ignore-gpu-blocklist",
            "--hide-scrollbars",
            "--force-device-scale-factor=1",
            "--window-size=500,400",
        ])
        .arg(format!("--user-data-dir={}", folder.display()))
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{FILE}#{fragment}"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a browser");
    let started = Instant::now();
    while run.try_wait().expect("a process").is_none() {
        if started.elapsed() > Duration::from_secs(90) {
            run.kill().expect("a process");
            panic!("{browser} has not ended after 90 s");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    read_picture(&picture, None).expect("a screenshot")
}

/// The page drawn by Chromium (Debian: chromium) and the library's model: bytes of the sRGB picture.
#[test]
fn browser_draws_what_the_library_computes() {
    let Some(browser) = chromium() else {
        println!(
            "chromium is not installed: the page is not drawn (Debian: apt-get install chromium)"
        );
        return;
    };
    let folder = std::env::temp_dir().join(format!("airlight-page-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let (width, height) = (320, 200);
    let mut compared = 0;
    for (sun_deg, ev, altitude_m) in [(20.0, 13.0, 1.0), (1.0, 11.0, 3000.0)] {
        let fragment =
            format!("size={width}x{height}&sun={sun_deg}&azimuth=0&ev={ev}&altitude={altitude_m}");
        let picture = draw(browser, &fragment, &folder);
        let settings = Settings {
            variant: Variant::PrintedF64,
            eye_altitude_m: altitude_m,
            ..Settings::default()
        };
        // The page looks north.
        let sun = axes::direction(0.0, sun_deg);
        let sky = SkyArticle::new(&settings, sun).expect("a sky");
        let exposure = 0.18 / (0.125 * f64::exp2(ev));
        let tangent = 35f64.to_radians().tan();
        let (sin, cos) = 22f64.to_radians().sin_cos();
        for (column, row) in [
            (3u32, 2u32),
            (100, 60),
            (160, 20),
            (250, 110),
            (319, 140),
            (20, 150),
        ] {
            let x = (2.0 * (f64::from(column) + 0.5) / f64::from(width) - 1.0) * tangent * 1.6;
            let y = (1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(height)) * tangent;
            let view = DVec3::new(x, sin + y * cos, -cos + y * sin).normalize();
            assert!(view.y > 0.0 && view.dot(sun) < 0.999, "{column} {row}");
            let light = sky.luminance(view).map(|v| (v * exposure) as f32);
            let signal = srgb_encode(camera_tone(Vec3::from(light), 1.2, 1.0));
            let at = 3 * (row * picture.size.width() + column) as usize;
            let got = srgb_encode(Vec3::from_slice(&picture.rgb[at..]));
            // A level of dither, and the 0.2 % that f32 costs.
            let apart = (255.0 * (got - signal)).abs().max_element();
            assert!(apart < 2.0, "{column} {row}: {got} instead of {signal}");
            compared += 1;
        }
    }
    assert_eq!(compared, 12);
    std::fs::remove_dir_all(&folder).expect("a folder");
}
