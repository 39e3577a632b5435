//! Exposure, tone curve, dither.

use airlight::spectrum::{
    RgbSpace,
    rgb::{srgb_decode, srgb_encode},
};
use airlight_image::tone::{
    AgxSettings, CameraSettings, Exposure, Metering, ToneCurve, ToneMapper, WhiteBalance,
};

/// The curves that roll off.
fn curves() -> [ToneCurve; 2] {
    [
        ToneCurve::Camera(CameraSettings::default()),
        ToneCurve::Agx(AgxSettings::default()),
    ]
}

fn mapper(curve: ToneCurve) -> ToneMapper {
    ToneMapper::new(1.0, curve).unwrap()
}

fn decoded(encoded: [f32; 3]) -> [f64; 3] {
    encoded.map(|v| srgb_decode(f64::from(v)))
}

#[test]
fn middle_grey_is_unchanged() {
    for curve in curves() {
        for (exposure, scene) in [(1.0, 0.18), (0.001, 180.0), (1e6, 0.18e-6)] {
            for v in ToneMapper::new(exposure, curve).unwrap().map([scene; 3]) {
                assert!((f64::from(v) - srgb_encode(0.18)).abs() < 1e-3, "{v}");
            }
        }
    }
}

#[test]
fn the_curves_rise_from_black_to_white() {
    for (curve, white_stops) in curves().into_iter().zip([24.0, 6.6]) {
        rises_from_black_to_white(&mapper(curve), white_stops);
    }
}

fn rises_from_black_to_white(tone: &ToneMapper, white_stops: f32) {
    assert_eq!(tone.map([0.0; 3]), [0.0; 3]);
    assert_eq!(tone.map([0.18 * white_stops.exp2(); 3]), [1.0; 3]);
    let mut last = 0.0;
    for i in 0..200_000 {
        let v = 1e-5 * (1.0 + 1e-4f32).powi(i);
        let shown = tone.map([v; 3]);
        assert!(shown[1] >= last, "falls at {v}");
        assert!(shown[1] - last < 1e-3, "jumps at {v}");
        assert!((shown[0] - shown[1]).abs() < 1e-6 && (shown[2] - shown[1]).abs() < 1e-6);
        last = shown[1];
    }
    // Raising one component never lowers the luminance.
    let brightness = |rgb: [f32; 3]| RgbSpace::Srgb.luminance(decoded(tone.map(rgb)));
    for c in 0..3 {
        let mut last = 0.0;
        for i in 0..2000 {
            let mut rgb = [0.05, 0.1, 0.2];
            rgb[c] += 1e-3 * 1.01f32.powi(i);
            let now = brightness(rgb);
            assert!(
                now >= last - 1e-5,
                "component {c} step {i}: {now} below {last}"
            );
            last = now;
        }
    }
}

#[test]
fn any_input_gives_valid_colours() {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -1.0,
        -1e30,
        1e38,
        -0.0,
        0.0,
        1e-40,
        0.18,
        5.0,
    ];
    for curve in curves().into_iter().chain([ToneCurve::Clip]) {
        for exposure in [0.0, 1e-30, 1.0, 1e30] {
            let tone = ToneMapper::new(exposure, curve).unwrap();
            for r in odd {
                for g in odd {
                    for b in odd {
                        for v in tone.map([r, g, b]) {
                            assert!((0.0..=1.0).contains(&v), "{v} from {r} {g} {b}");
                        }
                    }
                }
            }
        }
    }
    assert!(ToneMapper::new(f32::NAN, ToneCurve::Clip).is_err());
    assert!(ToneMapper::new(-1.0, ToneCurve::Clip).is_err());
    let flat = AgxSettings {
        slope: 0.5,
        ..AgxSettings::default()
    };
    assert!(ToneMapper::new(1.0, ToneCurve::Agx(flat)).is_err());
    for (contrast, saturation) in [(0.0, 1.0), (f64::NAN, 1.0), (1.2, -1.0), (1.2, f64::NAN)] {
        let settings = CameraSettings {
            contrast,
            saturation,
        };
        assert!(ToneMapper::new(1.0, ToneCurve::Camera(settings)).is_err());
    }
}

#[test]
fn agx_keeps_the_saturation_near_middle_grey() {
    let rgb = [0.12f32, 0.18, 0.30];
    let shown = decoded(mapper(ToneCurve::Agx(AgxSettings::default())).map(rgb));
    for (got, want) in shown.iter().zip(rgb) {
        assert!((got / f64::from(want) - 1.0).abs() < 0.1, "{shown:?}");
    }
}

