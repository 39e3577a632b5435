//! The table of functions: for each its twin, inputs, and the value in f64.

mod air;
mod article;
mod colour;
mod fog;
mod fog_table;
mod lights;
mod marched_air;
mod phase;
mod shadows;
mod sky_tables;

use crate::flat::FlatFunction;
use crate::random::Random;

/// A function of f64 numbers.
pub type Exact = Box<dyn Fn(&[f64]) -> Vec<f64>>;

/// A function of the library.
pub struct Row {
    pub name: &'static str,
    pub twin: FlatFunction,
    /// The arguments as one row of numbers, random or singular.
    pub inputs: fn(&mut Random) -> Vec<f32>,
    /// The value by the f64 library, or by f64 arithmetic where it has no public function.
    pub exact: Exact,
}

/// Rows of twins in a module: `name(inputs) = exact`.
macro_rules! rows {
    ($module:path { $($name:ident: $inputs:expr => $exact:expr;)+ }) => {{
        use $module::*;
        vec![$(crate::rows::Row {
            name: stringify!($name),
            twin: crate::flat::Twin::flat($name),
            inputs: $inputs,
            exact: Box::new($exact),
        }),+]
    }};
}

pub(crate) use rows;

/// All functions.
pub fn all() -> Vec<Row> {
    let mut all = air::exponentials();
    all.extend(phase::phase());
    all.extend(air::path_optics());
    all.extend(air::columns());
    all.extend(fog::fog());
    all.extend(marched_air::marched_air());
    all.extend(lights::lights());
    all.extend(shadows::shadows());
    all.extend(sky_tables::sky_tables());
    all.extend(colour::colour_functions());
    all.extend(colour::tone());
    all.extend(colour::dither());
    all.extend(colour::disc());
    all.extend(article::article());
    all.extend(fog_table::fog_table());
    all
}
