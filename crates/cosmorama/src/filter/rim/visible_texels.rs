use super::field_edge::FieldEdge;
use crate::sphere::Direction;
use crate::world::{TexelPlace, World};

/// Texels of a world that a target's field of view falls on. Neighbouring pixels at its edge ask for the same texels,
/// so results are remembered.
#[derive(Clone, Debug)]
pub(crate) struct SeenTexels<'a> {
    world: &'a World,
    edge: FieldEdge<'a>,
    /// Texels that were asked for recently, each with the result.
    found: Vec<Option<(u32, bool)>>,
}

/// Number of results that are remembered: enough for a row of patches at an edge.
const MEMORY: usize = 1 << 10;

impl<'a> SeenTexels<'a> {
    pub(crate) fn new(world: &'a World, edge: FieldEdge<'a>) -> Self {
        Self { world, edge, found: vec![None; MEMORY] }
    }

    /// Returns whether some texel within `reach` radians of a direction may be unseen.
    pub(crate) fn ends_near(&self, direction: Direction, reach: f64) -> bool {
        self.edge.is_near(direction, reach)
    }

    /// Returns whether a part of the field falls on the texel with this index.
    pub(crate) fn holds(&mut self, index: u32) -> bool {
        let slot = &mut self.found[slot(index)];
        match *slot {
            Some((known, is_seen)) if known == index => is_seen,
            _ => {
                let TexelPlace { view, texel } = self.world.texel(index);
                let is_seen = self.edge.touches(&self.world.sources()[view], texel);
                *slot = Some((index, is_seen));
                is_seen
            }
        }
    }
}

/// Returns the slot of a texel by a multiplicative hash (Knuth 1973): texels above each other are a power of two apart.
fn slot(index: u32) -> usize {
    (index.wrapping_mul(2_654_435_769) >> (u32::BITS - MEMORY.ilog2())) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{FieldStop, PixelGrid, View};
    use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
    use crate::sphere::Orientation;
    use crate::world::panorama;

    #[test]
    fn what_is_remembered_is_what_the_edge_says() {
        let rect = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
        let target = View {
            projection: ProjectionKind::EQUIDISTANT,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(60, 60, rect),
            stop: FieldStop::circle(0.7),
        };
        let world = World::new(["a", "b"].map(|name| (name.to_owned(), panorama(90, 45)))).expect("two views");
        let edge = FieldEdge::of(&target).expect("a circle");
        let mut seen = SeenTexels::new(&world, edge);
        let mut count = 0;
        // Far more texels than are remembered, each of them asked for twice.
        for index in (0..world.texel_count() as u32).flat_map(|index| [index, index]) {
            let TexelPlace { view, texel } = world.texel(index);
            let is_seen = edge.touches(&world.sources()[view], texel);
            assert_eq!(seen.holds(index), is_seen, "{texel:?}");
            count += usize::from(is_seen);
        }
        assert!(count > 1000 && count < world.texel_count(), "{count} texels are seen");
    }
}
