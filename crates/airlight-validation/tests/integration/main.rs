//! Claims of the accuracy report, and comparison of the Monte Carlo with another code.

mod monte_carlo;
mod report;
