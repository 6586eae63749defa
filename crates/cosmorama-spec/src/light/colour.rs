use std::fmt;
use std::str::FromStr;

use cosmorama::raster::{ColourChannel, Rgba, Transfer};

use crate::nearest;

/// A colour as premultiplied linear light, typed as a name, `#rrggbb` or `#rrggbbaa` (sRGB), or `r,g,b[,a]` in linear
/// light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub Rgba);

/// Named colours, as on the web.
const NAMES: [(&str, &str); 11] = [
    ("black", "000000"),
    ("white", "ffffff"),
    ("grey", "808080"),
    ("gray", "808080"),
    ("red", "ff0000"),
    ("lime", "00ff00"),
    ("green", "008000"),
    ("blue", "0000ff"),
    ("cyan", "00ffff"),
    ("magenta", "ff00ff"),
    ("yellow", "ffff00"),
];

/// Prints linear light, `r,g,b` or `r,g,b,a`, or `transparent`.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Rgba([red, green, blue, alpha]) = self.0;
        if self.0 == Rgba::TRANSPARENT {
            return f.write_str("transparent");
        }
        if alpha == 1.0 {
            return write!(f, "{red},{green},{blue}");
        }
        let [red, green, blue] = [red, green, blue].map(|light| unweighted(light, alpha));
        write!(f, "{red},{green},{blue},{alpha}")
    }
}

/// Returns the light that gives exactly this when multiplied by alpha, if such a number exists.
fn unweighted(light: f32, alpha: f32) -> f32 {
    let near = light / alpha;
    [near, near.next_up(), near.next_down()].into_iter().find(|other| other * alpha == light).unwrap_or(near)
}

impl FromStr for Colour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = NAMES.iter().find(|(name, _)| *name == text).map(|(_, code)| *code);
        let colour = match named.or(text.strip_prefix('#')) {
            Some(code) => hexadecimal(code),
            None if text == "transparent" => Some(Rgba::TRANSPARENT),
            None => linear(text),
        };
        let names: Vec<_> = NAMES.iter().map(|(name, _)| *name).collect();
        colour.map(Self).ok_or_else(|| {
            let is_nothing = ["none", "clear", "alpha", "empty", "skip", "ignore", "allow"].contains(&text);
            let meant = if is_nothing { Some("transparent") } else { nearest(text, &names) };
            format!(
                "expected #rrggbb or #rrggbbaa (sRGB), r,g,b or r,g,b,a (linear light), transparent or one of {}{}",
                names.join(", "),
                meant.map_or_else(String::new, |meant| format!("; did you mean '{meant}'?"))
            )
        })
    }
}

fn hexadecimal(code: &str) -> Option<Rgba> {
    if !matches!(code.len(), 6 | 8) || !code.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let byte = |at: usize| u8::from_str_radix(&code[at..at + 2], 16).ok().map(|byte| f64::from(byte) / 255.0);
    let light = |at: usize, channel| byte(at).map(|code| Transfer::Srgb.decode(code, channel) as f32);
    let alpha = if code.len() == 8 { byte(6)? as f32 } else { 1.0 };
    Some(
        Rgba::opaque(light(0, ColourChannel::Red)?, light(2, ColourChannel::Green)?, light(4, ColourChannel::Blue)?)
            * alpha,
    )
}

fn linear(text: &str) -> Option<Rgba> {
    let numbers: Vec<f32> = text.split(',').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
    if !numbers.iter().all(|number| number.is_finite() && *number >= 0.0) {
        return None;
    }
    match numbers[..] {
        [red, green, blue] => Some(Rgba::opaque(red, green, blue)),
        [red, green, blue, alpha] if alpha <= 1.0 => Some(Rgba::opaque(red, green, blue) * alpha),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Rgba {
        text.parse::<Colour>().unwrap().0
    }

    #[test]
    fn colours() {
        assert_eq!(parsed("white"), Rgba::opaque(1.0, 1.0, 1.0));
        assert_eq!(parsed("#ff000080").alpha(), 128.0 / 255.0);
        assert!((parsed("#808080").0[0] - 0.2158605).abs() < 1e-6);
        assert_eq!(parsed("0.5,1,2"), Rgba::opaque(0.5, 1.0, 2.0));
        assert_eq!(parsed("transparent"), Rgba::TRANSPARENT);
        for wrong in ["beige", "#12345", "#12345g", "1,2", "-1,0,0", "0,0,0,2", ""] {
            assert!(wrong.parse::<Colour>().is_err(), "{wrong}");
        }
    }
}
