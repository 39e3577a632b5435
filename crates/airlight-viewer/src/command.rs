//! [`command_line`]: the program `airlight` for the picture.

use airlight::Named;
use airlight::scene::{Exposure, FogSpec, Scene};

/// The command that draws a scene into `sky.png`, quoted for a shell; `None` for a scene with parts that no option of it sets here, which
/// is drawn from a file.
pub fn command_line(scene: &Scene) -> Option<String> {
    let mut line = Line {
        words: vec!["airlight".to_owned(), "sky".to_owned()],
    };
    let mut rest = scene.clone();
    let sun = std::mem::take(&mut rest.sun);
    line.number("--sun-elevation", sun.elevation_deg);
    line.number("--sun-azimuth", sun.azimuth_deg);
    if let (Some(latitude_deg), Some(longitude_deg)) = (sun.latitude_deg, sun.longitude_deg) {
        line.add("--at", format!("{latitude_deg},{longitude_deg}"));
    }
    line.text("--when", sun.time);
    if sun.distance_ratio.is_some() || sun.refraction.is_some() {
        return None;
    }
    line.number("--altitude-m", rest.observer.altitude_m.take());
    let air = std::mem::take(&mut rest.air);
    if air.atmosphere_toml.is_some() || air.contrast.is_some() {
        return None;
    }
    line.text("--atmosphere", air.atmosphere);
    line.text("--aerosol", air.aerosol);
    line.number("--humidity", air.humidity);
    line.number("--aod-550", air.aod_550);
    line.number("--turbidity", air.turbidity);
    line.number("--haze-visibility-m", air.haze_visibility_m);
    line.number("--ozone-du", air.ozone_du);
    line.number("--ground-albedo", air.ground_albedo);
    line.number("--ground-altitude-m", air.ground_altitude_m);
    if let Some(mut fog) = rest.fog.take() {
        line.number("--visibility-m", fog.visibility_m.take());
        line.number("--scale-height-m", fog.scale_height_m.take());
        line.number("--top-m", fog.top_m.take());
        if fog != FogSpec::default() {
            return None;
        }
    }
    let camera = std::mem::take(&mut rest.camera);
    line.text(
        "--projection",
        camera.projection.map(|kind| kind.name().to_owned()),
    );
    line.text(
        "--size",
        camera
            .size
            .map(|[width, height]| format!("{width}x{height}")),
    );
    line.number("--camera-azimuth", camera.azimuth_deg);
    line.number("--camera-elevation", camera.elevation_deg);
    line.number("--camera-roll", camera.roll_deg);
    line.number("--fov", camera.fov_deg);
    line.text(
        "--orientation",
        camera.orientation.map(|program| program.name().to_owned()),
    );
    let output = &mut rest.output;
    match output.exposure.take() {
        Some(Exposure::Ev100(ev100)) => line.number("--exposure", Some(ev100)),
        Some(Exposure::Metered(mode)) => line.add("--exposure", mode.name().to_owned()),
        None => {}
    }
    line.number("--brighten", output.brighten.take());
    line.text(
        "--tone",
        output.tone.take().map(|tone| tone.name().to_owned()),
    );
    line.number("--tone-contrast", output.tone_contrast.take());
    line.number("--saturation", output.saturation.take());
    line.number("--white-balance", output.white_balance_k.take());
    output.file = None;
    line.add("-o", "sky.png".to_owned());
    (rest == Scene::default()).then(|| line.words.join(" "))
}

/// The words of a command.
struct Line {
    words: Vec<String>,
}

impl Line {
    fn add(&mut self, option: &str, value: String) {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+.,:/@%".contains(c);
        // A value that begins with a minus sign would be read as an option.
        let value = match value.chars().all(plain) {
            true => value,
            false => format!("'{}'", value.replace('\'', "'\\''")),
        };
        match option {
            "-o" => self.words.push(format!("-o {value}")),
            _ => self.words.push(format!("{option}={value}")),
        }
    }

    fn number(&mut self, option: &str, value: Option<f64>) {
        self.text(option, value.map(|value| value.to_string()));
    }

    fn text(&mut self, option: &str, value: Option<String>) {
        if let Some(value) = value {
            self.add(option, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_commands() {
        let scene = Scene::from_toml(
            "sun.elevation_deg = -4
            observer.altitude_m = 1500
            air.aerosol = \"urban:0.7,desert:0.3\"
            camera.projection = \"perspective\"
            output.exposure = 9.5",
        );
        assert_eq!(
            command_line(&scene.unwrap()).unwrap(),
            "airlight sky --sun-elevation=-4 --altitude-m=1500 --aerosol=urban:0.7,desert:0.3 --projection=perspective --exposure=9.5 -o sky.png"
        );
        let scene = Scene::from_toml("sun.elevation_deg = 3\nsun.refraction = false");
        assert_eq!(command_line(&scene.unwrap()), None);
        let scene = Scene::from_toml("sun.elevation_deg = 3\nnight.stars = true");
        assert_eq!(command_line(&scene.unwrap()), None);
    }
}
