//! Names of filters and kernels, and the corresponding words of other programs.

use cosmorama::filter::Classic;

use crate::error::{WordError, WordKind, nearest};

/// Filters that are not of the literature, each with a line of help.
const OWN: [(&str, &str); 5] = [
    ("ewa", "Elliptical weighted average of all texels under a pixel"),
    ("ewa-pyramid", "The same from smaller copies: bounded time at any shrink, about 40 dB from ewa"),
    ("point", "The texel under a pixel's centre"),
    ("bilinear", "Four texels around a pixel's centre"),
    ("reference", "Brute force, N by N samples a pixel (:samples=N, 1 to 64)"),
];

/// Number of filters.
const COUNT: usize = OWN.len() + Classic::NAMES.len();

/// Filters, each with a line of help: our own, and those of the library's table.
pub(super) const FILTERS: [(&str, &str); COUNT] = {
    let mut filters = [("", ""); COUNT];
    let mut k = 0;
    while k < COUNT {
        filters[k] = if k < OWN.len() { OWN[k] } else { Classic::NAMES[k - OWN.len()] };
        k += 1;
    }
    filters
};

/// Kernels, each with a line of help.
pub(super) const KERNELS: [(&str, &str); 12] = [
    ("adaptive", "A sharp cubic, softer the more texels a pixel holds"),
    ("gaussian", "Heckbert's Gaussian; takes alpha=, cutoff= and table=, too"),
    ("mitchell", "Mitchell and Netravali's cubic"),
    ("robidoux", "Robidoux's cubic, soft"),
    ("robidoux-sharp", "Robidoux's sharper cubic"),
    ("catmull-rom", "Catmull and Rom's cubic, which others call bicubic"),
    ("lanczos2", "Jinc windowed by jinc, two lobes"),
    ("lanczos3", "Jinc windowed by jinc, three lobes"),
    ("lanczos3-sharp", "The same, a little sharper, as ImageMagick's LanczosSharp"),
    ("tent", "A cone over a disc"),
    ("box", "A disc of equal weights"),
    ("light", "A wide Gaussian that keeps the light of suns"),
];

/// Other programs' words for kernels, each with our name.
const KERNEL_WORDS: [(&str, &str); 14] = [
    ("bicubic", "catmull-rom"),
    ("cubic", "catmull-rom"),
    ("catrom", "catmull-rom"),
    ("catmull", "catmull-rom"),
    ("catmullrom", "catmull-rom"),
    ("spline", "mitchell"),
    ("mitchell-netravali", "mitchell"),
    ("gauss", "gaussian"),
    ("lanczos", "lanczos3"),
    ("lanczos4", "lanczos3"),
    ("sinc", "lanczos3"),
    ("jinc", "lanczos3"),
    ("triangle", "tent"),
    ("hat", "tent"),
];

/// Other programs' words for filters, each with our name.
const FILTER_WORDS: [(&str, &str); 15] = [
    ("nearest", "point"),
    ("near", "point"),
    ("neighbor", "point"),
    ("neighbour", "point"),
    ("none", "point"),
    ("linear", "bilinear"),
    ("mip", "mipmap"),
    ("trilinear", "mipmap"),
    ("sat", "summed-area"),
    ("perlin", "repeated-integration"),
    ("2-pass", "two-pass"),
    ("pyramid", "ewa-pyramid"),
    ("supersampling", "reference"),
    ("supersample", "reference"),
    ("samples", "reference"),
];

/// Returns a filter's name with the key that it takes, if any; `None` of one that is another with a key.
fn with_key(name: &str) -> Option<&str> {
    Some(match name {
        "reference" => "reference[:samples=N]",
        "mipmap" => "mipmap[:levels=nearest|trilinear]",
        "mipmap:levels=nearest" => return None,
        "repeated-integration" => "repeated-integration[:order=N]",
        name => name,
    })
}

/// Returns the keys that a filter takes, or else all that there are.
fn no_such_key(name: &str) -> &'static str {
    match name {
        "ewa-pyramid" => "ewa-pyramid takes no key: it always interpolates between two levels",
        "mipmap" => "mipmap takes levels=nearest or levels=trilinear",
        _ => {
            "reference takes samples=N, as in reference:samples=8, repeated-integration order=N, and mipmap \
             levels=nearest or trilinear; others with a second word are ewa:paper and ewa:integer"
        }
    }
}

