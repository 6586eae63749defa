use std::path::Path;

use anyhow::{Result, bail};
use cosmorama::world::{EquirectFrame, Frame, Placement, SamplePositions};
use cosmorama_io::{EnvMap, Header};

use crate::spec::{Single, SphereSamples};

/// What one image is a picture of, as far as its metadata and shape tell.
pub(crate) enum Guess {
    /// A panorama, says its metadata.
    LatLong,
    /// A panorama, by its shape: twice as wide as high.
    TwoToOne,
    /// A cube in one file, which is not read.
    CubeInOneFile,
    /// Nothing tells.
    Unknown,
}

impl Guess {
    /// Looks at a header.
    pub(crate) fn of(header: &Header) -> Self {
        let (width, height) = match header.window {
            Some(window) => (window.canvas_width, window.canvas_height),
            None => (header.width, header.height),
        };
        match header.metadata.envmap {
            Some(EnvMap::LatLong) => Self::LatLong,
            Some(EnvMap::Cube) => Self::CubeInOneFile,
            None if width == 2 * height => Self::TwoToOne,
            None => Self::Unknown,
        }
    }
}

/// The projection of an image for which no `--from` was given.
pub(super) fn detect(path: &Path, header: &Header, warnings: &mut Vec<String>) -> Result<Single> {
    let panorama = |samples| Single {
        placement: Placement::new(Frame::Equirect(EquirectFrame { samples, ..EquirectFrame::default() })),
        samples: SphereSamples::ByFormat,
    };
    match Guess::of(header) {
        Guess::LatLong => Ok(panorama(SamplePositions::Edges)),
        Guess::TwoToOne => {
            warnings.push(format!(
                "{} is taken for a panorama (--from equirect), because it is twice as wide as high",
                path.display()
            ));
            Ok(panorama(SamplePositions::Centres))
        }
        Guess::CubeInOneFile => bail!(
            "{}: an environment map that holds a cube in one file, which is not read; split it into six files and give \
             them as '{{face}}.exr'",
            path.display()
        ),
        Guess::Unknown => bail!(
            "{}: {}x{} pixels do not tell the projection; give --from perspective:fov=DEGREES, equirect, fisheye, \
             fulldome or omnimax, or a pattern with {{face}} for the faces of a cube",
            path.display(),
            header.width,
            header.height
        ),
    }
}
