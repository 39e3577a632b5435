//! Objects from TOML; the book's chapter on pictures describes the format.

use super::shape::Shape;
use super::surface::{Checker, Gloss, Surface};
use super::{Object, Objects};
use airlight::scene::{ObjectShape, ObjectSpec, Reflectance, RepeatSpec};
use airlight::spectrum::SpectralCurve;
use glam::DVec3;

/// Largest number of objects of a scene.
const MOST: usize = 10_000;
/// Default reflectance.
const GREY: Reflectance = Reflectance::Grey(0.5);
/// Default refractive index of a coat.
const GLASS: f64 = 1.5;

/// Error of a description of objects.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ObjectsError {
    /// A text that is not TOML or not a list of objects, with line and column; or no objects, or too many.
    #[error("{0}")]
    Text(String),
    /// An invalid value of an object.
    #[error("object {number}{name}: {what}: expected {right}, got {got}")]
    Value {
        /// Number of the object, from 1.
        number: usize,
        /// Its shape in parentheses.
        name: String,
        /// Key of the value.
        what: &'static str,
        /// The values allowed.
        right: &'static str,
        /// The value given.
        got: String,
    },
}

impl Objects {
    /// Reads a list of objects, `[[object]]`, from TOML.
    ///
    /// # Errors
    /// [`ObjectsError`] for invalid keys and values, with their place.
    pub fn from_toml(text: &str) -> Result<Self, ObjectsError> {
        let specs = ObjectSpec::list_from_toml(text)
            .map_err(|error| ObjectsError::Text(error.to_string()))?;
        Self::from_specs(&specs)
    }

    /// Builds the objects of a scene.
    ///
    /// # Errors
    /// [`ObjectsError`] for the first invalid value.
    pub fn from_specs(specs: &[ObjectSpec]) -> Result<Self, ObjectsError> {
        let mut objects = Vec::new();
        for (number, described) in (1..).zip(specs) {
            let made = Reading { number, described }.objects()?;
            objects.extend(made);
            if objects.len() > MOST {
                return Err(ObjectsError::Text(format!(
                    "expected at most {MOST} objects, got more with object {number} and its copies"
                )));
            }
        }
        match objects.is_empty() {
            true => Err(ObjectsError::Text(
                "expected an object, got none; try [[object]] with a shape".to_owned(),
            )),
            false => Ok(Self::new(objects)),
        }
    }
}

/// One object of a file.
struct Reading<'a> {
    number: usize,
    described: &'a ObjectSpec,
}

