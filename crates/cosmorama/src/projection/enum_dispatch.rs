//! Enums whose variants each hold one type, generated from a list.

/// Generates an enum whose variants each hold one type, and the macro `each!`, which runs the same code on whichever is
/// inside. `all` returns the examples in the list's order.
///
/// `($)` comes first because `each!` needs a `$` to be written with. Modules that use `each!` must come after the list.
macro_rules! enum_dispatch {
    (($d:tt) $(#[$about:meta])* pub enum $Kind:ident {
        $($(#[$what:meta])* $Variant:ident($held:ty) = $examples:expr,)*
    }) => {
        enum_dispatch! { ($d) $(#[$about])* pub enum $Kind { $($(#[$what])* $Variant($held),)* } }

        impl $Kind {
            /// Returns examples of every variant, for tests and listings; some variants have several.
            pub fn all() -> Vec<Self> {
                let mut all = Vec::new();
                $(all.extend($examples.into_iter().map(Self::$Variant));)*
                all
            }
        }
    };
    (($d:tt) $(#[$about:meta])* pub enum $Kind:ident {
        $($(#[$what:meta])* $Variant:ident($held:ty),)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $Kind {
            $($(#[$what])* $Variant($held),)*
        }

        $(impl From<$held> for $Kind {
            fn from(held: $held) -> Self {
                Self::$Variant(held)
            }
        })*

        macro_rules! each {
            ($d kind:expr, $d inside:ident => $d call:expr) => {
                match $d kind {
                    $($Kind::$Variant($d inside) => $d call,)*
                }
            };
        }
    };
}

pub(crate) use enum_dispatch;
