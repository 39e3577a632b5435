use super::tests::{read, refuse};
use super::*;
use crate::atmosphere::aerosol_types::Ingredient;
use crate::atmosphere::{AerosolError, AerosolLoad, AerosolMixture, AerosolType, AerosolTypeError};

#[test]
fn types_are_what_the_library_makes_of_them() {
    let got = read(
        "base = \"clear\"\naerosol = { type = \"urban\", relative_humidity = 0.5, aod_550 = 0.3 }",
    );
    let mixture = AerosolMixture::of(AerosolType::Urban, 0.5).unwrap();
    let load = Some(AerosolLoad::OpticalDepth550(0.3));
    let clear = got.clear_air();
    let want = mixture.constituent(load, None, clear, 0.0, 100e3).unwrap();
    assert_eq!(got.constituent(&ConstituentKind::Aerosol), Some(&want));
    // At 80 % and as much as published, where nothing is said.
    let usual = read("aerosol.type = \"urban\"");
    let mixture = AerosolMixture::of(AerosolType::Urban, 0.8).unwrap();
    let want = mixture.constituent(None, None, clear, 0.0, 100e3).unwrap();
    assert_eq!(usual.constituent(&ConstituentKind::Aerosol), Some(&want));
    let placed = read("aerosol = { type = \"urban\", visibility_m = 10e3, scale_height_m = 900 }");
    let part = placed.constituent(&ConstituentKind::Aerosol).unwrap();
    let whole = part.extinction_per_m(550.0) + clear.ground_extinction_per_m;
    assert!(((-whole * 10e3).exp() / 0.05 - 1.0).abs() < 1e-9);
    assert_eq!(
        part.density,
        crate::atmosphere::DensityProfile::exponential(900.0)
    );
}

#[test]
fn mixtures_are_read() {
    let text = r#"
        [aerosol]
        mixture = [{ type = "desert", share = 3 }, { component = "soot", share = 1 }]
        aod_550 = 0.2
    "#;
    let parts = vec![
        (3.0, Ingredient::Type(AerosolType::Desert)),
        (
            1.0,
            Ingredient::Component(crate::atmosphere::aerosol_types::Component::Soot),
        ),
    ];
    let mixture = AerosolMixture::new(parts, 0.8).unwrap();
    let got = read(text);
    let load = Some(AerosolLoad::OpticalDepth550(0.2));
    let want = mixture
        .constituent(load, None, got.clear_air(), 0.0, 100e3)
        .unwrap();
    assert_eq!(got.constituent(&ConstituentKind::Aerosol), Some(&want));
}

#[test]
fn mistakes_are_told_where_they_stand() {
    let near = refuse("aerosol.type = \"dessert\"");
    assert_eq!(near.key, "aerosol.type");
    assert!(
        near.to_string().contains("did you mean \"desert\""),
        "{near}"
    );
    let damp = refuse("aerosol = { type = \"urban\", relative_humidity = 80 }");
    assert_eq!(damp.key, "aerosol.relative_humidity");
    assert!(damp.to_string().contains("between 0 and 0.99"), "{damp}");
    let dry = refuse("aerosol = { type = \"biomass-forest\", relative_humidity = 0.5 }");
    assert_eq!(*dry.problem, ConfigProblem::Dry);
    let alone = refuse("aerosol.relative_humidity = 0.5");
    assert!(matches!(*alone.problem, ConfigProblem::Needs { .. }));
    for key in [
        "angstrom_exponent = 1",
        "single_scattering_albedo = 1",
        "phase.g = 0.5",
        "mixture = []",
    ] {
        let text = format!("[aerosol]\ntype = \"urban\"\n{key}");
        assert!(matches!(
            *refuse(&text).problem,
            ConfigProblem::Conflict { with: "type" }
        ));
    }
    let part = |text: &str| refuse(&format!("[aerosol]\nmixture = [{{ {text} }}]"));
    assert_eq!(part("type = \"urban\"").key, "aerosol.mixture[0].share");
    assert_eq!(part("share = 1").key, "aerosol.mixture[0].type");
    assert_eq!(
        part("share = 0, type = \"urban\"").key,
        "aerosol.mixture[0].share"
    );
    let soot = part("share = 1, component = \"sooot\"");
    assert!(soot.to_string().contains("did you mean \"soot\""), "{soot}");
    let both = part("share = 1, component = \"soot\", type = \"urban\"");
    assert!(matches!(*both.problem, ConfigProblem::Conflict { .. }));
    let none = refuse("aerosol.mixture = []");
    assert_eq!(
        *none.problem,
        ConfigProblem::AerosolType(AerosolTypeError::Empty)
    );
    let turbid = refuse("aerosol = { type = \"urban\", turbidity = 0.5 }");
    let want = AerosolTypeError::Aerosol(AerosolError::Turbidity(0.5));
    assert_eq!(
        (turbid.key.as_str(), *turbid.problem),
        ("aerosol.turbidity", ConfigProblem::AerosolType(want))
    );
}
