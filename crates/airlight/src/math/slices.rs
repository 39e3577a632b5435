//! Lengths of slices.

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