#[test]
fn colours_outside_the_gamut_keep_their_luminance() {
    let tone = ToneMapper::new(1.0, ToneCurve::default()).unwrap();
    // Slightly negative blue: close to the same colour without blue.
    let a = tone.map([0.5, 0.2, -0.001]);
    let b = tone.map([0.5, 0.2, 0.0]);
    for c in 0..3 {
        assert!((a[c] - b[c]).abs() < 0.02, "{a:?} against {b:?}");
    }
    assert_eq!(tone.map([-1.0, -1.0, -1.0]), [0.0; 3]);
}

#[test]
fn the_table_agrees_with_the_formula() {
    let clip = ToneMapper::new(1.0, ToneCurve::Clip).unwrap();
    let mut worst: f64 = 0.0;
    for i in 0..=100_000 {
        let v = i as f32 / 100_000.0;
        let got = f64::from(clip.map([v; 3])[0]);
        worst = worst.max((got - srgb_encode(f64::from(v))).abs());
    }
    assert!(worst < 2e-6, "{worst}");
}

#[test]
fn dither_keeps_the_mean_between_two_steps() {
    let tone = ToneMapper::new(1.0, ToneCurve::Clip).unwrap();
    let level = 100.3;
    let linear = srgb_decode(level / 255.0) as f32;
    let row = vec![linear; 3 * 100_000];
    let mut out = vec![0u8; row.len()];
    tone.row_to_u8(5, &row, &mut out);
    let mean = out.iter().map(|&v| f64::from(v)).sum::<f64>() / out.len() as f64;
    assert!((mean - level).abs() < 0.01, "{mean}");
    tone.with_dither(false).row_to_u8(5, &row, &mut out);
    assert!(out.iter().all(|&v| v == 100));
    // Black and white are not dithered.
    let tone = ToneMapper::new(1.0, ToneCurve::Clip).unwrap();
    for (linear, want) in [(0.0, 0), (1.0, 255), (7.0, 255)] {
        tone.row_to_u8(5, &vec![linear; 3000], &mut out[..3000]);
        assert!(out[..3000].iter().all(|&v| v == want));
    }
}

#[test]
fn exposure_values_follow_the_standard() {
    let exposure = Exposure::from_ev100(15.0).unwrap();
    assert!((exposure.factor() * 1.2 * 32768.0 - 1.0).abs() < 1e-12);
    assert!((exposure.ev100() - 15.0).abs() < 1e-12);
    assert!((exposure.brighter_by(2.0).unwrap().ev100() - 13.0).abs() < 1e-12);
    assert!(Exposure::from_ev100(f64::NAN).is_err());
    assert!(Exposure::from_ev100(1e9).is_err());
    assert!(Exposure::from_factor(f64::INFINITY).is_err());
}

#[test]
fn metering_ignores_the_sun() {
    let sky: Vec<(f32, f32)> = (0..1000).map(|i| (2000.0 + i as f32 * 4.0, 1.0)).collect();
    let metering = Metering::default();
    let plain = Exposure::metered(&sky, metering).unwrap();
    let typical = metering.typical_luminance(&sky).unwrap();
    assert!((3000.0..5000.0).contains(&typical), "{typical}");
    assert!((plain.factor() * typical - 0.18).abs() < 1e-9);
    let mut with_sun = sky.clone();
    with_sun.extend([(1.6e9, 1.0); 10]);
    with_sun.extend([
        (f32::NAN, 1.0),
        (f32::INFINITY, 1.0),
        (-3.0, 1.0),
        (0.0, 1.0),
        (1.0, 0.0),
        (1.0, f32::NAN),
    ]);
    with_sun.reverse();
    let sunny = Exposure::metered(&with_sun, metering).unwrap();
    assert!((sunny.factor() / plain.factor()).log2().abs() < 0.02);
    let up = Metering {
        compensation_stops: 1.0,
        ..metering
    };
    let brighter = Exposure::metered(&sky, up).unwrap();
    assert!((brighter.factor() / plain.factor() - 2.0).abs() < 1e-9);
    assert!(Exposure::metered(&[], metering).is_none());
    assert!(Exposure::metered(&[(0.0, 1.0), (f32::NAN, 1.0)], metering).is_none());
    assert!(Exposure::metered(&[(5.0, 1.0)], metering).is_some());
    let empty_range = Metering {
        low_percentile: 0.9,
        high_percentile: 0.1,
        ..metering
    };
    assert!(empty_range.typical_luminance(&sky).is_some());
}

#[test]
fn bright_primaries_end_in_white() {
    for curve in curves() {
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let shown = mapper(curve).map(rgb.map(|v: f32| v * 1e4));
            assert!(shown.iter().all(|&v| v > 0.99), "{shown:?}");
        }
    }
}

