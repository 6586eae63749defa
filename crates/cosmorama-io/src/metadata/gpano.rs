use std::fmt;

use roxmltree::{Document, Node};

use crate::Window;

/// Namespace of Google's XMP properties, which declare that a photograph is a panorama, and which part of one.
pub(crate) const NAMESPACE: &str = "http://ns.google.com/photos/1.0/panorama/";
const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";

/// Content of a packet.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Said {
    /// Part of an equirectangular panorama of 360°×180° that the picture is.
    pub(crate) window: Option<Window>,
    /// Pose of the camera.
    pub(crate) pose: Option<Pose>,
    /// Statements that cannot be right, or that are ignored.
    pub(crate) complaints: Vec<String>,
}

/// Parses a packet for a picture of this size; the result is empty if the packet has no GPano properties.
pub(crate) fn parse(packet: &[u8], size: (usize, usize)) -> Said {
    let Ok(text) = std::str::from_utf8(packet) else { return Said::default() };
    let Ok(document) = Document::parse(text.trim_matches(|c: char| c == '\0' || c.is_whitespace())) else {
        return Said::default();
    };
    let words = Words(&document);
    match window(&words, size) {
        Ok(window) => Said { window, pose: window.and_then(|_| pose(&words)), complaints: Vec::new() },
        Err(reason) => {
            let complaint = format!("its GPano metadata are left out: {reason}; mend or remove them");
            Said { window: None, pose: None, complaints: vec![complaint] }
        }
    }
}

/// Pose of a panorama's camera, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Compass heading of the panorama's middle, clockwise from north.
    pub heading: f64,
    /// Angle of the panorama's middle above the horizon.
    pub pitch: f64,
    /// Clockwise turn of the camera: a level horizon runs down to the left for positive ones.
    pub roll: f64,
}

/// Writes the angles that are not zero, as the file names them.
impl fmt::Display for Pose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { heading, pitch, roll } = *self;
        let named = [("PoseHeadingDegrees", heading), ("PosePitchDegrees", pitch), ("PoseRollDegrees", roll)];
        let turned: Vec<String> = named
            .into_iter()
            .filter(|(_, angle)| *angle != 0.0)
            .map(|(name, angle)| format!("{name} {angle}"))
            .collect();
        f.write_str(&turned.join(", "))
    }
}

/// Properties of a packet.
struct Words<'a>(&'a Document<'a>);

impl<'a> Words<'a> {
    fn word(&self, name: &str) -> Option<&'a str> {
        self.0.descendants().find_map(|node| property(node, name)).map(str::trim)
    }

    /// Reads a number of pixels; the error quotes the invalid text.
    fn pixels(&self, name: &str) -> Result<Option<usize>, String> {
        let number =
            |text: &str| text.parse().map_err(|_| format!("{name} is \"{text}\", which is no number of pixels"));
        self.word(name).map(number).transpose()
    }

    /// Reads a number of pixels that must not be 0.
    fn side(&self, name: &str) -> Result<Option<usize>, String> {
        match self.pixels(name)? {
            Some(0) => Err(format!("{name} is 0")),
            side => Ok(side),
        }
    }
}

