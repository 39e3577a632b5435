//! Orientation of panoramas for the programs that read them.

use crate::names::named;

/// Program for whose axes a panorama or a cube map is oriented, so that north and up lie where that program's scenes have them.
///
/// Each program reads equirectangular pictures unmirrored, with up at the top, but with another of its axes in the centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Orientation {
    /// North in the centre.
    #[default]
    Airlight,
    /// Blender: +Y is north, +Z up; the centre is +X, east.
    Blender,
    /// Mitsuba: -Z is north, +Y up; the centre is +Z, south.
    Mitsuba,
    /// three.js: -Z is north, +Y up; the centre of a panorama is +X, east. Cube maps are sampled mirrored in x.
    Three,
    /// Unreal Engine: +X is north, +Z up; the centre is -Y, west.
    Unreal,
    /// Unity, material Skybox/Panoramic: +Z is north, +Y up; the centre is +X, east.
    Unity,
    /// Godot: -Z is north, +Y up; the centre is +Z, south.
    Godot,
}

named! { Orientation, "an orientation", [
    ("airlight", (Airlight), "north in the centre; cube maps for OpenGL and Vulkan"),
    ("blender", (Blender), "Blender: north is +Y, up +Z"),
    ("mitsuba", (Mitsuba), "Mitsuba: north is -Z, up +Y"),
    ("three", (Three), "three.js: north is -Z, up +Y; also cube maps, for CubeTextureLoader"),
    ("unreal", (Unreal), "Unreal Engine: north is +X, up +Z"),
    ("unity", (Unity), "Unity, material Skybox/Panoramic: north is +Z, up +Y"),
    ("godot", (Godot), "Godot: north is -Z, up +Y"),
] }

impl Orientation {
    /// Azimuth of the centre of an equirectangular picture, degrees clockwise from north.
    pub fn center_azimuth_deg(self) -> f64 {
        match self {
            Self::Airlight => 0.0,
            Self::Blender | Self::Three | Self::Unity => 90.0,
            Self::Mitsuba | Self::Godot => 180.0,
            Self::Unreal => 270.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes;
    use std::f64::consts::{PI, TAU};

    /// Place across and down a panorama, from 0 to 1, at which a program looks for a direction in its own axes; the unit vectors of
    /// its axes that are east, north and up.
    type Host = (Orientation, fn([f64; 3]) -> f64, usize, [[f64; 3]; 3]);

    const HOSTS: [Host; 6] = [
        (
            Orientation::Blender,
            |[x, y, _]| 0.5 - y.atan2(x) / TAU,
            2,
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        ),
        (
            Orientation::Mitsuba,
            |[x, _, z]| x.atan2(-z) / TAU,
            1,
            [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        ),
        (
            Orientation::Three,
            |[x, _, z]| 0.5 + z.atan2(x) / TAU,
            1,
            [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        ),
        // `LookupLongLat` in TextureCompressorModule.cpp, whose y and z `TransformSideToWorldSpace` has exchanged.
        (
            Orientation::Unreal,
            |[x, y, _]| 0.5 + x.atan2(-y) / TAU,
            2,
            [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        ),
        // `ToRadialCoords` in Skybox-Panoramic.shader.
        (
            Orientation::Unity,
            |[x, _, z]| 0.5 - z.atan2(x) / TAU,
            1,
            [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        ),
        // `panorama_coords` in sky.glsl, the SKY_COORDS of shaders.
        (
            Orientation::Godot,
            |[x, _, z]| x.atan2(-z) / TAU,
            1,
            [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        ),
    ];

    /// The pixel that a program reads for a direction in its axes shows the same direction in the world.
    #[test]
    fn every_program_finds_each_direction_where_its_axes_have_it() {
        for (host, across, vertical, [east, north, up]) in HOSTS {
            for azimuth_deg in (5..360).step_by(10) {
                for elevation_deg in [-60.0, 0.0, 35.0] {
                    let world = axes::direction(f64::from(azimuth_deg), elevation_deg);
                    let theirs: [f64; 3] = std::array::from_fn(|i| {
                        world.x * east[i] - world.z * north[i] + world.y * up[i]
                    });
                    let down = theirs[vertical].acos() / PI;
                    let read = axes::direction(
                        host.center_azimuth_deg() + 360.0 * (across(theirs) - 0.5),
                        90.0 - 180.0 * down,
                    );
                    assert!(read.distance(world) < 1e-12, "{host}: {world} {read}");
                }
            }
        }
        assert_eq!(HOSTS.len() + 1, <Orientation as crate::Named>::ALL.len());
    }
}
