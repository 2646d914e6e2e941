//! Methods by which structs that grow are built: what a version adds has a default, and no caller has to name it.

/// For each field of a struct, defines a method of the same name that sets it; where some have none, the struct stands by
/// itself, and those that have one are listed.
#[macro_export]
macro_rules! setters {
    ($(#[$about:meta])* pub struct $of:ident { $($(#[$doc:meta])* pub $field:ident: $value:ty),+ $(,)? }) => {
        $(#[$about])*
        pub struct $of {
            $($(#[$doc])* pub $field: $value,)+
        }

        $crate::setters!($of { $($field: $value),+ });

        impl $of {
            /// All fields in their order: code that takes every one of them does not compile before it takes a new one too.
            #[doc(hidden)]
            #[allow(clippy::type_complexity)]
            pub fn fields(self) -> ($($value,)+) {
                ($(self.$field,)+)
            }
        }
    };
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
