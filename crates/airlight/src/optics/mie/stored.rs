//! Tables of the published drops, computed beforehand and embedded.
//!
//! A file of `data/optics/drops` begins with lines of text, which state what it holds and end with an empty line. Numbers
//! follow in little-endian order: the counts of angles and of wavelengths (`u16`); the angles in degrees (`f32`); and for each
//! wavelength the wavelength (`f32`, nm), the cross-sections of scattering and absorption (um^2) and the asymmetry (`f64`), the
//! least and the greatest `ln p` (`f32`), and codes at the angles: `ln p` in steps of 1 / 65535 of that range, then `f12`, `f33` and `f34`
//! relative to `p` in steps of 1 / 127. Codes are stored as [`differences`] from those of the wavelength before, which compress to half
//! the size: of `ln p` first all high bytes, then all low bytes, with the sign in the lowest bit ([`sign_last`]); of the others `i8`.

use super::droplets::Drops;
use super::shared::GREEN_NM;
use super::{BulkOptics, DropTable, MieError, Particles};
use crate::optics::{MatrixRatios, TabulatedPhase};

/// Wavelengths of the embedded tables, nm: those of the grids `rgb`, `fast` and `standard`, those that stand for red, green and
/// blue, and the one for which visibility is defined.
const STORED_NM: [f64; 29] = [
    360.0, 398.0, 423.0, 424.0, 440.0, 446.0, 457.0, 465.0, 466.0, 485.0, 499.0, 510.0, 526.0,
    539.0, 549.0, 550.0, 559.0, 562.0, 595.0, 596.0, 612.0, 635.0, 637.0, 671.0, 680.0, 683.0,
    716.0, 765.0, 830.0,
];
/// Largest code of `ln p`.
const LOG_STEPS: f64 = u16::MAX as f64;
/// Largest code of an element of the scattering matrix.
const RATIO_STEPS: f64 = i8::MAX as f64;

/// The embedded table of a distribution.
fn embedded(drops: Drops) -> &'static [u8] {
    macro_rules! table {
        ($name:literal) => {
            include_bytes!(concat!("../../../data/optics/drops/", $name, ".bin"))
        };
    }
    match drops {
        Drops::HeavyAdvectionFog => table!("heavy-advection-fog"),
        Drops::ModerateAdvectionFog => table!("moderate-advection-fog"),
        // The same distribution.
        Drops::HeavyRadiationFog | Drops::CloudC1 => table!("heavy-radiation-fog"),
        Drops::ModerateRadiationFog => table!("moderate-radiation-fog"),
        Drops::CloudC2 => table!("cloud-c2"),
        Drops::CloudC3 => table!("cloud-c3"),
        Drops::HazeM => table!("haze-m"),
        Drops::HazeL => table!("haze-l"),
        Drops::HazeH => table!("haze-h"),
        Drops::Rain => table!("rain"),
    }
}

impl Drops {
    /// The table at wavelengths (nm, increasing) from the embedded one; `None` if that has not all of them.
    pub(super) fn stored_table(self, wavelengths_nm: &[f64]) -> Option<DropTable> {
        let stored = read(embedded(self), self.sizes().mean_volume_um3());
        let row = |nm: &f64| stored.rows.iter().find(|row| row.bulk.wavelength_nm == *nm);
        let rows: Vec<&Row> = wavelengths_nm.iter().map(row).collect::<Option<_>>()?;
        let values = rows.iter().flat_map(|row| &row.values).copied().collect();
        let ratios: Vec<[f64; 3]> = rows.iter().flat_map(|row| &row.ratios).copied().collect();
        let phase = TabulatedPhase::new(stored.angles_deg, wavelengths_nm.to_vec(), values);
        Some(DropTable {
            phase: phase.ok()?.with_matrix(&ratios).ok()?,
            bulk: rows.iter().map(|row| row.bulk).collect(),
            green: row(&GREEN_NM)?.bulk,
        })
    }

