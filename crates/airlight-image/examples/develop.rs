//! Tone maps an EXR file in cd/m^2: `cargo run --release -p airlight-image --example develop -- IN.exr OUT.png [EV100]`.
//! Without an exposure value the exposure is metered.

use airlight::spectrum::RgbSpace;
use airlight_image::{
    Control, PictureOptions,
    input::read_picture,
    rows::StoredRows,
    tone::{Exposure, Metering, ToneCurve, ToneMapper},
    write_picture,
};
use std::{error::Error, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, ev100 @ ..] = arguments.as_slice() else {
        return Err("expected the arguments IN.exr OUT.png [EV100]".into());
    };
    let picture = read_picture(Path::new(input), None)?;
    let luminances: Vec<(f32, f32)> = picture
        .rgb
        .as_chunks::<3>()
        .0
        .iter()
        .map(|rgb| (RgbSpace::Srgb.luminance(rgb.map(f64::from)) as f32, 1.0))
        .collect();
    let exposure = match ev100 {
        [ev100, ..] => Exposure::from_ev100(ev100.parse()?)?,
        [] => Exposure::metered(&luminances, Metering::default())
            .ok_or("expected a picture with light, got a black one")?,
    };
    println!("{output}: EV {:.2}", exposure.ev100());
    let tone = ToneMapper::new(exposure.factor() as f32, ToneCurve::default())?;
    let rows = StoredRows::new(picture.size.width(), 3, picture.rgb)?;
    let options = PictureOptions::default();
    write_picture(
        Path::new(output),
        picture.size,
        &rows,
        &tone,
        &options,
        Control::default(),
    )?;
    Ok(())
}
