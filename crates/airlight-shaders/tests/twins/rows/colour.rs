//! Colour, tone curves, dither, the discs of sun and moon.

use super::sky_tables::weighted;
use super::{Row, rows};
use crate::flat::flat_struct;
use crate::random::Random;
use airlight::night::MoonState;
use airlight::spectrum::{RgbSpace, rgb};
use airlight::sun::SunDisc;
use airlight_image::tone::{AgxSettings, CameraSettings, ToneCurve, ToneMapper};
use airlight_shaders::twins;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use std::sync::LazyLock;

flat_struct! {
    twins::colour::RgbWeights { red, green, blue }
    twins::disc::LimbDarkening { zeroth, first, second, third, fourth, fifth }
}

fn three(x: &[f64]) -> [f64; 3] {
    [x[0], x[1], x[2]]
}

/// A colour inside or outside the gamut, dark or bright.
fn colour(r: &mut Random) -> Vec<f32> {
    let size = r.or(&[1.0, 0.0, 0.18, 100.0], |r| r.decades(1e-4, 1e3));
    let grey = r.unit();
    let saturated = r.one_of(&[0.0, 1e-4, 0.5, 1.0, 1.0]);
    r.rgb(|r| size * (grey + saturated * (r.between(-0.3, 1.0) - grey)))
        .to_vec()
}

/// XYZ of a colour of light: one that is not the difference of much larger numbers.
fn light(r: &mut Random) -> Vec<f32> {
    r.rgb(Random::unit).to_vec()
}

fn luminance(x: &[f64]) -> f64 {
    0.2126 * x[0] + 0.7152 * x[1] + 0.0722 * x[2]
}

/// Towards grey until no component is negative.
fn exact_without_negatives(x: &[f64]) -> Vec<f64> {
    let bottom = x[0].min(x[1]).min(x[2]);
    let grey = luminance(x).max(0.0);
    match bottom < 0.0 {
        true => x
            .iter()
            .map(|v| (grey + grey * (v - grey) / (grey - bottom)).max(0.0))
            .collect(),
        false => x.to_vec(),
    }
}

fn exact_into_unit_cube(x: &[f64]) -> Vec<f64> {
    let x = exact_without_negatives(x);
    let top = x[0].max(x[1]).max(x[2]);
    let grey = luminance(&x).min(1.0);
    match top > 1.0 {
        true => x
            .iter()
            .map(|v| grey + (1.0 - grey) * (v - grey) / (top - grey))
            .collect(),
        false => x,
    }
}

/// Contrasts and saturations of the camera curve in the tests.
const CONTRASTS: [f32; 4] = [0.5, 1.0, 1.2, 3.0];
const SATURATIONS: [f32; 3] = [0.0, 1.0, 1.5];

/// The library's tone mappers, whose tables take time to fill.
static CAMERAS: LazyLock<Vec<(f64, f64, ToneMapper)>> = LazyLock::new(|| {
    let pairs = CONTRASTS
        .iter()
        .flat_map(|c| SATURATIONS.map(|s| (f64::from(*c), f64::from(s))));
    let mapper = |(contrast, saturation)| {
        let curve = ToneCurve::Camera(CameraSettings {
            contrast,
            saturation,
        });
        let mapper = ToneMapper::new(1.0, curve).expect("a curve");
        (contrast, saturation, mapper)
    };
    pairs.map(mapper).collect()
});
static AGX: LazyLock<ToneMapper> = LazyLock::new(|| {
    ToneMapper::new(1.0, ToneCurve::Agx(AgxSettings::default())).expect("a curve")
});

/// Display light of a colour by the library.
fn mapped(mapper: &ToneMapper, x: &[f64]) -> Vec<f64> {
    let encoded = mapper.map(three(x).map(|v| v as f32));
    encoded
        .iter()
        .map(|v| rgb::srgb_decode(f64::from(*v)))
        .collect()
}

fn response(x: f64, contrast: f64) -> f64 {
    let n = contrast / 0.82;
    match x > 0.0 {
        true => 1.0 / (1.0 + (1.0 / 0.18 - 1.0) * (0.18 / x).powf(n)),
        false => 0.0,
    }
}

