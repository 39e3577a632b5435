//! Picture and depth files, checked against independent decoders and encoders.

mod arrays;
mod common;
mod enlarge;
mod frames;
mod intrinsics;
mod join;
mod memory;
mod picture_files;
mod pictures;
mod read_colours;
mod read_depth_files;
mod read_depths;
mod read_exr;
mod read_pictures;
mod read_robust;
mod read_tiff;
mod round_trips;
mod terminal;
mod tone;
