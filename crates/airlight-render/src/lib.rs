//! Cameras, pictures in and out, tone curves.
