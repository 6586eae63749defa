use thiserror::Error;

use super::{Arrangement, LayoutKind};

/// Reason why a picture does not fit a layout.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LayoutError {
    /// The faces would not be square.
    #[error(
        "{width}x{height} pixels are no {kind} of square faces, whose shape is {}:{}{}", .shape.0, .shape.1,
        fitting(.fits)
    )]
    Shape {
        /// The layout.
        kind: LayoutKind,
        /// Columns of the picture.
        width: usize,
        /// Rows of the picture.
        height: usize,
        /// The layout's own width and height, in lowest terms.
        shape: (usize, usize),
        /// The layouts that have this shape.
        fits: Vec<LayoutKind>,
    },
    /// A face with an odd number of pixels has no half.
    #[error("faces of {edge}x{edge} pixels cannot be halved; an even number is needed")]
    Odd {
        /// Pixels of a face's edge.
        edge: usize,
    },
    /// The outer faces of the layout would not be divided into halves that overlap so much.
    #[error(
        "{width}x{height} pixels are no two rows of three square faces whose outer ones have {overlap} columns twice; expected a \
         width of three faces and {} columns, as in 4096x2688 with 32", 2 * .overlap
    )]
    Overlap {
        /// Columns of the picture.
        width: usize,
        /// Rows of the picture.
        height: usize,
        /// Columns that both halves of a face show.
        overlap: usize,
    },
    /// Faces are smaller than the overlap of their halves.
    #[error(
        "faces of {edge}x{edge} pixels have no {overlap} columns for both of their halves; at least {overlap} are needed"
    )]
    Narrow {
        /// Pixels of a face's edge.
        edge: usize,
        /// Columns that both halves of a face show.
        overlap: usize,
    },
    /// Two pictures share an image that cannot be halved.
    #[error(
        "{width}x{height} pixels cannot be halved {}; an even {} is needed",
        match .arrangement { Arrangement::SideBySide => "side by side", Arrangement::TopBottom => "into top and bottom" },
        match .arrangement { Arrangement::SideBySide => "width", Arrangement::TopBottom => "height" }
    )]
    NoHalves {
        /// Arrangement of the two pictures.
        arrangement: Arrangement,
        /// Columns of the image.
        width: usize,
        /// Rows of the image.
        height: usize,
    },
}

fn fitting(kinds: &[LayoutKind]) -> String {
    if kinds.is_empty() {
        return "; no layout has that shape".to_owned();
    }
    let names: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
    format!("; of that shape: {}", names.join(", "))
}
