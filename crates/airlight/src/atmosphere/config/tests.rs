use super::*;
use crate::atmosphere::{
    AerosolError, AerosolLoad, AerosolMixture, AerosolType, AerosolTypeError, Component,
    DensityError, DensityProfile, Ingredient, preset,
};
use crate::optics::{PhaseError, PhaseFunction};
use crate::sun::LimbDarkening;

fn read(text: &str) -> Atmosphere {
    Atmosphere::from_toml(text).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// The error of a text. Its message must start with the line and name the key.
fn refuse(text: &str) -> ConfigError {
    let error = Atmosphere::from_toml(text).expect_err(text);
    let message = error.to_string();
    assert!(
        message.contains(&error.key) && message.starts_with(&format!("line {}", error.line)),
        "{message}"
    );
    error
}

#[test]
fn the_default_is_the_average_earth() {
    assert_eq!(read(""), preset("average").unwrap());
    assert_eq!(read("base = \"mars\""), preset("mars").unwrap());
    assert_eq!(read("name = \"mine\"").name, "mine");
}

#[test]
fn single_values_override_the_base() {
    let text = r#"
        base = "clear"
        remove = ["ozone"]
        planet = { radius_m = 6_400_000, top_altitude_m = 80e3, ground_altitude_m = -100, ground_albedo = 0.25 }
        sun = { angular_radius_deg = 0.3, limb_darkening = "uniform", irradiance_factor = 0.5 }
        rayleigh.pressure_pa = 90e3
    "#;
    let (got, base) = (read(text), preset("clear").unwrap());
    assert_eq!(
        (got.planet.radius_m, got.planet.top_altitude_m),
        (6.4e6, 80e3)
    );
    assert_eq!(
        (
            got.planet.ground_altitude_m,
            got.planet.ground_albedo.at(500.0)
        ),
        (-100.0, 0.25)
    );
    assert!(got.constituent(&ConstituentKind::Ozone).is_none());
    assert!((got.sun.angular_radius_rad.to_degrees() - 0.3).abs() < 1e-12);
    assert_eq!(got.sun.limb_darkening, LimbDarkening::Uniform);
    assert_eq!(
        got.solar_irradiance.at(550.0),
        0.5 * base.solar_irradiance.at(550.0)
    );
    let air = |a: &Atmosphere| {
        a.constituent(&ConstituentKind::Molecules)
            .unwrap()
            .scattering_per_m
            .at(550.0)
    };
    assert!((air(&got) / air(&base) - 90.0 / 101.325).abs() < 1e-12);
    let ozone = read("ozone.column_du = 450")
        .constituent(&ConstituentKind::Ozone)
        .unwrap()
        .absorption_per_m
        .at(600.0);
    let usual = preset("average")
        .unwrap()
        .constituent(&ConstituentKind::Ozone)
        .unwrap()
        .absorption_per_m
        .at(600.0);
    assert!((ozone / usual - 1.5).abs() < 1e-12);
}

#[test]
fn aerosol_values_not_given_are_those_of_the_base() {
    let depth = |a: &Atmosphere, nm| {
        a.constituent(&ConstituentKind::Aerosol)
            .unwrap()
            .optical_depth(0.0, 100e3, nm)
    };
    let hazy = preset("hazy").unwrap();
    let got = read("base = \"hazy\"\naerosol.aod_550 = 0.7");
    assert!((depth(&got, 440.0) / depth(&hazy, 440.0) - 2.0).abs() < 1e-12);
    let got = read("base = \"hazy\"\naerosol.angstrom_exponent = 0.5");
    assert!((depth(&got, 550.0) - 0.35).abs() < 1e-12);
    assert!((depth(&got, 440.0) / depth(&got, 880.0) - 2f64.sqrt()).abs() < 1e-12);
    let aerosol = got.constituent(&ConstituentKind::Aerosol).unwrap();
    assert!(
        (aerosol.scattering_per_m.at(470.0) / aerosol.extinction_per_m(470.0) - 0.93).abs() < 1e-9
    );
    let got = read("base = \"hazy\"\naerosol.scale_height_m = 3000");
    assert!((depth(&got, 550.0) - 0.35).abs() < 1e-12);
    assert_eq!(
        got.constituent(&ConstituentKind::Aerosol).unwrap().density,
        DensityProfile::exponential(3000.0)
    );
    let got = read("aerosol.turbidity = 2.5");
    let clear = got.clear_air();
    assert!((depth(&got, 550.0) / (1.5 * clear.optical_depth_550) - 1.0).abs() < 1e-12);
    let got = read("aerosol.visibility_m = 10e3");
    assert!(
        (got.constituent(&ConstituentKind::Aerosol)
            .unwrap()
            .extinction_per_m(550.0)
            + clear.ground_extinction_per_m
            - 2.9957e-4)
            .abs()
            < 1e-7
    );
    let two = read("aerosol.visibility_m = 10e3\naerosol.contrast = 0.02");
    let extinction = |air: &Atmosphere| {
        air.constituent(&ConstituentKind::Aerosol)
            .unwrap()
            .extinction_per_m(550.0)
    };
    let more = (0.05f64 / 0.02).ln() / 10e3;
    assert!((extinction(&two) - extinction(&got) - more).abs() < 1e-9);
    // The dust of Mars keeps its spectral albedo.
    let (mars, got) = (
        preset("mars").unwrap(),
        read("base = \"mars\"\naerosol.aod_550 = 1.5"),
    );
    let albedo = |a: &Atmosphere, nm| {
        let dust = a.constituent(&ConstituentKind::Aerosol).unwrap();
        dust.scattering_per_m.at(nm) / dust.extinction_per_m(nm)
    };
    for nm in [400.0, 500.0, 700.0] {
        assert!((albedo(&got, nm) - albedo(&mars, nm)).abs() < 1e-9);
    }
    let got = read("base = \"none\"\naerosol = { aod_550 = 0.1 }\nrayleigh.pressure_pa = 101325");
    assert_eq!(got.constituents.len(), 2);
    let zero = read("aerosol.aod_550 = 0");
    assert_eq!(depth(&zero, 550.0), 0.0);
}

#[test]
fn phase_parameters_without_a_kind_change_the_base() {
    let phase = |text: &str| {
        read(text)
            .constituent(&ConstituentKind::Aerosol)
            .unwrap()
            .phase
            .clone()
    };
    assert_eq!(
        phase("base = \"bruneton\"\naerosol.phase.g = 0.7"),
        PhaseFunction::CornetteShanks { g: 0.7 }
    );
    let draine = "aerosol.phase = { kind = \"draine\", g = 0.6, alpha = 2 }";
    assert_eq!(phase(draine), PhaseFunction::Draine { g: 0.6, alpha: 2.0 });
    let mixture = "aerosol.phase = { kind = \"mixture\", parts = [{ weight = 0.5, kind = \"isotropic\" }, \
                   { weight = 0.5, kind = \"henyey-greenstein\", g = 0.9 }] }";
    assert!(matches!(phase(mixture), PhaseFunction::Mixture(parts) if parts.len() == 2));
    let table = "aerosol.phase = { kind = \"table\", angles_deg = [0, 90, 180], wavelengths_nm = [400, 700], \
                 values = [[3, 1, 1], [2, 1, 1]] }";
    assert!(phase(table).depends_on_wavelength());
    assert!(matches!(
        *refuse("aerosol.phase.g = 0.7").problem,
        ConfigProblem::Missing(_)
    ));
}

#[test]
fn constituents_are_read() {
    let got = read(
        r#"
        base = "none"
        [[constituent]]
        name = "gas"
        density = { kind = "table", altitudes_m = [0, 5e3, 40e3], densities = [1, 0.5, 0.01], interpolation = "log-linear" }
        scattering_per_m = { wavelengths_nm = [400, 700], values = [4e-5, 4e-6] }
        phase.kind = "rayleigh"
        [[constituent]]
        name = "soot"
        density = { kind = "tent", bottom_m = 0, peak_m = 1e3, top_m = 2e3 }
        absorption_per_m = { at_550_nm = 1e-5, angstrom_exponent = 1 }
        "#,
    );
    assert_eq!(got.constituents.len(), 2);
    assert!((got.extinction_per_m(1e3, 550.0) - 1e-5 - 2.2e-5 * 0.5f64.powf(0.2)).abs() < 1e-12);
    assert_eq!(
        got.constituent(&"soot".into()).unwrap().phase,
        PhaseFunction::Isotropic
    );
    let replaced = read(
        "[[constituent]]\nname = \"ozone\"\ndensity.kind = \"standard-air\"\nabsorption_per_m = 0",
    );
    assert_eq!(replaced.constituents.len(), 3);
    assert_eq!(
        replaced
            .constituent(&ConstituentKind::Ozone)
            .unwrap()
            .absorption_per_m
            .at(600.0),
        0.0
    );
}

#[test]
fn unknown_keys_report_place_and_similar_key() {
    for (text, line, key, meant) in [
        (
            "base = \"clear\"\naersol.aod_550 = 1",
            2,
            "aersol",
            Some("aerosol"),
        ),
        (
            "[aerosol]\n\naod_55 = 0.1",
            3,
            "aerosol.aod_55",
            Some("aod_550"),
        ),
        (
            "[planet]\nradius_km = 6371",
            2,
            "planet.radius_km",
            Some("radius_m"),
        ),
        (
            "ozone = { colum_du = 3 }",
            1,
            "ozone.colum_du",
            Some("column_du"),
        ),
        ("[sun]\nxyzzyxyzzy = 1", 2, "sun.xyzzyxyzzy", None),
        (
            "aerosol.phase = { kind = \"isotropic\", g = 1 }",
            1,
            "aerosol.phase.g",
            None,
        ),
    ] {
        let error = refuse(text);
        assert_eq!((error.line, error.key.as_str()), (line, key));
        match &*error.problem {
            ConfigProblem::UnknownKey { nearest, valid } => {
                assert_eq!(nearest.as_deref(), meant, "{text}");
                assert!(!valid.is_empty());
            }
            other => panic!("{text}: {other:?}"),
        }
    }
    let list = "[[constituent]]\nname = \"a\"\ndensity.kind = \"layer\"\nscatering_per_m = 1";
    assert_eq!(refuse(list).key, "constituent[0].scatering_per_m");
}

#[test]
fn unknown_names_list_the_allowed_names() {
    for (text, meant) in [
        ("base = \"marz\"", "mars"),
        ("remove = [\"ozon\"]", "ozone"),
        ("sun.limb_darkening = \"neckl\"", "neckel"),
        ("aerosol.phase.kind = \"draine2\"", "draine"),
        ("aerosol.density.kind = \"tents\"", "tent"),
        (
            "aerosol.density = { kind = \"table\", altitudes_m = [0, 1], densities = [1, 0], interpolation = \"log\" }",
            "log-linear",
        ),
    ] {
        let error = refuse(text);
        assert!(
            matches!(&*error.problem, ConfigProblem::UnknownName(error) if error.names.iter().any(|v| v == meant)),
            "{error}"
        );
    }
    let error = refuse("base = \"marz\"").to_string();
    assert!(
        error.ends_with("try \"mars\"") && error.contains("hazy"),
        "{error}"
    );
}

#[test]
fn wrong_types_and_values_report_what_is_expected() {
    for text in [
        "planet = 3",
        "base = 3",
        "planet.radius_m = \"big\"",
        "remove = \"ozone\"",
        "remove = [1]",
        "constituent = 1",
        "constituent = [1]",
        "planet.ground_albedo = true",
        "aerosol.phase = 0.5",
        "aerosol.density = 1",
        "planet.ground_albedo = { wavelengths_nm = [400], values = [\"a\"] }",
        "planet.ground_albedo = { wavelengths_nm = 400, values = [1] }",
        "planet.radius_m = 2000-01-01",
    ] {
        assert!(
            matches!(*refuse(text).problem, ConfigProblem::WrongType { .. }),
            "{text}"
        );
    }
    for text in [
        "planet.radius_m = 0",
        "planet.radius_m = nan",
        "planet.top_altitude_m = -inf",
        "ozone.column_du = -1",
        "planet.ground_albedo = 1.5",
        "planet.ground_albedo = { wavelengths_nm = [400, 500], values = [0.5, -0.1] }",
        "sun.angular_radius_deg = 90",
        "sun.irradiance_factor = -1",
        "aerosol.single_scattering_albedo = 2",
        "aerosol.angstrom_exponent = 99",
        "aerosol.scale_height_m = 0",
        "rayleigh.pressure_pa = inf",
        "aerosol.phase = { kind = \"draine\", g = 1, alpha = 0 }",
        "aerosol.phase = { kind = \"draine\", g = 0, alpha = -1 }",
        "planet.ground_altitude_m = nan",
    ] {
        assert!(
            matches!(*refuse(text).problem, ConfigProblem::OutOfRange { .. }),
            "{text}"
        );
    }
    let message = refuse("[planet]\nground_albedo = 1.5").to_string();
    assert_eq!(
        message,
        "line 2, column 17: planet.ground_albedo: expected values in [0, 1], got 1.5"
    );
}

#[test]
fn invalid_combinations_are_rejected() {
    assert!(matches!(
        *refuse("aerosol = { aod_550 = 1, turbidity = 2 }").problem,
        ConfigProblem::Conflict { .. }
    ));
    let two = "aerosol = { scale_height_m = 1e3, density = { kind = \"standard-air\" } }";
    assert!(matches!(
        *refuse(two).problem,
        ConfigProblem::Conflict { .. }
    ));
    for (text, want) in [
        ("aerosol.aod_550 = -1", AerosolError::OpticalDepth(-1.0)),
        ("aerosol.turbidity = 0.5", AerosolError::Turbidity(0.5)),
    ] {
        assert_eq!(*refuse(text).problem, ConfigProblem::Aerosol(want));
    }
    let contrast = refuse("aerosol.visibility_m = 1e4\naerosol.contrast = 0.1");
    assert_eq!(contrast.key, "aerosol.contrast");
    let far = refuse("aerosol.visibility_m = 1e6");
    assert!(matches!(
        *far.problem,
        ConfigProblem::Aerosol(AerosolError::Visibility { .. })
    ));
    assert_eq!(far.key, "aerosol.visibility_m");
    let layer = "aerosol.density = { kind = \"layer\", bottom_m = 2, top_m = 1 }";
    assert!(matches!(
        *refuse(layer).problem,
        ConfigProblem::Density(DensityError::Edges(_))
    ));
    let weights =
        "aerosol.phase = { kind = \"mixture\", parts = [{ weight = 0.5, kind = \"isotropic\" }] }";
    assert_eq!(
        *refuse(weights).problem,
        ConfigProblem::Phase(PhaseError::WeightSum(0.5))
    );
    let order = "planet.ground_albedo = { wavelengths_nm = [500, 400], values = [0, 1] }";
    assert!(matches!(*refuse(order).problem, ConfigProblem::Curve(_)));
    let under = refuse("planet = { top_altitude_m = 100, ground_altitude_m = 200 }");
    assert!(matches!(
        *under.problem,
        ConfigProblem::Atmosphere(AtmosphereError::Planet { .. })
    ));
    for text in [
        "base = \"none\"\naerosol.angstrom_exponent = 1",
        "[[constituent]]\nscattering_per_m = 1",
        "[[constituent]]\nname = \"a\"",
        "[[constituent]]\nname = \"a\"\nscattering_per_m = 1",
        "[[constituent]]\nname = \"a\"\nabsorption_per_m = 1",
        "aerosol.phase.kind = \"henyey-greenstein\"",
        "aerosol.phase = { kind = \"draine\", g = 0.5 }",
        "aerosol.density.kind = \"exponential\"",
        "aerosol.density = {}",
        "planet.ground_albedo = {}",
        "planet.ground_albedo = { values = [1] }",
    ] {
        assert!(
            matches!(*refuse(text).problem, ConfigProblem::Missing(_)),
            "{text}"
        );
    }
}

#[test]
fn syntax_errors_have_a_place() {
    let error = refuse("base = \"clear\"\nplanet = {");
    assert!(matches!(*error.problem, ConfigProblem::Syntax(_)));
    assert_eq!(error.line, 2);
    for text in [
        "=",
        "a = ",
        "\u{1F30D} = 1",
        "[",
        "base = \"clear",
        "a = 1\na = 2",
        "planet.radius_m = 99999999999999999999",
    ] {
        let _ = refuse(text);
    }
}

#[test]
fn aerosol_types_equal_those_of_the_library() {
    let got = read(
        "base = \"clear\"\naerosol = { type = \"urban\", relative_humidity = 0.5, aod_550 = 0.3 }",
    );
    let mixture = AerosolMixture::of(AerosolType::Urban, 0.5).unwrap();
    let load = Some(AerosolLoad::OpticalDepth550(0.3));
    let clear = got.clear_air();
    let want = mixture.constituent(load, None, clear, 0.0, 100e3).unwrap();
    assert_eq!(got.constituent(&ConstituentKind::Aerosol), Some(&want));
    // Defaults: 80 % and the published number densities.
    let usual = read("aerosol.type = \"urban\"");
    let mixture = AerosolMixture::of(AerosolType::Urban, 0.8).unwrap();
    let want = mixture.constituent(None, None, clear, 0.0, 100e3).unwrap();
    assert_eq!(usual.constituent(&ConstituentKind::Aerosol), Some(&want));
    let placed = read("aerosol = { type = \"urban\", visibility_m = 10e3, scale_height_m = 900 }");
    let part = placed.constituent(&ConstituentKind::Aerosol).unwrap();
    let whole = part.extinction_per_m(550.0) + clear.ground_extinction_per_m;
    assert!(((-whole * 10e3).exp() / 0.05 - 1.0).abs() < 1e-9);
    assert_eq!(part.density, DensityProfile::exponential(900.0));
}

#[test]
fn aerosol_mixtures_are_read() {
    let text = r#"
        [aerosol]
        mixture = [{ type = "desert", share = 3 }, { component = "soot", share = 1 }]
        aod_550 = 0.2
    "#;
    let parts = vec![
        (3.0, Ingredient::Type(AerosolType::Desert)),
        (1.0, Ingredient::Component(Component::Soot)),
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
fn errors_in_aerosol_types_report_their_key() {
    let near = refuse("aerosol.type = \"dessert\"");
    assert_eq!(near.key, "aerosol.type");
    assert!(near.to_string().ends_with("try \"desert\""), "{near}");
    let damp = refuse("aerosol = { type = \"urban\", relative_humidity = 80 }");
    assert_eq!(damp.key, "aerosol.relative_humidity");
    assert!(damp.to_string().contains("from 0 to 0.99"), "{damp}");
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
    assert!(soot.to_string().ends_with("try \"soot\""), "{soot}");
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
