//! Upsampling by splines, against functions that it reproduces.

use airlight_image::{RowSource, Size, enlarge::Enlarged, rows::StoredRows};

fn picture(width: u32, height: u32, of: impl Fn(f64, f64, usize) -> f64) -> StoredRows {
    let mut samples = Vec::new();
    for j in 0..height {
        for i in 0..width {
            let (x, y) = (
                (f64::from(i) + 0.5) / f64::from(width),
                (f64::from(j) + 0.5) / f64::from(height),
            );
            samples.extend((0..3).map(|channel| of(x, y, channel) as f32));
        }
    }
    StoredRows::new(width, 3, samples).unwrap()
}

fn enlarged(picture: &StoredRows, width: u32, height: u32) -> Vec<f32> {
    let all = Enlarged::new(picture, Size::new(width, height).unwrap()).unwrap();
    let mut out = vec![f32::NAN; (width * height * 3) as usize];
    for (y, row) in out.chunks_exact_mut(width as usize * 3).enumerate() {
        all.fill_row(y as u32, row);
    }
    out
}

/// Also at the edges.
#[test]
fn parabolas_are_exact_at_any_size() {
    let of = |x: f64, y: f64, channel: usize| match channel {
        0 => 1.0 + x - 2.0 * x * x,
        1 => 3.0 + y * y * 4.0,
        _ => 5.0 - x * y + x * x * y * y,
    };
    for (from, to) in [
        ((8, 5), (64, 35)),
        ((3, 3), (100, 7)),
        ((9, 4), (9, 4)),
        ((16, 16), (5, 3)),
    ] {
        let got = enlarged(&picture(from.0, from.1, of), to.0, to.1);
        let want = picture(to.0, to.1, of);
        for (a, b) in got.iter().zip(want.samples()) {
            assert!((a - b).abs() < 3e-5, "{from:?} {to:?}: {a} {b}");
        }
    }
}

#[test]
fn the_spline_passes_through_every_pixel() {
    let rough =
        |x: f64, y: f64, channel: usize| (40.0 * x + channel as f64).sin() + (31.0 * y * y).cos();
    let small = picture(11, 7, rough);
    // Enlarged three times, every third pixel from the second has the centre of an original one.
    let large = enlarged(&small, 33, 21);
    for j in 0..7 {
        for i in 0..11 {
            for channel in 0..3 {
                let a = small.samples()[(j * 11 + i) * 3 + channel];
                let b = large[((3 * j + 1) * 33 + 3 * i + 1) * 3 + channel];
                assert!((a - b).abs() < 1e-6, "{i} {j}: {a} {b}");
            }
        }
    }
}

/// The error of cubic splines falls with the fourth power of the pixel size.
#[test]
fn the_error_falls_with_the_fourth_power() {
    let smooth = |x: f64, y: f64, _: usize| (9.0 * x + 1.0).sin() + (8.0 * y).cos();
    let want = picture(240, 240, smooth);
    let worst = |size: u32| {
        let got = enlarged(&picture(size, size, smooth), 240, 240);
        // Away from the edges, where the parabola has an order less.
        let inside = (60..180).flat_map(|j| (60..180).map(move |i| (j * 240 + i) * 3));
        inside
            .map(|at| (got[at] - want.samples()[at]).abs())
            .fold(0.0, f32::max)
    };
    let ratio = worst(20) / worst(40);
    assert!((12.0..20.0).contains(&ratio), "{ratio}");
}

#[test]
fn short_lines_stay_straight() {
    let one = enlarged(&picture(1, 1, |_, _, channel| channel as f64), 4, 3);
    assert!(one.chunks(3).all(|rgb| rgb == [0.0, 1.0, 2.0]));
    let two = enlarged(&picture(2, 1, |x, _, _| x), 8, 1);
    for (i, rgb) in two.chunks(3).enumerate() {
        assert!((rgb[0] - (i as f32 + 0.5) / 8.0).abs() < 1e-6);
    }
    let none = StoredRows::new(2, 1, vec![1.0, f32::NAN]).unwrap();
    assert!(Enlarged::new(&none, Size::new(4, 4).unwrap()).is_err());
}
