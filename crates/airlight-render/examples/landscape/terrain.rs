//! Heights of the ground: posts of an elevation model, interpolated smoothly, repeated as in mirrors beyond its edges.

use std::{error::Error, path::Path};

/// Metres a degree of latitude, at the latitudes of the scene.
const METRES_PER_DEGREE: f64 = 111_000.0;

/// An even grid of values over a flat map: x east and z south of the map's middle, metres.
#[derive(Clone, Debug)]
pub struct Grid {
    columns: usize,
    rows: usize,
    /// Metres from post to post, eastward and southward.
    spacing_m: [f64; 2],
    /// Row after row, from north to south, each from west to east.
    values: Vec<f32>,
}

/// An elevation model on the globe.
#[derive(Clone, Debug)]
pub struct Terrain {
    /// Metres above sea level.
    pub heights: Grid,
    /// Latitude and longitude of the map's middle, degrees.
    middle_deg: [f64; 2],
}

impl Terrain {
    /// Reads `NAME_m.png` (16-bit grey, metres) and `NAME.json` (`west_deg`, `east_deg`, `north_deg`, `south_deg`).
    pub fn read(folder: &Path, name: &str) -> Result<Self, Box<dyn Error>> {
        let open = |file: String| {
            let path = folder.join(file);
            std::fs::read(&path).map_err(|e| format!("cannot read `{}`: {e}", path.display()))
        };
        let facts = String::from_utf8(open(format!("{name}.json"))?)?;
        let edge = |key: &str| number(&facts, key).ok_or(format!("{name}.json lacks `{key}`"));
        let [west, east] = [edge("west_deg")?, edge("east_deg")?];
        let [north, south] = [edge("north_deg")?, edge("south_deg")?];
        let bytes = open(format!("{name}_m.png"))?;
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info()?;
        let mut samples = vec![0; reader.output_buffer_size().ok_or("a picture too large")?];
        let info = reader.next_frame(&mut samples)?;
        if (info.color_type, info.bit_depth) != (png::ColorType::Grayscale, png::BitDepth::Sixteen)
        {
            return Err(format!("{name}_m.png is not 16-bit grey").into());
        }
        let (columns, rows) = (info.width as usize, info.height as usize);
        let middle_deg = [(north + south) / 2.0, (east + west) / 2.0];
        let across = METRES_PER_DEGREE * middle_deg[0].to_radians().cos();
        let heights = Grid::new(
            columns,
            rows,
            [
                (east - west) * across / columns as f64,
                (north - south) * METRES_PER_DEGREE / rows as f64,
            ],
            samples
                .as_chunks::<2>()
                .0
                .iter()
                .map(|&pair| f32::from(u16::from_be_bytes(pair)))
                .collect(),
        );
        Ok(Self {
            heights,
            middle_deg,
        })
    }

    /// Where a place lies on the map: metres east and south of its middle.
    pub fn place(&self, latitude_deg: f64, longitude_deg: f64) -> [f64; 2] {
        let across = METRES_PER_DEGREE * self.middle_deg[0].to_radians().cos();
        [
            (longitude_deg - self.middle_deg[1]) * across,
            (self.middle_deg[0] - latitude_deg) * METRES_PER_DEGREE,
        ]
    }
}

impl Grid {
    /// Takes `columns * rows` values.
    pub fn new(columns: usize, rows: usize, spacing_m: [f64; 2], values: Vec<f32>) -> Self {
        assert_eq!(values.len(), columns * rows);
        Self {
            columns,
            rows,
            spacing_m,
            values,
        }
    }

    /// A grid of the same posts with values made by `value(x, z)`.
    pub fn map(&self, value: impl Fn(f64, f64) -> f32 + Sync) -> Self {
        self.finer(1, value)
    }

    /// A grid over the same map of `times` as many posts each way, with values made by `value(x, z)`.
    pub fn finer(&self, times: usize, value: impl Fn(f64, f64) -> f32 + Sync) -> Self {
        use rayon::prelude::*;
        let mut finer = Self {
            columns: self.columns * times,
            rows: self.rows * times,
            spacing_m: self.spacing_m.map(|spacing| spacing / times as f64),
            values: Vec::new(),
        };
        finer.values = (0..finer.columns * finer.rows)
            .into_par_iter()
            .map(|i| {
                let [x, z] = finer.post(i % finer.columns, i / finer.columns);
                value(x, z)
            })
            .collect();
        finer
    }

    /// Where a post stands.
    pub fn post(&self, column: usize, row: usize) -> [f64; 2] {
        let from_middle = |i: usize, n: usize| i as f64 + 0.5 - n as f64 / 2.0;
        [
            from_middle(column, self.columns) * self.spacing_m[0],
            from_middle(row, self.rows) * self.spacing_m[1],
        ]
    }

