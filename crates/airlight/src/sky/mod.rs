//! The solver for a spherical, multiply scattering atmosphere.
