//! The library as naga reads it.

use airlight::Named;
use airlight_shaders::{Part, source};
use naga::Module;

/// All parts.
pub fn whole() -> Module {
    naga::front::wgsl::parse_str(&source(Part::ALL))
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source(Part::ALL))))
}
