//! A small SVG writer. Shapes are in document order and numbers are rounded, so that a figure's bytes are reproducible.

use std::fmt::Write as _;

use super::lettering;

/// A point of a drawing in its units: x to the right, y down.
pub(crate) type Point = (f64, f64);

/// An upright rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

/// Paint of a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Paint<'a> {
    pub(crate) fill: &'a str,
    pub(crate) stroke: &'a str,
    pub(crate) stroke_width: f64,
    pub(crate) opacity: f64,
    pub(crate) dashed: bool,
}

impl<'a> Paint<'a> {
    pub(crate) const fn fill(colour: &'a str) -> Self {
        Self { fill: colour, stroke: "none", stroke_width: 0.0, opacity: 1.0, dashed: false }
    }

    pub(crate) const fn stroke(colour: &'a str, width: f64) -> Self {
        Self { fill: "none", stroke: colour, stroke_width: width, opacity: 1.0, dashed: false }
    }

    pub(crate) const fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    pub(crate) const fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }
}

/// Point of a label that is at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
}

/// An SVG document under construction.
#[derive(Clone, Debug)]
pub(crate) struct Drawing {
    width: f64,
    height: f64,
    body: String,
}

impl Drawing {
    /// Creates an empty sheet.
    pub(crate) fn new(width: f64, height: f64, background: &str) -> Self {
        let mut drawing = Self { width, height, body: String::new() };
        drawing.rect(Rect { x: 0.0, y: 0.0, width, height }, Paint::fill(background));
        drawing
    }

