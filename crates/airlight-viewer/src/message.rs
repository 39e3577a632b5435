//! Requests and answers as bytes, for a worker of a page. Numbers are in the byte order of the machine, which both ends share.

use crate::compute::{
    Answer, Colours, Facts, GroundLight, Light, Output, Request, Spectrum, Target, Task,
};
use airlight::scene::Scene;
use airlight_gpu::{DirectLight, DiscTable, FogFrame, FrameTables, Lighting, SourceTables};
use airlight_shaders::twins::colour::RgbWeights;
use airlight_shaders::twins::fog::{FogLayer, FogMedium};
use airlight_shaders::twins::fog_table::FogTableView;
use airlight_shaders::twins::lights::ExponentialFog;
use airlight_shaders::twins::sky_tables::{SkyScales, SkyView};
use airlight_shaders::twins::texture::Texture;
use airlight_shaders::{FogTables, SingleScatteringTable, SkyTables};
use glam::{Vec3, Vec4};

impl Request {
    /// The request as bytes: its number, its task, and its scene as TOML.
    ///
    /// # Errors
    /// Why the scene cannot be written, as a sentence.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let scene = self.scene.to_toml().map_err(|error| error.to_string())?;
        let mut bytes = Vec::new();
        self.number.put(&mut bytes);
        self.task.put(&mut bytes);
        bytes.extend_from_slice(scene.as_bytes());
        Ok(bytes)
    }

    /// The request of [`Request::to_bytes`].
    ///
    /// # Errors
    /// Why the bytes are none, as a sentence.
    pub fn from_bytes(mut bytes: &[u8]) -> Result<Self, String> {
        let before = u64::take(&mut bytes).zip(Task::take(&mut bytes));
        let (number, task) = before.ok_or("expected the bytes of a request, got others")?;
        let scene = str::from_utf8(bytes).map_err(|error| error.to_string())?;
        let scene = Scene::from_toml(scene).map_err(|error| error.to_string())?;
        Ok(Self {
            number,
            scene,
            task,
        })
    }
}

impl Answer {
    /// The answer as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.put(&mut bytes);
        bytes
    }

    /// The answer of [`Answer::to_bytes`]; `None` for other bytes.
    pub fn from_bytes(mut bytes: &[u8]) -> Option<Self> {
        Self::take(&mut bytes).filter(|_| bytes.is_empty())
    }
}

/// Values as bytes.
trait Bytes: Sized {
    /// Appends the value.
    fn put(&self, bytes: &mut Vec<u8>);
    /// Removes a value from the front.
    fn take(bytes: &mut &[u8]) -> Option<Self>;
}

/// Numbers.
macro_rules! numbers {
    ($($kind:ty),*) => { $(
        impl Bytes for $kind {
            fn put(&self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_ne_bytes());
            }
            fn take(bytes: &mut &[u8]) -> Option<Self> {
                let (first, rest) = bytes.split_first_chunk()?;
                *bytes = rest;
                Some(Self::from_ne_bytes(*first))
            }
        }
    )* };
}

numbers!(f32, f64, u8, u32, u64);

/// Structs, field by field.
macro_rules! structs {
    ($($name:ident { $($field:ident),* })*) => { $(
        impl Bytes for $name {
            fn put(&self, bytes: &mut Vec<u8>) {
                $(self.$field.put(bytes);)*
            }
            fn take(bytes: &mut &[u8]) -> Option<Self> {
                $(let $field = Bytes::take(bytes)?;)*
                Some(Self { $($field),* })
            }
        }
    )* };
}

