//! The Python module `airlight`: the libraries of Airlight over NumPy arrays, with the same words.
//!
//! - [`compute`]: threads, the lock of the interpreter, and Ctrl-C; [`errors`]: exceptions; [`arrays`]: directions and pictures.
//! - [`atmosphere`], [`sun`], [`sky`], [`scene`], [`picture`], [`fog`], [`batch`], [`mie`], [`accuracy`], [`openjd`]: the classes and
//!   functions of Python.
//!
//! What is only Python, such as xarray output and transforms for training, is in `python/airlight`.

mod accuracy;
mod arrays;
mod atmosphere;
mod batch;
mod compute;
mod errors;
mod fog;
mod mie;
mod openjd;
mod picture;
mod scene;
mod sky;
mod sun;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<atmosphere::Atmosphere>()?;
    module.add_class::<sky::Sky>()?;
    module.add_class::<sky::View>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<scene::RadianceView>()?;
    module.add_class::<picture::Picture>()?;
    module.add_class::<fog::Fog>()?;
    module.add_class::<mie::Particles>()?;
    module.add_class::<accuracy::AccuracyReport>()?;
    module.add_function(wrap_pyfunction!(accuracy::accuracy, module)?)?;
    module.add_function(wrap_pyfunction!(batch::fog_batch, module)?)?;
    module.add_function(wrap_pyfunction!(batch::job_of_batch, module)?)?;
    module.add_function(wrap_pyfunction!(mie::mie_phase, module)?)?;
    module.add_function(wrap_pyfunction!(mie::mie_sphere, module)?)?;
    module.add_function(wrap_pyfunction!(openjd::job_of_command, module)?)?;
    module.add_function(wrap_pyfunction!(openjd::job_of_scene, module)?)?;
    module.add_function(wrap_pyfunction!(scene::models, module)?)?;
    module.add_function(wrap_pyfunction!(sun::sun_position, module)?)?;
    module.add_function(wrap_pyfunction!(sun::unix_time, module)?)?;
    module.add_function(wrap_pyfunction!(sun::direction, module)?)?;
    module.add_function(wrap_pyfunction!(picture::read_picture, module)?)?;
    module.add_function(wrap_pyfunction!(picture::read_depth, module)?)?;
    module.add_function(wrap_pyfunction!(picture::write_picture, module)?)?;
    Ok(())
}
