use cosmorama::layout::{Arrangement, Eye, Stereo};

use super::fields::{Fields, wrong};
use crate::SpecError;

/// That a picture is two, one for each eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StereoSpec {
    /// How they share an image.
    pub packing: Stereo,
    /// The only one that is used, if not both are.
    pub eye: Option<Eye>,
}

impl StereoSpec {
    /// The keys of a stereo picture; `None` where it is none.
    pub(super) fn build(fields: &Fields) -> Result<Option<Self>, SpecError> {
        use Arrangement::{SideBySide, TopBottom};
        let packing = |arrangement, is_half| Stereo { arrangement, is_half, is_swapped: false };
        let packings = [
            ("sbs", packing(SideBySide, false)),
            ("tb", packing(TopBottom, false)),
            ("sbs-half", packing(SideBySide, true)),
            ("tb-half", packing(TopBottom, true)),
        ];
        let Some(packing) = fields.choice("stereo", &packings)? else {
            let alone = ["swap", "eye"].into_iter().find_map(|key| Some((key, fields.get(key)?)));
            let needs =
                |(key, value)| wrong(key, value, "stereo= beside it, as in stereo=sbs; without, there is one eye");
            return alone.map(needs).map_or(Ok(None), Err);
        };
        let is_swapped = fields.choice("swap", &[("yes", true), ("no", false)])?.unwrap_or(false);
        let eye = fields.choice("eye", &Eye::ALL.map(|eye| (eye.name(), eye)))?;
        Ok(Some(Self { packing: Stereo { is_swapped, ..packing }, eye }))
    }

    /// The eyes that are used.
    pub fn eyes(self) -> Vec<Eye> {
        self.eye.map_or_else(|| Eye::ALL.to_vec(), |eye| vec![eye])
    }
}
