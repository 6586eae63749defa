//! Rules for the Exif fields that an output takes over. A file's own directory mostly describes how its pixels are
//! stored, so that only listed fields are kept: those about the camera and by the photographer. Of the camera's
//! directory, all fields are kept except listed ones.

use ::exif::{Context, Field, Tag, Value};

/// Treatment of a field for another file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// The output takes it over.
    Kept,
    /// The writer sets it itself, or does not need it.
    Rewritten,
    /// It is not true of the output.
    Untrue,
}

/// Fields of the file's own directory that an output takes over: ImageDescription, Make, Model, resolution, PageName,
/// DateTime, Artist, HostComputer, Rating, Copyright, and the fields that Windows writes (XPTitle to XPSubject).
const KEPT: [u16; 20] = [
    269, 270, 271, 272, 282, 283, 285, 296, 306, 315, 316, 18246, 18249, 32781, 33432, 40091, 40092, 40093, 40094,
    40095,
];

/// Fields of the file's own directory that are about the input's pixels: their place on Earth (GeoTIFF), and a camera's
/// raw pixels (DNG), which have many more fields, all from 50706 on.
const GEOTIFF: [u16; 8] = [33550, 33922, 34264, 34735, 34736, 34737, 42112, 42113];
const FIRST_OF_DNG: u16 = 50706;

/// Fields of the camera's directory that the writer sets itself, or that describe how pixels were stored:
/// ComponentsConfiguration, CompressedBitsPerPixel, ColorSpace, PixelXDimension, PixelYDimension, Gamma.
const REWRITTEN: [u16; 6] = [37121, 37122, 40961, 40962, 40963, 42240];

/// Fields of the camera's directory that are not true of another picture: SubjectArea, MakerNote (which holds places in
/// the old file), RelatedSoundFile, SpatialFrequencyResponse, FocalPlaneXResolution, FocalPlaneYResolution,
/// FocalPlaneResolutionUnit, SubjectLocation, CFAPattern, DigitalZoomRatio, FocalLengthIn35mmFilm.
const UNTRUE: [u16; 11] = [37396, 37500, 40964, 41484, 41486, 41487, 41488, 41492, 41730, 41988, 41989];

/// GPSImgDirectionRef and GPSImgDirection, the direction of the picture's middle.
const DIRECTION: [u16; 2] = [16, 17];

/// Beginnings of descriptions by which tifffile and ImageJ read a picture's sizes.
const OF_SIZES: [&[u8]; 2] = [b"{\"shape\":", b"ImageJ="];

/// Returns the treatment of a field for another file.
pub(super) fn fate_of(field: &Field) -> Fate {
    let is_of_sizes = |text: &Vec<u8>| OF_SIZES.iter().any(|start| text.starts_with(start));
    match (field.tag, &field.value) {
        (Tag::ImageDescription, Value::Ascii(texts)) if texts.iter().any(is_of_sizes) => Fate::Untrue,
        (tag, _) => fate(tag),
    }
}

/// Returns the treatment of a field of this kind, whatever it says.
pub(super) fn fate(tag: Tag) -> Fate {
    let Tag(context, number) = tag;
    let of = |is_untrue: bool, is_rewritten: bool| match (is_untrue, is_rewritten) {
        (true, _) => Fate::Untrue,
        (false, true) => Fate::Rewritten,
        (false, false) => Fate::Kept,
    };
    match context {
        Context::Tiff => of(GEOTIFF.contains(&number) || number >= FIRST_OF_DNG, !KEPT.contains(&number)),
        Context::Exif => of(UNTRUE.contains(&number), REWRITTEN.contains(&number)),
        Context::Gps => of(DIRECTION.contains(&number), false),
        _ => Fate::Rewritten,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exif::In;

    #[test]
    fn descriptions_of_sizes_are_untrue() {
        let fate_of = |text: &str| {
            let value = Value::Ascii(vec![text.as_bytes().to_vec()]);
            fate_of(&Field { tag: Tag::ImageDescription, ifd_num: In::PRIMARY, value })
        };
        assert_eq!(fate_of("{\"shape\": [64, 32, 3]}"), Fate::Untrue);
        assert_eq!(fate_of("ImageJ=1.53t\nimages=3\nslices=3\n"), Fate::Untrue);
        assert_eq!(fate_of("A shape of ImageJ"), Fate::Kept);
    }
}