fn window(words: &Words<'_>, (width, height): (usize, usize)) -> Result<Option<Window>, String> {
    let Some(projection) = words.word("ProjectionType") else { return Ok(None) };
    if !projection.eq_ignore_ascii_case("equirectangular") {
        return Err(format!("ProjectionType is \"{projection}\", where equirectangular was expected"));
    }
    let full = (words.side("FullPanoWidthPixels")?, words.side("FullPanoHeightPixels")?);
    let part = (words.side("CroppedAreaImageWidthPixels")?, words.side("CroppedAreaImageHeightPixels")?);
    let (left, top) = (words.pixels("CroppedAreaLeftPixels")?, words.pixels("CroppedAreaTopPixels")?);
    let (Some(full_width), Some(full_height)) = full else {
        // Only the projection is given: the picture is a whole panorama if its shape says so, too.
        let whole = Window { canvas_width: width, canvas_height: height, x: 0, y: 0 };
        return Ok((width == 2 * height).then_some(whole));
    };
    let across = Axis { name: "Width", start: "Left", full: full_width, part: part.0.unwrap_or(full_width), left };
    let down = Axis { name: "Height", start: "Top", full: full_height, part: part.1.unwrap_or(full_height), left: top };
    // Programs that shrink a picture may leave the packet as it was, but they shrink both sides alike.
    let (wide, high) = (width as u128 * down.part as u128, height as u128 * across.part as u128);
    if wide.abs_diff(high) > across.part.max(down.part) as u128 {
        return Err(format!(
            "CroppedAreaImageWidthPixels and CroppedAreaImageHeightPixels are {}x{}, but the picture has {width}x{height}, \
             another shape",
            across.part, down.part
        ));
    }
    let ((canvas_width, x), (canvas_height, y)) = (across.scaled(width)?, down.scaled(height)?);
    Ok(Some(Window { canvas_width, canvas_height, x, y }))
}

/// Properties of a panorama along one axis.
struct Axis {
    name: &'static str,
    start: &'static str,
    full: usize,
    part: usize,
    left: Option<usize>,
}

impl Axis {
    /// Returns the size of the whole panorama and the picture's offset in it, scaled to a picture of so many pixels.
    fn scaled(&self, pixels: usize) -> Result<(usize, usize), String> {
        let left = self.left.unwrap_or(0);
        if left.checked_add(self.part).is_none_or(|end| end > self.full) {
            let Self { name, start, full, part, .. } = self;
            return Err(format!(
                "CroppedArea{start}Pixels {left} and CroppedAreaImage{name}Pixels {part} reach beyond \
                 FullPano{name}Pixels {full}"
            ));
        }
        let scaled = |value: usize| {
            let scaled = (value as u128 * pixels as u128 + self.part as u128 / 2) / self.part as u128;
            usize::try_from(scaled).map_err(|_| format!("FullPano{}Pixels is {}", self.name, self.full))
        };
        let whole = scaled(self.full)?;
        Ok((whole, scaled(left)?.min(whole.saturating_sub(pixels))))
    }
}

/// Reads the camera's pose; `None` where it is level and heads north, or does not say.
fn pose(words: &Words<'_>) -> Option<Pose> {
    let angle = |name: &str| {
        let angle = words.word(name).and_then(|text| text.parse().ok());
        angle.filter(|angle: &f64| angle.is_finite()).unwrap_or(0.0)
    };
    let pose =
        Pose { heading: angle("PoseHeadingDegrees"), pitch: angle("PosePitchDegrees"), roll: angle("PoseRollDegrees") };
    (pose != Pose::default()).then_some(pose)
}

/// Reads a property, which may be an attribute or an element.
fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let element = node.tag_name();
    if element.namespace() == Some(NAMESPACE) && element.name() == name {
        return node.text();
    }
    node.attribute((NAMESPACE, name))
}

/// Returns the packet of a description.
pub(crate) fn around(description: &str) -> String {
    format!(
        "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n\
         <x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n\
         <rdf:RDF xmlns:rdf=\"{RDF}\">\n{description}\n</rdf:RDF>\n</x:xmpmeta>\n<?xpacket end=\"w\"?>"
    )
}

