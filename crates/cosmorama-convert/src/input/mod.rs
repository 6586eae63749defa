//! Inputs: files found and probed, their views, and lists of views.

mod builtin;
pub(crate) mod eye_view;
pub(crate) mod faces;
mod find;
pub(crate) mod folder;
mod input_view;
pub(crate) mod lists;
pub(crate) mod packed;
pub(crate) mod pictures;
mod planned_input;
pub(crate) mod spec_files;

pub use builtin::Builtin;
pub use find::listed;
pub use folder::{face_set, is_one_file};
pub use input_view::InputView;
pub use lists::listing::Listed;

pub(crate) use faces::face_file::Face;
pub(crate) use faces::face_shape::FacePicture;

use std::collections::HashSet;
use std::path::PathBuf;

use cosmorama::camera::View;
use cosmorama::raster::{Depth, FixedDecoder, Transfer};
use cosmorama_io::{EnvMap, Format, Header, Pose};

use crate::detect::GivenFaces;
use crate::diagnostic::{Code, Diagnostic, FROM, Result, TO};
use crate::source::memory_budget::read_bytes;
use crate::source::{Access, Files};

/// Pictures of a stream beside those of frames: one that is being read, one that has come, and the first.
const AHEAD: u64 = 3;

/// The input of a conversion: views, frames and files.
pub struct Input {
    /// Views, including missing ones: of one world, or of the left eye's and the right eye's.
    pub worlds: Vec<Vec<InputView>>,
    /// Frames to work on.
    pub frames: Vec<Option<u64>>,
    /// Arrangement of the views as faces of one cube, if they are whole faces.
    pub faces: Option<GivenFaces>,
    /// Files beside those of views: lists of views, masks, calibrations and maps.
    pub beside: Vec<PathBuf>,
}

/// Returns the message about a camera's pose that is ignored.
fn not_followed(pose: Pose) -> String {
    format!(
        "its GPano metadata say {pose}, which is not followed: the middle of the panorama is taken for the front; follow it \
         with {FROM} equirect:pose=yes, or turn it with yaw=, pitch= and roll= there"
    )
}

/// Message for an output with two eyes and an input with one.
pub(crate) const SAME_FOR_BOTH: &str =
    "both eyes get the same picture, since the input has only one: there is no depth in it";

impl Input {
    /// Returns an empty input, for light by a formula.
    pub(crate) fn none() -> Self {
        Self { worlds: Vec::new(), frames: vec![None], faces: None, beside: Vec::new() }
    }

    /// Takes what a file holds for the whole picture, where it is little of a huge one, and shares its world with no other.
    pub(crate) fn narrow_to_files(&mut self) {
        for views in &mut self.worlds {
            if let [view] = &mut views[..] {
                view.narrow_to_file();
            }
        }
    }

    /// Provides as many worlds as the output has eyes, and reports what is dropped or duplicated.
    pub(crate) fn fit_eyes(&mut self, stereo: bool, warnings: &mut Vec<Diagnostic>) {
        match (self.worlds.len(), stereo) {
            (2, false) => {
                self.worlds.truncate(1);
                let message = format!(
                    "the left eye's picture is used, since the output is for one eye; say so with eye=left, or eye=right \
                     for the other, or {TO} with stereo="
                );
                warnings.push(Diagnostic::warning(Code::LeftEye, message));
            }
            (1, true) => warnings.push(Diagnostic::warning(Code::OneForBothEyes, SAME_FOR_BOTH)),
            _ => {}
        }
    }

    /// Returns warnings and notes about what the files say of themselves.
    pub(crate) fn diagnostics(&self) -> Vec<Diagnostic> {
        let mut told = self.turned();
        told.extend(self.complaints());
        told
    }

    /// Returns notes about files that are turned upright, as their metadata ask.
    fn turned(&self) -> Vec<Diagnostic> {
        let turned = self.present().filter_map(|(view, header, _)| Some((view, header.metadata.orientation?)));
        let mut told: Vec<Diagnostic> = turned
            .map(|(view, orientation)| {
                let path = view.files.path(self.frames[0]);
                let message = format!(
                    "{} is turned or mirrored as it asks (orientation {orientation}); centers, windows and SPECs are of the \
                     upright picture",
                    path.display()
                );
                Diagnostic::note(Code::Orientation, message).about(path.display())
            })
            .collect();
        // Faces may share a file.
        told.dedup();
        told
    }