structs! {
    Answer { number, result }
    Spectrum { wavelengths_nm, radiance, transmittance, xyz }
    Target { direction, ground }
    GroundLight { distance_m, rgb }
    Colours { rgb, ignored, noise }
    Light { tables, facts }
    Facts {
        sun_elevation_deg, sun_azimuth_deg, altitude_m, horizon_deg, haze_depth_550, ozone_du, ground_albedo, is_earth, sun_lx, sky_lx,
        holds_lights, visibility_m
    }
    FrameTables { first, second, lighting }
    SourceTables { sky, disc, single, fog }
    SingleScatteringTable { smooth, scale }
    DiscTable { radiance, one_minus_cos, moon_to_sun }
    SkyTables {
        view, scales, sky_smooth, sky_haze, aerial_smooth, aerial_haze, extinction, phase, radiance_weights, transmittance_weights,
        disc_weights
    }
    SkyView { sun, height_m, ground_radius_m, air_height_m, horizon_rad, highest_rad, kink_rad, kink_place,
        dense_share, dense_azimuth, dense_width, even_below, jump_height_m, jump_place, jump_part, extinction_above, smooth_above, haze_above }
    SkyScales { smooth_light, haze }
    RgbWeights { red, green, blue }
    FogFrame { tables, layers, eye_height_m, around_lights }
    ExponentialFog { medium, mean_cosine, reference_height_m, scale_height_m }
    FogMedium { extinction_per_m, scattering_per_m }
    FogTables { views, diffuse, streams, stream_phase }
    FogTableView {
        sun, below_per_sine, depth_below, above_per_sine, depth_above, diffuse_scale, sunlit_scale, layer, layer_count, phase_count
    }
    FogLayer { extinction_per_m, profile, scattering_per_m, height_m, phase, scale_m }
    Lighting { sun, sun_illuminance_lx, second, sky_coefficients_lx }
    DirectLight { direction, illuminance_lx }
}

impl Bytes for Task {
    fn put(&self, bytes: &mut Vec<u8>) {
        match self {
            Self::Light { has_terrain } => {
                0u8.put(bytes);
                has_terrain.put(bytes);
            }
            Self::Spectrum(target) => {
                1u8.put(bytes);
                target.put(bytes);
            }
            Self::Colours {
                model,
                directions,
                bundles,
            } => {
                2u8.put(bytes);
                model.put(bytes);
                directions.put(bytes);
                bundles.put(bytes);
            }
            Self::Picture => 3u8.put(bytes),
        }
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        match u8::take(bytes)? {
            0 => Some(Self::Light {
                has_terrain: Bytes::take(bytes)?,
            }),
            1 => Bytes::take(bytes).map(Self::Spectrum),
            2 => Some(Self::Colours {
                model: Bytes::take(bytes)?,
                directions: Bytes::take(bytes)?,
                bundles: Bytes::take(bytes)?,
            }),
            3 => Some(Self::Picture),
            _ => None,
        }
    }
}

impl Bytes for Output {
    fn put(&self, bytes: &mut Vec<u8>) {
        match self {
            Self::Light(light) => {
                0u8.put(bytes);
                light.put(bytes);
            }
            Self::Spectrum(spectrum) => {
                1u8.put(bytes);
                spectrum.put(bytes);
            }
            Self::Colours(colours) => {
                2u8.put(bytes);
                colours.put(bytes);
            }
        }
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        match u8::take(bytes)? {
            0 => Bytes::take(bytes).map(Self::Light),
            1 => Bytes::take(bytes).map(Self::Spectrum),
            2 => Bytes::take(bytes).map(Self::Colours),
            _ => None,
        }
    }
}

