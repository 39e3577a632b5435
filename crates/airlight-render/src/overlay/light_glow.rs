//! LightSet in the fog over a picture.

use airlight::fog::lights::{
    Light, LightForm, LightRayGeometry, LightSet, LightSettings, ParticipatingMedium, ViewRay,
};
use airlight::fog::{FogError, Ground, Layer};
use airlight::spectrum::Spectrum;
use airlight::spectrum::rgb::DOMINANT_NM;
use glam::DVec3;

/// The light that fog scatters out of lamps' into lines of sight from a camera above the origin.
///
/// Light is scattered once. What the lamps light besides fog, and the lamps themselves, the picture shows or does not; fog
/// dims either as it dims all of it.
#[derive(Clone, Debug)]
pub struct LightGlow {
    lamps: LightSet<3>,
    /// Each layer with the others, which dim its light.
    layers: Vec<(Layer<3>, Vec<Layer<3>>)>,
    ground: Ground,
    form: LightForm,
}

impl LightGlow {
    /// LightSet (metres east, up and south of the point at height 0 under the camera; intensities in the picture's unit times
    /// m^2) in layers of fog.
    ///
    /// # Errors
    /// [`FogError`] for a layer that is none.
    pub fn new(
        lamps: Vec<Light<3>>,
        layers: &[Layer<3>],
        ground: Ground,
    ) -> Result<Self, FogError> {
        for layer in layers {
            layer.medium.validate()?;
            layer.profile.validate()?;
        }
        let with_others = |(i, layer): (usize, &Layer<3>)| {
            let others = [&layers[..i], &layers[i + 1..]].concat();
            (layer.clone(), others)
        };
        Ok(Self {
            lamps: LightSet::new(lamps, LightSettings::default())?,
            layers: layers.iter().enumerate().map(with_others).collect(),
            ground,
            form: LightForm::Exact,
        })
    }

    /// The same by another form of their light.
    ///
    /// # Errors
    /// [`FogError::LightForm`] where that does not hold for these lamps and layers.
    pub fn by(self, form: LightForm) -> Result<Self, FogError> {
        let layers: Vec<Layer<3>> = self.layers.iter().map(|(layer, _)| layer.clone()).collect();
        form.check(self.lamps.lights(), &layers)?;
        Ok(Self { form, ..self })
    }

    /// What they add to a line of sight of a length (m; may be infinite) from an eye at a height (m).
    pub fn path_radiance(
        &self,
        eye_height_m: f64,
        direction: DVec3,
        distance_m: f64,
    ) -> Spectrum<3> {
        let sight = ViewRay {
            eye: DVec3::Y * eye_height_m,
            direction,
            length_m: distance_m,
        };
        if self.form != LightForm::Exact {
            return self.by_form(&sight);
        }
        self.layers
            .iter()
            .fold(Spectrum::ZERO, |sum, (layer, others)| {
                let murk = ParticipatingMedium {
                    medium: &layer.medium,
                    profile: &layer.profile,
                    others,
                    wavelengths_nm: &DOMINANT_NM,
                    ground_radius_m: self.ground.radius_m,
                };
                sum + self.lamps.path_radiance(&murk, &sight)
            })
    }

    /// By a form that holds in the layer that there is.
    fn by_form(&self, sight: &ViewRay) -> Spectrum<3> {
        let mut sum = Spectrum::ZERO;
        for (layer, _) in &self.layers {
            for lamp in self.lamps.lights() {
                let (position, radius_m) = (lamp.position(), lamp.radius_m());
                let (eye, direction) = (sight.eye, sight.direction);
                let passage =
                    LightRayGeometry::new(eye, direction, sight.length_m, position, radius_m);
                sum += self.form.path_radiance(layer, &passage, lamp.intensity());
            }
        }
        sum
    }
}