    /// Warns about statements of files that are ignored.
    fn complaints(&self) -> Vec<Diagnostic> {
        let told = |(view, header, _): (&InputView, &Header, _)| -> Vec<Diagnostic> {
            let path = view.files.path(self.frames[0]);
            let path = path.display();
            let complaint = |words| Diagnostic::warning(Code::Metadata, format!("{path}: {words}")).about(&path);
            let note = |words| Diagnostic::note(Code::Metadata, format!("{path}: {words}")).about(&path);
            let metadata = &header.metadata;
            let pose = metadata.pose.map(not_followed);
            let complaints = metadata.complaints.iter().chain(&pose).map(complaint);
            complaints.chain(metadata.notes.iter().map(note)).collect()
        };
        let mut told: Vec<Diagnostic> = self.present().flat_map(told).collect();
        // Faces may share a file.
        told.dedup();
        told
    }

    /// Visits the views that have files and are wanted, with the geometry of those files.
    pub(crate) fn present(&self) -> impl Iterator<Item = (&InputView, &Header, &View)> {
        self.views().filter_map(InputView::present)
    }

    /// Visits the views that have files, wanted or not, with the geometry of those files: the same, whichever frames are made.
    pub(crate) fn there(&self) -> impl Iterator<Item = (&InputView, &Header, &View)> {
        self.views().filter_map(InputView::there)
    }

    /// Visits all views of all worlds.
    pub(crate) fn views(&self) -> impl Iterator<Item = &InputView> {
        self.worlds.iter().flatten()
    }

    /// Returns the map of the environment that the first file says it is.
    pub(crate) fn envmap(&self) -> Option<EnvMap> {
        self.present().next().and_then(|(_, header, _)| header.metadata.envmap)
    }

    /// Returns pixels per radian at the centre of the finest view.
    pub(crate) fn pixels_per_radian(&self) -> f64 {
        let views = self.views().filter(|view| view.wanted);
        views.map(|view| view.nominal.pixels_per_radian()).fold(0.0, f64::max)
    }

    /// Returns the number of texels in all files of a frame.
    pub(crate) fn texels(&self) -> usize {
        self.present().map(|(_, header, _)| header.width.saturating_mul(header.height)).fold(0, usize::saturating_add)
    }

    /// Visits every file that is read.
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> {
        let of_frame =
            |frame: &Option<u64>| self.present().map(|(input, ..)| input.files.file(*frame)).collect::<Vec<_>>();
        self.frames.iter().flat_map(of_frame).chain(self.beside.iter().cloned())
    }

    /// Returns whether it is a stream that is read as it comes.
    pub(crate) fn is_live(&self, files: &dyn Files) -> bool {
        self.present().filter_map(|(view, ..)| view.files.video()).any(|video| files.live(video).is_some())
    }

    /// Returns whether the formats of all files hold integers alone.
    pub(crate) fn holds_only_integers(&self) -> bool {
        let is_integer = |format: Format| format.depths().iter().all(|depth| !depth.is_float());
        self.present().all(|(_, header, _)| is_integer(header.format))
    }

    /// Returns whether all files are opaque, of 8 bits, and fit 15-bit light by the transfer function of each, which is `None` where its
    /// colours have to be converted.
    pub(crate) fn takes_integers(&self, transfer: impl Fn(&Header) -> Option<Transfer>) -> bool {
        // Tables of a transfer function are made once, since a world may have thousands of views.
        let mut known: Option<Transfer> = None;
        self.present().all(|(_, header, _)| {
            let Some(transfer) = transfer(header) else { return false };
            let fits = known.as_ref() == Some(&transfer) || FixedDecoder::new(&transfer).is_some();
            known = Some(transfer);
            fits && header.depth == Depth::Eight && !header.channels.has_alpha()
        })
    }

    /// Returns the bytes of the pictures that streams hold beside those of frames.
    pub(crate) fn ahead_bytes(&self, files: &dyn Files) -> u64 {
        let mut seen = HashSet::new();
        let live = self.present().filter_map(|(view, header, _)| Some((view.files.video()?, header)));
        let live = live.filter(|(video, _)| files.live(video).is_some() && seen.insert(video.to_path_buf()));
        live.map(|(_, header)| AHEAD.saturating_mul(read_bytes(header))).fold(0, u64::saturating_add)
    }

    /// Tells the videos which of their frames will be read.
    pub(crate) fn expect_frames(&self, access: Access) -> Result<()> {
        let Some(videos) = access.files.videos() else { return Ok(()) };
        for video in self.present().filter_map(|(view, ..)| view.files.video()) {
            videos.expect(video, self.frames.iter().copied().flatten())?;
        }
        Ok(())
    }

    /// Returns the files of a frame; frames of videos have names of their own.
    pub(crate) fn paths(&self, frame: Option<u64>) -> Vec<PathBuf> {
        self.present().map(|(input, _, _)| input.files.path(frame)).collect()
    }
}
