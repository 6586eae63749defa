use crate::sphere::Angle;

/// The field of view of a camera, measured across its image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldOfView {
    /// From the left edge to the right one.
    Horizontal(Angle),
    /// From the bottom edge to the top one.
    Vertical(Angle),
    /// From one corner to the opposite one.
    Diagonal(Angle),
    /// Horizontal and vertical angle; pixels are square only if the two fit the image's shape.
    Both {
        /// From the left edge to the right one.
        horizontal: Angle,
        /// From the bottom edge to the top one.
        vertical: Angle,
    },
}

impl FieldOfView {
    /// Returns an angle measured in this way; `None` where two angles are needed.
    pub(crate) fn with_angle(self, angle: Angle) -> Option<Self> {
        match self {
            Self::Horizontal(_) => Some(Self::Horizontal(angle)),
            Self::Vertical(_) => Some(Self::Vertical(angle)),
            Self::Diagonal(_) => Some(Self::Diagonal(angle)),
            Self::Both { .. } => None,
        }
    }
}
