//! Lengths and sums of slices.

/// Checks that a slice has the length that a call states.
///
/// # Panics
/// If it has another.
#[track_caller]
pub(crate) fn check_length<T>(slice: &[T], expected: usize) {
    assert!(
        slice.len() == expected,
        "expected a slice of {expected} values, got {}",
        slice.len()
    );
}

/// Adds values to sums, one by one.
pub(crate) fn accumulate(values: &[f32], sums: &mut [f32]) {
    sums.iter_mut().zip(values).for_each(|(sum, v)| *sum += v);
}