    pub(crate) fn rect(&mut self, frame: Rect, paint: Paint) {
        let Rect { x, y, width, height } = frame;
        let (x, y, width, height) = (Number(x), Number(y), Number(width), Number(height));
        self.shape(&format!(r#"rect x="{x}" y="{y}" width="{width}" height="{height}""#), paint);
    }

    /// Draws many rectangles with one paint.
    pub(crate) fn rects(&mut self, frames: &[Rect], paint: Paint) {
        let mut path = String::new();
        for frame in frames {
            let (x, y) = (Number(frame.x), Number(frame.y));
            let (width, height, back) = (Number(frame.width), Number(frame.height), Number(-frame.width));
            // Writing to a string cannot fail.
            let _ = write!(path, "M{x} {y}h{width}v{height}h{back}z");
        }
        if !path.is_empty() {
            self.shape(&format!(r#"path d="{path}""#), paint);
        }
    }

    pub(crate) fn polylines<'p>(&mut self, lines: impl IntoIterator<Item = &'p [Point]>, paint: Paint) {
        let mut path = String::new();
        for line in lines {
            for (index, &(x, y)) in line.iter().enumerate() {
                let command = if index == 0 { 'M' } else { 'L' };
                let _ = write!(path, "{command}{} {}", Number(x), Number(y));
            }
        }
        if !path.is_empty() {
            self.shape(&format!(r#"path d="{path}" stroke-linecap="round" stroke-linejoin="round""#), paint);
        }
    }

    /// Draws an ellipse of two semi-axes, the first one turned by `angle` radians from x towards y.
    pub(crate) fn ellipse(&mut self, (x, y): Point, (major, minor): (f64, f64), angle: f64, paint: Paint) {
        let (x, y, major, minor, degrees) =
            (Number(x), Number(y), Number(major), Number(minor), Number(angle.to_degrees()));
        let turn = format!(r#"transform="translate({x} {y}) rotate({degrees})""#);
        self.shape(&format!(r#"ellipse rx="{major}" ry="{minor}" {turn}"#), paint);
    }

    /// Draws a picture, given by its address or as a data URI.
    pub(crate) fn image(&mut self, frame: Rect, href: &str) {
        let Rect { x, y, width, height } = frame;
        let (x, y, width, height) = (Number(x), Number(y), Number(width), Number(height));
        let place = format!(r#"x="{x}" y="{y}" width="{width}" height="{height}" preserveAspectRatio="none""#);
        let _ = writeln!(self.body, r#"<image {place} href="{}"/>"#, escaped(href));
    }

    /// Draws text on a baseline at (x, y), with capitals of height `size`.
    pub(crate) fn label(&mut self, text: &str, (x, y): Point, size: f64, anchor: Anchor, colour: &str) {
        let (lines, width) = lettering::polylines(text);
        let x = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width * size / 2.0,
        };
        let placed: Vec<Vec<Point>> =
            lines.iter().map(|line| line.iter().map(|&(u, v)| (x + u * size, y + v * size)).collect()).collect();
        let _ = writeln!(self.body, r#"<g role="img" aria-label="{}">"#, escaped(text));
        self.polylines(placed.iter().map(Vec::as_slice), Paint::stroke(colour, size * 0.13));
        self.body.push_str("</g>\n");
    }

    /// Draws text like [`Drawing::label`] from its start, on a background of its own.
    pub(crate) fn label_on(&mut self, text: &str, (x, y): Point, size: f64, ground: &str, colour: &str) {
        let width = lettering::polylines(text).1 * size;
        let frame = Rect { x: x - 0.5 * size, y: y - 1.5 * size, width: width + size, height: 2.2 * size };
        self.rect(frame, Paint::fill(ground).opacity(0.85));
        self.label(text, (x, y), size, Anchor::Start, colour);
    }

    /// Draws centred lines of text with their sizes, on a background of their own, inside `bounds` if possible.
    pub(crate) fn plaque(&mut self, lines: &[(&str, f64)], (x, y): Point, bounds: Rect, ground: &str, colour: &str) {
        let width = lines.iter().map(|(text, size)| lettering::polylines(text).1 * size).fold(0.0, f64::max) + 18.0;
        let height = lines.iter().map(|(_, size)| 1.7 * size).sum::<f64>() + 9.0;
        let kept = |at: f64, half: f64, start: f64, size: f64| {
            let (least, most) = (start + half + 4.0, start + size - half - 4.0);
            if least <= most { at.clamp(least, most) } else { at }
        };
        let x = kept(x, width / 2.0, bounds.x, bounds.width);
        let y = kept(y, height / 2.0, bounds.y, bounds.height);
        let frame = Rect { x: x - width / 2.0, y: y - height / 2.0, width, height };
        self.rect(frame, Paint::fill(ground).opacity(0.85));
        let mut baseline = frame.y + 4.5;
        for &(text, size) in lines {
            self.label(text, (x, baseline + 1.3 * size), size, Anchor::Middle, colour);
            baseline += 1.7 * size;
        }
    }

    /// Returns the document.
    pub(crate) fn finish(self, title: &str) -> String {
        let (width, height) = (Number(self.width), Number(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n<title>{}</title>\n{}</svg>\n",
            escaped(title),
            self.body
        )
    }

    fn shape(&mut self, shape: &str, paint: Paint) {
        let _ = write!(self.body, r#"<{shape} fill="{}""#, paint.fill);
        if paint.stroke != "none" {
            let _ = write!(self.body, r#" stroke="{}" stroke-width="{}""#, paint.stroke, Number(paint.stroke_width));
        }
        if paint.dashed {
            self.body.push_str(r#" stroke-dasharray="5 6""#);
        }
        if paint.opacity < 1.0 {
            let _ = write!(self.body, r#" opacity="{}""#, Number(paint.opacity));
        }
        self.body.push_str("/>\n");
    }
}

/// A number with at most two decimals, without trailing zeros.
struct Number(f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rounded = (self.0 * 100.0).round() / 100.0;
        // Adding zero turns −0 into 0.
        write!(f, "{}", rounded + 0.0)
    }
}

/// Escapes text for XML content and attributes; characters that XML forbids are replaced.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(character),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let text = |value| Number(value).to_string();
        assert_eq!([text(1.0), text(0.125), text(-0.001), text(-2.5)], ["1", "0.13", "0", "-2.5"]);
    }

    #[test]
    fn names_cannot_break_out_of_the_document() {
        assert_eq!(escaped("a<b>&\"c\"\u{1}\n"), "a&lt;b&gt;&amp;&quot;c&quot;\u{fffd} ");
    }
}