    /// The file of the embedded table, computed again (example `drop_tables`; minutes of processor time). `source`
    /// is text for its first lines: how the file was made.
    ///
    /// # Errors
    /// As [`Particles::table`].
    #[doc(hidden)]
    pub fn file_of_stored_table(self, source: &str) -> Result<Vec<u8>, MieError> {
        let water = Particles::water(self.sizes())?;
        // Number of sizes relative to tables that are computed when they are needed.
        let finer = match self {
            Self::Rain => 5.0,
            _ => 20.0,
        };
        let (phase, bulk) = water.fine_table(&STORED_NM, finer)?;
        Ok(write(source, &phase, &bulk))
    }
}

/// A table as stored.
struct Stored {
    angles_deg: Vec<f64>,
    rows: Vec<Row>,
}

/// A wavelength of a stored table: `p`, and the elements of the scattering matrix relative to it, at the angles.
struct Row {
    bulk: BulkOptics,
    values: Vec<f64>,
    ratios: Vec<[f64; 3]>,
}

fn write(source: &str, phase: &TabulatedPhase, bulk: &[BulkOptics]) -> Vec<u8> {
    let angles = phase.angles_rad();
    let mut file = format!("{source}\n\n").into_bytes();
    let mut before = Codes::zero(angles.len());
    for count in [angles.len(), bulk.len()] {
        file.extend((count as u16).to_le_bytes());
    }
    for angle in angles {
        file.extend((angle.to_degrees() as f32).to_le_bytes());
    }
    for row in bulk {
        let nm = row.wavelength_nm;
        let logs: Vec<f64> = angles
            .iter()
            .map(|a| phase.evaluate(a.cos(), nm).ln())
            .collect();
        let range = logs
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], log| {
                [low.min(*log), high.max(*log)]
            });
        let [low, high] = range.map(|log| log as f32);
        file.extend((nm as f32).to_le_bytes());
        for value in [row.scattering_um2, row.absorption_um2, row.asymmetry] {
            file.extend(value.to_le_bytes());
        }
        file.extend(low.to_le_bytes());
        file.extend(high.to_le_bytes());
        let [low, high] = [low, high].map(f64::from);
        let log_code = |log: &f64| (LOG_STEPS * (log - low) / (high - low)).round() as i32;
        let ratios: Vec<_> = angles
            .iter()
            .map(|a| phase.matrix_ratios(a.cos(), nm))
            .collect();
        let ratio_codes = |element: fn(&MatrixRatios) -> f64| {
            let code = |ratios| (RATIO_STEPS * element(ratios)).round() as i32;
            ratios.iter().map(code).collect()
        };
        let codes = Codes {
            logs: logs.iter().map(log_code).collect(),
            ratios: [
                ratio_codes(|of| of.f12),
                ratio_codes(|of| of.f33),
                ratio_codes(|of| of.f34),
            ],
        };
        let steps = differences(&codes.logs, &before.logs).map(|step| sign_last(step as i16));
        let (high, low): (Vec<u8>, Vec<u8>) = steps
            .map(u16::to_be_bytes)
            .map(|[high, low]| (high, low))
            .unzip();
        file.extend(high);
        file.extend(low);
        for (codes, before) in codes.ratios.iter().zip(&before.ratios) {
            file.extend(differences(codes, before).map(|step| step as u8));
        }
        before = codes;
    }
    file
}

/// Codes of a row at the angles: `ln p`, `f12`, `f33` and `f34`.
struct Codes {
    logs: Vec<i32>,
    ratios: [Vec<i32>; 3],
}

impl Codes {
    /// The row before the first one.
    fn zero(angles: usize) -> Self {
        Self {
            logs: vec![0; angles],
            ratios: [(); 3].map(|()| vec![0; angles]),
        }
    }
}

/// Differences of codes from those before at the same angles, each less that at the angle before: small numbers for smooth tables.
fn differences(codes: &[i32], before: &[i32]) -> impl Iterator<Item = i32> {
    let changes = codes.iter().zip(before).map(|(code, before)| code - before);
    changes.scan(0, |last, change| {
        let step = change - *last;
        *last = change;
        Some(step)
    })
}

/// The codes that have [`differences`] from those before, but for the bits that the differences have lost.
fn sums(steps: impl Iterator<Item = i32>, before: &[i32]) -> impl Iterator<Item = i32> {
    let changes = steps.scan(0, |change: &mut i32, step| {
        *change += step;
        Some(*change)
    });
    changes.zip(before).map(|(change, before)| before + change)
}

