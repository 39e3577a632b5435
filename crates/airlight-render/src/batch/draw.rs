//! Pseudo-random numbers that depend on names only: the same on every machine and in any order.

use airlight::SplitMix64;

/// A number from 0 (inclusive) to 1 (exclusive) for a setting of a variant of a picture: the first of the generator whose seed is
/// an FNV-1a hash of the four arguments.
pub fn fraction(seed: u64, picture: &str, variant: u32, setting: &str) -> f64 {
    // A zero byte, which no name contains, ends the picture's name.
    let bytes = seed
        .to_le_bytes()
        .into_iter()
        .chain(picture.bytes())
        .chain([0])
        .chain(variant.to_le_bytes())
        .chain(setting.bytes());
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    SplitMix64::new(hash).unit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_uniform_and_independent() {
        let count = 20_000;
        let of = |n: u32, option| fraction(1, &format!("{:05}", n / 4), n % 4, option);
        let (mut tenths, mut product) = ([0u32; 10], 0.0);
        for n in 0..count {
            let (a, b) = (of(n, "visibility"), of(n, "top"));
            tenths[(a * 10.0) as usize] += 1;
            product += (a - 0.5) * (b - 0.5);
        }
        // Chi-squared with 9 degrees of freedom is above 27.9 once in a thousand times.
        let expected = f64::from(count) / 10.0;
        let chi_squared: f64 = tenths
            .iter()
            .map(|&n| (f64::from(n) - expected).powi(2) / expected)
            .sum();
        assert!(chi_squared < 27.9, "{tenths:?}");
        // The correlation's standard deviation is 1 / sqrt(count).
        let correlation = 12.0 * product / f64::from(count);
        assert!(
            correlation.abs() < 3.0 / f64::from(count).sqrt(),
            "{correlation}"
        );
    }
}

#[cfg(test)]
mod guards {
    use super::*;

    #[test]
    fn draws_do_not_change_between_versions() {
        for (seed, picture, variant, option, expected) in [
            (0, "0001", 1, "visibility", 0.5924187492576692),
            (0, "0001", 2, "visibility", 0.0998649442159063),
            (
                7,
                "street/\u{e9}t\u{e9}",
                1,
                "sun-elevation",
                0.1837321651840088,
            ),
        ] {
            assert_eq!(fraction(seed, picture, variant, option), expected);
        }
    }
}
