use super::scratch_pool::Pool;
use crate::camera::Footprint;
use crate::filter::Kernel;
use crate::filter::gather::{Gather, Scratch};
use crate::filter::kernel::KernelTable;
use crate::filter::taps::Taps;
use crate::world::World;

/// Lists of the texels under footprints, with their weights by one kernel. Threads reuse the memory of earlier lists.
pub(crate) struct TapLender {
    table: KernelTable,
    scratch: Pool<(Scratch, Taps)>,
}

impl TapLender {
    /// Prepares tap lists for a kernel.
    pub(crate) fn new(kernel: &Kernel) -> Self {
        Self { table: KernelTable::new(kernel), scratch: Pool::default() }
    }

    /// Calls `look` with the tap list of a footprint, and returns its result.
    pub(crate) fn lend<R>(&self, world: &World, footprint: &Footprint, look: impl FnOnce(&Taps) -> R) -> R {
        self.scratch.lend(|(scratch, taps)| {
            let mut gather = Gather::new(world, None, &self.table).with_scratch(std::mem::take(scratch));
            gather.taps(footprint, taps);
            *scratch = gather.into_scratch();
            look(taps)
        })
    }
}
