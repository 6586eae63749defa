use font8x8::legacy::BASIC_LEGACY;
use glam::DVec2;

/// A line of text on a wall: x to the reader's right, y up, in metres.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Line {
    /// ASCII.
    pub(in crate::demo) text: &'static str,
    pub(in crate::demo) middle: DVec2,
    /// Height of a letter's cell, which is as wide as it is high.
    pub(in crate::demo) height: f64,
}

impl Line {
    /// Returns the width of the whole line.
    pub(in crate::demo) const fn width(&self) -> f64 {
        self.text.len() as f64 * self.height
    }
}

/// Returns whether a point of the wall is covered by ink.
pub(in crate::demo) fn covers(line: &Line, point: DVec2) -> bool {
    let from_top_left =
        DVec2::new(point.x - line.middle.x + line.width() / 2.0, line.middle.y + line.height / 2.0 - point.y);
    let dots = (from_top_left * (8.0 / line.height)).floor();
    if dots.x < 0.0 || !(0.0..8.0).contains(&dots.y) {
        return false;
    }
    let (column, row) = (dots.x as usize, dots.y as usize);
    let Some(&letter) = line.text.as_bytes().get(column / 8) else { return false };
    // The font's lowest bit is the leftmost dot.
    BASIC_LEGACY.get(usize::from(letter)).is_some_and(|glyph| glyph[row] >> (column % 8) & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_stands_upright_and_reads_from_the_left() {
        let line = Line { text: "L", middle: DVec2::ZERO, height: 8.0 };
        // Row by row from the top: the stem is left of the middle, the foot reaches to the right.
        let ink_right_of_stem = |y: f64| (0..4).any(|x| covers(&line, DVec2::new(f64::from(x) + 0.5, y)));
        assert!(covers(&line, DVec2::new(-1.5, 1.5)));
        assert!(!ink_right_of_stem(1.5));
        assert!(ink_right_of_stem(-2.5));
    }
}
