//! What one particle does to light.