/// A number with its sign as the lowest bit, so that small ones of both signs have no high bits: 0, -1, 1, -2 become 0, 1, 2, 3.
fn sign_last(number: i16) -> u16 {
    ((number << 1) ^ (number >> 15)) as u16
}

/// The number of [`sign_last`].
fn sign_first(code: u16) -> i16 {
    (code >> 1) as i16 ^ -((code & 1) as i16)
}

/// Reads what [`write`] has written. Panics where an embedded table is cut short, which the tests exclude.
fn read(file: &[u8], volume_um3: f64) -> Stored {
    let text = file.windows(2).position(|pair| pair == b"\n\n");
    let mut rest = &file[text.map_or(0, |at| at + 2)..];
    let [angles, wavelengths] = [(); 2].map(|()| usize::from(u16::from_le_bytes(take(&mut rest))));
    let angles_deg = (0..angles)
        .map(|_| f64::from(f32::from_le_bytes(take(&mut rest))))
        .collect();
    let mut before = Codes::zero(angles);
    let row = |_| {
        let wavelength_nm = f64::from(f32::from_le_bytes(take(&mut rest)));
        let [scattering_um2, absorption_um2, asymmetry] =
            [(); 3].map(|()| f64::from_le_bytes(take(&mut rest)));
        let [low, high] = [(); 2].map(|()| f64::from(f32::from_le_bytes(take(&mut rest))));
        let [high_bytes, low_bytes, f12, f33, f34] = [(); 5].map(|()| {
            let (bytes, others) = rest.split_at(angles);
            rest = others;
            bytes
        });
        let steps = high_bytes.iter().zip(low_bytes);
        let steps = steps.map(|(high, low)| sign_first(u16::from_be_bytes([*high, *low])));
        let logs = sums(steps.map(i32::from), &before.logs).map(|code| i32::from(code as u16));
        let elements = [f12, f33, f34];
        let ratios = std::array::from_fn(|k| {
            let steps = elements[k].iter().map(|step| i32::from(*step as i8));
            let codes = sums(steps, &before.ratios[k]).map(|code| i32::from(code as i8));
            codes.collect()
        });
        before = Codes {
            logs: logs.collect(),
            ratios,
        };
        let value = |code: &i32| (low + (high - low) * f64::from(*code) / LOG_STEPS).exp();
        let values = before.logs.iter().map(value).collect();
        let ratio = |code: i32| f64::from(code) / RATIO_STEPS;
        let at_angle = |k: usize| before.ratios.each_ref().map(|codes| ratio(codes[k]));
        let ratios = (0..angles).map(at_angle).collect();
        Row {
            bulk: BulkOptics {
                wavelength_nm,
                scattering_um2,
                absorption_um2,
                asymmetry,
                volume_um3,
            },
            values,
            ratios,
        }
    };
    let rows = (0..wavelengths).map(row).collect();
    Stored { angles_deg, rows }
}