pub fn colour_functions() -> Vec<Row> {
    rows!(twins::colour {
        rgb_from_spectrum: |r| (0..16).map(|_| r.unit()).collect()
            => |x| weighted(&x[..12], &x[12..]);
        xyz_from_srgb: light => |x| RgbSpace::Srgb.to_xyz(three(x)).to_vec();
        srgb_from_xyz: light => |x| RgbSpace::Srgb.from_xyz(three(x)).to_vec();
        xyz_from_rec2020_rgb: light => |x| RgbSpace::Rec2020.to_xyz(three(x)).to_vec();
        rec2020_from_xyz: light => |x| RgbSpace::Rec2020.from_xyz(three(x)).to_vec();
        xyz_from_acescg: light => |x| RgbSpace::AcesCg.to_xyz(three(x)).to_vec();
        acescg_from_xyz: light => |x| RgbSpace::AcesCg.from_xyz(three(x)).to_vec();
        srgb_encode: colour => |x| x.iter().map(|&v| rgb::srgb_encode(v)).collect();
        srgb_decode: |r| r.rgb(|r| r.or(&[0.0, 0.04045, 1.0, -0.5], |r| r.between(-0.2, 1.5))).to_vec()
            => |x| x.iter().map(|&v| rgb::srgb_decode(v)).collect();
        srgb_luminance: light => |x| vec![luminance(x)];
        without_negatives: light_or_not => exact_without_negatives;
        into_unit_cube: light_or_not => exact_into_unit_cube;
    })
}

/// A colour whose components may be negative or above 1.
fn light_or_not(r: &mut Random) -> Vec<f32> {
    r.rgb(|r| r.or(&[0.0, 1.0], |r| r.between(-1.0, 3.0)))
        .to_vec()
}

pub fn tone() -> Vec<Row> {
    rows!(twins::tone {
        clip_tone: colour => |x| x.iter().map(|v| v.clamp(0.0, 1.0)).collect();
        camera_response: |r| {
            let mut all = r.rgb(|r| r.or(&[0.0, 0.18], |r| r.decades(1e-6, 1e6))).to_vec();
            all.push(r.between(0.5, 3.0));
            all
        } => |x| x[..3].iter().map(|&v| response(v, x[3])).collect();
        camera_tone: |r| {
            let mut all = colour(r);
            all.extend([r.one_of(&CONTRASTS), r.one_of(&SATURATIONS)]);
            all
        } => |x| {
            let (contrast, saturation) = (x[3], x[4]);
            let known = CAMERAS.iter().find(|(c, s, _)| *c == contrast && *s == saturation);
            mapped(&known.expect("a mapper").2, x)
        };
        agx_response: |r| [r.or(&[0.0, 0.18, 1e4], |r| r.decades(1e-4, 20.0)); 3].to_vec()
            // Equal components pass the inset and the outset.
            => |x| mapped(&AGX, x);
        agx_tone: colour => |x| mapped(&AGX, x);
    })
}

fn hash(n: u32) -> u32 {
    let mix = |n: u32, shift: u32, factor: u64| (u64::from(n ^ (n >> shift)) * factor) as u32;
    let n = mix(mix(n, 16, 0x21f0_aaad), 15, 0x735a_2d97);
    n ^ (n >> 15)
}

fn numbers(bits: u32) -> [f64; 3] {
    [22, 11, 0].map(|shift| f64::from((bits >> shift) % 1024) / 1024.0)
}

fn noise(column: f64, row: f64) -> [f64; 3] {
    let seed = hash(row as u32 ^ 0x5bd1_e995);
    let at = |column: u64| numbers(hash((u64::from(seed) + column * 0x9e37_79b9) as u32));
    let (here, before) = (at(column as u64 + 1), at(column as u64));
    [0, 1, 2].map(|c| here[c] - before[c])
}

/// A number of a pixel or a level, which f32 holds.
fn index(r: &mut Random) -> f32 {
    r.or(&[0.0, 1.0, 1919.0], |r| {
        (r.unit() * 65536.0 * 128.0).floor()
    })
}

