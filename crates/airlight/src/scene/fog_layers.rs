//! Conversion of a scene's fog to layers.

use super::{FogLayerSpec, FogPatchesSpec, FogSpec, SceneError};
use crate::atmosphere::visibility::{Contrast, extinction_per_m};
use crate::atmosphere::{Constituent, DensityProfile};
use crate::control::Control;
use crate::fog::droplets::DropletKind;
use crate::fog::{FogPatches, FogScattering, PatchField, PatchView};
use crate::sky::View;
use glam::DVec3;

/// The fog of a scene: layers with an upper end, and orders of scattering.
#[derive(Clone, Debug, PartialEq)]
pub struct FogLayers {
    /// The layers, whose extinctions add up.
    pub layers: Vec<FogLayer>,
    /// Orders of scattering.
    pub scattering: FogScattering,
    /// Patches; `None`: even fog.
    pub patches: Option<FogPatches>,
}

/// A layer of fog before its droplets are evaluated at wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct FogLayer {
    /// Relative density by height above the ground.
    pub profile: DensityProfile,
    /// Kind of droplets.
    pub droplets: DropletKind,
    /// Extinction at density 1 at 550 nm, 1/m.
    pub extinction_per_m: f64,
}

impl FogLayers {
    /// The layers as constituents at wavelengths (nm, increasing), with heights above the ground.
    ///
    /// # Errors
    /// [`SceneError`] for an invalid profile or invalid droplets.
    pub fn constituents(&self, wavelengths_nm: &[f64]) -> Result<Vec<Constituent>, SceneError> {
        self.constituents_with(wavelengths_nm, Control::default())
    }

    /// As [`Self::constituents`], with cancellation.
    ///
    /// # Errors
    /// As [`Self::constituents`], and if the caller cancelled.
    pub fn constituents_with(
        &self,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<Vec<Constituent>, SceneError> {
        let layers = self.layers.iter();
        layers
            .map(|layer| layer.constituent_with(wavelengths_nm, control))
            .collect()
    }

    /// The patches seen from an eye (m, above the ground) over ground of a radius (m), at an angular resolution (rad); `None` for even
    /// fog.
    ///
    /// # Errors
    /// [`SceneError`] for patches or profiles out of range.
    pub fn patches_seen_from(
        &self,
        eye_height_m: f64,
        ground_radius_m: f64,
        resolution_rad: f64,
    ) -> Result<Option<PatchView>, SceneError> {
        let Some(patches) = &self.patches else {
            return Ok(None);
        };
        let layers = self.layers.iter();
        let layers = layers.map(|layer| (layer.extinction_per_m, layer.profile.clone()));
        let field = PatchField::new(patches)?;
        let eye = DVec3::Y * eye_height_m;
        PatchView::new(
            field,
            layers.collect(),
            ground_radius_m,
            eye,
            resolution_rad,
        )
        .map(Some)
        .map_err(SceneError::from)
    }

    /// The patches in a view of the sky, at the resolution of a panorama.
    pub(super) fn patches_in_view(&self, view: &View) -> Result<Option<PatchView>, SceneError> {
        /// A quarter of a degree, rad.
        const RESOLUTION_RAD: f64 = 0.004;
        let ground_radius_m = view.bounds_m().0;
        let eye_height_m = view.radius_m() - ground_radius_m;
        self.patches_seen_from(eye_height_m, ground_radius_m, RESOLUTION_RAD)
    }

    /// The layers as constituents of the air over a ground at this altitude (m), for Monte Carlo.
    ///
    /// # Errors
    /// As [`Self::constituents`], and for a profile without an upper end.
    pub(crate) fn in_air(
        &self,
        ground_altitude_m: f64,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<Vec<Constituent>, SceneError> {
        let endless = || {
            SceneError::value(
                "fog.profile",
                "fog with a top or a scale height",
                "fog without an upper end",
                "height, clamped, unclamped or slab",
            )
        };
        let layers = self.constituents_with(wavelengths_nm, control)?.into_iter();
        layers
            .map(|layer| match layer.density.is_uniform() {
                true => Err(endless()),
                false => layer.raised(ground_altitude_m).ok_or_else(endless),
            })
            .collect()
    }
}

impl FogLayer {
    /// The layer as a constituent at wavelengths (nm, increasing), with heights above the ground.
    ///
    /// # Errors
    /// [`SceneError`] for an invalid profile or invalid droplets.
    pub fn constituent(&self, wavelengths_nm: &[f64]) -> Result<Constituent, SceneError> {
        self.constituent_with(wavelengths_nm, Control::default())
    }

    /// As [`Self::constituent`], with cancellation of the computation of published droplets.
    ///
    /// # Errors
    /// As [`Self::constituent`], and if the caller cancelled.
    pub fn constituent_with(
        &self,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<Constituent, SceneError> {
        self.profile
            .validate()
            .map_err(|error| SceneError::refused("fog", error))?;
        let profile = self.profile.clone();
        let (extinction, droplets) = (self.extinction_per_m, self.droplets);
        Ok(Constituent::fog_with(
            extinction,
            droplets,
            profile,
            wavelengths_nm,
            control,
        )?)
    }
}

impl FogSpec {
    /// The layers, with visibilities defined by a contrast threshold.
    ///
    /// # Errors
    /// [`SceneError::Value`] for a layer without a visibility, and for a profile without an upper end, which hides the sky.
    pub(crate) fn resolve(&self, contrast: Contrast) -> Result<FogLayers, SceneError> {
        let layers = self
            .all_layers()
            .enumerate()
            .map(|(i, layer)| match i {
                0 => layer.resolve("fog", contrast),
                more => layer.resolve(&format!("fog.layers[{}]", more - 1), contrast),
            })
            .collect::<Result<_, _>>()?;
        Ok(FogLayers {
            layers,
            scattering: self.scattering.unwrap_or(FogScattering::Multiple),
            patches: self.patches.as_ref().map(FogPatchesSpec::patches),
        })
    }
}

impl FogLayerSpec {
    /// The layer at a key of the scene, with its visibility defined by a contrast threshold.
    ///
    /// # Errors
    /// [`SceneError::Value`] for a layer without a visibility, and for a profile without an upper end, which hides the sky.
    pub fn resolve(&self, key: &str, contrast: Contrast) -> Result<FogLayer, SceneError> {
        let Some(visibility_m) = self.visibility_m else {
            return Err(SceneError::value(
                format!("{key}.visibility_m"),
                "the visibility where the fog is densest, m",
                "none",
                "visibility_m = 200",
            ));
        };
        let Some(profile) = self.density() else {
            return Err(SceneError::value(
                format!("{key}.profile"),
                "fog with an upper end, as the sky must be visible through it",
                "a profile for pictures with depth",
                "height, clamped, unclamped or slab",
            ));
        };
        Ok(FogLayer {
            profile,
            droplets: self.droplets.unwrap_or_default(),
            extinction_per_m: extinction_per_m(visibility_m, contrast),
        })
    }
}
