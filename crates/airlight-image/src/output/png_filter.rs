//! PNG row filters (PNG specification, clause 9): each byte is stored as its difference from a guess.

/// Filters a row by each method and keeps the one whose differences have the least sum of magnitudes, as the
/// specification recommends. `above` is the row before, if the guess may use it; `step` the bytes of a pixel.
///
/// Appends the filter's number and the filtered bytes to `out`.
pub(super) fn filter(
    row: &[u8],
    above: Option<&[u8]>,
    step: usize,
    scratch: &mut Scratch,
    out: &mut Vec<u8>,
) {
    let step = step.min(row.len());
    scratch.best.resize(row.len(), 0);
    scratch.candidate.resize(row.len(), 0);
    left(row, step, &mut scratch.best);
    let mut method = 1;
    let mut least = cost(&scratch.best);
    if let Some(above) = above {
        let methods: [(u8, Method); 3] = [(2, up), (3, average), (4, paeth)];
        for (number, apply) in methods {
            apply(row, above, step, &mut scratch.candidate);
            let sum = cost(&scratch.candidate);
            if sum < least {
                least = sum;
                method = number;
                std::mem::swap(&mut scratch.best, &mut scratch.candidate);
            }
        }
    }
    out.push(method);
    out.extend_from_slice(&scratch.best);
}

type Method = fn(&[u8], &[u8], usize, &mut [u8]);

/// Buffers that are kept from row to row.
#[derive(Default)]
pub(super) struct Scratch {
    best: Vec<u8>,
    candidate: Vec<u8>,
}

/// Sum of the differences' magnitudes, taken as signed bytes.
fn cost(filtered: &[u8]) -> u64 {
    filtered
        .chunks(4096)
        .map(|part| {
            let sum: u32 = part
                .iter()
                .map(|&b| u32::from((b as i8).unsigned_abs()))
                .sum();
            u64::from(sum)
        })
        .sum()
}

fn left(row: &[u8], step: usize, out: &mut [u8]) {
    out[..step].copy_from_slice(&row[..step]);
    for ((out, now), before) in out[step..].iter_mut().zip(&row[step..]).zip(row) {
        *out = now.wrapping_sub(*before);
    }
}

fn up(row: &[u8], above: &[u8], _step: usize, out: &mut [u8]) {
    for ((out, now), above) in out.iter_mut().zip(row).zip(above) {
        *out = now.wrapping_sub(*above);
    }
}

fn average(row: &[u8], above: &[u8], step: usize, out: &mut [u8]) {
    for i in 0..step {
        out[i] = row[i].wrapping_sub(above[i] / 2);
    }
    let neighbours = row.iter().zip(&above[step..]);
    for ((out, now), (&a, &b)) in out[step..].iter_mut().zip(&row[step..]).zip(neighbours) {
        // Half the sum, rounded down, within 8 bits.
        *out = now.wrapping_sub((a & b) + ((a ^ b) >> 1));
    }
}

fn paeth(row: &[u8], above: &[u8], step: usize, out: &mut [u8]) {
    for i in 0..step {
        out[i] = row[i].wrapping_sub(above[i]);
    }
    let neighbours = row.iter().zip(&above[step..]).zip(above);
    for ((out, now), ((&a, &b), &c)) in out[step..].iter_mut().zip(&row[step..]).zip(neighbours) {
        // The neighbour nearest to a + b - c: left, then above, then diagonal.
        let (x, y, z) = (i16::from(a), i16::from(b), i16::from(c));
        let (to_a, to_b, to_c) = ((y - z).abs(), (x - z).abs(), (x + y - 2 * z).abs());
        let nearer = if to_b <= to_c { b } else { c };
        let guess = if to_a <= to_b && to_a <= to_c {
            a
        } else {
            nearer
        };
        *out = now.wrapping_sub(guess);
    }
}