/// Takes the first bytes.
fn take<const N: usize>(rest: &mut &[u8]) -> [u8; N] {
    let (first, others) = rest
        .split_first_chunk()
        .expect("an embedded table is whole");
    *rest = others;
    *first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::Named;
    use crate::spectrum::WavelengthGrid;

    /// The embedded tables agree with theory as far as sums over a twentieth of the sizes do.
    #[test]
    fn stored_tables_agree_with_theory() -> Result<(), MieError> {
        for &drops in Drops::ALL {
            let stored = drops.stored_table(&[GREEN_NM, 562.0]).unwrap();
            let water = Particles::water(drops.sizes())?;
            let bulk = water.bulk(GREEN_NM)?;
            assert_eq!(stored.bulk[0], stored.green);
            let extinction = stored.green.extinction_um2() / bulk.extinction_um2() - 1.0;
            let asymmetry = stored.green.asymmetry - bulk.asymmetry;
            let [got, want] = [stored.green, bulk].map(|of| 1.0 - of.single_scattering_albedo());
            let absorption = got - want;
            let cosines: Vec<f64> = (0..=60)
                .map(|i| (3.0 * f64::from(i)).to_radians().cos())
                .collect();
            let mut squares = 0.0;
            let mut polarisation: f64 = 0.0;
            for (mu, exact) in cosines.iter().zip(water.matrices(GREEN_NM, &cosines)?) {
                let got = stored.phase.evaluate(*mu, GREEN_NM);
                let ratios = stored.phase.matrix_ratios(*mu, GREEN_NM);
                squares += (got / exact.f11 - 1.0).powi(2) / cosines.len() as f64;
                polarisation = polarisation.max((ratios.f12 - exact.f12 / exact.f11).abs());
            }
            let rms = squares.sqrt();
            println!(
                "{drops}: extinction {extinction:.1e}, absorption {absorption:.1e}, g {asymmetry:.1e}, phase {rms:.1e}, polarisation {polarisation:.1e}"
            );
            // The noise of the sums that are computed here, of the fringes of raindrops and of resonances.
            let noise = if drops == Drops::Rain { 0.12 } else { 0.015 };
            assert!(
                extinction.abs() < 1e-3 && asymmetry.abs() < 1e-3 && absorption.abs() < 2e-5,
                "{drops}"
            );
            assert!(
                rms < noise && polarisation < 3.0 * noise,
                "{drops}: {rms} {polarisation}"
            );
        }
        Ok(())
    }

    #[test]
    fn codes_are_the_sums_of_their_differences() {
        let (before, codes) = ([0, 65_535, 300, 7], [65_535, 0, 299, 7]);
        let steps = differences(&codes, &before).map(|step| sign_last(step as i16));
        let sums = sums(steps.map(|step| i32::from(sign_first(step))), &before);
        assert_eq!(sums.map(|sum| sum & 0xffff).collect::<Vec<_>>(), codes);
        assert_eq!(
            [0, -1, 1, -2, i16::MIN].map(sign_last),
            [0, 1, 2, 3, 65_535]
        );
        assert!((i16::MIN..=i16::MAX).all(|number| sign_first(sign_last(number)) == number));
    }

    /// What is written is read back, within the steps in which it is stored.
    #[test]
    fn tables_are_read_as_they_were_written() -> Result<(), MieError> {
        let water = Particles::water(Drops::HazeH.sizes())?;
        let (phase, bulk) = water.table(&[450.0, 650.0])?;
        let stored = read(
            &write("A line.\nAnother.", &phase, &bulk),
            bulk[0].volume_um3,
        );
        assert_eq!(stored.angles_deg.len(), phase.angles_rad().len());
        assert_eq!(
            (stored.angles_deg[0], stored.angles_deg.last()),
            (0.0, Some(&180.0))
        );
        for (row, bulk) in stored.rows.iter().zip(bulk) {
            assert_eq!(row.bulk, bulk);
            for ((angle, value), ratios) in
                stored.angles_deg.iter().zip(&row.values).zip(&row.ratios)
            {
                let (mu, nm) = (angle.to_radians().cos(), bulk.wavelength_nm);
                assert!(
                    (value / phase.evaluate(mu, nm) - 1.0).abs() < 2e-4,
                    "{angle}"
                );
                let exact = phase.matrix_ratios(mu, nm);
                assert!((ratios[0] - exact.f12).abs() < 0.5 / RATIO_STEPS + 1e-4);
                assert!((ratios[2] - exact.f34).abs() < 0.5 / RATIO_STEPS + 1e-4);
            }
        }
        Ok(())
    }

    /// The grids that pictures use need no computation; others are computed.
    #[test]
    fn grids_of_pictures_are_stored() {
        for grid in [
            WavelengthGrid::rgb(),
            WavelengthGrid::fast(),
            WavelengthGrid::standard(),
        ] {
            let table = Drops::Rain.stored_table(grid.wavelengths_nm()).unwrap();
            assert_eq!(table.phase.wavelengths_nm(), grid.wavelengths_nm());
        }
        assert!(
            Drops::Rain
                .stored_table(&[crate::spectrum::rgb::DOMINANT_NM[2]])
                .is_some()
        );
        assert!(Drops::Rain.stored_table(&[500.0]).is_none());
    }
}
