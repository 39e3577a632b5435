//! [`Shard`]: a part of the pictures of a batch or a sequence.

use std::fmt;
use std::str::FromStr;

/// One of several parts of the inputs of a batch or of the pictures of a sequence, each for a machine of its own: parsed from
/// `3/16`, the third of 16. They are dealt out one by one in their order, so that all shards are of nearly the same size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u32,
    count: u32,
}

impl Shard {
    /// Whether the input or picture at an index, from 0, belongs to the shard.
    pub fn has(&self, index: usize) -> bool {
        index % self.count as usize == self.number as usize - 1
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
    fn shards_share_all_inputs() {
        let shards: Vec<Shard> = (1..=3)
            .map(|number| format!("{number}/3").parse().unwrap())
            .collect();
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
