use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama::world::{Canvas, Frame, Mirror, Placement, SamplePositions};
use cosmorama_io::Naming;

/// What a SPEC stands for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    /// One image.
    Single(Single),
    /// An image for each face of a cube.
    Cube(Cube),
}

/// One image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Single {
    /// Its frame and place in the world.
    pub(crate) placement: Placement,
    /// Whether `samples=` was given for a panorama.
    pub(crate) samples: SphereSamples,
}

/// Where a panorama's outermost samples lie, and who says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SphereSamples {
    /// The projection has no such choice.
    NotAPanorama,
    /// As the file format has it.
    ByFormat,
    /// As the SPEC says.
    Given(SamplePositions),
}

/// The faces of a cube, a file each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cube {
    /// How they are named.
    pub(crate) naming: Option<&'static Naming>,
    /// Which of them count.
    pub(crate) faces: Vec<CubeFace>,
    /// How the cube is turned.
    pub(crate) orientation: Orientation,
    /// How every face's picture is mirrored.
    pub(crate) mirror: Mirror,
    /// The canvas of every face.
    pub(crate) canvas: Option<Canvas>,
    /// The canvas of single faces.
    pub(crate) face_canvas: Vec<(CubeFace, Canvas)>,
}

impl Single {
    /// The same with samples where a file format has them, unless the SPEC says where.
    pub(crate) fn with_samples(mut self, samples: SamplePositions) -> Self {
        if let (Frame::Equirect(frame), SphereSamples::ByFormat) = (&mut self.placement.frame, self.samples) {
            frame.samples = samples;
        }
        self
    }
}

impl Cube {
    /// The canvas of a face.
    pub(crate) fn canvas_of(&self, face: CubeFace) -> Option<Canvas> {
        let own = self.face_canvas.iter().find(|(other, _)| *other == face).map(|(_, canvas)| *canvas);
        own.or(self.canvas)
    }
}

impl Default for Cube {
    fn default() -> Self {
        Self {
            naming: None,
            faces: CubeFace::ALL.to_vec(),
            orientation: Orientation::IDENTITY,
            mirror: Mirror::default(),
            canvas: None,
            face_canvas: Vec::new(),
        }
    }
}
