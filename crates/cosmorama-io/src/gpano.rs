use roxmltree::{Document, Node};

use crate::Window;

/// Adobe's XMP packets say in words of Google's that a photograph is a panorama, and which part of one.
const NAMESPACE: &str = "http://ns.google.com/photos/1.0/panorama/";

/// The part of an equirectangular panorama of 360°×180° that a picture of this size is, as a packet says; `None` where
/// it says nothing, or nothing that fits.
pub(crate) fn parse(packet: &[u8], (width, height): (usize, usize)) -> Option<Window> {
    let text = std::str::from_utf8(packet).ok()?;
    let document = Document::parse(text.trim_matches(|c: char| c == '\0' || c.is_whitespace())).ok()?;
    let word = |name: &str| document.descendants().find_map(|node| property(node, name));
    if !word("ProjectionType")?.trim().eq_ignore_ascii_case("equirectangular") {
        return None;
    }
    let number = |name: &str| word(name).and_then(|text| text.trim().parse::<usize>().ok());
    let cropped = (number("CroppedAreaImageWidthPixels"), number("CroppedAreaImageHeightPixels"));
    let (Some(full_width), Some(full_height)) = (number("FullPanoWidthPixels"), number("FullPanoHeightPixels")) else {
        // Nothing but the projection: all of it, if the shape says so, too.
        return (width == 2 * height).then_some(Window { canvas_width: width, canvas_height: height, x: 0, y: 0 });
    };
    // Who makes a picture smaller may leave the packet as it was.
    let (declared_width, declared_height) = (cropped.0.unwrap_or(full_width), cropped.1.unwrap_or(full_height));
    let scaled = |value: usize, size: usize, declared: usize| {
        (declared > 0).then(|| (value as u128 * size as u128 + declared as u128 / 2) / declared as u128)
    };
    let across = |value| usize::try_from(scaled(value, width, declared_width)?).ok();
    let down = |value| usize::try_from(scaled(value, height, declared_height)?).ok();
    let window = Window {
        canvas_width: across(full_width)?,
        canvas_height: down(full_height)?,
        x: across(number("CroppedAreaLeftPixels").unwrap_or(0))?,
        y: down(number("CroppedAreaTopPixels").unwrap_or(0))?,
    };
    let fits = |start: usize, size: usize, whole: usize| start.checked_add(size).is_some_and(|end| end <= whole);
    (fits(window.x, width, window.canvas_width) && fits(window.y, height, window.canvas_height)).then_some(window)
}

/// A property is written as an attribute or as an element.
fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let element = node.tag_name();
    if element.namespace() == Some(NAMESPACE) && element.name() == name {
        return node.text();
    }
    node.attribute((NAMESPACE, name))
}

/// The packet that says the same of a picture of this size.
pub(crate) fn packet(window: Window, (width, height): (usize, usize)) -> String {
    let Window { canvas_width, canvas_height, x, y } = window;
    format!(
        "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n\
         <x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n\
         <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n\
         <rdf:Description rdf:about=\"\" xmlns:GPano=\"{NAMESPACE}\"\n \
         GPano:ProjectionType=\"equirectangular\" GPano:UsePanoramaViewer=\"True\"\n \
         GPano:FullPanoWidthPixels=\"{canvas_width}\" GPano:FullPanoHeightPixels=\"{canvas_height}\"\n \
         GPano:CroppedAreaImageWidthPixels=\"{width}\" GPano:CroppedAreaImageHeightPixels=\"{height}\"\n \
         GPano:CroppedAreaLeftPixels=\"{x}\" GPano:CroppedAreaTopPixels=\"{y}\"/>\n\
         </rdf:RDF>\n</x:xmpmeta>\n<?xpacket end=\"w\"?>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window { canvas_width: 4000, canvas_height: 2000, x: 500, y: 600 };

    #[test]
    fn a_packet_says_what_it_was_told() {
        assert_eq!(parse(packet(WINDOW, (3000, 800)).as_bytes(), (3000, 800)), Some(WINDOW));
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
        assert_eq!(parse(xml.as_bytes(), (3000, 800)), Some(WINDOW));
        // Made smaller by half.
        let half = Window { canvas_width: 2000, canvas_height: 1000, x: 250, y: 300 };
        assert_eq!(parse(xml.as_bytes(), (1500, 400)), Some(half));
    }

    #[test]
    fn what_does_not_fit_says_nothing() {
        let window = |x, y| Window { canvas_width: 400, canvas_height: 200, x, y };
        for (window, size) in
            [(window(1, 0), (400, 200)), (window(0, 150), (400, 100)), (window(0, usize::MAX), (9, 9))]
        {
            assert_eq!(parse(packet(window, size).as_bytes(), size), None);
        }
        assert_eq!(parse(b"<a/>", (2, 1)), None);
        assert_eq!(parse(b"\xff", (2, 1)), None);
        let other = packet(window(0, 0), (400, 200)).replace("equirectangular", "cylindrical");
        assert_eq!(parse(other.as_bytes(), (400, 200)), None);
    }
}
