//! Conversion of a scene's air to an atmosphere.

use super::{AirSpec, Scene, SceneError};
use crate::atmosphere::Ingredient;
use crate::atmosphere::presets::Earth;
use crate::atmosphere::{
    AerosolLoad, AerosolMixture, AerosolType, AerosolTypeError, Atmosphere, ConstituentKind, gases,
    preset,
};
use crate::spectrum::SpectralCurve;

impl Scene {
    /// The atmosphere that the scene names, with the values that the scene overrides.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown name, a file whose text is missing, and values that are invalid for the atmosphere.
    pub fn atmosphere(&self) -> Result<Atmosphere, SceneError> {
        let spec = &self.air;
        let mut air = spec.named_atmosphere()?;
        let eye_altitude_m = self.observer.altitude_m.unwrap_or(0.0);
        air.planet.ground_altitude_m = spec
            .ground_altitude_m
            .unwrap_or_else(|| air.planet.ground_altitude_m.min(eye_altitude_m));
        let top_m = air.planet.top_altitude_m;
        if let Some(ground_m) = spec.ground_altitude_m.filter(|ground_m| *ground_m >= top_m) {
            return Err(SceneError::value(
                "air.ground_altitude_m",
                format!("a ground below the top of the atmosphere at {top_m} m"),
                format!("{ground_m} m"),
                "a lower ground",
            ));
        }
        if let Some(albedo) = spec.ground_albedo {
            air.planet.ground_albedo = SpectralCurve::Constant(albedo);
        }
        if let Some(column_du) = spec.ozone_du {
            require_earth(&air, "air.ozone_du")?;
            air.put(gases::ozone(column_du));
        }
        match (&spec.aerosol, spec.haze_amount()) {
            (Some(types), amount) => {
                let mixture = aerosol_mixture(types, spec.humidity)?;
                set_type(&mut air, &mixture, amount)?;
            }
            (None, Some((key, load))) => set_haze(&mut air, key, load)?,
            (None, None) => {}
        }
        air.validate()?;
        for change in spec.changes() {
            air.name.push_str(", ");
            air.name.push_str(&change);
        }
        Ok(air)
    }

    /// Altitude of the eye above sea level, m, clamped to at least the eye height above the ground of an atmosphere.
    pub fn observer_altitude_m(&self, atmosphere: &Atmosphere) -> f64 {
        let lowest_m =
            atmosphere.planet.ground_altitude_m + self.observer.eye_height_m.unwrap_or(2.0);
        self.observer.altitude_m.unwrap_or(0.0).max(lowest_m)
    }
}

impl AirSpec {
    /// Whether the name of the atmosphere is that of a file: it ends in `.toml` or contains a slash or backslash.
    pub(crate) fn names_file(&self) -> bool {
        self.atmosphere.as_deref().is_some_and(|name| {
            name.to_ascii_lowercase().ends_with(".toml") || name.contains(['/', '\\'])
        })
    }

    /// The atmosphere that the scene names, without the scene's overrides.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown name, and for a file that is invalid or whose text is missing.
    pub fn named_atmosphere(&self) -> Result<Atmosphere, SceneError> {
        let name = self.atmosphere.as_deref().unwrap_or("average");
        if let Some(text) = &self.atmosphere_toml {
            return atmosphere_of_file(name, text);
        }
        match self.names_file() {
            true => Err(SceneError::value(
                "air.atmosphere",
                format!("the text of the file `{name}`"),
                "only its name",
                "Scene::inline_files",
            )),
            false => preset(name).map_err(SceneError::UnknownAtmosphere),
        }
    }

    /// What the scene changes in the constituents of the atmosphere that it names, in words.
    fn changes(&self) -> impl Iterator<Item = String> {
        let aerosol = self
            .aerosol
            .as_ref()
            .map(|types| format!("aerosol {types}"));
        let humidity = self.humidity.map(|share| format!("humidity {share}"));
        let amount = self.haze_amount().map(|(_, load)| match load {
            AerosolLoad::OpticalDepth550(depth) => format!("haze of optical depth {depth}"),
            AerosolLoad::Turbidity(ratio) => format!("turbidity {ratio}"),
            AerosolLoad::Visibility { range_m, .. } => format!("haze of visibility {range_m} m"),
        });
        let ozone = self
            .ozone_du
            .map(|column_du| format!("ozone {column_du} DU"));
        [aerosol, humidity, amount, ozone].into_iter().flatten()
    }

    /// The amount of haze with the key that sets it.
    fn haze_amount(&self) -> Option<(&'static str, AerosolLoad)> {
        let depth = self
            .aod_550
            .map(|depth| ("air.aod_550", AerosolLoad::OpticalDepth550(depth)));
        let turbidity = self
            .turbidity
            .map(|ratio| ("air.turbidity", AerosolLoad::Turbidity(ratio)));
        let visibility = self.haze_visibility_m.map(|range_m| {
            let contrast = self.visibility_contrast();
            (
                "air.haze_visibility_m",
                AerosolLoad::Visibility { range_m, contrast },
            )
        });
        depth.or(turbidity).or(visibility)
    }
}

