//! Options for the projection, display and encoding of a picture.

use crate::parse::{self, PixelSize, put};
use airlight::scene::{
    CameraSpec, Exposure, ExrCompression, Gamut, Orientation, OutputSpec, Projection,
    SamplePrecision, SunDiscPlacement, ToneKind,
};
use airlight::spectrum::RgbSpace;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// Projection and direction of a picture.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Picture")]
pub struct CameraArgs {
    /// Projection: the whole sphere with north in the centre (equirectangular), six square files of a cube map (sky.px.exr, .nx,
    /// .py, .ny, .pz, .nz; x east, y up, z south), an equidistant fisheye (fisheye), or a rectilinear camera (perspective)
    /// [default: equirectangular]
    #[arg(long, value_name = "KIND")]
    #[arg(value_parser = parse::named::<Projection>())]
    pub projection: Option<Projection>,
    /// Size in pixels [default: 2048x1024; cube and fisheye 1024x1024; perspective 1920x1080]
    #[arg(long, value_name = "WxH", value_parser = parse::pixel_size)]
    pub size: Option<PixelSize>,
    /// Azimuth of the centre of the picture, degrees clockwise from north [default: 0; perspective: that of the sun at the
    /// start; fisheye: 180, which puts north at the top of a picture of the zenith]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub camera_azimuth: Option<f64>,
    /// Program for whose axes a panorama is oriented, instead of --camera-azimuth; with three also a cube map [default: airlight,
    /// north in the centre]
    #[arg(long, value_name = "PROGRAM", value_parser = parse::named::<Orientation>())]
    #[arg(conflicts_with = "camera_azimuth")]
    pub orientation: Option<Orientation>,
    /// Elevation of the centre of a perspective or fisheye picture, degrees [default: perspective 10, fisheye 90]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg)]
    pub camera_elevation: Option<f64>,
    /// Rotation of the perspective camera about its axis, degrees clockwise [default: 0]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub camera_roll: Option<f64>,
    /// Field of view, degrees: left to right edge of a perspective picture [default: 75], across the disc of a
    /// fisheye [default: 180]
    #[arg(long, value_name = "DEG", value_parser = parse::positive)]
    pub fov: Option<f64>,
}

/// Display of a picture.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Picture")]
pub struct DisplayArgs {
    /// Colour space of .exr and .hdr; .png and .jpg are always sRGB [default: srgb]
    #[arg(long, value_name = "SPACE", value_parser = parse::named::<RgbSpace>())]
    pub color_space: Option<RgbSpace>,
    #[command(flatten)]
    pub tone: ToneArgs,
}

/// Tone mapping of linear light.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Picture")]
pub struct ToneArgs {
    /// Exposure of .png, .jpg and preview: the exposure value of a camera at ISO 100 (sunny day 15, dusk 8), its settings ('f/8
    /// 1/125 s ISO 100'), or metered: auto, centre-weighted, spot, average, highlight-weighted, incident [default: auto]
    #[arg(long, value_name = "MODE|EV100|CAMERA", value_parser = parse::exposure)]
    pub exposure: Option<Exposure>,
    /// Stops by which .png, .jpg and preview are brightened (negative: darkened) [default: 0]
    #[arg(long, value_name = "STOPS", value_parser = parse::number)]
    pub brighten: Option<f64>,
    /// Tone curve of .png, .jpg and preview [default: camera]
    #[arg(long, value_name = "CURVE", value_parser = parse::named::<ToneKind>())]
    pub tone: Option<ToneKind>,
    /// Contrast of the camera curve: its slope at middle grey on logarithmic axes, 0.5 to 3 [default: 1.2]
    #[arg(long, value_name = "SLOPE", value_parser = parse::positive)]
    pub tone_contrast: Option<f64>,
    /// Saturation of the camera curve: factor on the distance from grey, 0 to 3 [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = parse::not_negative)]
    pub saturation: Option<f64>,
    /// Colour temperature of the light that .png, .jpg and preview show as neutral, K: 4000 for a night sky [default: daylight,
    /// D65]
    #[arg(long, value_name = "K", value_parser = parse::positive)]
    pub white_balance: Option<f64>,
    /// Show dark scenes in .png, .jpg and preview as the dark-adapted eye sees them: bluish grey
    #[arg(long)]
    pub scotopic: bool,
}

