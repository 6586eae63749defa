/// Number of frames in flight around the one that is filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct QueueDepth {
    /// Frames that are being read or wait for their turn. If it is one, a frame is read when the one before it is
    /// finished and its samples are freed.
    pub(crate) read: usize,
    /// Frames whose pictures exist: one is being made, the others, in samples, are being written. If it is one, a picture is written
    /// before the next is made.
    pub(crate) written: usize,
    /// Bytes of all of them together, including the frame that is filtered, without what they share.
    pub(crate) bytes: u64,
}

/// Memory of a frame in bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameMemory {
    /// Samples, light and outputs.
    pub(crate) all: u64,
    /// Samples, if they differ from frame to frame.
    pub(crate) read: u64,
    /// Outputs.
    pub(crate) written: u64,
}

impl QueueDepth {
    /// Returns as many frames as fit into so many bytes, and no more than are wanted to be read and written.
    pub(crate) fn fitting(room: u64, frame: FrameMemory, (read, written): (usize, usize)) -> Self {
        let mut left = room.saturating_sub(frame.all);
        let mut fitting = Self { read: 1, written: 1, bytes: 0 };
        // In turns, so that neither side waits for the other.
        loop {
            let before = fitting;
            if fitting.read < read && left >= frame.read {
                (fitting.read, left) = (fitting.read + 1, left - frame.read);
            }
            if fitting.written < written && left >= frame.written {
                (fitting.written, left) = (fitting.written + 1, left - frame.written);
            }
            if fitting == before {
                return Self { bytes: room - left, ..fitting };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: FrameMemory = FrameMemory { all: 100, read: 10, written: 30 };

    fn fitting(room: u64, wanted: usize) -> [u64; 3] {
        let QueueDepth { read, written, bytes } = QueueDepth::fitting(room, FRAME, (wanted, wanted));
        [read as u64, written as u64, bytes]
    }

    #[test]
    fn without_room_frames_come_one_by_one() {
        assert_eq!(fitting(109, 4), [1, 1, 100]);
        assert_eq!(fitting(100, 4), [1, 1, 100]);
        assert_eq!(fitting(60, 4), [1, 1, 60], "never more than there is room for");
    }

    #[test]
    fn both_sides_grow_in_turns_until_nothing_more_fits() {
        assert_eq!(fitting(110, 4), [2, 1, 110]);
        assert_eq!(fitting(140, 4), [2, 2, 140]);
        assert_eq!(fitting(169, 4), [4, 2, 160]);
        assert_eq!(fitting(1000, 4), [4, 4, 220]);
        assert_eq!(fitting(1000, 1), [1, 1, 100]);
    }

    #[test]
    fn bytes_are_those_of_all_that_is_alive_at_once() {
        for room in 0..400 {
            let [read, written, bytes] = fitting(room, 5);
            let alive = FRAME.all + (read - 1) * FRAME.read + (written - 1) * FRAME.written;
            assert_eq!(bytes, alive.min(room), "{room}");
        }
    }
}
