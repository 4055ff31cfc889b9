//! Builder methods of options, which users of the library need because option structs are `non_exhaustive`.

/// Implements a method for each named field of a struct that sets the field.
macro_rules! setters {
    ($name:ident $(<$life:lifetime $(, $parameter:ident)?>)? { $($field:ident: $type:ty),* $(,)? }) => {
        impl $(<$life $(, $parameter)?>)? $name $(<$life $(, $parameter)?>)? {
            $(
                #[doc = concat!("Sets [`", stringify!($field), "`](Self#structfield.", stringify!($field), ").")]
                #[must_use]
                pub fn $field(mut self, $field: $type) -> Self {
                    self.$field = $field;
                    self
                }
            )*
        }
    };
}
