//! The page `examples/web/sky-article.html`: up to date, and drawn by a browser as the library computes it.

use airlight::Named;
use airlight::axes;
use airlight::glam::DVec3;
use airlight::models::single_scattering::{Settings, SkyArticle, Variant};
use airlight_image::read_picture;
use airlight_shaders::twins::{colour::srgb_encode, tone::camera_tone};
use airlight_shaders::{Language, Part, source, translate};
use glam::Vec3;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
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

/// Options for a run without a screen and without a network.
const HEADLESS: [&str; 12] = [
    "--headless",
    "--no-sandbox",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    "--ignore-gpu-blocklist",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--use-webgpu-adapter=swiftshader",
];

/// A folder for a browser's files, removed with it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("airlight-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A browser that was ended may still write to it.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A browser that is started on a page.
fn started(browser: &str, options: &[&str], folder: &Folder, page: &str) -> Child {
    Command::new(browser)
        .args(HEADLESS)
        .args(options)
        .arg(format!("--user-data-dir={}", folder.0.display()))
        .arg(page)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a browser")
}

/// Draws the page without a screen.
fn draw(browser: &str, fragment: &str, folder: &Folder) -> airlight_image::Picture {
    let picture = folder.0.join("page.png");
    let screenshot = format!("--screenshot={}", picture.display());
    let options = [
        "--hide-scrollbars",
        "--force-device-scale-factor=1",
        "--window-size=500,400",
        &screenshot,
    ];
    let page = format!("file://{FILE}#{fragment}");
    let mut run = started(browser, &options, folder, &page);
    let begin = Instant::now();
    while run.try_wait().expect("a process").is_none() {
        if begin.elapsed() > Duration::from_secs(90) {
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
    let folder = Folder::new("page");
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
}

/// A page that compiles the WGSL of `/shader` and sends what the browser says of it.
const COMPILE_WGSL: &str = r#"<!doctype html><script>
(async () => {
    let text;
    try {
        const adapter = await navigator.gpu?.requestAdapter();
        if (!adapter) throw new Error("none");
        const device = await adapter.requestDevice();
        const code = await (await fetch("/shader")).text();
        const { messages } = await device.createShaderModule({ code }).getCompilationInfo();
        text = messages.map((m) => `${m.type} ${m.lineNum}: ${m.message}`).join("\n") || "accepted";
    } catch (error) {
        text = error.message;
    }
    await fetch("/result", { method: "POST", body: text });
})();
</script>"#;

/// The same for a fragment shader in GLSL ES 3.00.
const COMPILE_GLSL: &str = r#"<!doctype html><script>
(async () => {
    let text;
    try {
        const gl = document.createElement("canvas").getContext("webgl2");
        if (!gl) throw new Error("none");
        const shader = gl.createShader(gl.FRAGMENT_SHADER);
        gl.shaderSource(shader, await (await fetch("/shader")).text());
        gl.compileShader(shader);
        text = gl.getShaderParameter(shader, gl.COMPILE_STATUS) ? "accepted" : gl.getShaderInfoLog(shader);
    } catch (error) {
        text = error.message;
    }
    await fetch("/result", { method: "POST", body: text });
})();
</script>"#;

/// Method and path of a request, and its body.
fn request(stream: &mut TcpStream) -> (String, String) {
    let mut bytes = Vec::new();
    let mut buffer = [0; 4096];
    loop {
        let read = stream.read(&mut buffer).unwrap_or_default();
        bytes.extend_from_slice(&buffer[..read]);
        let text = String::from_utf8_lossy(&bytes);
        if let Some((head, body)) = text.split_once("\r\n\r\n") {
            let length = head.lines().find_map(|line| {
                let (name, value) = line.split_once(':')?;
                let is_length = name.eq_ignore_ascii_case("content-length");
                is_length.then(|| value.trim().parse::<usize>().ok())?
            });
            if read == 0 || body.len() >= length.unwrap_or_default() {
                let first = head.lines().next().unwrap_or_default();
                return (first.to_owned(), body.to_owned());
            }
        } else if read == 0 {
            return (String::new(), String::new());
        }
    }
}

/// What a browser says of a shader on a page.
fn verdict(browser: &str, page: &str, shader: &str) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    listener.set_nonblocking(true).expect("a port");
    let port = listener.local_addr().expect("a port").port();
    let folder = Folder::new(&format!("compile-{port}"));
    let address = format!("http://127.0.0.1:{port}/");
    let mut run = started(browser, &["--enable-unsafe-webgpu"], &folder, &address);
    let begin = Instant::now();
    let mut result = None;
    while result.is_none() && begin.elapsed() < Duration::from_secs(90) {
        let Ok((mut stream, _)) = listener.accept() else {
            std::thread::sleep(Duration::from_millis(20));
            continue;
        };
        stream.set_nonblocking(false).expect("a connection");
        let timeout = Some(Duration::from_secs(5));
        stream.set_read_timeout(timeout).expect("a connection");
        let (first, body) = request(&mut stream);
        let (kind, text) = match first.split(' ').nth(1) {
            Some("/") => ("text/html", page),
            Some("/shader") => ("text/plain", shader),
            Some("/result") => {
                result = Some(body);
                ("text/plain", "")
            }
            _ => ("text/plain", ""),
        };
        let answer = format!(
            "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{text}",
            text.len()
        );
        // A connection that the browser gave up is of no use to it.
        let _ = stream.write_all(answer.as_bytes());
    }
    run.kill().expect("a process");
    run.wait().expect("a process");
    result.unwrap_or_else(|| panic!("{browser} has not answered after 90 s"))
}

/// The compilers of Chromium's WebGPU and WebGL are independent of those that the other tests use.
#[test]
fn browser_accepts_all_functions() {
    let Some(browser) = chromium() else {
        println!(
            "chromium is not installed: its compilers are not asked (Debian: apt-get install chromium)"
        );
        return;
    };
    let functions = translate(Part::ALL, Language::GlslEs300).expect("GLSL");
    let main = "out vec4 colour; void main() { colour = vec4(mean_transmittance(0.5)); }";
    let glsl = format!("#version 300 es\n{functions}\n{main}\n");
    for (api, page, shader) in [
        ("WebGPU", COMPILE_WGSL, source(Part::ALL)),
        ("WebGL 2", COMPILE_GLSL, glsl),
    ] {
        match verdict(browser, page, &shader).as_str() {
            "none" => println!("chromium has no {api} here: its compiler is not asked"),
            result => assert_eq!(result, "accepted", "{api}"),
        }
    }
}