/// Encoding of a picture.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Picture")]
pub struct EncodingArgs {
    /// Sun's disc in the picture, omitted, or in a second file (sky.sun.exr beside sky.exr) [default: in]
    #[arg(long, value_name = "WHERE", value_parser = parse::named::<SunDiscPlacement>())]
    pub sun_disc: Option<SunDiscPlacement>,
    /// Factor on the values of .exr and .hdr, which are in cd/m^2 (spectral: W m^-2 sr^-1 nm^-1) [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive)]
    pub scale: Option<f64>,
    /// Colours outside the RGB space of .exr and .hdr, such as those of a low sun, whose disc has negative components [default: keep]
    #[arg(long, value_name = "HOW", value_parser = parse::named::<Gamut>())]
    pub gamut: Option<Gamut>,
    /// Write one EXR channel for each wavelength besides RGB; implied by a name that ends in .spectral.exr
    #[arg(long)]
    pub spectral: bool,
    /// Precision of .exr samples: 32 bits, or 16 bits up to 65504, to which the sun's disc of about 1e9 cd/m^2 is clipped unless
    /// --scale reduces it [default: float]
    #[arg(long, value_name = "BITS", value_parser = parse::named::<SamplePrecision>())]
    pub precision: Option<SamplePrecision>,
    /// Lossless compression of .exr samples [default: zip]
    #[arg(long, value_name = "METHOD")]
    #[arg(value_parser = parse::named::<ExrCompression>())]
    pub compression: Option<ExrCompression>,
    /// Bits per component of .png [default: 8]
    #[arg(long, value_name = "BITS", value_parser = PossibleValuesParser::new(["8", "16"]).map(|bits| bits.parse::<u8>().unwrap_or(8)))]
    pub bits: Option<u8>,
    /// Quality of .jpg, 1 to 100 [default: 92]
    #[arg(long, value_name = "Q", value_parser = parse::quality)]
    pub quality: Option<u8>,
}

impl CameraArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, camera: &mut CameraSpec) {
        put(&mut camera.projection, &self.projection);
        let size = self.size.map(|size| [size.width, size.height]);
        put(&mut camera.size, &size);
        if self.camera_azimuth.is_some() || self.orientation.is_some() {
            (camera.azimuth_deg, camera.orientation) = (self.camera_azimuth, self.orientation);
        }
        put(&mut camera.elevation_deg, &self.camera_elevation);
        put(&mut camera.roll_deg, &self.camera_roll);
        put(&mut camera.fov_deg, &self.fov);
    }
}

impl DisplayArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, output: &mut OutputSpec) {
        put(&mut output.color_space, &self.color_space);
        self.tone.fill(output);
    }
}

impl ToneArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, output: &mut OutputSpec) {
        put(&mut output.exposure, &self.exposure);
        put(&mut output.brighten, &self.brighten);
        put(&mut output.tone, &self.tone);
        put(&mut output.tone_contrast, &self.tone_contrast);
        put(&mut output.saturation, &self.saturation);
        put(&mut output.white_balance_k, &self.white_balance);
        put(&mut output.scotopic, &self.scotopic.then_some(true));
    }
}

impl EncodingArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, output: &mut OutputSpec) {
        put(&mut output.sun_disc, &self.sun_disc);
        put(&mut output.scale, &self.scale);
        put(&mut output.gamut, &self.gamut);
        put(&mut output.spectral, &self.spectral.then_some(true));
        put(&mut output.precision, &self.precision);
        put(&mut output.compression, &self.compression);
        put(&mut output.bits, &self.bits);
        put(&mut output.quality, &self.quality);
    }
}
