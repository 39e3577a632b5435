//! [`Part`]: the WGSL files.

use airlight::{Named, named};

/// A file of WGSL functions on one subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Part {
    /// Exponentials of optical depth without cancellation.
    Exponentials,
    /// Phase functions.
    Phase,
    /// The affine map that air applies to radiance.
    PathOptics,
    /// Integrals of density along rays.
    Columns,
    /// Fog in sunlight and ambient light.
    Fog,
    /// Air over round ground, marched.
    Air,
    /// Point, spot and sphere lights in fog.
    Lights,
    /// Fog with shadows.
    Shadows,
    /// Wavelengths, XYZ, RGB spaces, sRGB signals.
    Colour,
    /// Skies and aerial perspective from tables.
    SkyTables,
    /// Fog with all orders of scattering from tables.
    FogTable,
    /// The sky article's shader as printed.
    Article,
    /// The sun's disc.
    Disc,
    /// Tone curves.
    Tone,
    /// Dither.
    Dither,
}

named! { Part, "a part of the shader library", [
    ("exponentials", (Exponentials), "exponentials of optical depth without cancellation"),
    ("phase", (Phase), "phase functions of molecules, haze and fog droplets"),
    ("path-optics", (PathOptics), "transmittance and path radiance of a ray segment"),
    ("columns", (Columns), "integrals of density along rays over flat or round ground"),
    ("fog", (Fog), "fog in sunlight and ambient light, by single scattering"),
    ("air", (Air), "air of molecules, haze and ozone over round ground, marched by single scattering"),
    ("lights", (Lights), "point, spot and sphere lights in uniform and in exponential fog"),
    ("shadows", (Shadows), "fog with shadows, from visibilities that the program supplies"),
    ("colour", (Colour), "wavelengths, XYZ, linear RGB spaces, sRGB signals"),
    ("sky-tables", (SkyTables), "skies and aerial perspective from tables at four wavelengths"),
    ("fog-table", (FogTable), "fog with all orders of scattering from tables"),
    ("article", (Article), "the sky article's shader as printed: single scattering in 8 steps"),
    ("disc", (Disc), "the sun's disc with limb darkening and a smooth edge"),
    ("tone", (Tone), "tone curves: camera, AgX, clipping"),
    ("dither", (Dither), "triangular noise for 8-bit targets"),
] }

impl Part {
    /// The text of the file alone.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Exponentials => include_str!("../wgsl/exponentials.wgsl"),
            Self::Phase => include_str!("../wgsl/phase.wgsl"),
            Self::PathOptics => include_str!("../wgsl/path_optics.wgsl"),
            Self::Columns => include_str!("../wgsl/columns.wgsl"),
            Self::Fog => include_str!("../wgsl/fog.wgsl"),
            Self::Air => include_str!("../wgsl/air.wgsl"),
            Self::Lights => include_str!("../wgsl/lights.wgsl"),
            Self::Shadows => include_str!("../wgsl/shadows.wgsl"),
            Self::Colour => include_str!("../wgsl/colour.wgsl"),
            Self::SkyTables => include_str!("../wgsl/sky_tables.wgsl"),
            Self::FogTable => include_str!("../wgsl/fog_table.wgsl"),
            Self::Article => include_str!("../wgsl/article.wgsl"),
            Self::Disc => include_str!("../wgsl/disc.wgsl"),
            Self::Tone => include_str!("../wgsl/tone.wgsl"),
            Self::Dither => include_str!("../wgsl/dither.wgsl"),
        }
    }

    /// The parts whose functions this one calls, as named in the first line of the file.
    pub fn requires(self) -> Vec<Self> {
        let first = self.text().lines().next().unwrap_or_default();
        let Some(names) = first.strip_prefix("// requires: ") else {
            return Vec::new();
        };
        let part = |name: &str| Self::from_name(&name.trim().replace('_', "-")).ok();
        names.split(',').filter_map(part).collect()
    }
}

/// What a program asks for by name: one part, or all of a subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Subject {
    /// The sky, aerial perspective and the sun's disc: from tables, and marched without any.
    Sky,
    /// A part.
    Part(Part),
}

impl Subject {
    /// Its parts, without those that they require.
    pub fn parts(&self) -> &[Part] {
        match self {
            Self::Sky => &[Part::SkyTables, Part::Air, Part::Disc],
            Self::Part(part) => std::slice::from_ref(part),
        }
    }
}

impl Named for Subject {
    const WHAT: &'static str = "a part of the shader library or a subject";
    const ALL: &'static [Self] = &{
        let mut all = [Self::Sky; Part::ALL.len() + 1];
        let mut k = 0;
        while k < Part::ALL.len() {
            all[k + 1] = Self::Part(Part::ALL[k]);
            k += 1;
        }
        all
    };

    fn name(self) -> &'static str {
        match self {
            Self::Sky => "sky",
            Self::Part(part) => part.name(),
        }
    }

    fn summary(self) -> &'static str {
        match self {
            Self::Sky => {
                "the parts sky-tables, air and disc: skies and aerial perspective from tables or marched, and the sun"
            }
            Self::Part(part) => part.summary(),
        }
    }
}

/// Parts with all parts that they require, each once, in an order in which none is used before it is defined.
pub fn with_required(parts: &[Part]) -> Vec<Part> {
    let mut all = Vec::new();
    for &part in parts {
        for part in with_required(&part.requires())
            .into_iter()
            .chain(std::iter::once(part))
        {
            if !all.contains(&part) {
                all.push(part);
            }
        }
    }
    all
}

/// WGSL text of parts with all parts that they require.
pub fn source(parts: &[Part]) -> String {
    let texts: Vec<&str> = with_required(parts).into_iter().map(Part::text).collect();
    texts.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn required_parts_come_first_and_once() {
        assert_eq!(
            with_required(&[Part::Fog, Part::Phase]),
            [
                Part::Exponentials,
                Part::Columns,
                Part::PathOptics,
                Part::Fog,
                Part::Phase
            ]
        );
        for &part in Part::ALL {
            // A name that is misspelt in the first line would be lost.
            let first = part.text().lines().next().unwrap();
            let named = match first.strip_prefix("// requires: ") {
                Some(names) => names.split(',').count(),
                None => 0,
            };
            assert_eq!(part.requires().len(), named, "{part}");
        }
    }

    #[test]
    fn subjects_and_parts_have_names_of_their_own() {
        let names: Vec<_> = Subject::ALL.iter().map(|subject| subject.name()).collect();
        for (k, &name) in names.iter().enumerate() {
            assert!(!names[..k].contains(&name), "{name}");
            assert_eq!(Subject::from_name(name), Ok(Subject::ALL[k]));
        }
        assert_eq!(names.len(), Part::ALL.len() + 1);
        assert_eq!(Subject::Part(Part::Fog).parts(), [Part::Fog]);
        let sky = source(Subject::Sky.parts());
        for function in [
            "sky_radiance",
            "aerial_perspective",
            "air_march",
            "sun_disc_radiance",
        ] {
            assert!(sky.contains(&format!("fn {function}(")), "{function}");
        }
    }

    #[test]
    fn files_are_parts() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/wgsl");
        let files = std::fs::read_dir(folder).unwrap().count();
        assert_eq!(files, Part::ALL.len());
    }
}
