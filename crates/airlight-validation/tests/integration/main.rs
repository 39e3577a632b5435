//! Claims of the accuracy report, and comparison of the Monte Carlo with another code.

#[cfg(feature = "gpu")]
mod frames;
mod monte_carlo;
mod report;
