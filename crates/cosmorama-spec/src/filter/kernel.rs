use std::fmt;
use std::str::FromStr;

use cosmorama::filter::{CrossSection, Kernel};

use super::names;
use crate::WordError;

/// A kernel by name, with its parameters: `gaussian:alpha=3,scale=0.6`.
///
/// A value is only made by parsing, so that every kernel has a name to print.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct KernelName {
    /// Weights of the kernel.
    pub kernel: Kernel,
    /// Default of anti-ringing: off for `light`, because clamping would change the total light.
    pub anti_ringing: bool,
}

impl KernelName {
    /// All names with a line of help, in the order of the help.
    pub const NAMES: [(&str, &str); 12] = names::KERNELS;
}

/// Name of the kernel whose shape and table may be chosen.
const GAUSSIAN: &str = "gaussian";

/// Name of the kernel that keeps the light of suns.
const LIGHT: &str = "light";

/// Returns the default kernel.
impl Default for KernelName {
    fn default() -> Self {
        Self { kernel: Kernel::ADAPTIVE, anti_ringing: true }
    }
}

impl FromStr for KernelName {
    type Err = WordError;

    fn from_str(text: &str) -> Result<Self, WordError> {
        let (name, keys) = text.split_once(':').unwrap_or((text, ""));
        let mut kernel = named(name).ok_or_else(|| names::no_kernel(name))?;
        for pair in keys.split(',').filter(|_| !keys.is_empty()) {
            set_pair(&mut kernel, name, pair).map_err(WordError::Parameter)?;
        }
        Ok(Self { kernel, anti_ringing: name != LIGHT })
    }
}

/// Prints the name, and parameters that differ from those of the named kernel.
impl fmt::Display for KernelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kernel, anti_ringing } = *self;
        let Kernel { scale, floor, entries, round, .. } = kernel;
        let scaled = |other: Kernel| Kernel { scale, floor, entries, round, ..other };
        let of_name = |name: &&str| (*name == LIGHT) != anti_ringing && named(name).map(scaled) == Some(kernel);
        let name = Self::NAMES.iter().map(|(name, _)| *name).find(of_name).unwrap_or(GAUSSIAN);
        let usual = named(name).unwrap_or(kernel);
        let mut keys = Vec::new();
        if let (CrossSection::Gaussian { alpha, cutoff }, CrossSection::Gaussian { alpha: two, cutoff: one }) =
            (kernel.fine, usual.fine)
        {
            keys.extend([("alpha", alpha, two), ("cutoff", cutoff, one)]);
        }
        let entries = |kernel: Kernel| kernel.entries as f64;
        keys.extend([("scale", kernel.scale, usual.scale), ("floor", kernel.floor, usual.floor)]);
        keys.push(("table", entries(kernel), entries(usual)));
        f.write_str(name)?;
        let given = keys.into_iter().filter(|(_, value, usual)| value != usual);
        given.enumerate().try_for_each(|(index, (key, value, _))| {
            let separator = if index == 0 { ":" } else { "," };
            write!(f, "{separator}{key}={value}")
        })
    }
}

fn named(name: &str) -> Option<Kernel> {
    let cross_section = match name {
        "adaptive" => return Some(Kernel::ADAPTIVE),
        LIGHT => return Some(Kernel::LIGHT),
        GAUSSIAN => CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 },
        "mitchell" => CrossSection::MITCHELL,
        "robidoux" => CrossSection::ROBIDOUX,
        "robidoux-sharp" => CrossSection::ROBIDOUX_SHARP,
        "catmull-rom" => CrossSection::CATMULL_ROM,
        "lanczos2" => CrossSection::JincJinc { lobes: 2, blur: 1.0 },
        "lanczos3" => CrossSection::JincJinc { lobes: 3, blur: 1.0 },
        // N. Robidoux's factor, as ImageMagick's LanczosSharp has it: the kernel keeps vertical lines as they are.
        "lanczos3-sharp" => CrossSection::JincJinc { lobes: 3, blur: 0.981_250_522_384_614_2 },
        "tent" => CrossSection::Tent,
        "box" => CrossSection::Box,
        _ => return None,
    };
    Some(Kernel::uniform(cross_section))
}

