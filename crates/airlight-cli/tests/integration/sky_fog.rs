//! Fog in `airlight sky`: what it draws, and what it refuses.

use crate::common::{Exr, Folder, run, succeed};

#[test]
fn fog_changes_the_sky_or_is_refused() {
    let folder = Folder::new();
    let sky = "sky --sun-elevation 20 --wavelengths rgb --size 32x16 -q -o";
    for (name, fog) in [
        ("clear.png", ""),
        ("thinning.png", "--visibility-m 200 --scale-height-m 60"),
        (
            "slab.png",
            "--visibility-m 200 --top-m 60 --droplets coarse",
        ),
    ] {
        succeed(&folder, &format!("{sky} {name} {fog}"));
    }
    let [clear, thinning, slab] = ["clear.png", "thinning.png", "slab.png"]
        .map(|name| image::open(folder.file(name)).unwrap().to_rgb8());
    assert!(clear != thinning && thinning != slab);
    let before = folder.names("");
    for (fog, sentence) in [
        ("--visibility-m 0", "above 0"),
        ("--visibility-m nan", "above 0"),
        ("--top-m 60", "--visibility-m"),
        (
            "--visibility-m 9 --top-m 60 --base-height-m 5",
            "try leaving one of them out",
        ),
        ("--visibility-m 9 --droplets soup", "possible values"),
        (
            "--visibility-m 9 --fog-scattering single --solver monte-carlo",
            "expected a solver that honours the scattering of the fog",
        ),
    ] {
        let output = run(&folder, &format!("{sky} refused.png {fog}"));
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{fog}: {text}");
        assert!(text.contains(sentence), "{fog}: {text}");
        assert_eq!(folder.names(""), before, "{fog} left something behind");
    }
}

/// The fog of a sky scatters as requested, in colours and in spectra, and the file says so.
#[test]
fn skies_have_fog_of_each_scattering() {
    let folder = Folder::new();
    let sky = "sky --sun-elevation 12 --visibility-m 300 --size 32x16 --sun-disc out --wavelengths fast -q";
    let of = |which: &str| {
        succeed(&folder, &format!("{sky} --fog-scattering {which} -o a.exr"));
        Exr::read(&folder.file("a.exr"))
    };
    let (all, single, undimmed) = (of("all"), of("single"), of("undimmed"));
    succeed(&folder, &format!("{sky} -o b.exr"));
    assert_eq!(Exr::read(&folder.file("b.exr")).channels, all.channels);
    // Level, and away from the sun.
    let luminance = |picture: &Exr| picture.luminance(0, 7);
    assert!(luminance(&undimmed) > 1.2 * luminance(&single));
    assert!((luminance(&all) / luminance(&single) - 1.0).abs() > 0.05);
    assert!(single.texts["fog"].ends_with("single scattering"));
    assert!(!all.texts["fog"].contains("single"));
    succeed(
        &folder,
        &format!("{sky} --fog-scattering single -o a.spectral.exr"),
    );
    let spectral = Exr::read(&folder.file("a.spectral.exr")).luminance(0, 7);
    assert!((spectral / luminance(&single) - 1.0).abs() < 0.02);
}