pub fn dither() -> Vec<Row> {
    rows!(twins::dither {
        dither_hash: |r| vec![index(r)] => |x| vec![f64::from(hash(x[0] as u32))];
        numbers_from_bits: |r| vec![index(r) * 512.0] => |x| numbers(x[0] as u32).to_vec();
        triangular_noise: |r| vec![index(r), index(r)] => |x| noise(x[0], x[1]).to_vec();
        dithered: |r| {
            let mut all = r.rgb(|r| r.or(&[0.0, 1.0, 0.5 / 255.0], Random::unit)).to_vec();
            all.extend([r.one_of(&[255.0, 1023.0]), index(r), index(r)]);
            all
        } => |x| {
            let noise = noise(x[4], x[5]);
            (0..3).map(|c| {
                let level = x[c] * x[3];
                (level + noise[c] * level.min(x[3] - level).min(1.0)) / x[3]
            }).collect()
        };
    })
}

/// Wavelengths of limb darkening.
fn wavelengths(r: &mut Random) -> Vec<f32> {
    (0..4)
        .map(|_| r.or(&[445.0, 525.0, 575.0, 640.0], |r| r.between(423.0, 1099.0)))
        .collect()
}

/// Coefficients of the library's polynomials relative to the mean of the disc, solved for from six places on it.
fn coefficients(wavelengths_nm: &[f64]) -> Vec<f64> {
    let disc = SunDisc::default();
    let edge = disc.angular_radius_rad.sin();
    let mu = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0f64];
    let mut all = vec![0.0; 24];
    for (lane, &nm) in wavelengths_nm.iter().enumerate() {
        // Newton's divided differences, then nested multiplication.
        let mut values = mu.map(|mu| {
            let angle = (edge * (1.0 - mu * mu).max(0.0).sqrt()).asin();
            // At the limb itself rounding may miss the disc.
            let angle = angle.min(disc.angular_radius_rad * (1.0 - 1e-15));
            disc.radiance_per_irradiance(angle, nm) * PI * edge * edge
        });
        for order in 1..6 {
            for k in (order..6).rev() {
                values[k] = (values[k] - values[k - 1]) / (mu[k] - mu[k - order]);
            }
        }
        let mut polynomial = [0.0; 6];
        for k in (0..6).rev() {
            let mut next = [0.0; 6];
            for power in 0..6 {
                next[power] -= polynomial[power] * mu[k];
                if power > 0 {
                    next[power] += polynomial[power - 1];
                }
            }
            next[0] += values[k];
            polynomial = next;
        }
        for (power, value) in polynomial.iter().enumerate() {
            all[4 * power + lane] = *value;
        }
    }
    all
}

fn profile(limb: &[f64], mu: f64) -> Vec<f64> {
    let lane = |lane: usize| (0..6).map(|k| limb[4 * k + lane] * mu.powi(k as i32)).sum();
    (0..4).map(lane).collect()
}

/// Coefficients of limb darkening.
fn limb(r: &mut Random) -> Vec<f32> {
    let nm: Vec<f64> = wavelengths(r).iter().map(|&nm| f64::from(nm)).collect();
    coefficients(&nm).iter().map(|&x| x as f32).collect()
}

/// 1 minus a cosine on the disc of a radius or beside it, not at the very edge.
fn beside_disc(r: &mut Random, sin_radius: f32) -> f32 {
    let place = r.or(&[0.0, 0.5, 0.999, 1.001, 1.5], |r| r.between(0.0, 1.3));
    let sine = (place * sin_radius).min(1.0);
    sine * sine / (1.0 + (1.0 - sine * sine).sqrt())
}

fn sin_radius(r: &mut Random) -> f32 {
    r.or(&[4.65e-3, 0.3], |r| r.decades(1e-3, 0.5))
}

fn exact_place_on_disc(sin_radius: f64, one_minus_cos: f64) -> f64 {
    match one_minus_cos < 1.0 {
        true => (one_minus_cos * (2.0 - one_minus_cos)).sqrt() / sin_radius,
        false => 2.0 / sin_radius,
    }
}

fn coverage(place: f64, sin_radius: f64, sin_pixel: f64) -> f64 {
    ((1.0 - place) * sin_radius / sin_pixel + 0.5).clamp(0.0, 1.0)
}

