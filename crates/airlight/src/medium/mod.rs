//! What fills the air and where.