/// Returns the error for a text that is not the name of a filter, with a suggestion.
pub(super) fn no_filter(text: &str) -> WordError {
    let name = text.split(':').next().unwrap_or_default();
    let keys = &text[name.len()..];
    let (names, word) = (FILTERS.map(|(name, _)| name), text.to_owned());
    if names.contains(&name) {
        return WordError::Parameter(format!("'{text}': {}", no_such_key(name)));
    }
    if let Some(kernel) = meaning(&KERNEL_WORDS, name) {
        return of_other(WordKind::Filter, text, WordKind::Kernel, kernel.to_owned());
    }
    match meaning(&FILTER_WORDS, name).map(Meant::Own).or_else(|| nearer(name, &names, &KERNELS.map(|(name, _)| name)))
    {
        Some(Meant::Other(kernel)) => of_other(WordKind::Filter, text, WordKind::Kernel, format!("{kernel}{keys}")),
        meant => WordError::Unknown {
            what: WordKind::Filter,
            word,
            meant: meant.map(Meant::name),
            known: names.into_iter().filter_map(with_key).collect::<Vec<_>>().join(", "),
        },
    }
}

/// Returns the error for a text that is not the name of a kernel, with a suggestion.
pub(super) fn no_kernel(name: &str) -> WordError {
    let names = KERNELS.map(|(name, _)| name);
    if let Some(filter) = meaning(&FILTER_WORDS, name) {
        return of_other(WordKind::Kernel, name, WordKind::Filter, filter.to_owned());
    }
    match meaning(&KERNEL_WORDS, name).map(Meant::Own).or_else(|| nearer(name, &names, &FILTERS.map(|(name, _)| name)))
    {
        Some(Meant::Other(filter)) => of_other(WordKind::Kernel, name, WordKind::Filter, filter.to_owned()),
        meant => WordError::Unknown {
            what: WordKind::Kernel,
            word: name.to_owned(),
            meant: meant.map(Meant::name),
            known: names.join(", "),
        },
    }
}

fn of_other(what: WordKind, word: &str, of: WordKind, name: String) -> WordError {
    WordError::OfOther { what, word: word.to_owned(), of, name }
}

/// A name that was meant: one of those that were expected, or one of the other setting.
enum Meant<'w> {
    Own(&'w str),
    Other(&'w str),
}

impl Meant<'_> {
    fn name(self) -> String {
        match self {
            Self::Own(name) | Self::Other(name) => name.to_owned(),
        }
    }
}

/// Finds the name that is most like a word, among those that were expected and those of the other setting.
fn nearer<'w>(word: &str, own: &[&'w str], other: &[&'w str]) -> Option<Meant<'w>> {
    // Of two equally similar names, the last wins.
    let name = nearest(word, &[other, own].concat())?;
    Some(if own.contains(&name) { Meant::Own(name) } else { Meant::Other(name) })
}

fn meaning<'w>(words: &[(&str, &'w str)], word: &str) -> Option<&'w str> {
    words.iter().find(|(other, _)| other.eq_ignore_ascii_case(word)).map(|(_, ours)| *ours)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FilterName, KernelName};

    #[test]
    fn other_words_mean_what_there_is() {
        for (word, ours) in KERNEL_WORDS {
            assert!(ours.parse::<KernelName>().is_ok() && word.parse::<KernelName>().is_err(), "{word}");
        }
        for (typed, kernel) in
            [("lanzcos3", "lanczos3"), ("michell:scale=2", "mitchell:scale=2"), ("Adaptive", "adaptive")]
        {
            let message = typed.parse::<FilterName>().unwrap_err().to_string();
            assert_eq!(message, format!("'{typed}' is no filter; that is a kernel: {kernel}"));
        }
        assert!("bilinaer".parse::<KernelName>().unwrap_err().to_string().ends_with("that is a filter: bilinear"));
        for (word, ours) in FILTER_WORDS {
            assert!(ours.parse::<FilterName>().is_ok() && word.parse::<FilterName>().is_err(), "{word}");
        }
    }
}
