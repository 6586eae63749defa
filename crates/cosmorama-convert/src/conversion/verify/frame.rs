use std::io::ErrorKind;
use std::path::Path;

use bytemuck::cast_slice;
use cosmorama::raster::{EncodedImage, Image, Rgba, Samples};
use cosmorama_io::{IoError, Limits};
use cosmorama_spec::TransferName;
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

use super::sheet;
use crate::colour::InputTransfer;
use crate::diagnostic::Result;
use crate::job::{DAMAGED_ORIGIN, damage_of, is_damaged, settings_of};
use crate::source::video::FrameDamage;
use crate::source::{Files, read};

/// Summary of a frame that was read.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) number: u64,
    pub(super) found: Found,
    /// Small picture in codes of sRGB, if it is to be shown, and there is one.
    pub(super) thumbnail: Option<Image<[u8; 3]>>,
}

/// Content in the place of a frame.
#[derive(Clone, Debug)]
pub(super) enum Found {
    Nothing,
    /// A file that is no whole picture, in words.
    Damage(String),
    Picture(Picture),
}

/// Summary of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) size: (usize, usize),
    /// Channels and samples, in words.
    pub(super) kind: String,
    /// Digests of the settings by which it was made, if its file tells them.
    pub(super) settings: Option<String>,
    /// Damage of the film of which it was made, if its file tells of any.
    pub(super) damage: Option<FrameDamage>,
    /// Hash of all samples.
    pub(super) hash: u64,
    /// Whether no sample of a colour differs from 0.
    pub(super) is_black: bool,
    /// Mean colours of [`CELLS`] × [`CELLS`] parts, as codes of sRGB.
    pub(super) cells: Vec<[u8; 3]>,
}

/// Number of parts along each side by which pictures are compared.
pub(super) const CELLS: usize = 16;

impl Frame {
    /// Approximate bytes of a frame without its small picture; words take a hundred.
    pub(super) const BYTES: u64 = (size_of::<Self>() + CELLS * CELLS * size_of::<[u8; 3]>() + 100) as u64;

    /// Reads a frame.
    ///
    /// # Errors
    /// When there is a file, but it may not be read, or needs more memory than permitted.
    pub(super) fn read(files: &dyn Files, (number, path): (u64, &Path), limits: &Limits, shows: bool) -> Result<Self> {
        let mut thumbnail = None;
        let found = match read(files, path, limits) {
            Ok(file) if file.metadata.origin.as_deref().is_some_and(is_damaged) => {
                Found::Damage(DAMAGED_ORIGIN.to_owned())
            }
            Ok(file) => {
                let transfer = InputTransfer::new(&TransferName::Auto, None).of(file.image.depth(), &file.metadata);
                let origin = file.metadata.origin.as_deref();
                let (settings, damage) = (origin.and_then(settings_of).map(str::to_owned), origin.and_then(damage_of));
                let light = file.image.to_light(&transfer);
                thumbnail = shows.then(|| sheet::thumbnail(&light));
                Found::Picture(Picture { settings, damage, ..Picture::of(&file.image, &light) })
            }
            Err(IoError::Open { source, .. }) if source.kind() == ErrorKind::NotFound => Found::Nothing,
            Err(IoError::LeftOut { .. }) => Found::Damage("its decoder has no such frame".to_owned()),
            Err(error) if is_of_system(&error) => return Err(error.into()),
            Err(error) => Found::Damage(error.to_string()),
        };
        Ok(Self { number, found, thumbnail })
    }

    /// Returns the picture, if there is a whole one.
    pub(super) fn picture(&self) -> Option<&Picture> {
        match &self.found {
            Found::Picture(picture) => Some(picture),
            Found::Nothing | Found::Damage(_) => None,
        }
    }
}

impl Picture {
    /// Returns whether all samples equal those of another picture.
    pub(super) fn equals(&self, other: &Self) -> bool {
        (self.hash, self.size, &self.kind) == (other.hash, other.size, &other.kind)
    }

    fn of(image: &EncodedImage, light: &Image<Rgba>) -> Self {
        let is_dark = |pixel: &Rgba| pixel.0[..3].iter().all(|sample| *sample == 0.0);
        Self {
            size: (image.width(), image.height()),
            kind: format!("{}, depth {}", image.channels(), image.depth()),
            settings: None,
            damage: None,
            hash: hash(image),
            is_black: light.pixels().par_iter().all(is_dark),
            cells: sheet::reduced(light, [CELLS; 2]).pixels().iter().map(sheet::codes).collect(),
        }
    }
}

/// Returns a hash of a picture's samples.
fn hash(image: &EncodedImage) -> u64 {
    xxh3_64(match image.samples() {
        Samples::U8(samples) => samples,
        Samples::U16(samples) => cast_slice(samples),
        Samples::Half(samples) => cast_slice(samples),
        Samples::Float(samples) => cast_slice(samples),
    })
}

/// Returns whether the system or the limits are in the way of a file that may be whole.
fn is_of_system(error: &IoError) -> bool {
    match error {
        IoError::TooLarge { .. } => true,
        IoError::Open { source, .. } => !matches!(source.kind(), ErrorKind::UnexpectedEof | ErrorKind::InvalidData),
        _ => false,
    }
}
