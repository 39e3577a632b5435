//! Skies by published models from the command line.

mod common;

use common::{Folder, run, succeed};

const SKY: &str = "sky --sun-elevation 20 --size 16x8 --wavelengths rgb";

#[test]
fn every_model_draws_a_sky() {
    let folder = Folder::new();
    let mut pictures = Vec::new();
    for (n, options) in [
        "single-scattering",
        "single-scattering --variant printed",
        "single-scattering --variant multiple --sunlight measured",
        "preetham",
        "hillaire2020",
        "bruneton2008",
    ]
    .iter()
    .enumerate()
    {
        let said = succeed(&folder, &format!("{SKY} --solver {options} -o {n}.png"));
        assert!(said.contains("16 x 8"), "{options}: {said}");
        pictures.push(std::fs::read(folder.file(&format!("{n}.png"))).unwrap());
    }
    for (i, picture) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|other| other != picture), "{i}");
    }
}

#[test]
fn models_refuse_what_they_do_not_know() {
    let folder = Folder::new();
    for (options, part) in [
        ("preetham --turbidity 1.3", "from 2 to 10"),
        ("preetham --variant printed", "one form only"),
        ("single-scattering --altitude-m 80e3", "60 000 m"),
        ("hillaire2020 --zenith-lux 6.28", "single-scattering"),
        ("bruneton2008 --spectral", "--spectral"),
    ] {
        let output = run(&folder, &format!("{SKY} --solver {options} -o a.exr"));
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{options}: {error}");
        assert!(error.contains(part), "{options}: {error}");
    }
    assert!(folder.names().is_empty());
}