/// Parses a mixture of published aerosol types with shares, such as "urban:0.7,desert:0.3", at a relative humidity.
///
/// # Errors
/// [`SceneError`] for an unknown type, a share that is not a positive number, a humidity out of range, or a humidity for
/// particles that take up no water.
fn aerosol_mixture(types: &str, humidity: Option<f64>) -> Result<AerosolMixture, SceneError> {
    let refused = |error: AerosolTypeError| match error {
        AerosolTypeError::Humidity(_) => SceneError::refused("air.humidity", error),
        _ => SceneError::refused("air.aerosol", error),
    };
    let mut parts = Vec::new();
    for part in types.split(',') {
        let (name, share) = part.split_once(':').unwrap_or((part, "1"));
        let kind: AerosolType = name
            .trim()
            .parse()
            .map_err(|error| SceneError::refused("air.aerosol", error))?;
        let share = share.trim().parse().map_err(|_| {
            let expected = format!("a number above 0 as the share of {name}");
            SceneError::value(
                "air.aerosol",
                expected,
                format!("`{share}`"),
                "urban:0.7,desert:0.3",
            )
        })?;
        parts.push((share, Ingredient::Type(kind)));
    }
    let mixture = AerosolMixture::new(parts, humidity.unwrap_or(AerosolMixture::USUAL_HUMIDITY));
    let mixture = mixture.map_err(refused)?;
    match humidity.is_some() && !mixture.grows() {
        true => Err(SceneError::value(
            "air.humidity",
            "particles that take up water",
            format!("{types}, whose particles do not grow"),
            "leaving it out",
        )),
        false => Ok(mixture),
    }
}

fn require_earth(air: &Atmosphere, key: &str) -> Result<(), SceneError> {
    match air.is_earth() {
        true => Ok(()),
        false => Err(SceneError::value(
            key,
            "the Earth's air",
            format!("the atmosphere \"{}\"", air.name),
            "describing its constituents in a TOML file",
        )),
    }
}

