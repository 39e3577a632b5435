//! [`Shard`]: a part of the pictures of a batch or a sequence, or of the rows of one picture.

use airlight_image::output::RowBand;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// One of several parts of the inputs of a batch or of the pictures of a sequence, each for a machine of its own: parsed from
/// `3/16`, the third of 16. They are dealt out one by one in their order, so that all shards are of nearly the same size. Of a single
/// picture, a shard is a band of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u32,
    count: u32,
}

impl Shard {
    /// All of a number of shards, in their order.
    pub fn all(count: u32) -> impl Iterator<Item = Self> {
        (1..=count).map(move |number| Self { number, count })
    }

    /// Whether the input or picture at an index, from 0, belongs to the shard.
    pub fn has(&self, index: usize) -> bool {
        index % self.count as usize == self.number as usize - 1
    }

    /// The rows of a picture that belong to the shard: a multiple of [`RowBand::MULTIPLE`], except for the last shard. Empty where
    /// the picture has fewer such bands than there are shards.
    pub fn rows(&self, height: u32) -> Range<u32> {
        let bands = u64::from(height.div_ceil(RowBand::MULTIPLE));
        let start = |shard: u32| {
            let band = bands * u64::from(shard) / u64::from(self.count);
            (band as u32 * RowBand::MULTIPLE).min(height)
        };
        start(self.number - 1)..start(self.number)
    }

    /// The file of the shard's rows of a picture: `sky-3-of-16.exr` for `sky.exr`.
    pub fn path_of(&self, picture: &Path) -> PathBuf {
        let stem = picture.file_stem().unwrap_or_default().to_string_lossy();
        let ending = picture.extension().unwrap_or_default().to_string_lossy();
        picture.with_file_name(format!("{stem}-{}-of-{}.{ending}", self.number, self.count))
    }

    /// Its number, from 1.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Number of parts.
    pub fn count(&self) -> u32 {
        self.count
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(number, count)| {
            Some((number.trim().parse().ok()?, count.trim().parse().ok()?))
        });
        match numbers {
            Some((number, count)) if (1..=count).contains(&number) => Ok(Self { number, count }),
            _ => Err(format!(
                "expected K/N with K from 1 to N, got `{text}`; try 1/4 for the first of four parts"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_all_rows() {
        for (height, count) in [(1024, 16), (1000, 7), (33, 2), (20, 3)] {
            let mut next = 0;
            for shard in Shard::all(count) {
                let rows = shard.rows(height);
                assert_eq!(rows.start, next);
                assert!(rows.end == height || rows.end % RowBand::MULTIPLE == 0);
                next = rows.end;
            }
            assert_eq!(next, height);
        }
        let shard: Shard = "3/16".parse().unwrap();
        assert_eq!(shard.rows(1024), 128..192);
        let path = shard.path_of(Path::new("a/sky.spectral.exr"));
        assert_eq!(path, Path::new("a/sky.spectral-3-of-16.exr"));
    }

    #[test]
    fn shards_share_all_inputs() {
        let shards: Vec<Shard> = Shard::all(3).collect();
        for index in 0..10 {
            let owners = shards.iter().filter(|shard| shard.has(index)).count();
            assert_eq!(owners, 1, "{index}");
        }
        assert_eq!((shards[1].number(), shards[1].count()), (2, 3));
        for text in [
            "0/3",
            "4/3",
            "3",
            "1/",
            "a/b",
            "-1/3",
            "0/0",
            "1/5000000000",
        ] {
            let said = text.parse::<Shard>().unwrap_err();
            assert!(said.contains("try 1/4"), "{said}");
        }
    }
}
