//! Closed choices from one list.

/// An enum of variants that hold a type each, from one list, and `each!`, which does the same with whatever is inside. Where
/// the lines give examples, `all` has them in the list's order.
///
/// `($)` comes first, so that there is one to write `each!` with. Modules that use `each!` stand after the list.
macro_rules! enum_dispatch {
    (($d:tt) $(#[$about:meta])* pub enum $Kind:ident {
        $($(#[$what:meta])* $Variant:ident($held:ty) = $examples:expr,)*
    }) => {
        enum_dispatch! { ($d) $(#[$about])* pub enum $Kind { $($(#[$what])* $Variant($held),)* } }

        impl $Kind {
            /// One of each, for tests and listings; several of those with parameters.
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
