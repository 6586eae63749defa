use std::error::Error as StdError;
use std::ffi::OsStr;
use std::marker::PhantomData;
use std::str::FromStr;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};
use cosmorama_spec::{DepthName, FilterName, KernelName, PrimariesName, Spec, SpecKind, TransferName};

/// Parser of a value that begins with one of some names, which completions offer.
///
/// It also reads other values, such as names of other programs and keys behind a name.
#[derive(Clone, Debug)]
pub(crate) struct Listed<T> {
    names: Vec<(&'static str, &'static str)>,
    of: PhantomData<fn() -> T>,
}

impl<T> Listed<T> {
    /// Reads a value that may begin with one of these names.
    pub(crate) fn new(names: impl IntoIterator<Item = (&'static str, &'static str)>) -> Self {
        Self { names: names.into_iter().collect(), of: PhantomData }
    }
}

impl<T> TypedValueParser for Listed<T>
where
    T: FromStr + Clone + Send + Sync + 'static,
    T::Err: Into<Box<dyn StdError + Send + Sync>>,
{
    type Value = T;

    fn parse_ref(&self, cmd: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<T, Error> {
        T::from_str.parse_ref(cmd, arg, value)
    }

    // For completions and manual pages.
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names.iter().map(|(name, about)| PossibleValue::new(*name).help(*about))))
    }
}

/// Reads any word, and lists some.
pub(crate) fn word(names: impl IntoIterator<Item = (&'static str, &'static str)>) -> Listed<String> {
    Listed::new(names)
}

/// Reads a SPEC. Other programs' names are offered, too.
pub(crate) fn spec() -> Listed<Spec> {
    Listed::new(SpecKind::all().map(|kind| (kind.name(), kind.about())).chain(SpecKind::other_names()))
}

/// Reads a sample type.
pub(crate) fn depth() -> Listed<DepthName> {
    Listed::new(DepthName::ALL.map(|depth| (depth.name(), depth.about())))
}

/// Reads the name of a filter.
pub(crate) fn filter() -> Listed<FilterName> {
    Listed::new(FilterName::NAMES.iter().copied())
}

/// Reads the name of a kernel.
pub(crate) fn kernel() -> Listed<KernelName> {
    Listed::new(KernelName::NAMES)
}

/// Reads the name of primaries.
pub(crate) fn primaries() -> Listed<PrimariesName> {
    Listed::new(PrimariesName::NAMES)
}

/// Reads the name of a transfer function.
pub(crate) fn transfer() -> Listed<TransferName> {
    Listed::new(TransferName::NAMES)
}