fn set_pair(kernel: &mut Kernel, name: &str, pair: &str) -> Result<(), String> {
    let (key, value) = pair.split_once('=').ok_or_else(|| format!("'{pair}' is no key=value"))?;
    if (name, key) == (GAUSSIAN, "table") {
        kernel.entries =
            value.parse().ok().filter(|entries| (2..=Kernel::MOST_ENTRIES).contains(entries)).ok_or_else(|| {
                format!("table={value}: expected a number of entries from 2 to {}", Kernel::MOST_ENTRIES)
            })?;
        return Ok(());
    }
    let value =
        within_reach(value).ok_or_else(|| format!("{key}={value}: expected a number more than 0, at most {MOST}"))?;
    set(kernel, name, key, value)
}

fn set(kernel: &mut Kernel, name: &str, key: &str, value: f64) -> Result<(), String> {
    match (key, &mut kernel.fine) {
        ("scale", _) => kernel.scale = value,
        ("floor", _) => kernel.floor = value,
        // A Gaussian of another shape would not keep the total light.
        _ if name == LIGHT => return Err(format!("unknown key '{key}' for {name}; it takes scale, floor")),
        ("alpha", CrossSection::Gaussian { alpha, .. }) => *alpha = value,
        ("cutoff", CrossSection::Gaussian { cutoff, .. }) => *cutoff = value,
        (_, CrossSection::Gaussian { .. }) => {
            return Err(format!("unknown key '{key}' for {name}; it takes alpha, cutoff, table, scale, floor"));
        }
        _ => return Err(format!("unknown key '{key}' for {name}; it takes scale, floor")),
    }
    if let CrossSection::Gaussian { .. } = kernel.fine {
        kernel.coarse = kernel.fine;
    }
    Ok(())
}

/// Greatest scale of a kernel; more is a typing error that would take hours.
const MOST: f64 = 32.0;

fn within_reach(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| *number > 0.0 && *number <= MOST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_kernel_is_answered_by_what_was_meant() {
        let refused = |text: &str| text.parse::<KernelName>().unwrap_err().to_string();
        assert_eq!(refused("ewa"), "'ewa' is no kernel; that is a filter: ewa");
        assert_eq!(refused("nearest"), "'nearest' is no kernel; that is a filter: point");
        assert!(refused("bicubic").contains("did you mean 'catmull-rom'?"));
        assert!(refused("Lanczos:scale=1").starts_with("unknown kernel 'Lanczos'; did you mean 'lanczos3'?"));
        assert!(refused("mitchel").contains("did you mean 'mitchell'?"));
        assert!(refused("sharp").starts_with("unknown kernel 'sharp'; there are adaptive, gaussian"));
    }

    #[test]
    fn kernels_with_parameters() {
        let KernelName { kernel, .. } = "gaussian:alpha=3,cutoff=1.5,scale=0.6".parse().unwrap();
        let gaussian = CrossSection::Gaussian { alpha: 3.0, cutoff: 1.5 };
        assert_eq!(kernel, Kernel { scale: 0.6, ..Kernel::uniform(gaussian) });
        let tabled: KernelName = "gaussian:alpha=2,cutoff=1,table=4096".parse().unwrap();
        assert_eq!((tabled.kernel.entries, tabled.to_string().as_str()), (4096, "gaussian:table=4096"));
        let light: KernelName = "light".parse().unwrap();
        let written: KernelName = "gaussian:cutoff=2,scale=1.4,floor=1.4".parse().unwrap();
        assert_eq!(light, KernelName { anti_ringing: false, ..written });
        let listed = "nothing".parse::<KernelName>().unwrap_err().to_string();
        for (name, _) in KernelName::NAMES {
            assert!(name.parse::<KernelName>().is_ok() && listed.contains(name), "{name}");
            assert!(format!("{name}:scale=0.5,floor=0.75").parse::<KernelName>().is_ok(), "{name}");
        }
        for wrong in [
            "gauss",
            "mitchell:alpha=2",
            "box:scale=0",
            "mitchell:scale=1000",
            "tent:floor=nan",
            "box:scale",
            "gaussian:sigma=1",
            "gaussian:table=1",
            "gaussian:table=0.5",
            "mitchell:table=64",
            "light:alpha=9",
        ] {
            assert!(wrong.parse::<KernelName>().is_err(), "{wrong}");
        }
    }
}
