//! Scenes as TOML: round trip, errors with their place, layered tables, files.

use super::*;
use crate::fog::FogScattering;
use crate::fog::droplets::DropletKind;
use crate::optics::mie::droplets::Drops;

/// A scene with all tables, as in the book.
const FULL: &str = r#"
version = 1

[sun]
elevation_deg = 10
azimuth_deg = 225

[night]
lights = "on"
moon_elevation_deg = 30
moon_azimuth_deg = 200
moon_phase_deg = 40
stars = false
solar_flux_sfu = 70
sky_quality_mag = 20
latitude_deg = -30

[observer]
altitude_m = 100
eye_height_m = 2

[air]
atmosphere = "average"
aerosol = "urban:0.7,desert:0.3"
humidity = 0.8
aod_550 = 0.12
contrast = 0.05
ozone_du = 300
ground_albedo = 0.1
ground_altitude_m = 0

[fog]
visibility_m = 150
profile = "clamped"
scale_height_m = 30
base_height_m = 5
droplets = "mist"
scattering = "undimmed"

[fog.patches]
strength = 0.6
size_m = 40
height_m = 15
seed = 7
wind_m_s = [2, -1]
time_s = 60

[[fog.layers]]
visibility_m = 800
top_m = 50

[[lights]]
kind = "spot"
position_m = [1, 5, -10]
intensity = [3, 2.5, 2]

[objects]
shadows = false

[[objects.object]]
shape = "sphere"
at_m = [0, 1, -5]
radius_m = 1
reflectance = [0.5, 0.1, 0.1]
gloss = { roughness = 0.2 }

[solver]
name = "orders"
scattering = "all"
effort = "fine"
wavelengths = "fast"

[solver.klassen1987]
wet_haze = "haze-l"

[camera]
projection = "perspective"
size = [1920, 1080]
fov_deg = 75

[output]
file = "sky.exr"
sun_disc = "separate"
color_space = "rec2020"
exposure = "auto"
white_balance_k = 4200
scotopic = true
compression = "piz"

[sequence]
until = "+6h"
every = "10m"
"#;

#[test]
fn scenes_round_trip_through_toml() {
    let scene = Scene::from_toml(FULL).unwrap();
    let fog = scene.fog.as_ref().unwrap();
    assert_eq!(
        fog.droplets,
        Some(DropletKind::from(Drops::ModerateRadiationFog))
    );
    assert_eq!(fog.scattering, Some(FogScattering::Undimmed));
    assert_eq!(scene.camera.size, Some([1920, 1080]));
    assert_eq!(scene.output.exposure, Some(Exposure::AUTO));
    let text = scene.to_toml().unwrap();
    assert_eq!(Scene::from_toml(&text).unwrap(), scene, "{text}");
    // Fields that are not set are not written.
    let empty = Scene::default().to_toml().unwrap();
    assert_eq!(empty.trim(), "version = 1");
    assert_eq!(Scene::from_toml("").unwrap(), Scene::default());
    let manual = Scene::from_toml("output.exposure = 14.5").unwrap();
    assert_eq!(manual.output.exposure, Some(Exposure::Ev100(14.5)));
    let camera = "output = { exposure = \"f/8 1/125 s ISO 100\" }";
    let camera = Scene::from_toml(camera).unwrap();
    let ev100 = camera.output.exposure.and_then(Exposure::ev100).unwrap();
    assert!((ev100 - (64.0f64 * 125.0).log2()).abs() < 1e-12, "{ev100}");
    let text = camera.to_toml().unwrap();
    assert_eq!(Scene::from_toml(&text).unwrap(), camera, "{text}");
}

#[test]
fn errors_have_a_place_and_the_expected_values() {
    for (text, sentence) in [
        (
            "[air]\nozone = 300\n",
            "line 2, column 1: air.ozone: unknown key; expected one of atmosphere,",
        ),
        ("[air]\nozone = 300\n", "; try \"ozone_du\""),
        (
            "[fogg]\n",
            "line 1, column 2: fogg: unknown key; expected one of version,",
        ),
        (
            "[[fog.layers]]\nvisibility_m = 1\n[[fog.layers]]\ntop = 3\n",
            "line 4, column 1: fog.layers[1].top: unknown key; expected one of visibility_m,",
        ),
        (
            "[camera]\nprojection = \"perspektive\"\n",
            "line 2, column 14: camera.projection: expected a projection (equirectangular,",
        ),
        (
            "[camera]\nprojection = \"perspektive\"\n",
            "got \"perspektive\"; try \"perspective\"",
        ),
        (
            "[fog]\n  droplets = \"radiaton\"\n",
            "line 2, column 14: fog.droplets: expected a kind of droplets (fine,",
        ),
        (
            "[sun]\nelevation_deg = \"low\"\n",
            "line 2, column 17: sun.elevation_deg: expected a number, got string \"low\"",
        ),
        (
            "[air]\n\nground_albedo = 1.5\n",
            "line 3, column 1: air.ground_albedo: expected a number from 0 to 1, got 1.5",
        ),
        (
            "[fog.patches]\nstrength = 3\n",
            "line 2, column 1: fog.patches.strength: expected a number from 0 to 2, got 3",
        ),
        (
            "[fog.patches]\nsize = 3\n",
            "fog.patches.size: unknown key; expected one of strength, size_m,",
        ),
        (
            "[[lights]]\nposition_m = [1, 2, 3]\nintensity = [1, 1, 1]\n[[lights]]\nintensity = [1, 1, 1]\n",
            "line 4, column 1: lights[1].position_m: expected either position_m or pixel, got none",
        ),
        (
            "version = 2\n",
            "line 1, column 1: version: expected 1, got 2; try a newer version",
        ),
        ("[sun\n", "line 1, column 5: "),
        (
            "[output]\nexposure = \"bright\"\n",
            "output.exposure: expected a metering mode (auto, centre-weighted, spot",
        ),
    ] {
        let error = Scene::from_toml(text).unwrap_err().to_string();
        assert!(error.contains(sentence), "{text}: {error}");
    }
}

