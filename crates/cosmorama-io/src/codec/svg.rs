//! Pictures from SVG documents: the diagrams of `cosmorama::explain` as images.

use std::path::{Component, Path};

use cosmorama::raster::{Channels, Depth, EncodedImage, ImageError, Samples};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{ImageHrefResolver, Options, Tree};
use thiserror::Error;

/// Longest side of a picture; a larger diagram is a mistake.
const LONGEST: f32 = 16384.0;

/// Reason why an SVG document cannot be turned into a picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SvgError {
    /// The document is not SVG.
    #[error("not an SVG document that can be drawn: {0}")]
    Document(#[from] resvg::usvg::Error),
    /// The picture would have no pixels, or too many.
    #[error(
        "an SVG picture of {width}x{height} pixels cannot be drawn; choose a scale for 1 to {LONGEST} pixels a side"
    )]
    Size {
        /// Columns.
        width: f32,
        /// Rows.
        height: f32,
    },
    /// The pixels do not make an image.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// Draws an SVG document as 8-bit RGBA in sRGB, at `scale` pixels per unit.
///
/// Text must be drawn as shapes. Embedded pictures are data URIs or files under `folder`; without a folder, nothing
/// outside the document is read.
///
/// # Errors
/// When the document is damaged, or the picture would be empty or longer than 16384 pixels.
pub fn rasterise(svg: &str, scale: f32, folder: Option<&Path>) -> Result<EncodedImage, SvgError> {
    let read_file = ImageHrefResolver::default_string_resolver();
    let is_below = |href: &str| Path::new(href).components().all(|part| matches!(part, Component::Normal(_)));
    let options = Options {
        resources_dir: folder.map(Path::to_owned),
        image_href_resolver: ImageHrefResolver {
            resolve_data: ImageHrefResolver::default_data_resolver(),
            resolve_string: Box::new(move |href, options| {
                let may_be_read = options.resources_dir.is_some() && is_below(href);
                if may_be_read { read_file(href, options) } else { None }
            }),
        },
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options)?;
    let (width, height) = ((tree.size().width() * scale).round(), (tree.size().height() * scale).round());
    let size = || SvgError::Size { width, height };
    if !((1.0..=LONGEST).contains(&width) && (1.0..=LONGEST).contains(&height)) {
        return Err(size());
    }
    let mut pixmap = Pixmap::new(width as u32, height as u32).ok_or_else(size)?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let samples = pixmap.pixels().iter().flat_map(|pixel| {
        let colour = pixel.demultiply();
        [colour.red(), colour.green(), colour.blue(), colour.alpha()]
    });
    let samples = Samples::U8(samples.collect());
    Ok(EncodedImage::new(width as usize, height as usize, Channels::Rgba, Depth::Eight, samples)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="4" height="2""#;

    fn pixels(svg: &str, scale: f32) -> (usize, Vec<u8>) {
        let image = rasterise(svg, scale, None).expect("a picture");
        let Samples::U8(samples) = image.samples() else { panic!("8-bit samples") };
        (image.width(), samples.clone())
    }

    #[test]
    fn shapes_become_pixels() {
        let svg = format!(r##"{FRAME}><rect x="2" width="2" height="2" fill="#ff8000"/></svg>"##);
        let (width, samples) = pixels(&svg, 1.0);
        assert_eq!(width, 4);
        assert_eq!(samples[..16], [0, 0, 0, 0, 0, 0, 0, 0, 255, 128, 0, 255, 255, 128, 0, 255]);
        assert_eq!(pixels(&svg, 2.5).0, 10);
    }

    #[test]
    fn half_transparent_colours_are_not_premultiplied() {
        let svg = format!(r##"{FRAME}><rect width="4" height="2" fill="#ff0000" opacity="0.5"/></svg>"##);
        let pixel: [u8; 4] = pixels(&svg, 1.0).1[..4].try_into().expect("a pixel");
        assert!(pixel[0] == 255 && pixel[1] == 0 && (127..=128).contains(&pixel[3]), "{pixel:?}");
    }

    #[test]
    fn a_picture_in_the_document_is_drawn_and_one_outside_is_not() {
        // One green pixel.
        let png = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNg+M8AAAICAQB7CYF4AAAAAElFTkSuQmCC";
        let with = |href: &str| {
            format!(r#"{FRAME}><image width="4" height="2" preserveAspectRatio="none" href="{href}"/></svg>"#)
        };
        let inside = pixels(&with(&format!("data:image/png;base64,{png}")), 1.0).1;
        assert_eq!(inside[..4], [0, 255, 0, 255]);
        assert!(pixels(&with("/etc/hostname.png"), 1.0).1.iter().all(|&sample| sample == 0));
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir(folder.path().join("inner")).expect("a folder in it");
        let pixel =
            EncodedImage::new(1, 1, Channels::Rgb, Depth::Eight, Samples::U8(vec![0, 255, 0])).expect("a pixel");
        let path = folder.path().join("inner/green.png");
        crate::write(&path, &pixel, &crate::WriteOptions::default()).expect("a file");
        let green = |href: &str, folder: &Path| {
            let image = rasterise(&with(href), 1.0, Some(folder)).expect("a picture");
            let Samples::U8(samples) = image.samples() else { panic!("8-bit samples") };
            samples[1] == 255
        };
        assert!(green("inner/green.png", folder.path()));
        assert!(!green("../inner/green.png", &folder.path().join("inner")));
        assert!(!green(&path.display().to_string(), folder.path()));
    }

    #[test]
    fn damage_and_absurd_sizes_are_refused() {
        assert!(matches!(rasterise("<svg", 1.0, None), Err(SvgError::Document(_))));
        let svg = format!("{FRAME}/>");
        for scale in [0.0, -1.0, 1e9, f32::NAN] {
            assert!(matches!(rasterise(&svg, scale, None), Err(SvgError::Size { .. })), "{scale}");
        }
    }
}
