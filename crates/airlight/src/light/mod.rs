//! What shines.
