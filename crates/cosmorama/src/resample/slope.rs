//! Anti-ringing at the rim of a lens, where the last texels that count may lie half a texel before the pixel.
//!
//! Clamped to what those hold, every slope would end flat, and the picture be displaced there by up to a pixel. So a
//! slope goes on beyond them. What tells it from a step, a dot or a sun is the middle texel: of a slope's it is far from
//! both the least and the greatest, of the others' it is one of the two, or nearly so.

use crate::raster::Rgba;

/// The channel that may not go beyond one.
const ALPHA: usize = 3;

/// An average as its texels bound it; alpha by what they hold, and no light becomes negative.
pub(super) fn clamp(average: Rgba, texels: impl Iterator<Item = Rgba> + Clone) -> Rgba {
    let mut values = Vec::new();
    // Where light is mixed with transparency, colour must stay within alpha.
    let is_opaque = texels.clone().all(|texel| texel.alpha() >= 1.0);
    Rgba(std::array::from_fn(|c| {
        let channel = || texels.clone().map(|texel| texel.0[c]);
        let least = channel().fold(f32::INFINITY, f32::min);
        let greatest = channel().fold(f32::NEG_INFINITY, f32::max);
        let value = average.0[c];
        if (least..=greatest).contains(&value) || least > greatest {
            return value;
        }
        if c == ALPHA || !is_opaque {
            return value.clamp(least, greatest);
        }
        values.clear();
        values.extend(channel());
        beyond(value, least, middle(&mut values), greatest)
    }))
}

/// The value in the middle of at least one.
fn middle(values: &mut [f32]) -> f32 {
    let half = values.len() / 2;
    *values.select_nth_unstable_by(half, f32::total_cmp).1
}

/// A value that is less than the least or more than the greatest: as far as there is room for a slope.
fn beyond(value: f32, least: f32, middle: f32, greatest: f32) -> f32 {
    let room = (middle - least).min(greatest - middle);
    if value < least {
        // Light does not become negative: where a slope would, it is none.
        let room = if least >= 0.0 { room.min(least) } else { room };
        least - kept(least - value, room)
    } else {
        greatest + kept(value - greatest, room)
    }
}

/// What stays of an excess: all of it while there is room, then less and less, since what goes so far is no slope.
fn kept(excess: f32, room: f32) -> f32 {
    excess.min(2.0 * room - excess).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clamp_grey(value: f32, texels: &[f32]) -> f32 {
        let texels: Vec<Rgba> = texels.iter().map(|&grey| Rgba::opaque(grey, grey, grey)).collect();
        clamp(Rgba::opaque(value, value, value), texels.iter().copied()).0[0]
    }

    #[test]
    fn a_slope_goes_on() {
        let slope = [1.0, 1.1, 1.2, 1.3, 1.4];
        for value in [0.85, 1.0, 1.25, 1.4, 1.55] {
            assert_eq!(clamp_grey(value, &slope), value);
        }
    }

    #[test]
    fn what_is_no_slope_goes_nowhere() {
        let sun = [1.0, 1.0, 1.0, 1.0, 1e6, 30.0, 1.1];
        assert_eq!(clamp_grey(-5e4, &sun), 1.0);
        assert_eq!(clamp_grey(2e6, &sun), 1e6);
        let step = [0.2, 0.2, 0.9, 0.9, 0.9];
        assert_eq!(clamp_grey(0.1, &step), 0.2);
        assert_eq!(clamp_grey(1.0, &step), 0.9);
        let dot = [0.5, 0.5, 0.5, 0.1];
        assert_eq!(clamp_grey(0.0, &dot), 0.1);
    }

    #[test]
    fn light_stays_positive_and_alpha_within_what_there_is() {
        let dark = [0.125, 0.25, 0.5, 0.75, 1.0];
        assert_eq!([0.0625, -0.0625, -5.0].map(|value| clamp_grey(value, &dark)), [0.0625, 0.0625, 0.125]);
        let veils = [0.2, 0.6, 1.0].map(|alpha| Rgba([alpha; 4]));
        assert_eq!(clamp(Rgba([1.1; 4]), veils.into_iter()).0, [1.0; 4]);
        assert_eq!(clamp(Rgba([0.3; 4]), std::iter::empty()).0, [0.3; 4]);
    }
}