impl Reading<'_> {
    fn wrong(&self, what: &'static str, right: &'static str, got: impl ToString) -> ObjectsError {
        ObjectsError::Value {
            number: self.number,
            name: format!(" ({})", self.described.shape),
            what,
            right,
            got: got.to_string(),
        }
    }

    /// The object and its copies.
    fn objects(&self) -> Result<Vec<Object>, ObjectsError> {
        let surface = self.surface()?;
        let repeat = self.described.repeat.unwrap_or(RepeatSpec {
            count: 1,
            step_m: [0.0; 3],
        });
        if !(1..=MOST).contains(&repeat.count) {
            return Err(self.wrong(
                "repeat.count",
                "a whole number from 1 to 10000",
                repeat.count,
            ));
        }
        let step = self.place("repeat.step_m", repeat.step_m)?;
        (0..repeat.count)
            .map(|k| {
                Ok(Object {
                    shape: self.shape(k as f64 * step)?,
                    surface: surface.clone(),
                })
            })
            .collect()
    }

    fn shape(&self, moved: DVec3) -> Result<Shape, ObjectsError> {
        let d = self.described;
        self.only_known()?;
        let at = self.place("at_m", d.at_m.unwrap_or_default())? + moved;
        let needed = "a number above 0 and at most 1e6";
        let length = |what, given: Option<f64>| match given {
            Some(m) if m > 0.0 && m <= 1e6 => Ok(m),
            Some(m) => Err(self.wrong(what, needed, m)),
            None => Err(self.wrong(what, needed, "nothing")),
        };
        Ok(match d.shape {
            ObjectShape::Ground => Shape::Ground { height_m: at.y },
            ObjectShape::Sphere => Shape::Sphere {
                centre: at,
                radius_m: length("radius_m", d.radius_m)?,
            },
            ObjectShape::Block => {
                let size = d.size_m.map(|size| size.map(Some)).unwrap_or_default();
                let [east, up, south] = size.map(|m| length("size_m", m));
                let turn_deg = d.turn_deg.unwrap_or(0.0);
                if !turn_deg.is_finite() {
                    return Err(self.wrong("turn_deg", "a number of degrees", turn_deg));
                }
                Shape::Block {
                    base: at,
                    half_m: DVec3::new(0.5 * east?, up?, 0.5 * south?),
                    turn: turn_deg.to_radians().sin_cos(),
                }
            }
            ObjectShape::Cylinder | ObjectShape::Cone => {
                let radius_m = length("radius_m", d.radius_m)?;
                Shape::Frustum {
                    base: at,
                    radius_m,
                    top_radius_m: match d.shape {
                        ObjectShape::Cone => 0.0,
                        _ => radius_m,
                    },
                    height_m: length("height_m", d.height_m)?,
                }
            }
        })
    }

    /// Refuses dimensions that the shape does not have.
    fn only_known(&self) -> Result<(), ObjectsError> {
        let d = self.described;
        let has = |radius, height, size| (radius, height, size);
        let (radius, height, size) = match d.shape {
            ObjectShape::Ground => has(false, false, false),
            ObjectShape::Sphere => has(true, false, false),
            ObjectShape::Block => has(false, false, true),
            ObjectShape::Cylinder | ObjectShape::Cone => has(true, true, false),
        };
        let left_out = "no value for this shape";
        for (what, known, given) in [
            ("radius_m", radius, d.radius_m.is_some()),
            ("height_m", height, d.height_m.is_some()),
            ("size_m", size, d.size_m.is_some()),
            ("turn_deg", size, d.turn_deg.is_some()),
        ] {
            if given && !known {
                return Err(self.wrong(what, left_out, "a value"));
            }
        }
        Ok(())
    }

    fn place(&self, what: &'static str, at: [f64; 3]) -> Result<DVec3, ObjectsError> {
        match at.iter().find(|m| !(m.is_finite() && m.abs() <= 1e6)) {
            None => Ok(DVec3::from_array(at)),
            Some(m) => Err(self.wrong(what, "[east, up, south], each within 1e6", m)),
        }
    }

    fn surface(&self) -> Result<Surface, ObjectsError> {
        let d = self.described;
        let checker = d.checker.clone().map(|checker| {
            let size_m = checker.size_m;
            match size_m > 0.0 && size_m <= 1e6 {
                true => Ok(Checker {
                    size_m,
                    reflectance: self.reflectance(&checker.reflectance)?,
                }),
                false => {
                    Err(self.wrong("checker.size_m", "a number above 0 and at most 1e6", size_m))
                }
            }
        });
        let gloss = d.gloss.map(|gloss| Gloss {
            roughness: gloss.roughness,
            index: gloss.index.unwrap_or(GLASS),
        });
        if let Some(Gloss { roughness, index }) = gloss {
            if !(0.02..=1.0).contains(&roughness) {
                return Err(self.wrong("gloss.roughness", "a number from 0.02 to 1", roughness));
            }
            if !(1.01..=10.0).contains(&index) {
                return Err(self.wrong("gloss.index", "a number from 1.01 to 10", index));
            }
        }
        Ok(Surface {
            reflectance: self.reflectance(d.reflectance.as_ref().unwrap_or(&GREY))?,
            checker: checker.transpose()?,
            gloss,
        })
    }

    fn reflectance(&self, given: &Reflectance) -> Result<SpectralCurve, ObjectsError> {
        let values: &[f64] = match given {
            Reflectance::Grey(value) => std::slice::from_ref(value),
            Reflectance::Rgb(rgb) => rgb,
            Reflectance::Spectrum { values, .. } => values,
        };
        if let Some(value) = values.iter().find(|v| !(0.0..=1.0).contains(*v)) {
            return Err(self.wrong("reflectance", "numbers from 0 to 1", value));
        }
        match given {
            Reflectance::Grey(value) => Ok(SpectralCurve::Constant(*value)),
            Reflectance::Rgb(rgb) => Ok(of_rgb(*rgb)),
            Reflectance::Spectrum {
                wavelengths_nm,
                values,
            } => SpectralCurve::table(wavelengths_nm.clone(), values.clone()).map_err(|error| {
                self.wrong(
                    "reflectance",
                    "increasing wavelengths_nm with as many values",
                    error,
                )
            }),
        }
    }
}

/// Reflectance that turns sunlight into a linear sRGB colour, with constant values up to 480 nm (blue), from 500 to 580 nm (green)
/// and from 600 nm (red). It is from 0 to 1 for every colour from 0 to 1; of all band edges at multiples of 5 nm, only these have
/// this property.
fn of_rgb(rgb: [f64; 3]) -> SpectralCurve {
    // Inverse of the colours of the three bands in sunlight outside the air, relative to the colour of sunlight.
    const BANDS: [[f64; 3]; 3] = [
        [0.995_718, 0.002_690, 0.001_592],
        [0.009_911, 0.959_431, 0.030_658],
        [0.021_212, 0.039_191, 0.939_597],
    ];
    let band = |k: usize| (0..3).map(|c| BANDS[k][c] * rgb[c]).sum::<f64>();
    let (red, green, blue) = (band(0), band(1), band(2));
    SpectralCurve::table(
        vec![480.0, 500.0, 580.0, 600.0],
        vec![blue, green, green, red],
    )
    .expect("wavelengths increase")
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::spectrum::{RgbSpace, WavelengthGrid};

    #[test]
    fn reflectances_reproduce_rgb_colours() {
        let grid = WavelengthGrid::one_nanometre();
        let seen = |curve: &SpectralCurve| {
            let pairs = grid.wavelengths_nm().iter().zip(grid.solar_irradiance());
            let light: Vec<f32> = pairs
                .map(|(nm, sun)| (sun * curve.at(*nm)) as f32)
                .collect();
            RgbSpace::Srgb.from_xyz(grid.to_xyz(&light))
        };
        let white = seen(&SpectralCurve::Constant(1.0));
        for number in 0..27 {
            let part = |k: u32| f64::from(number / 3u32.pow(k) % 3) / 2.0;
            let rgb = [part(0), part(1), part(2)];
            let curve = of_rgb(rgb);
            for nm in [400.0, 490.0, 540.0, 590.0, 650.0] {
                assert!((-1e-6..=1.0 + 1e-6).contains(&curve.at(nm)), "{rgb:?} {nm}");
            }
            let got = seen(&curve);
            for c in 0..3 {
                assert!(
                    (got[c] / white[c] - rgb[c]).abs() < 2e-3,
                    "{rgb:?}: {got:?} {white:?}"
                );
            }
        }
    }
}
