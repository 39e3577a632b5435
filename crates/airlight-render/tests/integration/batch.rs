//! Fog over many pictures: pairs, existing pictures, variation, the manifest.

use super::common::Folder;
use airlight::scene::FogProfile;
use airlight_image::Control;
use airlight_render::batch::{BatchError, BatchPlan, BatchReport, BatchSettings, listed};
use airlight_render::overlay::OverlayScene;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Pictures `rgb/NAME.png` and depths `depth/NAME.png`.
struct Pictures(Folder);

impl Pictures {
    fn new(names: &[&str]) -> Self {
        let folder = Self(Folder::new());
        for (number, name) in (1..).zip(names) {
            folder.picture(&format!("rgb/{name}.png"), number);
            folder.depth(&format!("depth/{name}.png"), (40, 30));
        }
        folder
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.file(name)
    }

    fn names(&self, below: &str) -> Vec<String> {
        self.0.names(below)
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.file(name)).unwrap()
    }

    fn picture(&self, name: &str, number: u8) {
        let path = self.file(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let colour = |x, y| image::Rgb([(x * 5) as u8, (y * 7) as u8, 20 * number]);
        image::RgbImage::from_fn(40, 30, colour).save(path).unwrap();
    }

    /// A depth map in millimetres.
    fn depth(&self, name: &str, (width, height): (u32, u32)) {
        let path = self.file(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let millimetres = |x, y| image::Luma([(2000 + 100 * x + 50 * y) as u16]);
        let map = image::ImageBuffer::from_fn(width, height, millimetres);
        map.save(path).unwrap();
    }

    /// Pictures with depth by patterns or folders, in fog of a visibility.
    fn scene(&self, colour: &str, depth: &str, output: &str, visibility_m: f64) -> OverlayScene {
        let mut scene = self.varied(colour, depth, output);
        scene.fog_mut().visibility_m = Some(visibility_m);
        scene
    }

    fn varied(&self, colour: &str, depth: &str, output: &str) -> OverlayScene {
        let mut scene = OverlayScene::default();
        scene.overlay.colour = self.file(colour);
        scene.overlay.depth = Some(self.file(depth));
        scene.overlay.depth_scale = 0.001;
        scene.scene.output.file = Some(self.file(output).to_str().unwrap().to_owned());
        scene
    }

    /// All pictures into `out/`.
    fn usual(&self, visibility_m: f64) -> OverlayScene {
        self.scene("rgb/*.png", "depth/*.png", "out/*.png", visibility_m)
    }

    /// The lines of a manifest, by output.
    fn manifest(&self, name: &str) -> BTreeMap<String, Map<String, Value>> {
        let text = fs::read_to_string(self.file(name)).unwrap();
        assert!(text.ends_with('\n'));
        let lines: Vec<Map<String, Value>> = text
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        let count = lines.len();
        let by_output: BTreeMap<_, _> = lines
            .into_iter()
            .map(|line| (line["output"].as_str().unwrap().to_owned(), line))
            .collect();
        assert_eq!(by_output.len(), count, "an output has two lines");
        by_output
    }
}

fn vary(texts: &[&str]) -> BatchSettings {
    BatchSettings {
        vary: texts.iter().map(|text| text.parse().unwrap()).collect(),
        ..BatchSettings::default()
    }
}

fn run(scene: OverlayScene, settings: BatchSettings) -> Result<BatchReport, BatchError> {
    let plan = BatchPlan::new(scene, settings)?;
    plan.start()?.run(Control::default())
}

/// Number of pictures made; all must succeed.
fn made(scene: OverlayScene, settings: BatchSettings) -> usize {
    let report = run(scene, settings).unwrap();
    assert!(report.stopped.is_none(), "{:?}", report.stopped);
    assert_eq!(report.failures, [""; 0]);
    report.made
}

fn refused(scene: OverlayScene, settings: BatchSettings) -> String {
    run(scene, settings).unwrap_err().to_string()
}

#[test]
fn folders_pair_by_name_and_patterns_by_their_captures() {
    let folder = Pictures::new(&["a", "b"]);
    for (colour, depth, output, expected) in [
        ("rgb", "depth/", "by_name", "by_name/a.png"),
        ("rgb/*.png", "depth", "jpg/x-*.jpg", "jpg/x-b.jpg"),
        ("r*b/*.png", "depth/a.png", "parts/*/*.png", "parts/g/b.png"),
        ("**/a.png", "depth/b.png", "deep/**.png", "deep/rgb.png"),
        ("rgb/a.png", "depth", "one", "one/a.png"),
    ] {
        let scene = folder.scene(colour, depth, output, 8.0);
        assert!(made(scene, BatchSettings::default()) > 0);
        assert!(folder.file(expected).is_file(), "{expected}");
    }
    let lines = folder.manifest("by_name/manifest.jsonl");
    let line = &lines["b.png"];
    let overlay = &line["scene"]["overlay"];
    assert_eq!(
        overlay["colour"],
        folder.file("rgb/b.png").to_str().unwrap()
    );
    assert_eq!(
        overlay["depth"],
        folder.file("depth/b.png").to_str().unwrap()
    );
    assert_eq!(line["scene"]["fog"]["visibility_m"], 8.0);
    assert_eq!((&line["width"], &line["height"]), (&40.into(), &30.into()));
    let extinction = line["extinction_per_m"].as_f64().unwrap();
    assert!((extinction - 20f64.ln() / 8.0).abs() < 1e-12);
    assert_eq!(line["ambient_rgb"].as_array().unwrap().len(), 3);
    assert_eq!(line["ambient_from"], "dark-channel");
}

#[test]
fn existing_pictures_are_kept_and_missing_ones_made() {
    let folder = Pictures::new(&["a", "b", "c"]);
    let scene = folder.varied("rgb/*.png", "depth/*.png", "out/*.png");
    let settings = BatchSettings {
        seed: 7,
        ..vary(&["visibility=5..50"])
    };
    assert_eq!(made(scene.clone(), settings.clone()), 3);
    let whole = ["a", "b", "c"].map(|name| folder.bytes(&format!("out/{name}.png")));
    let manifest = folder.bytes("out/manifest.jsonl");
    fs::remove_file(folder.file("out/b.png")).unwrap();
    fs::write(folder.file("out/c.png"), "").unwrap();
    // As a kill leaves it: the last line is unfinished.
    let torn = &manifest[..manifest.len() - 100];
    fs::write(folder.file("out/manifest.jsonl"), torn).unwrap();
    assert_eq!(made(scene.clone(), settings.clone()), 2);
    for (name, whole) in ["a", "b", "c"].iter().zip(&whole) {
        assert_eq!(&folder.bytes(&format!("out/{name}.png")), whole);
    }
    assert_eq!(folder.bytes("out/manifest.jsonl"), manifest);
    assert_eq!(made(scene.clone(), settings.clone()), 0);
    let overwrite = BatchSettings {
        overwrite: true,
        ..settings
    };
    assert_eq!(made(scene, overwrite), 3);
    assert_eq!(folder.bytes("out/manifest.jsonl"), manifest);
}

#[test]
fn pictures_with_other_settings_are_not_mixed_with_new_ones() {
    let folder = Pictures::new(&["a", "b"]);
    let plain = BatchSettings::default;
    made(folder.usual(8.0), plain());
    fs::remove_file(folder.file("out/b.png")).unwrap();
    let manifest = folder.bytes("out/manifest.jsonl");
    let sentence = refused(folder.usual(9.0), plain());
    assert!(
        sentence.contains("fog.visibility_m was 8.0, is 9.0") && sentence.contains("overwrite"),
        "{sentence}"
    );
    assert_eq!(folder.names("out"), ["a.png", "manifest.jsonl"]);
    assert_eq!(folder.bytes("out/manifest.jsonl"), manifest);
    let other = folder.scene("rgb/*.png", "depth/b.png", "out/*.png", 8.0);
    let sentence = refused(other, plain());
    assert!(sentence.contains("overlay.depth was "), "{sentence}");
    let mut single = folder.usual(8.0);
    single.fog_mut().scattering = Some(airlight::fog::FogScattering::Single);
    let sentence = refused(single, plain());
    assert!(
        sentence.contains("fog.scattering was not set, is \"single\""),
        "{sentence}"
    );
    // More variants are not other settings.
    let varied = || folder.varied("rgb/*.png", "depth/*.png", "v/*.png");
    let variants = |count| BatchSettings {
        variants: NonZeroU32::new(count),
        ..vary(&["visibility=5..9"])
    };
    assert_eq!(made(varied(), variants(1)), 2);
    assert_eq!(made(varied(), variants(3)), 4);
    // Files that are not in the manifest are neither taken for finished pictures nor overwritten.
    fs::create_dir(folder.file("mine")).unwrap();
    fs::write(folder.file("mine/a.png"), "mine").unwrap();
    let mine = folder.scene("rgb/*.png", "depth/*.png", "mine/*.png", 9.0);
    assert!(refused(mine, plain()).contains("in the manifest"));
    assert_eq!(folder.names("mine"), ["a.png"]);
    assert_eq!(folder.bytes("mine/a.png"), b"mine");
}

#[test]
fn draws_depend_on_names_not_on_threads() {
    let names: Vec<String> = (0..8).map(|n| format!("p{n}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let folder = Pictures::new(&names);
    let settings = |threads| BatchSettings {
        variants: NonZeroU32::new(2),
        seed: 3,
        threads: NonZeroU32::new(threads),
        ..vary(&[
            "visibility=5..50",
            "fog-profile=uniform,height",
            "sun-elevation=5..60",
            "droplets=fine,coarse",
            "eye-height-m=uniform:1..2",
        ])
    };
    let all = |output| folder.varied("rgb/*.png", "depth/*.png", output);
    assert_eq!(made(all("out/*.png"), settings(1)), 16);
    assert_eq!(made(all("two/*_{variant}.png"), settings(3)), 16);
    let one = folder.manifest("out/manifest.jsonl");
    let two = folder.manifest("two/manifest.jsonl");
    assert_eq!((one.len(), two.len()), (16, 16));
    let (mut visibilities, mut profiles) = (BTreeSet::new(), BTreeSet::new());
    for (first, second) in one.values().zip(two.values()) {
        for key in ["name", "variant", "scene", "ambient_rgb"] {
            assert_eq!(first[key], second[key], "{key}");
        }
        let bytes = |place, line: &Map<String, Value>| {
            folder.bytes(&format!("{place}/{}", line["output"].as_str().unwrap()))
        };
        assert_eq!(bytes("out", first), bytes("two", second));
        let visibility_m = first["scene"]["fog"]["visibility_m"].as_f64().unwrap();
        assert!((5.0..=50.0).contains(&visibility_m));
        assert_eq!(first["seed"], 3);
        profiles.insert(first["scene"]["fog"]["profile"].to_string());
        visibilities.insert(visibility_m.to_string());
    }
    assert_eq!((profiles.len(), visibilities.len()), (2, 16));
    // One picture alone draws the same values as among others.
    let alone = folder.varied("rgb/p5.png", "depth", "alone/");
    made(alone, settings(1));
    let alone = folder.manifest("alone/manifest.jsonl");
    assert_eq!(
        alone["p5_v0002.png"]["scene"]["fog"],
        one["p5_v0002.png"]["scene"]["fog"]
    );
}

fn each(texts: &[&str], varied: &[&str]) -> BatchSettings {
    BatchSettings {
        each: texts.iter().map(|text| text.parse().unwrap()).collect(),
        ..vary(varied)
    }
}

#[test]
fn every_picture_gets_each_value_and_all_combinations() {
    let folder = Pictures::new(&["a", "b"]);
    let settings = || BatchSettings {
        variants: NonZeroU32::new(2),
        ..each(
            &["visibility=5,10,20", "fog-profile=uniform,height"],
            &["eye-height=1..2"],
        )
    };
    let all = |output| folder.varied("rgb/*.png", "depth/*.png", output);
    assert_eq!(made(all("out/*.png"), settings()), 24);
    let lines = folder.manifest("out/manifest.jsonl");
    let line = &lines["a_visibility-10_fog-profile-height_v0002.png"];
    assert_eq!(line["scene"]["fog"]["visibility_m"], 10.0);
    assert_eq!(line["scene"]["fog"]["profile"], "height");
    assert_eq!(line["each"]["visibility"], 10.0);
    assert_eq!(line["each"]["fog-profile"], "height");
    // Draws are those of the variant, whatever the value.
    let other = &lines["a_visibility-5_fog-profile-uniform_v0002.png"];
    assert_eq!(line["scene"]["observer"], other["scene"]["observer"]);
    let (first, second) = (
        "a_visibility-5_fog-profile-height_v0001.png",
        "b_visibility-5_fog-profile-height_v0001.png",
    );
    assert_ne!(line["scene"]["observer"], lines[first]["scene"]["observer"]);
    assert_ne!(
        lines[first]["scene"]["observer"],
        lines[second]["scene"]["observer"]
    );
    assert_eq!(made(all("out/*.png"), settings()), 0);
    // Places for values in the name of the output.
    let output = "v/{visibility}/*_{fog-profile}_{variant}.png";
    assert_eq!(made(all(output), settings()), 24);
    let lines = folder.manifest("v/manifest.jsonl");
    assert!(lines.contains_key("20/b_uniform_0001.png"));
    let same = |a: &str, b: &str| assert_eq!(folder.bytes(a), folder.bytes(b));
    same(
        "v/20/b_uniform_0001.png",
        "out/b_visibility-20_fog-profile-uniform_v0001.png",
    );
    // A single value is that of the option.
    let single = each(&["visibility=8"], &[]);
    assert_eq!(made(all("one/{visibility}/*.png"), single), 2);
    made(
        folder.scene("rgb/*.png", "depth/*.png", "eight/*.png", 8.0),
        BatchSettings::default(),
    );
    same("one/8/a.png", "eight/a.png");
}

/// Values that change how a file is read give what the option gives.
#[test]
fn values_of_depth_are_read_for_each_picture() {
    let folder = Pictures::new(&["a"]);
    let scene = |output: &str| folder.scene("rgb/*.png", "depth/*.png", output, 8.0);
    let settings = each(&["depth-scale=0.001,0.002"], &[]);
    assert_eq!(made(scene("e/{depth-scale}/*.png"), settings), 2);
    for (scale, name) in [(0.001, "one"), (0.002, "two")] {
        let mut alone = scene(&format!("{name}/*.png"));
        alone.overlay.depth_scale = scale;
        made(alone, BatchSettings::default());
        assert_eq!(
            folder.bytes(&format!("e/{scale}/a.png")),
            folder.bytes(&format!("{name}/a.png"))
        );
    }
}

#[test]
fn shards_make_together_what_one_run_makes() {
    let names: Vec<String> = (0..7).map(|n| format!("p{n}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let folder = Pictures::new(&names);
    let settings = |shard: Option<&str>| BatchSettings {
        shard: shard.map(|text| text.parse().unwrap()),
        seed: 5,
        variants: NonZeroU32::new(2),
        ..each(
            &["patch-strength=0,0.8"],
            &["visibility=5..50", "patch-seed=0..99"],
        )
    };
    let all = |output| folder.varied("rgb/*.png", "depth/*.png", output);
    assert_eq!(made(all("whole/*.png"), settings(None)), 28);
    let counts = ["1/3", "2/3", "3/3"].map(|shard| made(all("parts/*.png"), settings(Some(shard))));
    assert_eq!(counts, [12, 8, 8]);
    let manifests: Vec<String> = folder
        .names("parts")
        .into_iter()
        .filter(|name| name.ends_with(".jsonl"))
        .collect();
    let name = |number: u32| format!("manifest-{number}-of-3.jsonl");
    assert_eq!(manifests, [name(1), name(2), name(3)]);
    // Joined, the manifests are that of one run, and the pictures are the same.
    let joined: Vec<u8> = manifests
        .iter()
        .flat_map(|name| folder.bytes(&format!("parts/{name}")))
        .collect();
    fs::write(folder.file("parts/manifest.jsonl"), joined).unwrap();
    assert_eq!(made(all("parts/*.png"), settings(None)), 0);
    assert_eq!(
        folder.bytes("parts/manifest.jsonl"),
        folder.bytes("whole/manifest.jsonl")
    );
    for picture in folder.names("whole") {
        assert_eq!(
            folder.bytes(&format!("parts/{picture}")),
            folder.bytes(&format!("whole/{picture}"))
        );
    }
    // A shard resumes; one without inputs makes nothing.
    fs::remove_file(folder.file("parts/p1_patch-strength-0_v0001.png")).unwrap();
    assert_eq!(made(all("parts/*.png"), settings(Some("1/3"))), 0);
    assert_eq!(made(all("parts/*.png"), settings(Some("2/3"))), 1);
    assert_eq!(made(all("parts/*.png"), settings(Some("9/9"))), 0);
}

#[test]
fn a_picture_that_fails_does_not_stop_the_others() {
    let folder = Pictures::new(&["a", "b", "c", "d"]);
    let whole = folder.bytes("rgb/b.png");
    fs::write(folder.file("rgb/b.png"), &whole[..whole.len() / 2]).unwrap();
    folder.depth("depth/c.png", (41, 30));
    let report = run(folder.usual(8.0), BatchSettings::default()).unwrap();
    assert_eq!((report.made, report.failures.len()), (2, 2));
    let failures = listed(&report.failures);
    assert!(
        failures.contains("rgb/b.png") && failures.contains("41 x 30"),
        "{failures}"
    );
    assert_eq!(folder.names("out"), ["a.png", "d.png", "manifest.jsonl"]);
    let lines = folder.manifest("out/manifest.jsonl");
    assert_eq!(lines.len(), 4);
    let error = lines["c.png"]["error"].as_str().unwrap();
    assert!(error.contains("41 x 30") && !lines["a.png"].contains_key("error"));
    // Repaired, they are made, and their lines say so.
    fs::write(folder.file("rgb/b.png"), whole).unwrap();
    folder.depth("depth/c.png", (40, 30));
    assert_eq!(made(folder.usual(8.0), BatchSettings::default()), 2);
    let lines = folder.manifest("out/manifest.jsonl");
    assert!(lines.values().all(|line| !line.contains_key("error")));
    // With fail_fast it stops at the first failure.
    fs::write(folder.file("rgb/b.png"), "").unwrap();
    let settings = BatchSettings {
        overwrite: true,
        fail_fast: true,
        threads: NonZeroU32::new(1),
        ..BatchSettings::default()
    };
    let report = run(folder.usual(8.0), settings).unwrap();
    let stopped = report.stopped.unwrap().to_string();
    assert!(
        stopped.contains("first failure") && stopped.contains("0 bytes"),
        "{stopped}"
    );
}

#[test]
fn a_cancelled_batch_leaves_what_is_done() {
    let folder = Pictures::new(&["a", "b"]);
    let plan = BatchPlan::new(folder.usual(8.0), BatchSettings::default()).unwrap();
    let report = plan
        .start()
        .unwrap()
        .run(Control::cancelled_by(&AtomicBool::new(true)))
        .unwrap();
    assert_eq!(report.made, 0);
    assert!(report.stopped.unwrap().is_cancelled());
    assert_eq!(folder.names("out"), [""; 0]);
    assert_eq!(made(folder.usual(8.0), BatchSettings::default()), 2);
}

#[test]
fn names_that_need_escaping_are_recorded() {
    let name = "a \"quoted\" \\ \u{e9}t\u{e9}";
    let folder = Pictures::new(&[name]);
    made(folder.usual(8.0), BatchSettings::default());
    let lines = folder.manifest("out/manifest.jsonl");
    assert_eq!(lines[&format!("{name}.png")]["name"], name);
}

#[test]
fn unpaired_pictures_are_refused_or_left_out() {
    let folder = Pictures::new(&["a", "b", "c"]);
    fs::remove_file(folder.file("depth/b.png")).unwrap();
    folder.depth("depth/z.png", (40, 30));
    for scene in [folder.usual(8.0), folder.scene("rgb", "depth", "out", 8.0)] {
        let error = run(scene, BatchSettings::default()).unwrap_err();
        assert!(!error.is_refusal());
        let sentence = error.to_string();
        assert!(
            sentence.contains("each of 3 pictures, got none for 1"),
            "{sentence}"
        );
        assert!(sentence.contains("b.png`: there is no `"), "{sentence}");
    }
    let settings = BatchSettings {
        skip_unpaired: true,
        ..BatchSettings::default()
    };
    let plan = BatchPlan::new(folder.usual(8.0), settings.clone()).unwrap();
    assert_eq!(plan.found().without_depth.len(), 1);
    assert_eq!(plan.found().unused_depths, [folder.file("depth/z.png")]);
    assert_eq!(made(folder.usual(8.0), settings), 2);
    fs::write(folder.file("depth/c.npy"), "").unwrap();
    let sentence = refused(
        folder.scene("rgb", "depth", "o", 8.0),
        BatchSettings::default(),
    );
    assert!(sentence.contains("could both be its depth"), "{sentence}");
}

#[test]
fn contradictions_are_refused_before_anything_is_written() {
    let folder = Pictures::new(&["a", "b"]);
    folder.picture("twice/a.png", 1);
    fs::copy(folder.file("twice/a.png"), folder.file("twice/a.jpg")).unwrap();
    fs::create_dir(folder.file("empty")).unwrap();
    for name in ["x_y/z", "x/y_z"] {
        folder.picture(&format!("deep/{name}.png"), 1);
    }
    let before = folder.names("");
    let paths = |colour, output| folder.scene(colour, "depth/a.png", output, 8.0);
    for (scene, part) in [
        (paths("none/*.png", "out/*.png"), "cannot read the folder"),
        (
            paths("rgb/*.bmp", "out/*.png"),
            "expected pictures, got none",
        ),
        (paths("empty", "out"), "expected pictures, got none"),
        (
            folder.scene("rgb/*.png", "depth/*_*.png", "out/*.png", 8.0),
            "in the depth pattern",
        ),
        (paths("rgb/*.png", "out/*/*.png"), "in the output pattern"),
        (
            paths("rgb/*.png", "out/***.png"),
            "text between the wildcards",
        ),
        (paths("rgb/*.png", "out.png"), "one file for all"),
        (paths("rgb/*.png", "out/*.tif"), "Known endings"),
        (paths("rgb/*.png", "rgb/*.png"), "not an input"),
        (paths("rgb/*.png", "rgb/*_fog.png"), "the next run"),
        (paths("twice", "out"), "both called `a`"),
        (paths("deep/*/*.png", "out/*_*.png"), "x_y_z.png` for both"),
    ] {
        let sentence = refused(scene, BatchSettings::default());
        assert!(sentence.contains(part), "{part}: {sentence}");
    }
    let mut layers = paths("rgb/*.png", "out/*.png");
    layers.overlay.layers = true;
    assert!(refused(layers, BatchSettings::default()).contains(".exr"));
    let mut given = folder.usual(5.0);
    given.fog_mut().profile = Some(FogProfile::Uniform);
    for (texts, part) in [
        (&["sun-azimuth=0..20"][..], "expected a sun"),
        (&["ambient-red=0..1", "ambient-blue=1"], "overlay.ambient"),
        (&["droplets=fine", "droplets=coarse"], "each setting once"),
        (&["visibility=5..9"], "leaving one of them out"),
        (&["scale-height=5..9"], "fog-profile height or clamped"),
        (
            &["fog-profile=uniform,height", "top=5..9"],
            "fog-profile slab",
        ),
    ] {
        let sentence = refused(given.clone(), vary(texts));
        assert!(sentence.contains(part), "{part}: {sentence}");
    }
    for (texts, varied, part) in [
        (&["visibility=5,9"][..], &[][..], "leaving one of them out"),
        (&["top=5,9"], &[], "fog-profile slab"),
        (
            &["droplets=fine"],
            &["droplets=coarse"],
            "each setting once",
        ),
        (
            &["patch-strength=0,1", "fog-profile=uniform,exp2"],
            &[],
            "patches: expected fog that scatters",
        ),
    ] {
        let sentence = refused(given.clone(), each(texts, varied));
        assert!(sentence.contains(part), "{part}: {sentence}");
    }
    let many: Vec<String> = (1..=1001).map(|n| n.to_string()).collect();
    let many = each(
        &[
            &format!("eye-height={}", many.join(",")),
            &format!("patch-seed={}", many.join(",")),
        ],
        &[],
    );
    assert!(refused(given.clone(), many).contains("1002001 combinations"));
    // Both ends of a range are checked.
    let sentence = refused(given.clone(), vary(&["sun-elevation=-5..20"]));
    assert!(sentence.contains("sun above the horizon"), "{sentence}");
    let mut patchy = given.clone();
    patchy.fog_mut().patches = Some(Default::default());
    patchy.scene.lights = vec![super::lights::point([0.0, 1.0, -5.0], 1.0)];
    let sentence = refused(patchy, BatchSettings::default());
    assert!(
        sentence.contains("fog.patches: expected fog in daylight"),
        "{sentence}"
    );
    let mut skylit = folder.usual(8.0);
    skylit.overlay.sky_light = true;
    skylit.fog_mut().top_m = Some(20.0);
    skylit.scene.sun.elevation_deg = Some(20.0);
    let sentence = refused(skylit, vary(&["sun-strength=1..3"]));
    assert!(sentence.contains("sun_strength"), "{sentence}");
    let unknown = folder.varied("rgb/*.png", "depth/*.png", "out/*.png");
    assert!(refused(unknown, BatchSettings::default()).contains("a visibility"));
    // A choice that is refused is refused whether it is drawn or not.
    let mut printed = folder.usual(8.0);
    printed.overlay.light_form = airlight::fog::lights::LightForm::Printed;
    printed.scene.lights = vec![super::lights::point([0.0, 1.0, -5.0], 1.0)];
    printed.fog_mut().droplets = Some(airlight::fog::droplets::DropletKind::Isotropic);
    let sentence = refused(printed.clone(), vary(&["fog-profile=uniform,slab"]));
    assert!(sentence.contains("fog-profile uniform"), "{sentence}");
    let sentence = refused(printed, vary(&["droplets=fine,isotropic"]));
    assert!(sentence.contains("droplets isotropic"), "{sentence}");
    assert_eq!(folder.names(""), before);
}

#[test]
fn manifests_that_cannot_be_resumed_are_refused() {
    let folder = Pictures::new(&["a"]);
    let with = |name: &str| BatchSettings {
        manifest: Some(folder.file(name)),
        ..BatchSettings::default()
    };
    let sentence = refused(folder.usual(8.0), with("rgb/a.png"));
    assert!(
        sentence.contains("expected a manifest of pictures"),
        "{sentence}"
    );
    let sentence = refused(folder.usual(8.0), with("rgb"));
    assert!(
        sentence.contains("cannot read or write the manifest"),
        "{sentence}"
    );
    // As version 0.1.0 wrote it.
    let old = "{\"output\":\"a.png\",\"name\":\"a\",\"variant\":1,\"model\":\"uniform\",\"visibility_m\":8.0}\n";
    fs::write(folder.file("old.jsonl"), old).unwrap();
    let sentence = refused(folder.usual(8.0), with("old.jsonl"));
    assert!(
        sentence.contains("version 3, got version 1 in line 1"),
        "{sentence}"
    );
    assert_eq!(folder.bytes("old.jsonl"), old.as_bytes());
    let held = fs::File::create(folder.file("held.jsonl")).unwrap();
    held.lock().unwrap();
    let sentence = refused(folder.usual(8.0), with("held.jsonl"));
    assert!(sentence.contains("another run"), "{sentence}");
}

#[cfg(unix)]
#[test]
fn names_that_are_not_unicode_and_folders_that_cannot_be_created_are_refused() {
    use std::os::unix::ffi::OsStrExt;
    let folder = Pictures::new(&["a"]);
    fs::write(folder.file("file"), "").unwrap();
    let inside = folder.scene("rgb/*.png", "depth/*.png", "file/out/*.png", 8.0);
    let sentence = refused(inside, BatchSettings::default());
    assert!(sentence.contains("cannot create the folder"), "{sentence}");
    let odd = std::ffi::OsStr::from_bytes(b"\xff.png");
    fs::copy(folder.file("rgb/a.png"), folder.file("rgb").join(odd)).unwrap();
    let error = run(folder.usual(8.0), BatchSettings::default()).unwrap_err();
    assert!(matches!(error, BatchError::NotUnicode(_)), "{error}");
}

/// TIFF is read, not written: in a folder, its pictures are PNG.
#[test]
fn tiff_pictures_become_png() {
    let folder = Pictures::new(&["a"]);
    let bytes = folder.bytes("rgb/a.png");
    fs::remove_file(folder.file("rgb/a.png")).unwrap();
    let colours = image::load_from_memory(&bytes).unwrap().into_rgb8();
    fs::create_dir(folder.file("tif")).unwrap();
    fs::write(folder.file("tif/a.TIF"), tiff(&colours)).unwrap();
    fs::write(folder.file("rgb/a.png"), bytes).unwrap();
    for (colour, output) in [("tif", "from_tif"), ("rgb", "from_png")] {
        let scene = folder.scene(colour, "depth", output, 8.0);
        assert_eq!(made(scene, BatchSettings::default()), 1);
    }
    assert_eq!(
        folder.bytes("from_tif/a.png"),
        folder.bytes("from_png/a.png")
    );
    let mut alone = folder.scene("tif", "depth", "alone", 8.0);
    alone.overlay.depth = None;
    assert!(refused(alone, BatchSettings::default()).contains("only EXR pictures hold depth"));
}

/// An uncompressed TIFF file of 8 bits.
fn tiff(colours: &image::RgbImage) -> Vec<u8> {
    let (width, height) = colours.dimensions();
    let count = colours.as_raw().len() as u32;
    // Width, height, bits, interpretation (RGB), offset, components, bytes: tag, kind (16 or 32 bits), number, value.
    let entries = [
        (256u16, 4u16, 1u32, width),
        (257, 4, 1, height),
        (258, 3, 3, 98),
        (262, 3, 1, 2),
        (273, 4, 1, 104),
        (277, 3, 1, 3),
        (279, 4, 1, count),
    ];
    let mut bytes = b"II*\0\x08\0\0\0\x07\0".to_vec();
    for (tag, kind, number, value) in entries {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(number.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend([0; 4]);
    assert_eq!(bytes.len(), 98);
    bytes.extend([8, 0, 8, 0, 8, 0]);
    bytes.extend(colours.as_raw());
    bytes
}

/// The pictures of a film, of which the wind moves the patches: each as it is alone at its time, in a shard, too.
#[test]
fn patches_drift_from_picture_to_picture() {
    let folder = Pictures::new(&["a", "b", "c"]);
    let patchy = |colour: &str, output: &str, time_s: f64| {
        let mut scene = folder.scene(colour, "depth/*.png", output, 8.0);
        scene.fog_mut().patches = Some(airlight::scene::FogPatchesSpec {
            size_m: Some(1.0),
            wind_m_s: Some([3.0, 0.0]),
            time_s: Some(time_s),
            ..Default::default()
        });
        scene
    };
    let film = |shard: Option<&str>| BatchSettings {
        patch_interval_s: Some(0.5),
        shard: shard.map(|text| text.parse().unwrap()),
        ..BatchSettings::default()
    };
    assert_eq!(made(patchy("rgb/*.png", "film/*.png", 4.0), film(None)), 3);
    assert_eq!(
        made(patchy("rgb/*.png", "part/*.png", 4.0), film(Some("2/2"))),
        1
    );
    assert_eq!(folder.bytes("part/b.png"), folder.bytes("film/b.png"));
    for (name, time_s) in [("a", 4.0), ("b", 4.5), ("c", 5.0)] {
        let mut scene = patchy(
            &format!("rgb/{name}.png"),
            &format!("alone/{name}.png"),
            time_s,
        );
        scene.overlay.depth = Some(folder.file(&format!("depth/{name}.png")));
        assert_eq!(made(scene, BatchSettings::default()), 1);
        assert_eq!(
            folder.bytes(&format!("alone/{name}.png")),
            folder.bytes(&format!("film/{name}.png"))
        );
    }
    assert_ne!(folder.bytes("film/a.png"), folder.bytes("film/b.png"));
    let calm = folder.scene("rgb/*.png", "depth/*.png", "calm/*.png", 8.0);
    assert!(refused(calm, film(None)).contains("expected patches of fog that a wind moves"));
}

/// Settings of the output, and settings that are no longer given.
#[test]
fn every_setting_is_recorded_and_compared() {
    let folder = Pictures::new(&["a"]);
    let settings = |change: fn(&mut OverlayScene)| {
        let mut scene = folder.scene("rgb/*.png", "depth/*.png", "out/*.jpg", 8.0);
        change(&mut scene);
        scene
    };
    let as_given = |scene: &mut OverlayScene| {
        scene.scene.output.quality = Some(50);
        scene.scene.air.ground_albedo = Some(0.5);
    };
    let usual = BatchSettings::default;
    assert_eq!(made(settings(as_given), usual()), 1);
    assert_eq!(made(settings(as_given), usual()), 0);
    let sentence = refused(settings(|_| {}), usual());
    for part in [
        "output.quality was 50, is not set",
        "air.ground_albedo was 0.5, is not set",
    ] {
        assert!(sentence.contains(part), "{sentence}");
    }
}

#[test]
fn a_manifest_elsewhere_names_outputs_from_its_own_folder() {
    let folder = Pictures::new(&["a"]);
    let settings = || BatchSettings {
        manifest: Some(folder.file("m.jsonl")),
        ..BatchSettings::default()
    };
    assert_eq!(made(folder.usual(8.0), settings()), 1);
    let lines = folder.manifest("m.jsonl");
    assert_eq!(lines.keys().collect::<Vec<_>>(), ["out/a.png"]);
    assert_eq!(made(folder.usual(8.0), settings()), 0);
}

#[test]
fn a_single_picture_is_what_a_batch_makes_of_it() {
    use airlight_render::overlay::{OverlayImage, PreparedOverlay};
    let folder = Pictures::new(&["a"]);
    made(folder.usual(8.0), BatchSettings::default());
    let scene = folder.scene("rgb/a.png", "depth/a.png", "one.png", 8.0);
    let output = Path::new(scene.scene.output.file.as_ref().unwrap());
    let format = scene.output_format(output).unwrap();
    let image = OverlayImage::read(&scene, format).unwrap();
    let prepared = PreparedOverlay::new(&scene, &image, None).unwrap();
    let rows = prepared.output(&scene, &image, format).unwrap();
    rows.write(output, Control::default()).unwrap();
    assert_eq!(folder.bytes("one.png"), folder.bytes("out/a.png"));
}

#[test]
fn the_manifest_lies_above_the_folders_of_variants() {
    let folder = Pictures::new(&["a"]);
    let settings = || BatchSettings {
        variants: NonZeroU32::new(2),
        ..vary(&["visibility=5..9"])
    };
    let scene = || folder.varied("rgb/*.png", "depth/*.png", "v/{variant}/*.png");
    assert_eq!(made(scene(), settings()), 2);
    let lines = folder.manifest("v/manifest.jsonl");
    assert_eq!(
        lines.keys().collect::<Vec<_>>(),
        ["0001/a.png", "0002/a.png"]
    );
    // A manifest in another folder names outputs from there.
    let elsewhere = BatchSettings {
        manifest: Some(folder.file("rgb/m.jsonl")),
        ..settings()
    };
    let scene = || folder.varied("rgb/*.png", "depth/*.png", "w/{variant}/*.png");
    assert_eq!(made(scene(), elsewhere.clone()), 2);
    let lines = folder.manifest("rgb/m.jsonl");
    assert!(lines.contains_key("../w/0002/a.png"), "{:?}", lines.keys());
    assert_eq!(made(scene(), elsewhere), 0);
}

#[cfg(target_os = "linux")]
#[test]
fn unfinished_files_of_killed_runs_are_removed() {
    let folder = Pictures::new(&["a"]);
    fs::create_dir(folder.file("out")).unwrap();
    // Numbers of processes are below 2^22.
    let (dead, alive) = (u32::MAX, std::process::id());
    for name in [
        format!(".a.png.{dead}-0.part"),
        format!(".manifest.jsonl.{dead}-7.part"),
        format!(".a.png.{alive}-9999999.part"),
        format!(".other.png.{dead}-0.part"),
    ] {
        fs::write(folder.file("out").join(name), "").unwrap();
    }
    let report = run(folder.usual(8.0), BatchSettings::default()).unwrap();
    assert!(
        report.notes.to_string().contains("2 unfinished files"),
        "{}",
        report.notes
    );
    assert_eq!(
        folder.names("out"),
        [
            format!(".a.png.{alive}-9999999.part"),
            format!(".other.png.{dead}-0.part"),
            "a.png".to_owned(),
            "manifest.jsonl".to_owned(),
        ]
    );
}

#[test]
fn what_a_batch_passes_over_or_takes_for_a_folder_is_said() {
    let folder = Pictures::new(&["a"]);
    for name in ["b.webp", "c.bmp", "depth.npy"] {
        fs::write(folder.file("rgb").join(name), "").unwrap();
    }
    let scene = folder.scene("rgb", "depth", "out", 8.0);
    let plan = BatchPlan::new(scene, BatchSettings::default()).unwrap();
    let expected = ["rgb/b.webp", "rgb/c.bmp", "rgb/depth.npy"].map(|name| folder.file(name));
    assert_eq!(plan.found().passed_over, expected);
    let dotted = folder.scene("rgb/*.png", "depth/*.png", "foggy_v1.0", 8.0);
    let sentence = refused(dotted, BatchSettings::default());
    assert!(sentence.contains("foggy_v1.0/` for a folder"), "{sentence}");
    // With layers, a folder gets EXR files.
    let mut layers = folder.scene("rgb", "depth", "layers", 8.0);
    layers.overlay.layers = true;
    assert_eq!(made(layers, BatchSettings::default()), 1);
    assert!(folder.file("layers/a.exr").is_file());
}
