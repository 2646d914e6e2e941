//! Methods by which structs that grow are built: what a version adds has a default, and no caller has to name it.

/// For each named field, defines a method of the same name that sets it.
#[macro_export]
macro_rules! setters {
    ($of:ident { $($field:ident: $value:ty),+ $(,)? }) => {
        impl $of {
            $(
                #[doc = concat!("Sets `", stringify!($field), "`; the field says what it means.")]
                #[must_use]
                pub fn $field(mut self, $field: $value) -> Self {
                    self.$field = $field;
                    self
                }
            )+
        }
    };
}
