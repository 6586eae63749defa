use cosmorama::layout::{Arrangement, Eye, Stereo};

use super::fields::{Fields, wrong};
use super::keys::Keys;
use crate::SpecError;

/// Division of a picture into those of two eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StereoSpec {
    /// Packing of the two eyes' pictures in the image: side by side or top and bottom, full or half size.
    pub packing: Stereo,
    /// The one eye that is used; `None` for both.
    pub eye: Option<Eye>,
}

const fn packing(arrangement: Arrangement, is_half: bool) -> Stereo {
    Stereo { arrangement, is_half, is_swapped: false }
}

const PACKINGS: [(&str, Stereo); 4] = [
    ("sbs", packing(Arrangement::SideBySide, false)),
    ("tb", packing(Arrangement::TopBottom, false)),
    ("sbs-half", packing(Arrangement::SideBySide, true)),
    ("tb-half", packing(Arrangement::TopBottom, true)),
];

impl StereoSpec {
    /// Reads the keys of a stereo picture; `None` if it is not one.
    pub(super) fn build(fields: &Fields) -> Result<Option<Self>, SpecError> {
        let Some(packing) = fields.choice("stereo", &PACKINGS)? else {
            let alone = ["swap", "eye"].into_iter().find_map(|key| Some((key, fields.get(key)?)));
            let needs =
                |(key, value)| wrong(key, value, "stereo= beside it, as in stereo=sbs; without, there is one eye");
            return alone.map(needs).map_or(Ok(None), Err);
        };
        let is_swapped = fields.choice("swap", &[("yes", true), ("no", false)])?.unwrap_or(false);
        let eye = fields.choice("eye", &Eye::ALL.map(|eye| (eye.name(), eye)))?;
        Ok(Some(Self { packing: Stereo { is_swapped, ..packing }, eye }))
    }

    /// Adds the keys of the division.
    pub(super) fn write(self, keys: Keys) -> Keys {
        let packing = Stereo { is_swapped: false, ..self.packing };
        let name = PACKINGS.iter().find(|(_, other)| *other == packing).map(|(name, _)| *name);
        keys.maybe("stereo", name).switch("swap", self.packing.is_swapped).maybe("eye", self.eye.map(Eye::name))
    }

    /// Returns the eyes that are used.
    pub fn eyes(self) -> Vec<Eye> {
        self.eye.map_or_else(|| Eye::ALL.to_vec(), |eye| vec![eye])
    }
}
