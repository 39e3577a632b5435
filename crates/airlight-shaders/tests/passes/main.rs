//! The passes of the library, drawn on a Vulkan device from WGSL and from SPIR-V, and compared with the f64 library.

mod camera;
mod fog;
mod frame;
mod sky;
mod sky_article;
#[path = "../vulkan/mod.rs"]
mod vulkan;
