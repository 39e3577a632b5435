//! temporary
use airlight_render::tone::{ToneCurve, ToneMapper};
use std::time::Instant;
fn main() {
    let w = 8192usize;
    let mut row: Vec<f32> = (0..w * 3)
        .map(|i| 0.05 + 0.4 * (i as f32 / (w * 3) as f32))
        .collect();
    let mut out = vec![0u8; w * 3];
    let mut out16 = vec![0u16; w * 3];
    for (name, curve, dither) in [
        ("filmic+dither", ToneCurve::default(), true),
        ("filmic", ToneCurve::default(), false),
        ("clip", ToneCurve::Clip, false),
    ] {
        let t = ToneMapper::new(1.0, curve).unwrap().with_dither(dither);
        let s = Instant::now();
        for y in 0..500 {
            t.row_to_u8(y, &row, &mut out);
            row[5] = out[7] as f32 * 0.001;
        }
        println!(
            "{name} {:.2} ns/px",
            s.elapsed().as_secs_f64() * 1e9 / (500.0 * w as f64)
        );
        let s = Instant::now();
        for _ in 0..500 {
            t.row_to_u16(&row, &mut out16);
            row[5] = out16[7] as f32 * 0.00001;
        }
        println!(
            "  16: {:.2} ns/px",
            s.elapsed().as_secs_f64() * 1e9 / (500.0 * w as f64)
        );
    }
}