/// Returns the description of a picture of this size.
pub(crate) fn description(window: Window, (width, height): (usize, usize)) -> String {
    let Window { canvas_width, canvas_height, x, y } = window;
    format!(
        "<rdf:Description rdf:about=\"\" xmlns:rdf=\"{RDF}\" xmlns:GPano=\"{NAMESPACE}\"\n \
         GPano:ProjectionType=\"equirectangular\" GPano:UsePanoramaViewer=\"True\"\n \
         GPano:FullPanoWidthPixels=\"{canvas_width}\" GPano:FullPanoHeightPixels=\"{canvas_height}\"\n \
         GPano:CroppedAreaImageWidthPixels=\"{width}\" GPano:CroppedAreaImageHeightPixels=\"{height}\"\n \
         GPano:CroppedAreaLeftPixels=\"{x}\" GPano:CroppedAreaTopPixels=\"{y}\"/>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packet(window: Window, size: (usize, usize)) -> String {
        around(&description(window, size))
    }

    const WINDOW: Window = Window { canvas_width: 4000, canvas_height: 2000, x: 500, y: 600 };

    fn said(window: Window) -> Said {
        Said { window: Some(window), ..Said::default() }
    }

    #[test]
    fn a_packet_says_what_it_was_told() {
        assert_eq!(parse(packet(WINDOW, (3000, 800)).as_bytes(), (3000, 800)), said(WINDOW));
    }

    #[test]
    fn elements_say_the_same_as_attributes() {
        let words = [
            ("ProjectionType", "equirectangular"),
            ("FullPanoWidthPixels", "4000"),
            ("FullPanoHeightPixels", "2000"),
            ("CroppedAreaImageWidthPixels", "3000"),
            ("CroppedAreaImageHeightPixels", "800"),
            ("CroppedAreaLeftPixels", "500"),
            ("CroppedAreaTopPixels", "600"),
        ];
        let elements: String = words.map(|(name, text)| format!("<p:{name}>{text}</p:{name}>")).concat();
        let xml = format!("<a xmlns:p=\"{NAMESPACE}\">{elements}</a>");
        assert_eq!(parse(xml.as_bytes(), (3000, 800)), said(WINDOW));
        // A picture shrunk to half.
        let half = Window { canvas_width: 2000, canvas_height: 1000, x: 250, y: 300 };
        assert_eq!(parse(xml.as_bytes(), (1500, 400)), said(half));
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let window = |x, y| Window { canvas_width: 400, canvas_height: 200, x, y };
        for (window, size, name) in [
            (window(1, 0), (400, 200), "CroppedAreaLeftPixels 1"),
            (window(0, 150), (400, 100), "CroppedAreaTopPixels 150"),
            (window(0, usize::MAX), (9, 9), "FullPanoHeightPixels 200"),
        ] {
            let said = parse(packet(window, size).as_bytes(), size);
            assert!(said.window.is_none() && said.complaints[0].contains(name), "{said:?}");
        }
        assert_eq!(parse(b"<a/>", (2, 1)), Said::default());
        assert_eq!(parse(b"\xff", (2, 1)), Said::default());
    }

    #[test]
    fn what_is_wrong_is_named() {
        let packet = packet(Window { canvas_width: 512, canvas_height: 256, x: 100, y: 50 }, (200, 100));
        for (from, to, parts) in [
            ("=\"equirectangular\"", "=\"cylindrical\"", ["ProjectionType", "cylindrical"]),
            ("FullPanoWidthPixels=\"512\"", "FullPanoWidthPixels=\"0\"", ["FullPanoWidthPixels", "is 0"]),
            ("LeftPixels=\"100\"", "LeftPixels=\"abc\"", ["CroppedAreaLeftPixels", "\"abc\""]),
            ("LeftPixels=\"100\"", "LeftPixels=\"400\"", ["CroppedAreaLeftPixels 400", "FullPanoWidthPixels 512"]),
            ("WidthPixels=\"200\"", "WidthPixels=\"250\"", ["CroppedAreaImageWidthPixels", "250x100"]),
        ] {
            assert!(packet.contains(from), "{from}");
            let Said { window, complaints, .. } = parse(packet.replacen(from, to, 1).as_bytes(), (200, 100));
            assert_eq!(window, None, "{to}");
            assert!(parts.iter().all(|part| complaints[0].contains(part)), "{complaints:?}");
        }
        let pose = "GPano:PoseRollDegrees=\"0\" GPano:PoseHeadingDegrees=\"90\" GPano:Full";
        let turned = packet.replacen("GPano:Full", pose, 1);
        let said = parse(turned.as_bytes(), (200, 100));
        let pose = Pose { heading: 90.0, ..Pose::default() };
        assert!(said.window.is_some() && said.pose == Some(pose) && said.complaints.is_empty(), "{said:?}");
        assert_eq!(pose.to_string(), "PoseHeadingDegrees 90");
    }
}
