//! The light of a pixel that is read.

use super::Viewer;
use crate::compute::Light;
use crate::reading::Reading;
use crate::truth;
use glam::DVec3;

impl Viewer {
    /// What is known of the light from a direction.
    pub(super) fn reading(&self, direction: DVec3) -> Reading<'_> {
        let facts = self.facts();
        let point = self.terrain_point(direction);
        let beside = self.beside.as_ref().zip(self.wanted());
        let spectrum = beside.and_then(|(beside, wanted)| beside.spectrum(&wanted));
        Reading {
            direction,
            ground: point.map(|point| {
                let light = self.light.as_deref();
                let ground_m = light.map_or(0.0, Light::ground_altitude_m);
                [point.distance_m, ground_m + point.height_m]
            }),
            spectrum,
            drawn: match point {
                Some(_) => self.pixel_of(direction),
                None => self.sky_colour(direction),
            },
            facts,
        }
    }

    /// Red, green and blue of the sky that is drawn in a direction, cd/m^2.
    pub(super) fn sky_colour(&self, direction: DVec3) -> Option<[f32; 3]> {
        let light = self.light.as_ref()?;
        let drawn = truth::drawn(light, &[direction.as_vec3().to_array()]);
        drawn.first().copied()
    }

    /// Red, green and blue of terrain that is drawn in a direction, cd/m^2; `None` where the device does not return them.
    pub(super) fn pixel_of(&self, direction: DVec3) -> Option<[f32; 3]> {
        let (drawn, of, rgb) = self.pixel.as_ref()?;
        (Some(*drawn) == self.drawn && *of == direction).then_some(*rgb)
    }

    /// Reads back the pixel of terrain that the reading is open on, unless it is that of the picture before.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn read_pixel(&mut self) {
        let (Some(direction), Some(drawn)) = (self.direction, self.drawn) else {
            return;
        };
        if self.pixel_of(direction).is_some() || self.terrain_point(direction).is_none() {
            return;
        }
        let (_, shot) = drawn;
        let Some((x, y)) = shot.frame.pixel_of(direction) else {
            return;
        };
        let [width, height] = shot.size();
        let [x, y] = [(x as u32).min(width - 1), (y as u32).min(height - 1)];
        if let Ok((_, pixels)) = self.pixels() {
            let rgb = pixels[(y * width + x) as usize];
            self.pixel = Some((drawn, direction, rgb));
        }
    }
}