#[test]
fn saturation_changes_no_luminance() {
    let with = |saturation| {
        let settings = CameraSettings {
            saturation,
            ..CameraSettings::default()
        };
        decoded(mapper(ToneCurve::Camera(settings)).map([0.1, 0.15, 0.3]))
    };
    let luminance = |rgb: [f64; 3]| RgbSpace::Srgb.luminance(rgb);
    let [grey, plain, more] = [0.0, 1.0, 1.5].map(with);
    assert!((grey[0] - grey[2]).abs() < 1e-6 && more[2] > plain[2] && more[0] < plain[0]);
    for other in [grey, more] {
        assert!((luminance(other) / luminance(plain) - 1.0).abs() < 1e-4);
    }
}

mod guards {
    use super::*;

    /// Hue angle in degrees and chroma of a linear sRGB colour in Oklab (Ottosson 2020).
    fn hue_and_chroma([r, g, b]: [f64; 3]) -> (f64, f64) {
        let l = (0.412_22 * r + 0.536_33 * g + 0.051_45 * b).cbrt();
        let m = (0.211_90 * r + 0.680_70 * g + 0.107_40 * b).cbrt();
        let s = (0.088_30 * r + 0.281_72 * g + 0.629_98 * b).cbrt();
        let (x, y) = (
            1.977_998 * l - 2.428_592 * m + 0.450_594 * s,
            0.025_904 * l + 0.782_772 * m - 0.808_676 * s,
        );
        (y.atan2(x).to_degrees(), x.hypot(y))
    }

    /// Largest difference of hue from that of the scene, from 4 stops below to 5 stops above middle grey, where colour remains.
    fn hue_drift(tone: &ToneMapper, rgb: [f32; 3]) -> f64 {
        let (scene, _) = hue_and_chroma(rgb.map(f64::from));
        (-40..=50)
            .map(|i| tone.map(rgb.map(|v| v * 0.18 * 2f32.powf(i as f32 * 0.1))))
            .map(|shown| hue_and_chroma(decoded(shown)))
            .filter(|(_, chroma)| *chroma > 0.02)
            .map(|(hue, _)| ((hue - scene + 540.0).rem_euclid(360.0) - 180.0).abs())
            .fold(0.0, f64::max)
    }

    /// The table of the book's chapter on pictures.
    #[test]
    fn bright_colours_keep_their_hue() {
        let clip = mapper(ToneCurve::Clip);
        let [camera, agx] = curves().map(mapper);
        for (name, rgb, most) in [
            ("zenith at noon", [0.39, 0.56, 1.0], 1.5),
            ("deep sky blue", [0.2, 0.4, 1.0], 2.0),
            ("horizon before sunset", [1.0, 0.63, 0.28], 2.0),
            ("sunset orange", [1.0, 0.45, 0.15], 3.5),
            ("setting sun", [1.0, 0.25, 0.02], 11.0),
        ] {
            let [ours, film, cut] = [&camera, &agx, &clip].map(|tone| hue_drift(tone, rgb));
            println!("| {name} {rgb:?} | {ours:.1} | {film:.1} | {cut:.1} |");
            assert!(ours < most, "{name}: hue drifts by {ours} degrees");
            assert!(ours < film.min(cut), "{name}: {ours} {film} {cut}");
        }
    }

    /// Below middle grey the camera curve keeps the hue, and nearly the chroma.
    #[test]
    fn dim_colours_keep_their_colour() {
        let [camera, _] = curves().map(mapper);
        for rgb in [[0.39, 0.56, 1.0], [0.63, 0.72, 1.0], [1.0, 0.63, 0.28]] {
            for stops in [-3.0f32, -2.0, -1.0, 0.0] {
                let scene = rgb.map(|v: f32| v * 0.18 * stops.exp2());
                let shown = decoded(camera.map(scene));
                let scene = scene.map(f64::from);
                let scale = RgbSpace::Srgb.luminance(scene) / RgbSpace::Srgb.luminance(shown);
                // At the luminance of the scene.
                let (hue, chroma) = hue_and_chroma(shown.map(|v| v * scale));
                let (scene_hue, scene_chroma) = hue_and_chroma(scene);
                let drift = (hue - scene_hue).abs();
                let ratio = chroma / scene_chroma;
                println!("{rgb:?} at {stops} stops: hue {drift:.1} deg, chroma {ratio:.2}");
                assert!(
                    drift < 1.0 && (0.95..1.2).contains(&ratio),
                    "{drift} {ratio}"
                );
            }
        }
    }
}

