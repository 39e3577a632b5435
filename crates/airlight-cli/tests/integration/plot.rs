//! `airlight plot`, and drops by theory in the other commands, as a user meets them.

use crate::common::{Folder, run, succeed};

/// The text of a file.
fn written(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.file(name)).unwrap()
}

#[test]
fn phase_functions_and_efficiencies_are_plotted() {
    let folder = Folder::new();
    for (words, curves) in [
        ("plot phase --polar --size-parameter 0.2,1,10 -o a.svg", 3),
        (
            "plot phase --droplets haze-h,fine --wavelength-nm 450,650 -o a.svg",
            4,
        ),
        ("plot efficiency --to 12 --index 1.5,0.01 -o a.svg", 2),
    ] {
        assert_eq!(succeed(&folder, words), "");
        let svg = written(&folder, "a.svg");
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        // Long curves only: axes have few points.
        let long = |line: &str| line.contains("<polyline") && line.len() > 1000;
        let count = svg.lines().filter(|line| long(line)).count();
        assert_eq!(count, curves, "{words}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
}

#[test]
fn light_air_and_fog_are_plotted() {
    let folder = Folder::new();
    for (words, said) in [
        (
            "plot spectrum --sun-elevation 20 --wavelengths fast -o a.svg",
            "irradiance",
        ),
        (
            "plot spectrum --sun-elevation 20 --wavelengths fast --view 0,90 -o a.svg",
            "elevation 90",
        ),
        (
            "plot transmittance --sun-elevation 20 --wavelengths fast -o a.svg",
            "angle 89",
        ),
        (
            "plot transmittance --sun-elevation 20 --wavelengths fast --map -o a.svg",
            "zenith",
        ),
        ("plot fog-profile --top-m 80 -o a.svg", "top at 80 m"),
        ("plot split-sum -o a.svg", "split sum"),
    ] {
        assert_eq!(succeed(&folder, words), "");
        let svg = written(&folder, "a.svg");
        assert!(svg.contains(said), "{words}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{words}");
    }
    succeed(&folder, "plot split-sum -o a.png");
    let picture = image::open(folder.file("a.png")).unwrap().into_rgb8();
    let colours: std::collections::HashSet<_> = picture.pixels().collect();
    assert!(colours.len() > 50, "{}", colours.len());
}

#[test]
fn plots_of_nothing_are_refused() {
    let folder = Folder::new();
    for (words, sentence) in [
        ("plot phase -o a.svg", "--droplets"),
        ("plot phase --size-parameter 0 -o a.svg", "above 0"),
        ("plot phase --size-parameter 1e9 -o a.svg", "size parameter"),
        (
            "plot phase --size-parameter 1 --index 0 -o a.svg",
            "refractive index",
        ),
        ("plot phase --droplets soup -o a.svg", "heavy-advection-fog"),
        (
            "plot phase --droplets rain --wavelength-nm 1e-9 -o a.svg",
            "size parameter",
        ),
        ("plot efficiency -o a.gif", ".svg"),
        (
            "plot transmittance --sun-elevation 9 --zenith-deg 91 -o a.svg",
            "zenith angle",
        ),
        (
            "plot spectrum --sun-elevation 9 --solver preetham -o a.svg",
            "--wavelengths",
        ),
        ("plot spectrum -o a.svg", "--sun-elevation"),
        ("plot efficiency --to nan -o a.svg", "above 0"),
    ] {
        let output = run(&folder, words);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{words}: {text}");
        assert!(text.contains(sentence), "{words}: {text}");
        assert!(folder.names("").is_empty(), "{words}");
    }
}

/// In RGB and spectrally; theory differs from the grey function, and a kind by its other name does not.
#[test]
fn skies_are_drawn_through_drops_by_theory() {
    let folder = Folder::new();
    let sky = "sky --sun-elevation 20 --wavelengths rgb --size 32x16 -q --visibility-m 300 --top-m 60 \
               --fog-scattering single";
    for (name, kind) in [
        ("grey.png", "radiation"),
        ("cloud.png", "cloud-c3"),
        ("fog.png", "moderate-radiation-fog"),
        ("mist.png", "mist"),
    ] {
        succeed(&folder, &format!("{sky} --droplets {kind} -o {name}"));
    }
    let pixels = |name: &str| image::open(folder.file(name)).unwrap().into_rgb8();
    assert_ne!(pixels("grey.png"), pixels("cloud.png"));
    assert_ne!(pixels("cloud.png"), pixels("fog.png"));
    assert_eq!(pixels("fog.png"), pixels("mist.png"));
    succeed(
        &folder,
        &format!("{sky} --droplets cloud-c3 -o a.spectral.exr"),
    );
}
