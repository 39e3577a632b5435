//! Loops over independent iterations: on all threads with the feature `parallel`, sequential without it. Results keep their
//! order, so both give the same bits.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// The result of `f`, computed on threads apart from those of the current pool, as many of them: for what other threads wait for under a
/// lock. A thread of a pool that waits for a part of its work takes up other work, which may be such a wait; and threads that wait under a
/// lock do not work.
pub(crate) fn apart<T: Send>(f: impl FnOnce() -> T + Send) -> T {
    #[cfg(all(feature = "parallel", not(target_arch = "wasm32")))]
    {
        let threads = rayon::current_num_threads();
        if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            let result = std::thread::scope(|scope| scope.spawn(|| pool.install(f)).join());
            return result.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    }
    f()
}

/// Results of `f(0)` to `f(count - 1)`.
pub(crate) fn map<T: Send>(count: usize, f: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
    #[cfg(feature = "parallel")]
    return (0..count).into_par_iter().map(f).collect();
    #[cfg(not(feature = "parallel"))]
    (0..count).map(f).collect()
}

/// Results of `f(0)` to `f(count - 1)`, or the error of one of them.
///
/// # Errors
/// As `f`.
pub(crate) fn try_map<T: Send, E: Send>(
    count: usize,
    f: impl Fn(usize) -> Result<T, E> + Send + Sync,
) -> Result<Vec<T>, E> {
    #[cfg(feature = "parallel")]
    return (0..count).into_par_iter().map(f).collect();
    #[cfg(not(feature = "parallel"))]
    (0..count).map(f).collect()
}

/// Calls `f(index, chunk)` for each chunk of `size` values; the last chunk may be shorter.
pub(crate) fn for_each_chunk<T: Send>(
    values: &mut [T],
    size: usize,
    f: impl Fn(usize, &mut [T]) + Send + Sync,
) {
    #[cfg(feature = "parallel")]
    values
        .par_chunks_mut(size)
        .enumerate()
        .for_each(|(index, chunk)| f(index, chunk));
    #[cfg(not(feature = "parallel"))]
    for (index, chunk) in values.chunks_mut(size).enumerate() {
        f(index, chunk);
    }
}

/// As [`for_each_chunk`], or the error of one of the calls.
///
/// # Errors
/// As `f`.
pub(crate) fn try_for_each_chunk<T: Send, E: Send>(
    values: &mut [T],
    size: usize,
    f: impl Fn(usize, &mut [T]) -> Result<(), E> + Send + Sync,
) -> Result<(), E> {
    #[cfg(feature = "parallel")]
    return values
        .par_chunks_mut(size)
        .enumerate()
        .try_for_each(|(index, chunk)| f(index, chunk));
    #[cfg(not(feature = "parallel"))]
    values
        .chunks_mut(size)
        .enumerate()
        .try_for_each(|(index, chunk)| f(index, chunk))
}

/// Results of `f` for each chunk of `size` values, or the error of one of the calls; the last chunk may be shorter.
///
/// # Errors
/// As `f`.
pub(crate) fn try_map_chunks<S: Sync, T: Send, E: Send>(
    values: &[S],
    size: usize,
    f: impl Fn(&[S]) -> Result<T, E> + Send + Sync,
) -> Result<Vec<T>, E> {
    try_map(values.len().div_ceil(size), |index| {
        let first = index * size;
        f(&values[first..values.len().min(first + size)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_runs_apart_may_be_parallel_and_panic() {
        assert_eq!(apart(|| map(100, |i| i).iter().sum::<usize>()), 4950);
        assert!(std::panic::catch_unwind(|| apart(|| panic!("as expected"))).is_err());
    }

    #[test]
    fn each_iteration_runs_once_and_in_order() {
        for count in [0usize, 1, 7, 1000] {
            let squares: Vec<usize> = (0..count).map(|i| i * i).collect();
            assert_eq!(map(count, |i| i * i), squares);
            assert_eq!(try_map(count, |i| Ok::<_, ()>(i * i)), Ok(squares.clone()));
            let mut values = vec![0; count];
            for_each_chunk(&mut values, 3, |index, chunk| {
                for (k, value) in chunk.iter_mut().enumerate() {
                    *value += (3 * index + k) * (3 * index + k);
                }
            });
            assert_eq!(values, squares);
            let sums: Vec<usize> = squares.chunks(4).map(|c| c.iter().sum()).collect();
            let summed = try_map_chunks(&squares, 4, |c| Ok::<_, ()>(c.iter().sum::<usize>()));
            assert_eq!(summed, Ok(sums));
        }
        let fifth = |i| if i == 5 { Err(i) } else { Ok(()) };
        assert_eq!(try_map(9, fifth), Err(5));
        assert_eq!(try_for_each_chunk(&mut [0; 9], 1, |i, _| fifth(i)), Err(5));
    }
}