/// Directions to the moon and from it to the sun, the sine of its radius, and a direction on the disc or beside it, not at the very edge.
fn beside_moon(r: &mut Random) -> Vec<f32> {
    let moon = Vec3::from(r.direction()).as_dvec3().normalize();
    let to_sun = match r.unit() < 0.2 {
        // Full.
        true => -moon,
        false => Vec3::from(r.direction()).as_dvec3(),
    };
    let radius = sin_radius(r);
    let place = r.or(&[0.0, 0.5, 0.97, 1.03, 1.5], |r| r.between(0.0, 0.98));
    let sine = f64::from(place * radius).min(1.0);
    let (sin, cos) = f64::from(r.between(0.0, 6.3)).sin_cos();
    let across = moon.any_orthonormal_vector();
    let aside = across * cos + moon.cross(across) * sin;
    let direction = moon * (1.0 - sine * sine).sqrt() + aside * sine;
    let [moon, to_sun, direction] = [moon, to_sun, direction].map(|v| v.as_vec3().to_array());
    [&moon[..], &to_sun, &[radius], &direction].concat()
}

/// The library's law, relative to what it is where sun and eye are equally high, which is one half.
fn exact_moon_reflection(x: &[f64]) -> f64 {
    /// Radius of the moon, m.
    const RADIUS_M: f64 = 1_737_400.0;
    let [direction, to_sun, along] = [0, 3, 7].map(|k| DVec3::from_slice(&x[k..k + 3]).normalize());
    let mut moon = MoonState::lit_by(direction, to_sun);
    moon.distance_m = RADIUS_M / x[6];
    let Some(normal) = (to_sun - direction).try_normalize() else {
        // New.
        return 0.0;
    };
    let aside = normal - direction * normal.dot(direction);
    let at_half =
        (direction * (1.0 - (x[6] * aside).length_squared()).sqrt() + aside * x[6]).normalize();
    0.5 * moon.relative_radiance(along) / moon.relative_radiance(at_half)
}

pub fn disc() -> Vec<Row> {
    rows!(twins::disc {
        moon_reflection: beside_moon => |x| vec![exact_moon_reflection(x)];
        limb_darkening: wavelengths => coefficients;
        limb_profile: |r| {
            let mut all = limb(r);
            all.push(r.or(&[0.0, 1.0], Random::unit));
            all
        } => |x| profile(x, x[24]);
        place_on_disc: |r| vec![sin_radius(r), r.or(&[0.0, 1e-9, 1.0, 2.0], |r| r.decades(1e-8, 2.0))]
            => |x| vec![exact_place_on_disc(x[0], x[1])];
        disc_coverage: |r| {
            let radius = sin_radius(r);
            vec![r.between(0.0, 2.0), radius, radius * r.decades(0.01, 2.0)]
        } => |x| vec![coverage(x[0], x[1], x[2])];
        sun_disc_radiance: |r| {
            let mut all = limb(r);
            all.extend((0..4).map(|_| r.unit()));
            let radius = sin_radius(r);
            all.extend([radius, radius * r.decades(0.01, 2.0), beside_disc(r, radius)]);
            all
        } => |x| {
            let place = exact_place_on_disc(x[28], x[30]);
            let mu = (1.0 - place * place).max(0.0).sqrt();
            let part = coverage(place, x[28], x[29]);
            profile(x, mu).iter().zip(&x[24..28]).map(|(p, mean)| p * mean * part).collect()
        };
    })
}

/// The bytes of a row that the library writes, but for signals at the border of two levels.
#[test]
fn dither_is_that_of_the_picture_writers() {
    use twins::{colour::srgb_encode, dither::dithered};
    let mapper = ToneMapper::as_displayed().with_dither(true);
    let mut random = Random::new(7);
    let mut borders = 0;
    for row in [0, 1, 1079] {
        let linear: Vec<f32> = (0..3 * 2000)
            .map(|_| random.or(&[0.0, 1.0], Random::unit))
            .collect();
        let mut bytes = vec![0; linear.len()];
        mapper.row_to_u8(row, &linear, &mut bytes);
        for (column, (rgb, bytes)) in linear.chunks(3).zip(bytes.chunks(3)).enumerate() {
            let signal = srgb_encode(glam::Vec3::from_slice(rgb));
            let stored = dithered(signal, 255.0, column as u32, row);
            for (stored, byte) in stored.to_array().iter().zip(bytes) {
                let level = stored * 255.0 + 0.5;
                if level as u8 != *byte {
                    assert!((level - level.round()).abs() < 1e-3, "{level} {byte}");
                    borders += 1;
                }
            }
        }
    }
    assert!(borders < 20, "{borders}");
}
