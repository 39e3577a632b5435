//! [`heights`]: the ground of a [`Terrain`].

use crate::state::Terrain;
use airlight_gpu::HeightField;
use airlight_image::input::{DepthMap, DepthMeaning, DepthOptions, read_depth_bytes};

/// Heights of a terrain's file, or why there are none.
#[derive(Debug)]
pub struct LoadedTerrain {
    pub file: Option<String>,
    pub spacing_m: Option<f64>,
    pub number: u64,
    pub heights: Result<HeightField, String>,
}

/// Heights around the Jacksboro fault in the Cumberland Mountains, m above sea level, 16-bit grey, from north to south.
const CUMBERLAND: &[u8] = include_bytes!("../data/jacksboro_dem_m.png");
/// Its distances between columns and rows, m: 3 arc seconds at 36.6 degrees north.
const CUMBERLAND_SPACING_M: [f64; 2] = [74.4, 92.5];
/// Distance between the posts of a file where none is stated, m: 1 arc second.
pub const SPACING_M: f64 = 30.0;

/// Height of the eye above the ground that it keeps, m.
pub const CLEARANCE_M: f64 = 2.0;

/// Whether a file is one of heights, by the ending of its name.
pub fn is_name(file: &std::path::Path) -> bool {
    let ending = file.extension().unwrap_or_default().to_ascii_lowercase();
    ["exr", "npy", "npz", "pfm", "png", "tif", "tiff"]
        .iter()
        .any(|known| ending == *known)
}

/// Heights of a terrain above its lowest point, which lies on the ground of the planet. `contents` are those of its file, if they are in
/// memory.
///
/// # Errors
/// A sentence where the file cannot be read or holds no heights.
pub fn heights(terrain: &Terrain, contents: Option<&[u8]>) -> Result<HeightField, String> {
    let (size, spacing_m, heights_m) = match &terrain.file {
        None => cumberland()?,
        Some(file) => {
            let (size, heights_m) = of_file(file, contents)?;
            let spacing_m = terrain.spacing_m.unwrap_or(SPACING_M);
            (size, [spacing_m; 2], heights_m)
        }
    };
    let lowest_m = heights_m.iter().copied().fold(f32::INFINITY, f32::min);
    let above_m = heights_m.iter().map(|height_m| height_m - lowest_m);
    HeightField::new(size, spacing_m, above_m.collect()).map_err(|error| error.to_string())
}

/// Size, distances between posts, and heights.
type Posts = ([usize; 2], [f64; 2], Vec<f32>);

fn cumberland() -> Result<Posts, String> {
    let decode = || {
        let mut reader = png::Decoder::new(std::io::Cursor::new(CUMBERLAND)).read_info()?;
        let mut samples = vec![0; reader.output_buffer_size().unwrap_or_default()];
        let info = reader.next_frame(&mut samples)?;
        Ok::<_, png::DecodingError>((info.width as usize, info.height as usize, samples))
    };
    let (columns, rows, samples) = decode().map_err(|error| error.to_string())?;
    let pairs = samples.as_chunks::<2>().0.iter();
    let heights_m = pairs.map(|pair| f32::from(u16::from_be_bytes(*pair)));
    Ok(([columns, rows], CUMBERLAND_SPACING_M, heights_m.collect()))
}

fn of_file(file: &str, contents: Option<&[u8]>) -> Result<([usize; 2], Vec<f32>), String> {
    let options = DepthOptions {
        meaning: DepthMeaning::RayDistance,
        // Sea level is a height as any other.
        offset: Some(0.0),
        ..Default::default()
    };
    let map = match contents {
        Some(contents) => read_depth_bytes(contents.to_vec(), file.as_ref(), &options)
            .map_err(|error| error.to_string()),
        None => from_disk(file, &options),
    }?;
    let size = [map.size.width() as usize, map.size.height() as usize];
    Ok((size, map.metres))
}

#[cfg(not(target_arch = "wasm32"))]
fn from_disk(file: &str, options: &DepthOptions) -> Result<DepthMap, String> {
    airlight_image::read_depth(file.as_ref(), options).map_err(|error| error.to_string())
}

#[cfg(target_arch = "wasm32")]
fn from_disk(file: &str, _options: &DepthOptions) -> Result<DepthMap, String> {
    Err(format!(
        "expected the file `{file}` of heights, which the address does not keep; try opening it again, or dropping it on the page"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cumberland_mountains_have_valleys_and_ridges() {
        let field = heights(&Terrain::default(), None).unwrap();
        assert_eq!(field.size(), [403, 344]);
        let posts = (0..403).flat_map(|i| (0..344).map(move |j| [f64::from(i), f64::from(j)]));
        let lowest_m = posts
            .map(|[i, j]| field.height_m([(i - 201.0) * 74.4, (j - 171.5) * 92.5]))
            .fold(f64::INFINITY, f64::min);
        assert!(lowest_m.abs() < 1e-3, "{lowest_m}");
        let highest_m = field.highest_m();
        assert!((500.0..900.0).contains(&highest_m), "{highest_m}");
    }

    #[test]
    fn files_of_heights_are_read_or_refused() {
        let folder = std::env::temp_dir().join(format!("airlight-heights-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("heights.pfm");
        // Rows from below; 40 m is the lowest.
        let mut bytes = b"Pf\n2 2\n-1.0\n".to_vec();
        for height_m in [50.0f32, 60.0, 40.0, 45.0] {
            bytes.extend(height_m.to_le_bytes());
        }
        std::fs::write(&file, bytes).unwrap();
        let terrain = |file: &std::path::Path| Terrain {
            file: Some(file.display().to_string()),
            spacing_m: Some(10.0),
            ..Default::default()
        };
        let field = heights(&terrain(&file), None).unwrap();
        assert_eq!(field.size(), [2, 2]);
        assert!((field.height_m([-5.0, -5.0]) - 0.0).abs() < 1e-5);
        assert!((field.height_m([5.0, 5.0]) - 20.0).abs() < 1e-5);
        // The same in memory, whatever is on the disk.
        let contents = std::fs::read(&file).unwrap();
        let none = terrain(&folder.join("none.pfm"));
        assert!(heights(&none, None).is_err());
        let in_memory = heights(&none, Some(&contents)).unwrap();
        assert_eq!(in_memory.height_m([5.0, 5.0]), field.height_m([5.0, 5.0]));
        let error = heights(&none, Some(&contents[..20])).unwrap_err();
        assert!(error.contains("none.pfm"), "{error}");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
