//! `Debug` of types that hold large tables: some of their fields, and dots for the rest.

/// Implements `Debug` with the listed fields.
macro_rules! debug_fields {
    ($type:ident $(<const $n:ident: usize>)? { $($field:ident),* }) => {
        impl $(<const $n: usize>)? std::fmt::Debug for $type $(<$n>)? {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_struct(stringify!($type))
                    $(.field(stringify!($field), &self.$field))*
                    .finish_non_exhaustive()
            }
        }
    };
}

pub(crate) use debug_fields;