/// Without dither the nearest level is written, on both sides of every border between two levels.
#[test]
fn display_light_is_rounded_to_the_nearest_level() {
    let tone = ToneMapper::as_displayed();
    let mut values = vec![
        f32::NAN,
        f32::NEG_INFINITY,
        -0.1,
        0.0,
        1e-30,
        1.0,
        1.1,
        f32::INFINITY,
    ];
    for level in 0..255 {
        let border = srgb_decode((f64::from(level) + 0.5) / 255.0) as f32;
        values.extend([border.next_down(), border, border.next_up()]);
        values.push(srgb_decode(f64::from(level) / 255.0) as f32);
    }
    values.extend((0..60_000).map(|i| i as f32 / 60_000.0));
    let mut out = vec![0; values.len()];
    tone.row_to_u8(0, &values, &mut out);
    for (value, got) in values.iter().zip(out) {
        let level = 255.0 * srgb_encode(f64::from(value.clamp(0.0, 1.0)));
        let expected = (level + 0.5) as u8;
        assert_eq!(got, expected, "{value}");
    }
}

/// Triangular noise of one step makes the mean of the written values that of the picture, and the variance of their error a
/// quarter of a step squared, whatever the value. Neighbours in a row share one of their two numbers with opposite signs:
/// their errors have the covariance -1/12, so that the noise is of high frequencies.
#[test]
fn dither_is_balanced_and_the_same_every_time() {
    let tone = ToneMapper::as_displayed().with_dither(true);
    let (rows, columns) = (200, 1000);
    for steps in [100.0, 100.3, 200.5] {
        // The value as the tone mapper reads it.
        let value = srgb_decode(steps / 255.0) as f32;
        let row = vec![value; columns * 3];
        let (mut sum, mut squares, mut beside) = ([0.0; 3], [0.0; 3], 0.0);
        let (mut out, mut again) = (vec![0; columns * 3], vec![0; columns * 3]);
        for y in 0..rows {
            tone.row_to_u8(y, &row, &mut out);
            tone.row_to_u8(y, &row, &mut again);
            assert_eq!(out, again);
            let mut last = 0.0;
            for pixel in out.as_chunks::<3>().0 {
                let error = pixel.map(|v| f64::from(v) - steps);
                for c in 0..3 {
                    sum[c] += error[c];
                    squares[c] += error[c].powi(2);
                }
                beside += last * error[0];
                last = error[0];
            }
        }
        let count = f64::from(rows) * columns as f64;
        for c in 0..3 {
            assert!(
                (sum[c] / count).abs() < 3e-3,
                "{steps} {c}: {}",
                sum[c] / count
            );
            assert!(
                (squares[c] / count - 0.25).abs() < 3e-3,
                "{steps} {c}: {}",
                squares[c] / count
            );
        }
        assert!(
            (beside / count + 1.0 / 12.0).abs() < 3e-3,
            "{steps}: {}",
            beside / count
        );
    }
}

#[test]
fn white_balance_makes_its_light_neutral_and_keeps_its_luminance() {
    // Linear sRGB of black bodies of luminance 1 (colour-science 0.4.7).
    for (kelvin, rgb) in [
        (3000.0, [1.7706, 0.8443, 0.2721]),
        (5000.0, [1.2133, 0.9605, 0.7625]),
        (10_000.0, [0.8718, 0.9946, 1.4310]),
    ] {
        let balance = WhiteBalance::new(kelvin).unwrap();
        let tone = ToneMapper::new(0.2, ToneCurve::Clip)
            .unwrap()
            .with_white_balance(Some(balance));
        let got = tone.map(rgb);
        let grey = srgb_encode(0.2) as f32;
        for v in got {
            assert!((v - grey).abs() < 0.01, "{kelvin}: {got:?} against {grey}");
        }
    }
    for kelvin in [1000.0, 30_000.0, f64::NAN] {
        assert!(WhiteBalance::new(kelvin).is_err());
    }
}

#[test]
fn night_vision_greys_dark_colours_only_and_darkens_red() {
    let tone = |scotopic| {
        ToneMapper::new(1.0, ToneCurve::Clip)
            .unwrap()
            .with_scotopic(scotopic)
    };
    let bright = [5.0, 4.0, 3.0].map(|v| v / 5.0);
    let mapper = |scotopic: bool, scale: f32| {
        let exposed = ToneMapper::new(1.0 / scale, ToneCurve::Clip)
            .unwrap()
            .with_scotopic(scotopic);
        move |rgb: [f32; 3]| exposed.map(rgb.map(|v| v * scale))
    };
    // Photopic above 4 cd/m^2.
    assert_eq!(mapper(true, 20.0)(bright), mapper(false, 20.0)(bright));
    // Wholly scotopic at 1e-3 cd/m^2: one bluish hue, and red darker than blue of the same luminance.
    let dark = mapper(true, 1e-3);
    let (red, blue) = (
        dark([0.3 / 0.2126, 0.0, 0.0]),
        dark([0.0, 0.0, 0.3 / 0.0722]),
    );
    assert!(red[2] > red[0] && red[2] < blue[2], "{red:?} {blue:?}");
    assert!(tone(true).map([0.0; 3]) == [0.0; 3]);
    assert!(tone(true).map([f32::NAN; 3]) == [0.0; 3]);
}
