//! Colour differences: CIELAB and CIEDE2000.

/// XYZ of the CIE standard illuminant D65, 2-degree observer, scaled to Y = 100.
pub const D65_WHITE: [f64; 3] = [95.047, 100.0, 108.883];

/// CIELAB (L*, a*, b*) of `xyz` relative to `white`, both on the same scale.
///
/// CIE 015:2018, CIE 1976 L*a*b* colour space. Negative components, which coarse wavelength grids can produce, follow the
/// linear part of the curve.
pub fn xyz_to_lab(xyz: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let f: [f64; 3] = std::array::from_fn(|i| {
        let t = xyz[i] / white[i];
        if t > DELTA * DELTA * DELTA {
            t.cbrt()
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    });
    [
        116.0 * f[1] - 16.0,
        500.0 * (f[0] - f[1]),
        200.0 * (f[1] - f[2]),
    ]
}

/// CIEDE2000 difference of two CIELAB colours, with all parametric factors 1. One unit is about the smallest difference
/// visible side by side.
///
/// Sharma, Wu, Dalal, The CIEDE2000 color-difference formula: implementation notes, supplementary test data, and
/// mathematical observations, Color Research & Application 30(1), 21-30, 2005, equations 2 to 22.
pub fn ciede2000(lab1: [f64; 3], lab2: [f64; 3]) -> f64 {
    let pow7 = |c: f64| c.powi(7) / (c.powi(7) + 25f64.powi(7));

    // Chroma and hue with a* rescaled near the neutral axis.
    let mean_chroma = (lab1[1].hypot(lab1[2]) + lab2[1].hypot(lab2[2])) / 2.0;
    let a_scale = 1.5 - 0.5 * pow7(mean_chroma).sqrt();
    let polar = |lab: [f64; 3]| {
        let a = lab[1] * a_scale;
        let hue = if a == 0.0 && lab[2] == 0.0 {
            0.0
        } else {
            lab[2].atan2(a).to_degrees().rem_euclid(360.0)
        };
        (a.hypot(lab[2]), hue)
    };
    let ((c1, h1), (c2, h2)) = (polar(lab1), polar(lab2));
    let grey = c1 * c2 == 0.0;

    // The formula jumps where hues are exactly opposite; the margin keeps rounding from choosing the branch.
    const HALF_TURN: f64 = 180.0 + 1e-9;
    let hue_step = match h2 - h1 {
        _ if grey => 0.0,
        d if d.abs() <= HALF_TURN => d,
        d if d > 0.0 => d - 360.0,
        d => d + 360.0,
    };
    let mean_hue = match h1 + h2 {
        sum if grey => sum,
        sum if (h1 - h2).abs() <= HALF_TURN => sum / 2.0,
        sum if sum < 360.0 => (sum + 360.0) / 2.0,
        sum => (sum - 360.0) / 2.0,
    };

    let delta_l = lab2[0] - lab1[0];
    let delta_c = c2 - c1;
    let delta_h = 2.0 * (c1 * c2).sqrt() * (hue_step / 2.0).to_radians().sin();

    let mean_c = (c1 + c2) / 2.0;
    let from_mid = ((lab1[0] + lab2[0]) / 2.0 - 50.0).powi(2);
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let t = 1.0 - 0.17 * cosine(mean_hue - 30.0)
        + 0.24 * cosine(2.0 * mean_hue)
        + 0.32 * cosine(3.0 * mean_hue + 6.0)
        - 0.20 * cosine(4.0 * mean_hue - 63.0);
    let s_l = 1.0 + 0.015 * from_mid / (20.0 + from_mid).sqrt();
    let s_c = 1.0 + 0.045 * mean_c;
    let s_h = 1.0 + 0.015 * mean_c * t;
    let turn = 30.0 * (-((mean_hue - 275.0) / 25.0).powi(2)).exp();
    let r_t = -2.0 * pow7(mean_c).sqrt() * (2.0 * turn).to_radians().sin();

    let (l, c, h) = (delta_l / s_l, delta_c / s_c, delta_h / s_h);
    // Rounding can make the sum negative only for nearly equal colours.
    (l * l + c * c + h * h + r_t * c * h).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table 1 of Sharma et al. 2005: two colours and their difference.
    const PAIRS: [([f64; 3], [f64; 3], f64); 34] = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
        ([50.0, 2.8361, -74.02], [50.0, 0.0, -82.7485], 3.4412),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0),
        ([50.0, -1.1848, -84.8006], [50.0, 0.0, -82.7485], 1.0),
        ([50.0, -0.9009, -85.5211], [50.0, 0.0, -82.7485], 1.0),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, -1.0, 2.0], [50.0, 0.0, 0.0], 2.3669),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.001], 7.1792),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0012], 7.2195),
        ([50.0, -0.001, 2.49], [50.0, 0.0009, -2.49], 4.8045),
        ([50.0, -0.001, 2.49], [50.0, 0.001, -2.49], 4.8045),
        ([50.0, -0.001, 2.49], [50.0, 0.0011, -2.49], 4.7461),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
        ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.903),
        ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
        ([50.0, 2.5, 0.0], [50.0, 3.1736, 0.5854], 1.0),
        ([50.0, 2.5, 0.0], [50.0, 3.2972, 0.0], 1.0),
        ([50.0, 2.5, 0.0], [50.0, 1.8634, 0.5757], 1.0),
        ([50.0, 2.5, 0.0], [50.0, 3.2592, 0.335], 1.0),
        (
            [60.2574, -34.0099, 36.2677],
            [60.4626, -34.1751, 39.4387],
            1.2644,
        ),
        (
            [63.0109, -31.0961, -5.8663],
            [62.8187, -29.7946, -4.0864],
            1.263,
        ),
        ([61.2901, 3.7196, -5.3901], [61.4292, 2.248, -4.962], 1.8731),
        (
            [35.0831, -44.1164, 3.7933],
            [35.0232, -40.0716, 1.5901],
            1.8645,
        ),
        (
            [22.7233, 20.0904, -46.694],
            [23.0331, 14.973, -42.5619],
            2.0373,
        ),
        (
            [36.4612, 47.858, 18.3852],
            [36.2715, 50.5065, 21.2231],
            1.4146,
        ),
        (
            [90.8027, -2.0831, 1.441],
            [91.1528, -1.6435, 0.0447],
            1.4441,
        ),
        (
            [90.9257, -0.5406, -0.9208],
            [88.6381, -0.8985, -0.7239],
            1.5381,
        ),
        (
            [6.7747, -0.2908, -2.4247],
            [5.8714, -0.0985, -2.2286],
            0.6377,
        ),
        ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
    ];

    #[test]
    fn differences_match_sharma_2005() {
        for (one, two, want) in PAIRS {
            for got in [ciede2000(one, two), ciede2000(two, one)] {
                assert!(
                    (got - want).abs() < 1e-4,
                    "{one:?} {two:?}: {got} against {want}"
                );
            }
        }
    }

    #[test]
    fn equal_colours_have_zero_difference() {
        for (one, two, _) in PAIRS {
            assert_eq!(ciede2000(one, one), 0.0);
            assert_eq!(ciede2000(two, two), 0.0);
        }
    }

    #[test]
    fn lab_of_white_black_and_a_dark_red() {
        assert_eq!(xyz_to_lab(D65_WHITE, D65_WHITE), [100.0, 0.0, 0.0]);
        assert!(
            xyz_to_lab([0.0; 3], D65_WHITE)
                .iter()
                .all(|v| v.abs() < 1e-12)
        );
        // The cubic and the linear branch meet.
        let at = |t: f64| xyz_to_lab([1.0, t, 1.0], [1.0; 3])[0];
        let junction = (6.0f64 / 29.0).powi(3);
        assert!((at(junction * 1.000_001) - at(junction * 0.999_999)).abs() < 1e-4);
        // A mid grey with Y = 18.4187 % has L* = 50.
        assert!((at(0.184_186_518_5) - 50.0).abs() < 1e-6);
    }
}
