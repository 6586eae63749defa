use cosmorama::camera::PixelPoint;
use glam::DVec3;
use rayon::prelude::*;

use crate::camera::Camera;
use crate::scene::Scene;
use crate::shape::{Mesh, Rim};

/// Pixels that outlines, borders and creases of meshes cross.
///
/// Each such edge is followed through the picture, so that none is missed, however thin what it bounds.
pub(super) struct Marks {
    width: usize,
    /// A flag for each pixel; none without meshes.
    marked: Vec<bool>,
}

/// Halvings of an edge at most, and of one whose ends are not shown.
const MOST: usize = 24;
const UNSEEN: usize = 5;

/// Follower of edges.
struct Follower<'a> {
    camera: &'a Camera,
    size: [f64; 2],
}

/// An end of an edge, and its place in the picture.
#[derive(Clone, Copy)]
struct End {
    point: DVec3,
    pixel: Option<PixelPoint>,
}

impl Marks {
    pub(super) fn of(scene: &Scene, camera: &Camera) -> Self {
        let width = camera.width();
        let meshes: Vec<&Mesh> = scene.objects.iter().filter_map(|object| object.shape.mesh()).collect();
        if meshes.is_empty() {
            return Self { width, marked: Vec::new() };
        }
        let mut marked = vec![false; width * camera.height()];
        let follower = Follower { camera, size: [width as f64, camera.height() as f64] };
        for mesh in meshes {
            let crossed: Vec<usize> = (0..mesh.rim_count())
                .into_par_iter()
                .map(|k| mesh.rim(k))
                .filter(|rim| shows(mesh, rim, camera))
                .flat_map_iter(|rim| follower.pixels(rim.ends))
                .collect();
            crossed.into_iter().for_each(|pixel| marked[pixel] = true);
        }
        Self { width, marked }
    }

    /// Returns whether an edge crosses a pixel.
    pub(super) fn has(&self, i: usize, j: usize) -> bool {
        self.marked.get(j * self.width + i).is_some_and(|marked| *marked)
    }
}

/// Returns whether a surface ends, or breaks off, at an edge: a smooth one is an outline where one side is seen from before and
/// the other from behind.
fn shows(mesh: &Mesh, rim: &Rim, camera: &Camera) -> bool {
    let is_before = |face: usize| {
        let (normal, point) = mesh.plane(face);
        camera.towards(point).is_some_and(|towards| normal.dot(towards) < 0.0)
    };
    rim.smooth.is_none_or(|faces| is_before(faces[0]) != is_before(faces[1]))
}

impl Follower<'_> {
    fn pixels(&self, ends: [DVec3; 2]) -> Vec<usize> {
        let mut into = Vec::new();
        self.follow(ends.map(|point| self.end(point)), 0, &mut into);
        into
    }

    fn end(&self, point: DVec3) -> End {
        End { point, pixel: self.camera.pixel(point) }
    }

    /// Adds the pixels under an edge: it is halved until its ends are at most a pixel apart.
    fn follow(&self, ends: [End; 2], depth: usize, into: &mut Vec<usize>) {
        let most = match ends.map(|end| end.pixel) {
            [Some(a), Some(b)] => {
                let apart = (a.x - b.x).abs().max((a.y - b.y).abs());
                if self.is_beside(a, b, apart + 1.0) {
                    return;
                }
                if apart <= 1.0 || depth == MOST {
                    return self.mark(a, b, into);
                }
                MOST
            }
            [None, None] => UNSEEN,
            _ => MOST,
        };
        if depth < most {
            let middle = self.end(0.5 * (ends[0].point + ends[1].point));
            self.follow([ends[0], middle], depth + 1, into);
            self.follow([middle, ends[1]], depth + 1, into);
        }
    }

    /// Returns whether all between two places is beside the picture, with room for edges that are bent.
    fn is_beside(&self, a: PixelPoint, b: PixelPoint, room: f64) -> bool {
        let beside = |a: f64, b: f64, size: f64| a.max(b) < -room || a.min(b) > size + room;
        beside(a.x, b.x, self.size[0]) || beside(a.y, b.y, self.size[1])
    }

    fn mark(&self, a: PixelPoint, b: PixelPoint, into: &mut Vec<usize>) {
        let range = |a: f64, b: f64, size: f64| {
            let last = size - 1.0;
            (a.min(b).floor().clamp(0.0, last) as usize, a.max(b).floor().clamp(0.0, last) as usize)
        };
        let (columns, rows) = (range(a.x, b.x, self.size[0]), range(a.y, b.y, self.size[1]));
        // Places far apart are those of an edge that crosses a seam: its ends alone count.
        if columns.1 - columns.0 > 2 || rows.1 - rows.0 > 2 {
            self.mark(a, a, into);
            return self.mark(b, b, into);
        }
        let width = self.size[0] as usize;
        into.extend((rows.0..=rows.1).flat_map(|j| (columns.0..=columns.1).map(move |i| j * width + i)));
    }
}
