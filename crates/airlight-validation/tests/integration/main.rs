//! The claims of the accuracy report, and our Monte Carlo against that of others.

mod monte_carlo;
mod report;
