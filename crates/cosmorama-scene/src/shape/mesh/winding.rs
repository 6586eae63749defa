//! Triangles that are wound the wrong way.

use std::collections::BTreeSet;

use glam::DVec3;

use super::build::{Half, Welded};
use super::tree::Tree;
use crate::ray::{Ray, RayChange};

/// Direction in which a piece is left to find what is around it: along no edge of a model that people make.
const AWAY: DVec3 = DVec3::new(0.539_816_339_744_831, 0.302_775_637_731_994_6, 0.784_371_216_397_448_3);

/// Triangles that hang together by edges of two. Each knows another, and whether that is wound the other way.
struct Pieces {
    above: Vec<u32>,
    is_turned: Vec<bool>,
}

/// A closed piece of a surface.
struct Piece {
    /// Its triangles, each with whether it is wound unlike the first.
    faces: Vec<(u32, bool)>,
    /// Volume if all are wound as the first.
    volume: f64,
}

/// Lists the triangles of closed pieces that are wound the wrong way.
///
/// A piece is closed if each edge is passed as often in one direction as in the other once its triangles are wound alike; other
/// pieces are left as they are. A piece inside an even number of others faces outward, by the sign of its volume, and a piece inside
/// an odd number faces inward: it is a hollow. `tree` has the triangles in the same order.
pub(super) fn wrongly_wound(welded: &Welded, tree: &Tree) -> Vec<usize> {
    let pieces = closed(welded, tree);
    let mut owner = vec![u32::MAX; welded.corners.len()];
    for (index, piece) in pieces.iter().enumerate() {
        piece.faces.iter().for_each(|(face, _)| owner[*face as usize] = index as u32);
    }
    let mut wrong = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let is_hollow = around(index as u32, piece, &owner, tree) % 2 == 1;
        let is_inverse = (piece.volume < 0.0) != is_hollow;
        let turned = piece.faces.iter().filter(|(_, is_turned)| *is_turned != is_inverse);
        wrong.extend(turned.map(|(face, _)| *face as usize));
    }
    wrong
}

/// Lists the closed pieces that have a volume.
fn closed(welded: &Welded, tree: &Tree) -> Vec<Piece> {
    let halves = welded.halves();
    let edges = || halves.chunk_by(|a, b| a.0 == b.0);
    let mut pieces = Pieces::new(welded.corners.len());
    for edge in edges() {
        if let [a, b] = edge {
            // Neighbours that are wound alike pass their edge in opposite directions.
            pieces.join(a.1, b.1, a.2 == b.2);
        }
    }
    let roots: Vec<(u32, bool)> = (0..welded.corners.len() as u32).map(|face| pieces.root(face)).collect();
    let mut is_open = vec![false; roots.len()];
    for edge in edges() {
        let pass = |half: &Half| {
            let (root, is_turned) = roots[half.1 as usize];
            (root, if half.2 == is_turned { -1 } else { 1 })
        };
        let mut passes: Vec<(u32, i32)> = edge.iter().map(pass).collect();
        passes.sort_unstable();
        for own in passes.chunk_by(|a, b| a.0 == b.0) {
            is_open[own[0].0 as usize] |= own.iter().map(|pass| pass.1).sum::<i32>() != 0;
        }
    }
    let mut order: Vec<u32> =
        (0..roots.len() as u32).filter(|face| !is_open[roots[*face as usize].0 as usize]).collect();
    order.sort_by_key(|face| roots[*face as usize].0);
    let piece = |faces: &[u32]| {
        let faces: Vec<(u32, bool)> = faces.iter().map(|face| (*face, roots[*face as usize].1)).collect();
        Piece { volume: volume(&faces, tree), faces }
    };
    let pieces = order.chunk_by(|a, b| roots[*a as usize].0 == roots[*b as usize].0).map(piece);
    pieces.filter(|piece| piece.volume != 0.0).collect()
}

fn volume(faces: &[(u32, bool)], tree: &Tree) -> f64 {
    let apex = tree.corners(faces[0].0 as usize)[0];
    let part = |(face, is_turned): &(u32, bool)| {
        let [a, b, c] = tree.corners(*face as usize).map(|corner| corner - apex);
        if *is_turned { -a.dot(b.cross(c)) } else { a.dot(b.cross(c)) }
    };
    faces.iter().map(part).sum()
}

/// Counts the pieces that all of a piece is inside of: from a corner of each of its triangles, a ray leaves such a piece an odd
/// number of times. Pieces that cut one another are beside one another.
fn around(index: u32, piece: &Piece, owner: &[u32], tree: &Tree) -> usize {
    let holders = |face: u32| {
        let mut met: BTreeSet<u32> = BTreeSet::new();
        tree.each_met(&leaving(tree.corners(face as usize)[0]), |face| {
            let other = owner[face];
            if other == index || other == u32::MAX {
                return;
            }
            // Each time it is met, the ray goes in or out.
            if !met.remove(&other) {
                met.insert(other);
            }
        });
        met
    };
    let mut faces = piece.faces.iter().map(|(face, _)| *face);
    let mut all = faces.next().map(holders).unwrap_or_default();
    for face in faces {
        if all.is_empty() {
            break;
        }
        let here = holders(face);
        all.retain(|holder| here.contains(holder));
    }
    all.len()
}

fn leaving(origin: DVec3) -> Ray {
    let still = RayChange { origin: DVec3::ZERO, direction: DVec3::ZERO };
    Ray { origin, direction: AWAY.normalize(), dx: still, dy: still }
}

impl Pieces {
    fn new(count: usize) -> Self {
        Self { above: (0..count as u32).collect(), is_turned: vec![false; count] }
    }

    /// Returns the first triangle of a triangle's piece, and whether that is wound the other way.
    fn root(&mut self, face: u32) -> (u32, bool) {
        let (mut at, mut is_turned) = (face as usize, false);
        while self.above[at] as usize != at {
            // Ways are halved as they are gone.
            let next = self.above[at] as usize;
            self.is_turned[at] ^= self.is_turned[next];
            self.above[at] = self.above[next];
            is_turned ^= self.is_turned[at];
            at = self.above[at] as usize;
        }
        (at as u32, is_turned)
    }

    /// Joins the pieces of two triangles that are wound alike, or not. Within one piece nothing changes.
    fn join(&mut self, a: u32, b: u32, is_turned: bool) {
        let (a, b) = (self.root(a), self.root(b));
        let (first, other) = if a.0 < b.0 { (a, b) } else { (b, a) };
        if first.0 != other.0 {
            self.above[other.0 as usize] = first.0;
            self.is_turned[other.0 as usize] = first.1 ^ other.1 ^ is_turned;
        }
    }
}
