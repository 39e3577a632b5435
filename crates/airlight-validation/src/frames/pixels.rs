//! Pixels of frames that are compared, and the walls that they see.

use airlight::axes;
use airlight::glam::{DVec3, Vec3};
use airlight::sky::View;
use airlight::spectrum::RgbSpace;
use airlight_gpu::headless::Frame;

/// Pixels on a side of a frame.
const SIDE: u32 = 128;

/// A pixel of one of the frames.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Index of its frame among [`frames`].
    pub frame: usize,
    /// Index among the pixels of the frame.
    pub index: usize,
    /// Unit vector through its middle.
    pub direction: DVec3,
    /// Distance of the wall, m: 0.1 to 100 km behind the start of the air, or the ground if that is nearer. `None` beside the planet's
    /// air.
    pub wall_m: Option<f64>,
}

/// Grey walls in the colour of sunlight, as bright as the sky.
#[derive(Clone, Debug)]
pub struct Wall {
    /// Luminance, cd/m^2: that of the sky 30 degrees above the horizon, or of the ground from space.
    pub luminance: f64,
    /// Spectral radiance at the wavelengths of the view, W m^-2 sr^-1 nm^-1.
    pub radiance: Vec<f32>,
    /// Red, green and blue, cd/m^2.
    pub rgb: [f64; 3],
    /// Red, green and blue of sunlight outside the air, lx.
    pub sunlight: [f64; 3],
}

impl Wall {
    /// The walls of a view.
    pub fn new(view: &View) -> Self {
        const BESIDE_SUN_DEG: f64 = 20.0;
        let grid = view.sky().grid();
        let luminance = |elevation_deg: f64| {
            let azimuth = axes::azimuth_deg(view.sun()) + BESIDE_SUN_DEG;
            let direction = axes::direction(azimuth, elevation_deg);
            grid.to_xyz(&view.along(direction, None).radiance())[1]
        };
        let luminance = match luminance(30.0) {
            0.0 => luminance(view.horizon_elevation_rad().to_degrees() - 5.0),
            sky => sky,
        };
        let solar = view.solar_irradiance();
        let sunlight = grid.to_xyz(&solar);
        let factor = luminance / sunlight[1];
        let sunlight = RgbSpace::Srgb.from_xyz(sunlight);
        Self {
            luminance,
            radiance: solar.iter().map(|e| e * factor as f32).collect(),
            rgb: sunlight.map(|v| v * factor),
            sunlight,
        }
    }
}

/// Frames to all sides.
pub fn frames() -> [Frame; 6] {
    [
        (100.0, 0.0),
        (190.0, 0.0),
        (280.0, 0.0),
        (10.0, 0.0),
        (140.0, 90.0),
        (140.0, -90.0),
    ]
    .map(|(azimuth, elevation)| Frame::towards(axes::direction(azimuth, elevation).as_vec3(), SIDE))
}

/// Distance of the wall in a pixel, m; infinite without one.
pub fn wall_m(view: &View, direction: Vec3, (x, y): (u32, u32)) -> f64 {
    let place = f64::from((3 * x + 7 * y) % 101) / 100.0;
    let into_air_m = 100.0 * 1e3f64.powf(place);
    let (ground_m, top_m) = view.bounds_m();
    let direction = direction.as_dvec3().normalize();
    let start_m = match view.radius_m() > top_m {
        true => match crossing_m(view.radius_m(), direction.y, top_m) {
            Some(start_m) => start_m,
            None => return f64::INFINITY,
        },
        false => 0.0,
    };
    let ground_m = crossing_m(view.radius_m(), direction.y, ground_m);
    (start_m + into_air_m).min(ground_m.unwrap_or(f64::INFINITY))
}

/// Distance at which a ray from `radius_m`, the cosine of whose zenith angle is `mu`, enters a sphere below, m.
fn crossing_m(radius_m: f64, mu: f64, sphere_m: f64) -> Option<f64> {
    let half_chord = (sphere_m - radius_m) * (sphere_m + radius_m) + (radius_m * mu).powi(2);
    (mu < 0.0 && half_chord >= 0.0).then(|| -radius_m * mu - half_chord.sqrt())
}

/// Pixels towards `count` directions all around, denser beside the horizon: the ones after the `first` of an endless sequence. Pixels at
/// the horizon, where radiance jumps, and at the sun's disc are left out.
pub fn pixels(view: &View, count: usize, first: usize) -> Vec<Pixel> {
    let horizon = view.horizon_elevation_rad();
    let (_, top_m) = view.bounds_m();
    let highest = match view.radius_m() > top_m {
        true => -(top_m / view.radius_m()).acos(),
        false => 90f64.to_radians(),
    };
    let frames = frames();
    let pixel = |k: usize| {
        // Multiples of the powers of the plastic number fill a square evenly.
        let [x, y] = [0.754_877_666_246_693, 0.569_840_290_998_053]
            .map(|step: f64| (k as f64 * step).fract());
        let end = if k.is_multiple_of(4) {
            -90f64.to_radians()
        } else {
            highest
        };
        let elevation = horizon + (end - horizon) * y * y;
        let towards = axes::direction(360.0 * x, elevation.to_degrees()).as_vec3();
        let found = frames.iter().enumerate();
        let (frame, (x, y)) = found
            .filter_map(|(index, frame)| Some((index, frame.pixel(towards)?)))
            .next()?;
        let seen = frames[frame].direction(x, y);
        let direction = seen.as_dvec3().normalize();
        let wall_m = wall_m(view, seen, (x, y));
        let beside_horizon = (direction.y.asin() - horizon).abs() > 1e-4;
        // A pixel that the disc touches holds a part of its light.
        let half_diagonal = std::f64::consts::SQRT_2 / f64::from(SIDE);
        let disc = 1.1 * view.disc().angular_radius_rad + half_diagonal;
        let beside_sun = direction.angle_between(view.sun()) > disc;
        (beside_horizon && beside_sun).then_some(Pixel {
            frame,
            index: (y * SIDE + x) as usize,
            direction,
            wall_m: wall_m.is_finite().then_some(wall_m),
        })
    };
    (first..).filter_map(pixel).take(count).collect()
}
