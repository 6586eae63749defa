//! Bounds of what kernels can reach in a world without holes. They are found from blocks of pixels; hardly any pixel is
//! tested singly.

use rayon::prelude::*;

use super::block::Block;
use super::need::{Reads, Survey};
use crate::camera::View;
use crate::filter::FilterSettings;
use crate::filter::gather::cap::Cap;
use crate::filter::gather::pixel_taps::PixelTaps;
use crate::filter::kernel::KernelTable;
use crate::render::Needs;
use crate::world::World;

impl Needs {
    /// Finds bounds of what is read in a world whose views leave no hole, as a cube's faces do; `None` for any other
    /// world. It is several times as fast as a survey. There are no uncovered pixels. `seen` may be too small, but is
    /// `Some` wherever anything is seen.
    pub(crate) fn within_reach(world: &World, targets: &[View], filter: &FilterSettings) -> Option<Self> {
        if !world.is_closed() {
            return None;
        }
        let mut needs = Self::nothing(world);
        let table = KernelTable::new(&filter.kernel);
        for (index, target) in targets.iter().enumerate() {
            let survey = Survey { world, target, index, filter, reads: Reads::AtMost };
            let blocks = Block::largest(target);
            let pixels = || PixelTaps::new(world, target, filter, &table);
            let reached = blocks.par_iter().map_init(pixels, |pixels, block| {
                let mut found = Self::nothing(world);
                survey.reach(*block, pixels, &mut found);
                found
            });
            needs = reached.collect::<Vec<_>>().iter().fold(needs, Self::merged);
            // A view that may be read, but that no block's middle sees, may still be seen by other pixels.
            let unseen: Vec<bool> = needs.views.iter().map(|need| need.seen.is_none() && need.read.is_some()).collect();
            if unseen.contains(&true) {
                let looks = blocks.par_iter().map(|block| {
                    let mut found = Self::nothing(world);
                    survey.look(*block, &unseen, &mut found);
                    found
                });
                needs = looks.collect::<Vec<_>>().iter().fold(needs, Self::merged);
            }
        }
        Some(needs)
    }
}

impl Survey<'_> {
    /// Adds what kernels around a block's pixels can touch, and what its middle sees. A block at the edge of the
    /// picture is divided into its smallest parts. In a block without a cap, each pixel is tested.
    fn reach(&self, block: Block, pixels: &mut PixelTaps, needs: &mut Needs) {
        if block.is_hidden(self.target) {
            return;
        }
        let cap = block.cap(self.target);
        let inside = cap.filter(|cap| !block.is_near_border_of(self.target) && cap.is_inside(self.target));
        if let Some(cap) = inside {
            self.add_reach(&cap, needs);
            let (i, j) = block.middle();
            return self.add_centre((i, j), needs);
        }
        if let Some(parts) = block.parts() {
            return parts.for_each(|part| self.reach(part, pixels, needs));
        }
        match cap {
            Some(cap) => self.add_reach(&cap, needs),
            None => self.add_block(&self.judged(block), pixels, needs),
        }
    }

    /// Adds what pixels see, in blocks whose kernels reach one of these views.
    fn look(&self, block: Block, views: &[bool], needs: &mut Needs) {
        let reaches = |cap: Cap| cap.read_texels(self.world, &self.filter.kernel).any(|(view, _)| views[view]);
        if block.is_hidden(self.target) || !block.cap(self.target).is_none_or(reaches) {
            return;
        }
        match block.parts() {
            Some(parts) => parts.for_each(|part| self.look(part, views, needs)),
            None => block.pixels().for_each(|pixel| self.add_screen(pixel, needs)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{FieldStop, OmnimaxFraming, PixelGrid, PixelRect};
    use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
    use crate::sphere::{Angle, CubeFace, Orientation};

    fn view(projection: ProjectionKind, size: [usize; 2], half: [f64; 2], orientation: Orientation) -> View {
        let rect = PlaneRect { min: PlanePoint::new(-half[0], -half[1]), max: PlanePoint::new(half[0], half[1]) };
        View { projection, orientation, grid: PixelGrid::spanning(size[0], size[1], rect), stop: FieldStop::NONE }
    }

    #[test]
    fn what_is_within_reach_is_little_more_than_what_is_read_at_most() {
        let face = |face: CubeFace| view(ProjectionKind::PERSPECTIVE, [512; 2], [1.0; 2], face.orientation());
        let world = World::new(CubeFace::ALL.map(|f| (f.name().to_owned(), face(f)))).expect("six faces");
        let quarter = Angle::from_degrees(90.0).radians();
        let [yaw, none] = [10.0, 0.0].map(Angle::from_degrees);
        let turned = Orientation::from_yaw_pitch_roll(yaw, none, none);
        let fisheye = view(ProjectionKind::EQUIDISTANT, [1024; 2], [quarter; 2], Orientation::IDENTITY);
        let omnimax = View {
            projection: ProjectionKind::OMNIMAX,
            orientation: Orientation::IDENTITY,
            grid: OmnimaxFraming::Fit.grid(983, 718, 1.0),
            stop: FieldStop::circle(1.0).with_lower(Angle::from_degrees(45.0)),
        };
        let targets = [
            View { stop: FieldStop::circle(quarter), ..fisheye },
            omnimax,
            view(ProjectionKind::PERSPECTIVE, [300, 200], [1.0, 2.0 / 3.0], turned),
        ];
        for target in targets {
            let most = Needs::at_most(&world, std::slice::from_ref(&target), &FilterSettings::DEFAULT);
            let quick = Needs::within_reach(&world, std::slice::from_ref(&target), &FilterSettings::DEFAULT)
                .expect("six faces leave no hole");
            for (most, quick) in most.views.iter().zip(&quick.views) {
                let wider = |most: PixelRect| PixelRect {
                    left: most.left.saturating_sub(10),
                    top: most.top.saturating_sub(10),
                    right: most.right + 10,
                    bottom: most.bottom + 10,
                };
                let holds = |quick| most.read.is_some_and(|most| wider(most).contains(&quick));
                assert!(quick.read.is_none_or(holds), "{quick:?} is not in {most:?}: {target:?}");
            }
        }
    }
}