/// Replaces the haze by one of a published type, in the given amount (default: as published).
fn set_type(
    air: &mut Atmosphere,
    mixture: &AerosolMixture,
    amount: Option<(&'static str, AerosolLoad)>,
) -> Result<(), SceneError> {
    require_earth(air, "air.aerosol")?;
    let (key, load) = amount.map_or(("air.aerosol", None), |(key, load)| (key, Some(load)));
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let part = mixture
        .constituent(load, None, air.clear_air(), ground, top)
        .map_err(|error| SceneError::refused(key, error))?;
    air.put(part);
    Ok(())
}

/// Scales the existing haze to an amount, or adds a continental haze if there is none.
fn set_haze(air: &mut Atmosphere, key: &str, load: AerosolLoad) -> Result<(), SceneError> {
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let old = air
        .constituent(&ConstituentKind::Aerosol)
        .filter(|old| old.optical_depth(ground, top, 550.0) > 0.0)
        .cloned();
    let part = match old {
        Some(mut haze) => {
            let column_m = haze.density.column_m(ground, top) / haze.density.at(ground);
            let depth = load
                .optical_depth_550(air.clear_air(), column_m)
                .map_err(|error| SceneError::refused(key, error))?;
            let factor = depth / haze.optical_depth(ground, top, 550.0);
            haze.scattering_per_m = haze.scattering_per_m.scaled(factor);
            haze.absorption_per_m = haze.absorption_per_m.scaled(factor);
            haze
        }
        None => {
            require_earth(air, key)?;
            let mut aerosol = Earth::with_aerosol(0.0).aerosol;
            aerosol.load = load;
            aerosol
                .constituent(air.clear_air(), ground, top)
                .map_err(|error| SceneError::refused(key, error))?
        }
    };
    air.put(part);
    Ok(())
}

/// The atmosphere in the text of a file.
#[cfg(feature = "config")]
fn atmosphere_of_file(name: &str, text: &str) -> Result<Atmosphere, SceneError> {
    Atmosphere::from_toml(text)
        .map_err(|error| SceneError::refused("air.atmosphere", format!("`{name}`, {error}")))
}

#[cfg(not(feature = "config"))]
fn atmosphere_of_file(name: &str, _: &str) -> Result<Atmosphere, SceneError> {
    Err(SceneError::value(
        "air.atmosphere",
        "a build with the feature config, which reads files",
        format!("one without, and the file `{name}`"),
        "the name of an atmosphere",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::visibility::Contrast;

    #[test]
    fn haze_has_the_given_amount_on_every_planet() {
        for name in ["average", "mars", "bruneton", "reference-rayleigh"] {
            let mut air = preset(name).unwrap();
            set_haze(&mut air, "air.aod_550", AerosolLoad::OpticalDepth550(0.4)).unwrap();
            let depth = air
                .constituent(&ConstituentKind::Aerosol)
                .unwrap()
                .optical_depth(0.0, air.planet.top_altitude_m, 550.0);
            assert!((depth - 0.4).abs() < 1e-9, "{name}: {depth}");
        }
        let mut air = preset("average").unwrap();
        let endless = AerosolLoad::Visibility {
            range_m: 1e9,
            contrast: Contrast::FivePercent,
        };
        assert!(set_haze(&mut air, "air.haze_visibility_m", endless).is_err());
        assert!(set_haze(&mut air, "air.turbidity", AerosolLoad::Turbidity(0.5)).is_err());
    }

    #[test]
    fn aerosol_types_have_the_given_amount() {
        let mut air = preset("average").unwrap();
        let desert = aerosol_mixture("desert", None).unwrap();
        let set = ("air.aod_550", AerosolLoad::OpticalDepth550(0.4));
        set_type(&mut air, &desert, Some(set)).unwrap();
        let depth = |air: &Atmosphere| {
            let part = air.constituent(&ConstituentKind::Aerosol).unwrap();
            part.optical_depth(0.0, air.planet.top_altitude_m, 550.0)
        };
        assert!((depth(&air) - 0.4).abs() < 1e-9);
        set_type(&mut air, &desert, None).unwrap();
        assert!((depth(&air) - 0.275).abs() < 2e-3, "{}", depth(&air));
        let wrong = Some(("air.turbidity", AerosolLoad::Turbidity(0.5)));
        let refused = set_type(&mut air, &desert, wrong).unwrap_err();
        assert_eq!(refused.key(), Some("air.turbidity"));
        let mut mars = preset("mars").unwrap();
        assert!(set_type(&mut mars, &desert, None).is_err());
    }

    #[test]
    fn names_are_distinguished_from_files() {
        let said = |name: &str| {
            let mut scene = Scene::default();
            scene.air.atmosphere = Some(name.to_owned());
            scene.atmosphere().unwrap_err().to_string()
        };
        assert!(said("claer").contains("\"clear\""), "{}", said("claer"));
        for file in ["no/such", "nothing-here.toml"] {
            assert!(said(file).contains(&format!("the text of the file `{file}`")));
        }
        let earth = |name| preset(name).unwrap().is_earth();
        assert!(earth("hillaire") && !earth("mars"));
    }

    /// The name of the air, which is stored with pictures, states what the scene changes in it.
    #[test]
    fn the_air_is_named_with_what_is_changed_in_it() {
        let named = |change: fn(&mut AirSpec)| {
            let mut scene = Scene::default();
            change(&mut scene.air);
            scene.atmosphere().unwrap().name
        };
        assert_eq!(named(|_| ()), "average");
        let urban = named(|air| {
            air.aerosol = Some("urban".to_owned());
            air.humidity = Some(0.5);
            air.aod_550 = Some(0.4);
        });
        assert_eq!(
            urban,
            "average, aerosol urban, humidity 0.5, haze of optical depth 0.4"
        );
        let hazy = named(|air| {
            air.atmosphere = Some("clear".to_owned());
            air.haze_visibility_m = Some(20e3);
            air.ozone_du = Some(250.0);
        });
        assert_eq!(hazy, "clear, haze of visibility 20000 m, ozone 250 DU");
        assert_eq!(
            named(|air| air.turbidity = Some(3.0)),
            "average, turbidity 3"
        );
    }

    #[test]
    fn types_and_shares_are_parsed() {
        let alone = aerosol_mixture("urban", None).unwrap();
        assert_eq!(alone, AerosolMixture::of(AerosolType::Urban, 0.8).unwrap());
        let two = aerosol_mixture("urban:3, desert", Some(0.5)).unwrap();
        let parts = vec![
            (0.75, Ingredient::Type(AerosolType::Urban)),
            (0.25, Ingredient::Type(AerosolType::Desert)),
        ];
        assert_eq!(two, AerosolMixture::new(parts, 0.5).unwrap());
        let refused =
            |types: &str, humidity| aerosol_mixture(types, humidity).unwrap_err().to_string();
        assert!(refused("urbam", None).contains("try \"urban\""));
        assert!(refused("biomass", None).contains("biomass-savanna"));
        assert!(refused("urban:x", None).contains("number above 0"));
        assert!(refused("urban:-1", None).contains("above 0"));
        assert!(refused("urban", Some(80.0)).contains("0.8 is 80 %"));
        assert!(refused("biomass-boreal", Some(0.5)).contains("leaving it out"));
    }
}
