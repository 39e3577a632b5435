//! [`command_line`]: the program `airlight` for the picture.

use crate::state::State;
use airlight::Named;
use airlight::scene::{Exposure, FogSpec, Scene};

/// The command that draws the picture of a state, quoted for a shell. A state with parts that no option sets is drawn from
/// `scene.toml`, a file to be saved first.
pub fn command_line(state: &State) -> String {
    if state.photograph.is_some() {
        return "airlight fog --scene scene.toml -o fogged.png".to_owned();
    }
    let is_sky = state.terrain.is_none() && state.scene.lights.is_empty();
    if is_sky {
        let line = with_options(&state.scene, "sky");
        return line.map_or_else(
            || "airlight sky --scene scene.toml -o sky.png".to_owned(),
            |mut line| {
                line.add("-o", "sky.png".to_owned());
                line.words.join(" ")
            },
        );
    }
    // The ground of a terrain whose middle the eye stands on.
    let terrain = state.terrain.as_ref();
    let terrain = terrain.filter(|terrain| [terrain.east_m, terrain.south_m] == [0.0; 2]);
    let line = with_options(&state.scene, "view").zip(terrain);
    let line = line.filter(|_| replaces_usual(&state.scene));
    let mut line = match line {
        Some((mut line, terrain)) => {
            let file = terrain.file.clone();
            line.add("--terrain", file.unwrap_or_else(|| "mountains".to_owned()));
            let spacing_m = terrain.spacing_m.filter(|_| terrain.file.is_some());
            line.number("--terrain-spacing-m", spacing_m);
            line
        }
        None => Line {
            words: ["airlight", "view", "scene.toml"]
                .map(str::to_owned)
                .to_vec(),
        },
    };
    line.add("--screenshot", "view.png".to_owned());
    line.words.push("--no-panel".to_owned());
    line.words.join(" ")
}

/// Whether a scene sets all that the viewer sets to begin with, as no option unsets it.
fn replaces_usual(scene: &Scene) -> bool {
    let (sun, camera) = (&scene.sun, &scene.camera);
    (sun.elevation_deg.is_none() || sun.azimuth_deg.is_some())
        && scene.observer.altitude_m.is_some()
        && scene.air.atmosphere.is_some()
        && camera.elevation_deg.is_some()
        && camera.fov_deg.is_some()
}

/// The options of a scene; `None` for a scene with parts that no option sets here.
fn with_options(scene: &Scene, command: &str) -> Option<Line> {
    let mut line = Line {
        words: vec!["airlight".to_owned(), command.to_owned()],
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
        line.name("--fog-profile", fog.profile.take());
        line.number("--scale-height-m", fog.scale_height_m.take());
        line.number("--base-height-m", fog.base_height_m.take());
        line.number("--top-m", fog.top_m.take());
        line.name("--droplets", fog.droplets.take());
        if fog != FogSpec::default() {
            return None;
        }
    }
    let camera = std::mem::take(&mut rest.camera);
    line.name("--projection", camera.projection);
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
    line.name("--orientation", camera.orientation);
    let output = &mut rest.output;
    match output.exposure.take() {
        Some(Exposure::Ev100(ev100)) => line.number("--exposure", Some(ev100)),
        Some(Exposure::Metered(mode)) => line.add("--exposure", mode.name().to_owned()),
        Some(Exposure::Camera(camera)) => line.add("--exposure", camera.to_string()),
        None => {}
    }
    line.number("--brighten", output.brighten.take());
    line.name("--tone", output.tone.take());
    line.number("--tone-contrast", output.tone_contrast.take());
    line.number("--saturation", output.saturation.take());
    line.number("--white-balance", output.white_balance_k.take());
    output.file = None;
    if command == "sky"
        && let Some(sequence) = rest.sequence.take()
    {
        line.text("--until", sequence.until);
        line.text("--every", sequence.every);
        if sequence.meter_each == Some(true) {
            line.words.push("--meter-each".to_owned());
        }
    }
    (rest == Scene::default()).then_some(line)
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

    fn name<T: Named>(&mut self, option: &str, value: Option<T>) {
        self.text(option, value.map(|value| value.name().to_owned()));
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
    use crate::state::Terrain;

    fn command(scene: &str) -> String {
        // Without what the viewer fills in.
        command_line(&State {
            scene: Scene::from_toml(scene).unwrap(),
            terrain: None,
            compare: None,
            photograph: None,
        })
    }

    #[test]
    fn scenes_are_commands() {
        let scene = "sun.elevation_deg = -4
            observer.altitude_m = 1500
            fog = { visibility_m = 300, profile = \"clamped\", base_height_m = 40, droplets = \"mist\" }
            air.aerosol = \"urban:0.7,desert:0.3\"
            camera.projection = \"perspective\"
            output.exposure = 9.5";
        assert_eq!(
            command(scene),
            "airlight sky --sun-elevation=-4 --altitude-m=1500 --aerosol=urban:0.7,desert:0.3 --visibility-m=300 --fog-profile=clamped --base-height-m=40 --droplets=moderate-radiation-fog --projection=perspective --exposure=9.5 -o sky.png"
        );
        assert_eq!(
            command(
                "sun.elevation_deg = 30\noutput = { exposure = \"f/8 1/125 s ISO 100\", white_balance_k = 5000 }"
            ),
            "airlight sky --sun-elevation=30 --exposure='f/8 1/125 s ISO 100' --white-balance=5000 -o sky.png"
        );
        let time = "sun = { latitude_deg = 48.9, longitude_deg = 2.3, time = \"2026-06-21T18:00:00+02:00\" }";
        assert_eq!(
            command(&format!(
                "{time}\nsequence = {{ until = \"+2h\", every = \"90s\", meter_each = true }}"
            )),
            "airlight sky --at=48.9,2.3 --when=2026-06-21T18:00:00+02:00 --until=+2h --every=90s --meter-each -o sky.png"
        );
        let from_file = "airlight sky --scene scene.toml -o sky.png";
        for scene in ["sun.refraction = false", "night.stars = true"] {
            let scene = format!("sun.elevation_deg = 3\n{scene}");
            assert_eq!(command(&scene), from_file);
        }
    }

    #[test]
    fn what_the_sky_does_not_draw_is_drawn_by_the_viewer() {
        let scene = "sun = { elevation_deg = 8, azimuth_deg = 100 }
            observer.altitude_m = 700
            air.atmosphere = \"clear\"
            camera = { elevation_deg = -4, fov_deg = 60 }";
        let mut state = State {
            scene: Scene::from_toml(scene).unwrap(),
            terrain: Some(Terrain::default()),
            ..Default::default()
        };
        assert_eq!(
            command_line(&state),
            "airlight view --sun-elevation=8 --sun-azimuth=100 --altitude-m=700 --atmosphere=clear --camera-elevation=-4 --fov=60 \
             --terrain=mountains --screenshot=view.png --no-panel"
        );
        state.terrain = Some(Terrain {
            south_m: 300.0,
            ..Default::default()
        });
        let from_file = "airlight view scene.toml --screenshot=view.png --no-panel";
        assert_eq!(command_line(&state), from_file);
        // The viewer begins with an elevation of its own.
        (state.terrain, state.scene.camera.elevation_deg) = (Some(Terrain::default()), None);
        assert_eq!(command_line(&state), from_file);
        let lights = "[[lights]]\nposition_m = [0, 3, -9]\nintensity = [1, 1, 1]";
        assert_eq!(command(lights), from_file);
    }
}
