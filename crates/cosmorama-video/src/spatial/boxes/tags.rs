//! `st3d` and `sv3d`, by Google's Spherical Video V2.

use super::Fault;
use super::tree::{boxed, find, get, split};
use crate::spatial::{Bounds, SpatialTags, SphericalPose, SphericalProjection, StereoMode};

/// Version and flags of a box.
const PLAIN: [u8; 4] = [0; 4];

/// Reads the boxes among those that extend a description of video; `None` if there are none.
pub(super) fn read(extensions: &[u8]) -> Result<Option<SpatialTags>, Fault> {
    let stereo = match find(extensions, b"st3d")? {
        Some(found) => Some(stereo(found.content)?),
        None => None,
    };
    let Some(spherical) = find(extensions, b"sv3d")? else {
        return Ok(stereo.map(|stereo| SpatialTags { stereo, ..SpatialTags::default() }));
    };
    let projection = get(spherical.content, b"proj")?.content;
    let pose = match find(projection, b"prhd")? {
        Some(found) => {
            let [yaw, pitch, roll] = numbers(found.content)?.map(u32::cast_signed);
            SphericalPose { yaw, pitch, roll }
        }
        None => SphericalPose::default(),
    };
    Ok(Some(SpatialTags { stereo: stereo.flatten(), projection: kind(projection)?, pose }))
}

fn stereo(content: &[u8]) -> Result<Option<StereoMode>, Fault> {
    match content.get(4) {
        Some(0) => Ok(Some(StereoMode::Mono)),
        Some(1) => Ok(Some(StereoMode::TopBottom)),
        Some(2) => Ok(Some(StereoMode::LeftRight)),
        Some(_) => Ok(None),
        None => Err("st3d is too short".to_owned()),
    }
}

fn kind(projection: &[u8]) -> Result<Option<SphericalProjection>, Fault> {
    for found in split(projection)? {
        match &found.name {
            b"equi" => {
                let [top, bottom, left, right] = numbers(found.content)?;
                return Ok(Some(SphericalProjection::Equirect(Bounds { top, bottom, left, right })));
            }
            b"cbmp" => {
                let [layout, padding] = numbers(found.content)?;
                return Ok(Some(SphericalProjection::Cubemap { layout, padding }));
            }
            b"mshp" => return Ok(Some(SphericalProjection::Mesh)),
            _ => {}
        }
    }
    Ok(None)
}

/// Reads numbers behind version and flags.
fn numbers<const COUNT: usize>(content: &[u8]) -> Result<[u32; COUNT], Fault> {
    let bytes = content.get(4..4 + 4 * COUNT).ok_or("a box is too short")?;
    let mut words =
        bytes.chunks_exact(4).map(|word| word.iter().fold(0, |number, byte| number << 8 | u32::from(*byte)));
    Ok(std::array::from_fn(|_| words.next().unwrap_or(0)))
}

/// Returns the boxes of the tags.
pub(super) fn write(tags: &SpatialTags) -> Result<Vec<u8>, Fault> {
    let mut boxes = match tags.stereo {
        Some(stereo) => {
            let mode = match stereo {
                StereoMode::Mono => 0,
                StereoMode::TopBottom => 1,
                StereoMode::LeftRight => 2,
            };
            boxed(b"st3d", &[0, 0, 0, 0, mode])?
        }
        None => Vec::new(),
    };
    if let Some(projection) = tags.projection {
        boxes.extend(spherical(projection, tags.pose)?);
    }
    Ok(boxes)
}

fn spherical(projection: SphericalProjection, pose: SphericalPose) -> Result<Vec<u8>, Fault> {
    let plain = |words: &[u32]| {
        let bytes = words.iter().flat_map(|word| word.to_be_bytes());
        PLAIN.into_iter().chain(bytes).collect::<Vec<u8>>()
    };
    let kind = match projection {
        SphericalProjection::Equirect(Bounds { top, bottom, left, right }) => {
            boxed(b"equi", &plain(&[top, bottom, left, right]))?
        }
        SphericalProjection::Cubemap { layout, padding } => boxed(b"cbmp", &plain(&[layout, padding]))?,
        SphericalProjection::Mesh => {
            return Err("a mesh cannot be written as its projection; give an equirectangular one, or a cube".to_owned());
        }
    };
    let header = boxed(b"svhd", &[&PLAIN, b"cosmorama\0".as_slice()].concat())?;
    let pose = boxed(b"prhd", &plain(&[pose.yaw, pose.pitch, pose.roll].map(i32::cast_unsigned)))?;
    boxed(b"sv3d", &[header, boxed(b"proj", &[pose, kind].concat())?].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_come_back_from_their_boxes() {
        let pose = SphericalPose { yaw: -90 << 16, pitch: 30 << 16, roll: 1 };
        let cube = SphericalProjection::Cubemap { layout: 0, padding: 8 };
        let all = [
            SpatialTags::panorama(StereoMode::Mono),
            SpatialTags::panorama(StereoMode::TopBottom),
            SpatialTags { pose, ..SpatialTags::vr180() },
            SpatialTags { stereo: None, projection: Some(cube), pose },
            SpatialTags { stereo: Some(StereoMode::LeftRight), ..SpatialTags::default() },
        ];
        for tags in all {
            assert_eq!(read(&write(&tags).unwrap()).unwrap(), Some(tags));
        }
        assert_eq!(read(b"").unwrap(), None);
        let mesh = SpatialTags { projection: Some(SphericalProjection::Mesh), ..SpatialTags::default() };
        assert!(write(&mesh).is_err());
    }

    #[test]
    fn boxes_are_those_of_the_specification() {
        let boxes = write(&SpatialTags::vr180()).unwrap();
        assert_eq!(&boxes[..13], b"\0\0\0\x0dst3d\0\0\0\0\x02");
        let end = b"\0\0\0\x1cequi\0\0\0\0\0\0\0\0\0\0\0\0\x40\0\0\0\x40\0\0\0";
        assert_eq!(&boxes[boxes.len() - end.len()..], end);
        // Shortened, they are refused.
        let short = boxed(b"sv3d", &boxed(b"proj", &boxed(b"equi", &[0; 9]).unwrap()).unwrap()).unwrap();
        assert!(read(&short).is_err());
    }
}