#[test]
fn layers_of_tables_override_key_by_key() {
    let text = "title = \"Fogs\"\n\
        [scene.fog]\nvisibility_m = 200\ntop_m = 30\n[scene.sun]\nelevation_deg = 5\n\
        [[cell]]\nlabel = \"denser\"\nfog.visibility_m = 50\n\
        [[cell]]\nlabel = \"wrong\"\nfog.visibility = 50\n\
        [[cell]]\nlabel = \"far\"\nfog.visibility_m = 1e12\n";
    let document = SceneDocument::new(text).unwrap();
    assert_eq!(document.count("cell").unwrap(), 3);
    let cell = |n: usize| document.scene(&["scene", &format!("cell[{n}]")], &["label"]);
    let denser = cell(0).unwrap();
    let fog = denser.fog.unwrap();
    assert_eq!((fog.visibility_m, fog.top_m), (Some(50.0), Some(30.0)));
    assert_eq!(denser.sun.elevation_deg, Some(5.0));
    let wrong = cell(1).unwrap_err().to_string();
    assert!(
        wrong.starts_with("line 12, column 5: cell[1].fog.visibility: unknown key"),
        "{wrong}"
    );
    let far = cell(2).unwrap_err().to_string();
    assert!(
        far.starts_with("line 15, column 5: fog.visibility_m: expected a number of metres"),
        "{far}"
    );
    // Tables beside the scene are read in the same way.
    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Sheet {
        title: String,
    }
    let sheet: Sheet = document.read(&[""], &["scene", "cell"]).unwrap();
    assert_eq!(sheet.title, "Fogs");
    let error = document
        .read::<Sheet>(&[""], &["scene"])
        .unwrap_err()
        .to_string();
    assert!(error.contains("cell: unknown key"), "{error}");
}

#[test]
fn files_are_inlined() {
    let mut scene =
        Scene::from_toml("air.atmosphere = \"mine.toml\"\nobjects.file = \"solids.toml\"\n")
            .unwrap();
    let load = |file: &str| match file {
        "mine.toml" => Ok("name = \"mine\"\nplanet.ground_albedo = 0.5\n"),
        "solids.toml" => Ok("[[object]]\nshape = \"ground\"\n"),
        _ => Err(format!("cannot read {file}")),
    };
    let load = |file: &str| load(file).map(str::to_owned);
    scene.inline_files(load).unwrap();
    let air = scene.atmosphere().unwrap();
    assert_eq!(
        (air.name.as_str(), air.planet.ground_albedo.at(550.0)),
        ("mine", 0.5)
    );
    let objects = scene.objects.clone().unwrap();
    assert_eq!(
        (objects.file, objects.object[0].shape),
        (None, ObjectShape::Ground)
    );
    // A scene with inlined files does not need them any more.
    let again = Scene::from_toml(&scene.to_toml().unwrap()).unwrap();
    assert_eq!(again, scene);
    let mut missing = Scene::from_toml("objects.file = \"nothing.toml\"\n").unwrap();
    let error = missing.inline_files(load).unwrap_err().to_string();
    assert_eq!(error, "objects.file: cannot read nothing.toml");
    let mut wrong = Scene::from_toml("objects.file = \"o.toml\"\n").unwrap();
    let error = wrong.inline_files(|_: &str| Ok::<_, String>("[[object]]\nshap = 1\n".to_owned()));
    let error = error.unwrap_err().to_string();
    assert!(
        error.starts_with("objects.file: o.toml: line 2, column 1: object[0].shap: unknown key"),
        "{error}"
    );
}

#[cfg(feature = "schema")]
#[test]
fn the_schema_contains_all_keys() {
    let schema: serde_json::Value = serde_json::from_str(&Scene::json_schema()).unwrap();
    let text = schema.to_string();
    let key = |line: &str| line.split_once(" =").map(|(key, _)| key.trim().to_owned());
    for key in FULL.lines().filter_map(key) {
        assert!(text.contains(&format!("\"{key}\"")), "{key}");
    }
    assert_eq!(schema["additionalProperties"], false);
    let properties = schema["properties"].as_object().unwrap();
    assert_eq!(properties.len(), 12);
}