impl Bytes for bool {
    fn put(&self, bytes: &mut Vec<u8>) {
        u8::from(*self).put(bytes);
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        match u8::take(bytes)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl<T: Bytes, const N: usize> Bytes for [T; N] {
    fn put(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|value| value.put(bytes));
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        let values: Option<Vec<T>> = (0..N).map(|_| T::take(bytes)).collect();
        values?.try_into().ok()
    }
}

impl Bytes for Vec3 {
    fn put(&self, bytes: &mut Vec<u8>) {
        self.to_array().put(bytes);
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        Bytes::take(bytes).map(Self::from_array)
    }
}

impl Bytes for Vec4 {
    fn put(&self, bytes: &mut Vec<u8>) {
        self.to_array().put(bytes);
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        Bytes::take(bytes).map(Self::from_array)
    }
}

impl Bytes for Texture {
    fn put(&self, bytes: &mut Vec<u8>) {
        let size = self.size().map(|n| n as u32);
        size.put(bytes);
        let texels = self.texels();
        bytes.reserve(size_of_val(texels));
        let values = texels.iter().flat_map(|texel| texel.to_array());
        bytes.extend(values.flat_map(f32::to_ne_bytes));
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        let size = <[u32; 3]>::take(bytes)?.map(|n| n as usize);
        let count = size.iter().try_fold(1usize, |a, b| a.checked_mul(*b))?;
        let (texels, rest) = bytes.split_at_checked(count.checked_mul(size_of::<Vec4>())?)?;
        *bytes = rest;
        let (texels, _) = texels.as_chunks::<16>();
        let texel = |mut of: &[u8]| Vec4::take(&mut of);
        let texels: Option<Vec<Vec4>> = texels.iter().map(|of| texel(of)).collect();
        Some(Self::new(size, texels?))
    }
}

impl Bytes for String {
    fn put(&self, bytes: &mut Vec<u8>) {
        (self.len() as u64).put(bytes);
        bytes.extend_from_slice(self.as_bytes());
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        let length = usize::try_from(u64::take(bytes)?).ok()?;
        let (text, rest) = bytes.split_at_checked(length)?;
        *bytes = rest;
        Self::from_utf8(text.to_vec()).ok()
    }
}

impl<T: Bytes> Bytes for Vec<T> {
    fn put(&self, bytes: &mut Vec<u8>) {
        (self.len() as u64).put(bytes);
        self.iter().for_each(|value| value.put(bytes));
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        let length = u64::take(bytes)?;
        (0..length).map(|_| T::take(bytes)).collect()
    }
}

impl<T: Bytes> Bytes for Box<T> {
    fn put(&self, bytes: &mut Vec<u8>) {
        self.as_ref().put(bytes);
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        T::take(bytes).map(Self::new)
    }
}

impl<T: Bytes> Bytes for Option<T> {
    fn put(&self, bytes: &mut Vec<u8>) {
        self.is_some().put(bytes);
        if let Some(value) = self {
            value.put(bytes);
        }
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        match bool::take(bytes)? {
            true => T::take(bytes).map(Some),
            false => Some(None),
        }
    }
}

impl<T: Bytes, E: Bytes> Bytes for Result<T, E> {
    fn put(&self, bytes: &mut Vec<u8>) {
        self.is_ok().put(bytes);
        match self {
            Ok(value) => value.put(bytes),
            Err(error) => error.put(bytes),
        }
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        match bool::take(bytes)? {
            true => T::take(bytes).map(Ok),
            false => E::take(bytes).map(Err),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::State;
    use airlight::scene::{FogSpec, Projection};

    #[test]
    fn requests_and_answers_return_from_bytes() {
        let mut scene = State::default().lit_scene();
        scene.camera.projection = Some(Projection::Perspective);
        scene.camera.size = Some([6, 4]);
        scene.fog = Some(FogSpec {
            visibility_m: Some(2000.0),
            ..Default::default()
        });
        let colours = |model: &str| Task::Colours {
            model: model.to_owned(),
            directions: vec![[0.0, 1.0, 0.0], [0.0; 3]],
            bundles: 2,
        };
        let spectrum = |ground| {
            Task::Spectrum(Target {
                direction: [0.0, 0.6, -0.8],
                ground,
            })
        };
        let tasks = [
            Task::Light { has_terrain: false },
            Task::Light { has_terrain: true },
            spectrum(None),
            spectrum(Some(GroundLight {
                distance_m: 900.0,
                rgb: [20.0, 30.0, 10.0],
            })),
            colours("preetham"),
            colours("monte-carlo"),
            Task::Picture,
        ];
        for (number, task) in (7..).zip(tasks) {
            let request = Request {
                number,
                scene: scene.clone(),
                task,
            };
            let sent = request.to_bytes().unwrap();
            assert_eq!(Request::from_bytes(&sent), Ok(request.clone()));
            let answer = crate::compute(&request);
            assert_eq!(answer.result.as_ref().err(), None);
            let bytes = answer.to_bytes();
            assert_eq!(Answer::from_bytes(&bytes), Some(answer));
            for length in [0, 1, 8, 9, bytes.len() / 2, bytes.len() - 1] {
                assert_eq!(Answer::from_bytes(&bytes[..length]), None, "{length}");
            }
            assert_eq!(Answer::from_bytes(&[bytes, vec![0]].concat()), None);
        }
        let refused = Answer {
            number: 8,
            result: Err("expected air, got none".to_owned()),
        };
        assert_eq!(Answer::from_bytes(&refused.to_bytes()), Some(refused));
    }
}
