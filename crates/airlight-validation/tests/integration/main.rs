//! Claims of the accuracy report, and comparison of the Monte Carlo with another code.

#[cfg(feature = "gpu")]
mod frames;
#[cfg(feature = "gpu")]
mod hillaire2020;
mod monte_carlo;
mod report;
