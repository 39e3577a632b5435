//! What makes no sense is refused in a sentence, with its exit code, and leaves nothing behind.

use crate::common::{Folder, command, run, succeed};

const SUN: &str = "--wavelengths rgb --scattering single --size 16x8 --sun-elevation 30";

/// Runs, and checks the exit code, that the message holds a text, and that no file appeared.
fn refused(folder: &Folder, words: &str, code: i32, part: &str) {
    let before = folder.names("");
    let output = run(folder, words);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{words}: {error}");
    assert!(error.contains(part), "{words}: `{part}` is not in: {error}");
    assert!(!error.contains("panicked"), "{words}: {error}");
    assert_eq!(folder.names(""), before, "{words}");
}

#[test]
fn bad_use_of_sky() {
    let folder = Folder::new();
    std::fs::write(
        folder.file("bad.toml"),
        "base = \"clear\"\n[aerosol]\naod_505 = 0.1\n",
    )
    .unwrap();
    std::fs::write(folder.file("broken.toml"), "base = [").unwrap();
    std::fs::write(folder.file("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
    for (words, part) in [
        ("sky -o a.exr", "--sun-elevation"),
        (
            "sky --sun-elevation 30 --haze-thickness-m 500 -o a.exr",
            "klassen1987",
        ),
        (
            "sky --solver klassen1987 --sun-elevation -2 -o a.exr",
            "at the horizon or above",
        ),
        (
            "sky --solver klassen1987 --sun-elevation 2 --altitude-m 9000 -o a.exr",
            "expected an eye on the ground",
        ),
        (
            "sky --solver klassen1987 --sun-elevation 2 --haze-thickness-m 9e4 -o a.exr",
            "effective top of the air",
        ),
        ("sky --sun-elevation 30", "--output"),
        ("sky --sun-elevation NaN -o a.exr", "-90 to 90"),
        ("sky --sun-elevation 91 -o a.exr", "-90 to 90"),
        ("sky --sun-azimuth 10 -o a.exr", "--sun-azimuth"),
        ("sky --at 100,0 -o a.exr", "a latitude from -90 to 90"),
        ("sky --at 10,361 -o a.exr", "a longitude from -180 to 360"),
        (
            "sky --sun-elevation 30 --exposure 12 -o a.exr",
            "--exposure: expected a file whose name ends in .png or .jpg",
        ),
        (
            "sky --sun-elevation 30 --scale 2 -o a.png",
            "--scale: expected a file whose name ends in .exr or .hdr",
        ),
        ("sky --sun-elevation 30 --bits 16 -o a.jpg", "--bits"),
        // Values and options in advice are as typed here, not as in scene files.
        (
            "sky --sun-elevation 30 --polarisation-correction maybe -o a.exr",
            "expected on or off",
        ),
        (
            "sky --sun-elevation 30 --stars maybe -o a.exr",
            "expected on or off",
        ),
        (
            "sky --sun-elevation 30 --top-m 40 -o a.exr",
            "try --visibility-m 200",
        ),
        (
            "sky --sun-elevation 30 --until +1h -o a.exr",
            "try --every 10m",
        ),
        (
            "sky --sun-elevation 30 --tone clip --tone-contrast 2 -o a.png",
            "try --tone camera",
        ),
        (
            "sky --sun-elevation 30 --projection perspective --fov 190 -o a.exr",
            "--fov: the camera's field of view",
        ),
        ("plot phase --droplets rain -o a.gif", "got `a.gif`"),
        (
            "sky --sun-elevation 30 --meter-each -o a.png",
            "--meter-each: expected a sequence",
        ),
        (
            "sky --sun-elevation 30 --projection cube --orientation unity -o a.exr",
            "--orientation: expected airlight or three for a cube map",
        ),
        ("sky --at 1;2 -o a.exr", "latitude,longitude"),
        (
            "sky --at 1,2 --sun-elevation 3 -o a.exr",
            "cannot be used with",
        ),
        (
            "sky --at 1,2 --when yesterday -o a.exr",
            "2013-05-27T16:30:00Z",
        ),
        (
            "sky --at 1,2 --when 2026-02-30T00:00:00Z -o a.exr",
            "'day' for `2026-02`",
        ),
        (
            "sky --at 1,2 --when 9999-01-01T00:00:00Z -o a.exr",
            "9999-01-01",
        ),
        ("sky --sun-elevation 30 --size 0x0 -o a.exr", "1 to 65536"),
        (
            "sky --sun-elevation 30 --size 70000x10 -o a.exr",
            "1 to 65536",
        ),
        (
            "sky --sun-elevation 30 --size 99999999999x1 -o a.exr",
            "1 to 65536",
        ),
        ("sky --sun-elevation 30 -o a.bmp", ".exr"),
        ("sky --sun-elevation 30 -o a", "no ending"),
        (
            "sky --sun-elevation 30 --atmosphere claer -o a.exr",
            "try \"clear\"",
        ),
        (
            "sky --sun-elevation 30 --atmosphere bad.toml -o a.exr",
            "line 3",
        ),
        (
            "sky --sun-elevation 30 --atmosphere bad.toml -o a.exr",
            "aod_550",
        ),
        (
            "sky --sun-elevation 30 --atmosphere broken.toml -o a.exr",
            "broken.toml",
        ),
        (
            "sky --sun-elevation 30 --atmosphere binary.toml -o a.exr",
            "UTF-8",
        ),
        ("sky --at 1,2 --atmosphere mars -o a.exr", "--sun-elevation"),
        (
            "sky --sun-elevation 30 --atmosphere mars --ozone-du 300 -o a.exr",
            "Earth",
        ),
        (
            "sky --sun-elevation 30 --aerosol dessert -o a.exr",
            "try \"desert\"",
        ),
        (
            "sky --sun-elevation 30 --aerosol urban --humidity 80 -o a.exr",
            "0.8 is 80 %",
        ),
        (
            "sky --sun-elevation 30 --humidity 0.5 -o a.exr",
            "--humidity: expected aerosol",
        ),
        (
            "sky --sun-elevation 30 --aerosol desert --atmosphere mars -o a.exr",
            "Earth",
        ),
        ("sky --sun-elevation 30 --aod-550 -1 -o a.exr", "--aod-550"),
        (
            "sky --sun-elevation 30 --aod-550 0.1 --turbidity 2 -o a.exr",
            "cannot be used with",
        ),
        (
            "sky --sun-elevation 30 --turbidity 0.5 -o a.exr",
            "turbidity",
        ),
        (
            "sky --sun-elevation 30 --haze-visibility-m 1e9 -o a.exr",
            "visibility",
        ),
        (
            "sky --sun-elevation 30 --ground-albedo 1.5 -o a.exr",
            "0 to 1",
        ),
        (
            "sky --sun-elevation 30 --ground-altitude-m 2e5 -o a.exr",
            "--ground-altitude-m: expected a ground below the top",
        ),
        (
            "sky --sun-elevation 30 --wavelengths red -o a.exr",
            "standard",
        ),
        (
            "sky --sun-elevation 30 --wavelengths 200,500 -o a.exr",
            "300 nm",
        ),
        (
            "sky --sun-elevation 30 --wavelengths 500,400 -o a.exr",
            "increasing",
        ),
        ("sky --sun-elevation 30 --exposure bright -o a.png", "auto"),
        (
            "sky --sun-elevation 30 --exposure 1000 -o a.png",
            "-40 and 60",
        ),
        ("sky --sun-elevation 30 --brighten 1e9 -o a.png", "exposure"),
        ("sky --sun-elevation 30 --spectral -o a.png", ".exr"),
        (
            "sky --sun-elevation 30 --color-space acescg -o a.png",
            "--color-space: expected a file whose name ends in .exr or .hdr",
        ),
        ("sky --sun-elevation 30 --sun-disc separate", "--output"),
        (
            "sky --sun-elevation 30 --solver preetham --ozone-du 500 -o a.exr",
            "--ozone-du: expected a solver that honours the ozone column",
        ),
        (
            "sky --sun-elevation 30 --solver preetham --visibility-m 100 -o a.exr",
            "--visibility-m: expected a solver that honours fog",
        ),
        ("sky --sun-elevation 30 --paths 256 -o a.exr", "monte-carlo"),
        ("sky --sun-elevation 30 --noise-map -o a.exr", "monte-carlo"),
        (
            "sky --sun-elevation 30 --solver monte-carlo --paths 5 -o a.exr",
            "128",
        ),
        (
            "sky --sun-elevation 30 --objects bad.toml --solver monte-carlo -o a.exr",
            "bad.toml",
        ),
        ("sky --scene broken.toml -o a.exr", "broken.toml"),
        ("sky --scene bad.toml -o a.exr", "aerosol: unknown key"),
        (
            "sky --sun-elevation 30 --fov 90 -o a.exr",
            "projection fisheye or perspective",
        ),
        (
            "sky --sun-elevation 30 --camera-roll 9 --projection fisheye -o a.exr",
            "perspective",
        ),
        (
            "sky --sun-elevation 30 --projection perspective --fov 180 -o a.exr",
            "below 180",
        ),
        (
            "sky --sun-elevation 30 --projection fisheye --fov 400 -o a.exr",
            "360",
        ),
        (
            "sky --sun-elevation 30 --projection cube --size 8x4 -o a.exr",
            "as wide as high",
        ),
        ("sky --sun-elevation 30 --scale 0 -o a.exr", "above 0"),
        (
            "sky --sun-elevation 30 --quality 0 -o a.jpg",
            "from 1 to 100",
        ),
        ("sky --sun-elevation 30 --bits 12 -o a.png", "16"),
        (
            "sky --sun-elevation 30 --threads 0 -o a.png",
            "from 1 to 1024",
        ),
        ("sky --sun-elevation 30 --altitude-m inf -o a.png", "metres"),
        (
            "sky --sun-elevation 30 --until +1h --every 10m -o a.png",
            "a sun of place and time",
        ),
        (
            "sky --at 1,2 --when 2026-01-01T00:00:00Z --until +1h -o a.png",
            "--until: expected every with this key",
        ),
        (
            "sky --at 1,2 --when 2026-01-01T00:00:00Z --until +1h --every 5x -o a.png",
            "1h30m",
        ),
        (
            "sky --at 1,2 --when 2026-01-01T00:00:00Z --until 2025-01-01T00:00:00Z --every 5m -o a.png",
            "later",
        ),
        (
            "sky --at 1,2 --when 2026-01-01T00:00:00Z --until +9000d --every 1s -o a.png",
            "1000000",
        ),
        (
            "sky --at 1,2 --when 2026-01-01T00:00:00Z --until +9000000d --every 9000d -o a.png",
            "expected year from -2000 to 6000",
        ),
        (
            "sky --at 1,2 --when 2026-01-01T00:00:00Z --until +1h --every 10m",
            "--output",
        ),
        ("", "Usage"),
        ("draw", "--help"),
        ("atmospheres claer", "\"clear\""),
        ("shaders --lang glsl -o shaders", "glsl450"),
        ("shaders --only fogs -o shaders", "'fog'"),
        ("shaders --only fog,,disc -o shaders", "a value is required"),
        ("accuracy random-air", "'random-airs'"),
        ("shaders", "--output"),
    ] {
        refused(&folder, words, 2, part);
    }
}

#[test]
fn failures() {
    let folder = Folder::new();
    std::fs::create_dir(folder.file("dir.exr")).unwrap();
    std::fs::write(folder.file("a.txt"), "").unwrap();
    std::fs::create_dir_all(folder.file("part/airlight-fog-pass.txt")).unwrap();
    for (words, part) in [
        (
            format!("sky {SUN} -o missing/a.exr"),
            "there is no folder `missing`",
        ),
        (format!("sky {SUN} -o dir.exr"), "it is a folder"),
        (
            "sky --sun-elevation 30 --atmosphere none.toml -o a.exr".to_owned(),
            "cannot read",
        ),
        (
            "sky --sun-elevation 30 --objects none.toml -o a.exr".to_owned(),
            "cannot read",
        ),
        ("sky --scene none.toml -o a.exr".to_owned(), "cannot read"),
        (
            "shaders --lang spirv -o a.txt".to_owned(),
            "expected a folder, got the file `a.txt`",
        ),
        (
            "shaders --lang spirv --only fog -o part".to_owned(),
            "cannot write `part/airlight-fog-pass.txt`: it is a folder",
        ),
    ] {
        refused(&folder, &words, 1, part);
    }
    // The modules belong together.
    let left = std::fs::read_dir(folder.file("part")).unwrap();
    assert_eq!(left.count(), 1);
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_a_failure_and_a_reader_gone_is_none() {
    let folder = Folder::new();
    let words = "probe --wavelengths rgb --scattering single --sun-elevation 30 --view 0,90";
    let full = std::fs::File::options()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let output = command(&folder, words).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard output"));

    let mut child = command(&folder, words)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(
        output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn help_and_lists_name_what_there_is() {
    let folder = Folder::new();
    let help = succeed(&folder, "sky --help");
    for part in [
        "Examples:",
        "--at <LAT,LON>",
        "Place and sun:",
        "Air:",
        "Solver:",
        "Picture:",
        "--scene <FILE.toml>",
        "mars: Mars",
        "EV100",
    ] {
        assert!(help.contains(part), "{part}");
    }
    assert!(succeed(&folder, "probe --help").contains("--views <FILE.csv>"));
    assert!(succeed(&folder, "--help").contains("130"));
    // Only the usual options, which point to the others.
    let short = succeed(&folder, "sky -h");
    assert!(short.contains("--help lists all") && !short.contains("--humidity"));
    assert!(succeed(&folder, "help topics").contains("airlight fog rgb --depth depth"));
    assert!(succeed(&folder, "topics").contains("--orientation blender"));
    for (words, similar) in [
        ("help topicz", "'topics'"),
        ("help --threads 2 grit", "'grid'"),
        ("help plot spectrun", "'spectrum'"),
        ("topicz", "'topics'"),
    ] {
        refused(&folder, words, 2, similar);
    }
    refused(&folder, "help xyz", 2, "unrecognized subcommand 'xyz'");
    assert!(succeed(&folder, "completions bash").contains("--haze-visibility-m"));
    succeed(&folder, "man pages");
    let page = std::fs::read_to_string(folder.file("pages/airlight-sky.1")).unwrap();
    assert!(page.contains("orientation") && page.contains(".SH"));
    assert!(succeed(&folder, "--version").starts_with("airlight "));
    succeed(
        &folder,
        "shaders --lang glsl-es300 --only phase -o web/shaders",
    );
    let glsl = std::fs::read_to_string(folder.file("web/shaders/airlight.glsl")).unwrap();
    assert!(glsl.contains("float henyey_greenstein(") && !glsl.contains("uniform_fog"));
    succeed(&folder, "shaders --only fog,sky -o sky");
    let wgsl = std::fs::read_to_string(folder.file("sky/airlight.wgsl")).unwrap();
    for function in [
        "uniform_fog",
        "sky_radiance",
        "air_march",
        "sun_disc_radiance",
    ] {
        assert!(wgsl.contains(&format!("fn {function}(")), "{function}");
    }
    assert!(!wgsl.contains("article_sky"));
    succeed(&folder, "shaders --lang spirv --only fog,fog -o vulkan");
    let mut names: Vec<_> = std::fs::read_dir(folder.file("vulkan"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let spirv = ["airlight-fog-pass.spv", "airlight-fog-pass.txt"];
    assert_eq!(
        names,
        [&spirv[..], &["airlight-fog.spv", "airlight-fog.txt"]].concat()
    );
    let module = std::fs::read(folder.file("vulkan/airlight-fog-pass.spv")).unwrap();
    assert_eq!(module[..4], 0x0723_0203_u32.to_le_bytes());
    let list = succeed(&folder, "atmospheres");
    assert!(list.lines().count() > 8 && list.contains("average"));
    assert!(list.contains("maritime-clean") && list.contains("biomass-savanna"));
    assert!(succeed(&folder, "atmospheres desert").contains("humidity  0.8"));
    assert!(succeed(&folder, "atmospheres mars").contains("optical depth"));
}

/// Errors of arguments show what would work, and errors of files the option that names them.
#[test]
fn errors_name_the_option_and_what_works() {
    let folder = Folder::new();
    for name in ["left.png", "depth.npy", "objects.toml"] {
        std::fs::write(folder.file(name), "").unwrap();
    }
    std::fs::write(folder.file("binary.csv"), [0xff, 0xfe]).unwrap();
    for (words, code, part) in [
        ("fog", 2, "for example: airlight fog photo.png --depth"),
        ("probe --view", 2, "for example: --view 0,90"),
        ("fog left.png --each", 2, "for example: --each "),
        ("compare orders orders2", 2, "'<SOLVER>': expected a solver"),
        ("atmospheres mar", 2, "NAME: expected an atmosphere"),
        (
            "sky --sun-elevation 9 -o none/a.png",
            1,
            "--output: cannot write `none/a.png`: there is no folder `none`; create it first",
        ),
        (
            "probe --sun-elevation 9 --views binary.csv",
            2,
            "--views: `binary.csv`: expected text in UTF-8",
        ),
        (
            "fog left.png left.png --depth depth.npy -o out/",
            2,
            "a pattern in quotes: airlight fog '*.png'",
        ),
        ("sky --seed x -o a.png", 2, "for example: --seed 7"),
        ("compare orders", 2, "for example: airlight compare orders"),
        (
            "sky --sun-elevation 9 --quality 200 -o a.jpg",
            2,
            "expected a whole number from 1 to 100, such as 92",
        ),
        (
            "sky --sun-elevation 9 --threads 0 -o a.jpg",
            2,
            "expected a whole number from 1 to 1024, such as 4",
        ),
        (
            "compare orders preetham --sun-elevation 9 -o a.exr",
            2,
            "got `a.exr`; try `a.png`",
        ),
        ("plot phase -o a.txt", 2, "got `a.txt`; try `a.svg`"),
        (
            "sky --sun-elevation 9 --objects object.toml -o a.png",
            1,
            "--objects: cannot read `object.toml`",
        ),
        (
            "sky --sun-elevation 9 --objects object.toml -o a.png",
            1,
            "; try `objects.toml`",
        ),
        (
            "fog letf.png --depth depth.npy --visibility-m 50 -o a.png",
            1,
            "COLOUR: cannot read `letf.png`",
        ),
        (
            "fog left.png --depth depth.npy --visibility-m 50 --each visibility=5,10 -o a.png",
            2,
            "--each visibility: expected",
        ),
        ("grid left.png -o a.png", 2, ""),
    ] {
        refused(&folder, words, code, part);
    }
}