    /// The largest value.
    pub fn highest(&self) -> f64 {
        f64::from(self.values.iter().copied().fold(f32::MIN, f32::max))
    }

    /// Interpolated with Catmull-Rom splines: passes through the posts, with a continuous slope.
    pub fn smooth(&self, x: f64, z: f64) -> f64 {
        let (column, fx) = self.cell(x, 0, self.columns);
        let (row, fz) = self.cell(z, 1, self.rows);
        let (wx, wz) = (catmull_rom(fx), catmull_rom(fz));
        let columns: [usize; 4] =
            std::array::from_fn(|k| mirrored(column + k as i64 - 1, self.columns));
        let mut sum = 0.0;
        for (k, wz) in wz.into_iter().enumerate() {
            let line = &self.values[mirrored(row + k as i64 - 1, self.rows) * self.columns..];
            let mut along = 0.0;
            for (column, wx) in columns.into_iter().zip(wx) {
                along += wx * f64::from(line[column]);
            }
            sum += wz * along;
        }
        sum
    }

    /// Interpolated linearly: cheaper.
    pub fn linear(&self, x: f64, z: f64) -> f64 {
        let (column, fx) = self.cell(x, 0, self.columns);
        let (row, fz) = self.cell(z, 1, self.rows);
        let columns = [0, 1].map(|k| mirrored(column + k, self.columns));
        let line = |k: i64| {
            let line = &self.values[mirrored(row + k, self.rows) * self.columns..];
            let [a, b] = columns.map(|c| f64::from(line[c]));
            a + fx * (b - a)
        };
        let (a, b) = (line(0), line(1));
        a + fz * (b - a)
    }

    /// The post before a coordinate, and how far it lies beyond, in parts of a step.
    fn cell(&self, metres: f64, axis: usize, posts: usize) -> (i64, f64) {
        let position = metres / self.spacing_m[axis] + posts as f64 / 2.0 - 0.5;
        let floor = position.floor();
        (floor as i64, position - floor)
    }
}

/// The post that stands at an index when the grid goes on as in mirrors on its edges.
fn mirrored(index: i64, posts: usize) -> usize {
    let n = posts as i64;
    if (0..n).contains(&index) {
        return index as usize;
    }
    let around = index.rem_euclid(2 * n);
    around.min(2 * n - 1 - around) as usize
}

fn catmull_rom(f: f64) -> [f64; 4] {
    let (f2, f3) = (f * f, f * f * f);
    [
        0.5 * (-f + 2.0 * f2 - f3),
        0.5 * (2.0 - 5.0 * f2 + 3.0 * f3),
        0.5 * (f + 4.0 * f2 - 3.0 * f3),
        0.5 * (f3 - f2),
    ]
}

/// The number after `"key":`.
fn number(json: &str, key: &str) -> Option<f64> {
    let (_, rest) = json.split_once(&format!("\"{key}\":"))?;
    let end = rest.find([',', '}', '\n'])?;
    rest[..end].trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bumpy() -> Grid {
        let values = (0..7 * 5).map(|i| ((i * 37) % 11) as f32).collect();
        Grid::new(7, 5, [80.0, 90.0], values)
    }

    #[test]
    fn the_ground_passes_through_its_posts() {
        let grid = bumpy();
        for row in 0..5 {
            for column in 0..7 {
                let [x, z] = grid.post(column, row);
                let post = f64::from(grid.values[row * 7 + column]);
                assert!((grid.smooth(x, z) - post).abs() < 1e-9);
                assert!((grid.linear(x, z) - post).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_ground_is_level_and_unbroken_at_its_mirrors() {
        let grid = bumpy();
        let edge = 7.0 * 80.0 / 2.0;
        for z in [-200.0, 13.0, 170.0] {
            for d in [0.1, 33.0, 400.0] {
                let (inside, outside) = (grid.smooth(edge - d, z), grid.smooth(edge + d, z));
                assert!((inside - outside).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_scene_is_as_high_as_its_source_says() -> Result<(), Box<dyn Error>> {
        let terrain = Terrain::read(Path::new(crate::SCENE), "jacksboro_dem")?;
        assert_eq!(terrain.heights.highest(), 1076.0);
        let [x, z] = terrain.place(36.73291666666667, -84.41375);
        let [x0, z0] = terrain.heights.post(0, 0);
        // The corner of the map lies half a step beyond the outermost post.
        assert!((x0 - x - terrain.heights.spacing_m[0] / 2.0).abs() < 1e-6);
        assert!((z0 - z - terrain.heights.spacing_m[1] / 2.0).abs() < 1e-6);
        Ok(())
    }
}
