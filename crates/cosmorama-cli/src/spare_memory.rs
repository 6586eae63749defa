use std::alloc::Layout;
use std::collections::VecDeque;

/// How many blocks are kept at most: they are looked through, and their list must itself be too small to be kept here.
pub(crate) const BLOCKS: usize = 1 << 10;

/// Memory that was given back and is kept for the next who asks for as much: frames of a sequence hold pictures of the same
/// sizes, one after the other. `M` is how a block of it is known.
pub(crate) struct SpareMemory<M> {
    /// Blocks in the order in which they were given back, latest last.
    blocks: VecDeque<(Layout, M)>,
    /// Bytes of these.
    spare: usize,
    /// Bytes in use.
    used: usize,
    /// Bytes up to which memory is kept with what is in use.
    allowed: usize,
}

impl<M> SpareMemory<M> {
    /// Nothing, and nothing will be kept.
    pub(crate) const fn none() -> Self {
        Self { blocks: VecDeque::new(), spare: 0, used: 0, allowed: 0 }
    }

    /// From now on memory may be kept as long as it and what is in use are no more than so many bytes beside what is in use now.
    pub(crate) fn allow(&mut self, bytes: usize) {
        self.allowed = self.used.saturating_add(bytes);
    }

    /// Counts a block of this layout as used. It is a spare one, if there is one.
    pub(crate) fn take(&mut self, layout: Layout) -> Option<M> {
        self.count(layout);
        // What was used last may still be near.
        let found = self.blocks.iter().rposition(|(spare, _)| *spare == layout)?;
        let (_, memory) = self.blocks.remove(found)?;
        self.spare -= layout.size();
        Some(memory)
    }

    /// Counts a block of this layout as used. An allocator must not panic: however many ask at once for all there is, what they do
    /// not get is released again.
    pub(crate) fn count(&mut self, layout: Layout) {
        self.used = self.used.wrapping_add(layout.size());
    }

    /// Counts a block of this layout as used no more.
    pub(crate) fn release(&mut self, layout: Layout) {
        self.used = self.used.wrapping_sub(layout.size());
    }

    /// Bytes in use.
    #[cfg(test)]
    pub(crate) fn used(&self) -> usize {
        self.used
    }

    /// Whether a block of this layout is kept.
    #[cfg(test)]
    pub(crate) fn holds(&self, layout: Layout) -> bool {
        self.blocks.iter().any(|(spare, _)| *spare == layout)
    }

    /// Keeps a block that is used no more.
    pub(crate) fn give(&mut self, layout: Layout, memory: M) {
        self.release(layout);
        self.spare += layout.size();
        self.blocks.push_back((layout, memory));
    }

    /// The block that nobody has wanted for longest, where more is kept than may be. It is the caller's to dispose of.
    pub(crate) fn surplus(&mut self) -> Option<(Layout, M)> {
        if self.used.saturating_add(self.spare) <= self.allowed && self.blocks.len() <= BLOCKS {
            return None;
        }
        self.oldest()
    }

    /// The block that nobody has wanted for longest, the caller's to dispose of.
    pub(crate) fn oldest(&mut self) -> Option<(Layout, M)> {
        let (layout, memory) = self.blocks.pop_front()?;
        self.spare -= layout.size();
        Some((layout, memory))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(count: usize) -> Layout {
        Layout::array::<u8>(count).unwrap()
    }

    /// Memory of which so much may be kept, of which these blocks were used and are not.
    fn with_spare(allowed: usize, blocks: &[(Layout, char)]) -> SpareMemory<char> {
        let mut memory = SpareMemory::none();
        memory.allow(allowed);
        for (layout, _) in blocks {
            assert_eq!(memory.take(*layout), None);
        }
        for (layout, block) in blocks {
            memory.give(*layout, *block);
        }
        memory
    }

    #[test]
    fn what_was_given_back_serves_who_asks_for_the_same_and_nobody_else() {
        let mut memory = with_spare(100, &[(bytes(10), 'a'), (bytes(20), 'b'), (bytes(10), 'c')]);
        assert_eq!(memory.take(bytes(15)), None);
        assert_eq!(memory.take(Layout::array::<u16>(5).unwrap()), None, "aligned in another way");
        assert_eq!([(); 3].map(|()| memory.take(bytes(10))), [Some('c'), Some('a'), None]);
        assert_eq!(memory.surplus(), None);
    }

    #[test]
    fn no_more_is_kept_than_allowed_with_what_is_used() {
        let mut memory = with_spare(60, &[(bytes(10), 'a'), (bytes(20), 'b'), (bytes(30), 'c')]);
        assert_eq!(memory.surplus(), None);
        assert_eq!(memory.take(bytes(20)), Some('b'));
        assert_eq!(memory.surplus(), None, "as much as before");
        assert_eq!(memory.take(bytes(25)), None);
        assert_eq!([(); 3].map(|()| memory.surplus()), [Some((bytes(10), 'a')), Some((bytes(30), 'c')), None]);
        memory.release(bytes(25));
        memory.give(bytes(20), 'b');
        assert_eq!(memory.surplus(), None);
        memory.allow(19);
        assert_eq!([(); 2].map(|()| memory.surplus()), [Some((bytes(20), 'b')), None]);
    }

    #[test]
    fn what_was_in_use_before_takes_nothing_of_what_is_allowed() {
        let mut memory = with_spare(100, &[(bytes(10), 'a'), (bytes(20), 'b')]);
        memory.count(bytes(1000));
        memory.allow(30);
        assert_eq!(memory.surplus(), None);
        memory.count(bytes(11));
        assert_eq!([(); 3].map(|()| memory.surplus()), [Some((bytes(10), 'a')), Some((bytes(20), 'b')), None]);
    }

    #[test]
    fn of_many_blocks_those_given_back_first_go() {
        let mut memory = with_spare(usize::MAX, &vec![(bytes(1), 'a'); BLOCKS]);
        assert_eq!(memory.surplus(), None);
        assert_eq!(memory.take(bytes(2)), None);
        memory.give(bytes(2), 'b');
        assert_eq!([(); 2].map(|()| memory.surplus()), [Some((bytes(1), 'a')), None]);
        assert_eq!(memory.take(bytes(2)), Some('b'));
    }

    #[test]
    fn where_none_is_allowed_none_is_kept() {
        let mut memory = with_spare(0, &[(bytes(10), 'a')]);
        assert_eq!(memory.surplus(), Some((bytes(10), 'a')));
        assert_eq!(memory.take(bytes(10)), None);
    }
}
