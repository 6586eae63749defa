//! Mirrored faces: the effect of `flip=x`.

use cosmorama::arrange::Pose;
use cosmorama::camera::Mirror;
use cosmorama::layout::{CubeLayout, FaceOrder, FacePlacement, LayoutKind};
use cosmorama_spec::Cube;

pub(crate) const ACROSS: Mirror = Mirror { x: true, y: false };

/// Returns the placement of a picture that is mirrored before it is turned.
pub(crate) fn of(pose: Pose) -> Pose {
    let lies = pose.placement();
    Pose::new(pose.face, FacePlacement { mirrored: !lies.mirrored, ..lies })
}

/// Returns the placements of pictures in a kind of layout, if the image is the mirror image of one in `layout`: every
/// face mirrored, in the opposite place. `None` if the kind does not have these places.
pub(crate) fn poses(kind: LayoutKind, layout: CubeLayout) -> Option<Vec<Pose>> {
    let across = layout.mirrored(ACROSS).faces(2);
    let places = CubeLayout::new(kind).faces(2);
    let pose =
        |rect| across.iter().find(|placed| placed.rect == rect).map(|placed| of(Pose::new(placed.face, placed.lies)));
    places.iter().map(|place| pose(place.rect)).collect()
}

/// Returns the cube, with its order and its turns, of pictures mirrored by `flip=x` that lie as given, in the order of the
/// layout's places.
pub(crate) fn cube(kind: LayoutKind, lie: &[Pose]) -> Option<Cube> {
    let plain = || CubeLayout::new(kind);
    let places = plain().faces(2);
    // An image that is mirrored has its first face last.
    let seats = plain().mirrored(ACROSS).faces(2);
    let seat = |rect| places.iter().position(|place| place.rect == rect);
    let seats: Vec<usize> = seats.iter().map(|placed| seat(placed.rect)).collect::<Option<_>>()?;
    let letters: String = seats.iter().filter_map(|place| lie.get(*place)?.face.name().chars().next()).collect();
    let order = FaceOrder::parse(&letters)?;
    let ordered = |turns: u8| plain().with_order(&order).with_turns([turns; 6]);
    let turned: Vec<Vec<Pose>> = (0..4).map(|turns| poses(kind, ordered(turns))).collect::<Option<_>>()?;
    let digit = |place: &usize| (0..4_u8).find(|turns| turned[usize::from(*turns)][*place] == lie[*place]);
    let rotate: Vec<u8> = seats.iter().map(digit).collect::<Option<_>>()?;
    Some(Cube { order: Some(order), rotate: rotate.try_into().ok(), ..kind.into() })
}
