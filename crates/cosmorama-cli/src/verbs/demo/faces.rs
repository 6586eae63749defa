use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use cosmorama::camera::{CameraModel, Canvas, OmnimaxCamera, PixelRect, View};
use cosmorama::explain::{Figures, Underlay};
use cosmorama::filter::FilterSettings;
use cosmorama::render::{Accuracy, Needs};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama::world::World;
use cosmorama_builtin::{DemoWorld, picture};
use cosmorama_convert::face_placement;
use cosmorama_io::FacePlacement;
use cosmorama_spec::{Cube, Spec};

use crate::console::Console;
use crate::verbs::{save_png, tell_made};

/// Edge of a whole face, in pixels.
pub(in crate::verbs) const FACE: usize = 1024;

/// Size of the frame, the paper's.
pub(in crate::verbs) const FRAME: (usize, usize) = (1966, 1436);

/// Folder of the faces.
const FOLDER: &str = "faces";

/// The demo world's faces that an Omnimax frame needs.
pub(in crate::verbs) struct Faces {
    /// Folder of all that is made; the faces lie in one of their own inside.
    dir: PathBuf,
    /// View of the frame.
    pub(in crate::verbs) target: View,
    /// Faces.
    pub(in crate::verbs) parts: Vec<PartialFace>,
}

/// A face of which only the part that the frame needs is rendered.
pub(in crate::verbs) struct PartialFace {
    face: CubeFace,
    window: PixelRect,
    view: View,
}

impl Faces {
    /// Finds the faces that the frame needs, each with the window that the filter reads.
    pub(in crate::verbs) fn needed(dir: &Path) -> Result<Self> {
        let target = CameraModel::Omnimax(OmnimaxCamera::default()).view(FRAME.0, FRAME.1)?;
        let needs = needs(&whole_cube()?, &target);
        let mut parts = Vec::new();
        for (face, need) in CubeFace::ALL.into_iter().zip(&needs.views) {
            let Some(window) = need.seen.and(need.read) else { continue };
            let view = face_view(face, Some(canvas(window)), window.width(), window.height())?;
            parts.push(PartialFace { face, window, view });
        }
        Ok(Self { dir: dir.to_owned(), target, parts })
    }

    /// Returns the folder of the faces.
    pub(in crate::verbs) fn folder(&self) -> PathBuf {
        self.dir.join(FOLDER)
    }

    /// Returns the pattern of the faces' files.
    pub(in crate::verbs) fn pattern(&self) -> PathBuf {
        self.folder().join("{face}.png")
    }

    /// Lists the faces' files.
    pub(in crate::verbs) fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.parts.iter().map(|part| self.file(part))
    }

    fn file(&self, part: &PartialFace) -> PathBuf {
        self.folder().join(part.face.name()).with_extension("png")
    }

    /// Renders a face, and writes it.
    pub(in crate::verbs) fn render(&self, part: &PartialFace, console: &Console) -> Result<()> {
        let start = Instant::now();
        let PartialFace { face, window, view } = part;
        save_png(&self.file(part), &picture(&DemoWorld, view), console)?;
        tell_made(console, &self.file(part), &format!("the {face} face, {window} of {FACE}x{FACE}, rendered"), start)
    }

    /// Returns the SPEC that declares the windows.
    pub(in crate::verbs) fn spec(&self) -> Spec {
        let is_cropped = |part: &&PartialFace| (part.window.width(), part.window.height()) != (FACE, FACE);
        let cropped = self.parts.iter().filter(is_cropped);
        let face_canvas = cropped.map(|part| (part.face, canvas(part.window))).collect();
        Cube { face_canvas, ..Cube::default() }.into()
    }

    /// Returns the world of these faces.
    pub(in crate::verbs) fn world(&self) -> Result<World> {
        let named = |part: &PartialFace| (part.face.name().to_owned(), part.view.clone());
        Ok(World::new(self.parts.iter().map(named))?)
    }

    /// Draws the unfolded cube with the faces' pictures.
    pub(in crate::verbs) fn unfolded(&self) -> Result<String> {
        let world = self.world()?;
        let underlay =
            |(view, part): (usize, &PartialFace)| Underlay { view, href: format!("{FOLDER}/{}.png", part.face) };
        let underlays: Vec<Underlay> = self.parts.iter().enumerate().map(underlay).collect();
        let figures = Figures { world: &world, target: &self.target };
        Ok(figures.unfolded(&needs(&world, &self.target), &underlays))
    }
}

/// Returns all six faces, whole.
pub(in crate::verbs) fn whole_cube() -> Result<World> {
    let view = |face: &CubeFace| Ok((face.name().to_owned(), face_view(*face, None, FACE, FACE)?));
    Ok(World::new(CubeFace::ALL.iter().map(view).collect::<Result<Vec<_>>>()?)?)
}

/// Returns the place of a window in its face.
fn canvas(window: PixelRect) -> Canvas {
    Canvas { width: FACE, height: FACE, left: window.left as i64, top: window.top as i64 }
}

fn needs(world: &World, target: &View) -> Needs {
    Needs::of(world, std::slice::from_ref(target), &FilterSettings::DEFAULT, Accuracy::Exact)
}

fn face_view(face: CubeFace, canvas: Option<Canvas>, width: usize, height: usize) -> Result<View> {
    let upright = FacePlacement::UPRIGHT;
    Ok(face_placement(&Cube::default(), face, upright, canvas, Orientation::IDENTITY).view(width, height)?)
}
