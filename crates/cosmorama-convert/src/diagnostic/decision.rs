use super::Message;

/// Decision of a conversion with its reason, for those who ask how their picture was made. Nothing is wrong with any.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Subject of the decision.
    pub topic: Topic,
    /// Whether it is a detail of another one: a file of many, or a frame.
    pub is_detail: bool,
    /// Readable text.
    pub message: Message,
}

/// Subject of a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Topic {
    /// Files that are read.
    Input,
    /// Projections of the input and of the output, and how the input's was found.
    Projection,
    /// Transfer functions, primaries, channels and samples of inputs and outputs.
    Colour,
    /// Filter, kernel, and the numbers in which they compute.
    Filter,
    /// Geometry: kept for all frames, or computed with each.
    Geometry,
    /// Memory and threads.
    Memory,
    /// Frames to make, and those that are read and written at once.
    Frames,
}

impl Decision {
    /// Creates a decision.
    pub fn new(topic: Topic, message: impl Into<Message>) -> Self {
        Self { topic, is_detail: false, message: message.into() }
    }

    /// Creates a detail of another decision.
    pub fn detail(topic: Topic, message: impl Into<Message>) -> Self {
        Self { is_detail: true, ..Self::new(topic, message) }
    }
}
