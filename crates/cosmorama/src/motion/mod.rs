//! A camera that turns: where it looks at each moment, and what a pixel sees while the shutter is open (N. Greene,
//! *Applications of world projections*, Graphics Interface '86, sections 9 and 10).
//!
//! Times are numbers of frames: 12.5 is halfway from frame 12 to frame 13. A [`Track`] goes through given poses, a
//! [`Turn`] turns evenly. A [`Shutter`] says for how long each frame is exposed, and an [`Exposure`] averages what is
//! seen meanwhile.
//!
//! ```
//! use cosmorama::motion::{Exposure, Key, Pose, Shutter, Smoothness, Track};
//! use cosmorama::prelude::*;
//!
//! let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.5, 0.5, 0.5)))?;
//! let turned = |degrees| Orientation::from_yaw_pitch_roll(Angle::from_degrees(degrees), Angle::ZERO, Angle::ZERO);
//! let keys = [(1.0, 0.0), (25.0, 30.0)].map(|(time, degrees)| Key { time, pose: Pose::of(turned(degrees)) });
//! let track = Track::new(keys.to_vec(), Smoothness::Slerp)?;
//! let wide = FieldOfView::Horizontal(Angle::from_degrees(60.0));
//! let camera = CameraModel::from(PerspectiveCamera::new(wide)).view(32, 24)?;
//! // Frame 12 is exposed from 11.75 to 12.25.
//! let view = |time| camera.turned(track.pose(time).orientation);
//! let exposure = Exposure::of(view, &Shutter::centred(0.5), 12.0, world.texel_pitch());
//! let frame = exposure.render(|view| Ok::<_, ()>(Resampler::new(&world, view).render(light.texels())));
//! assert_eq!(frame.expect("a frame").width(), 32);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod exposure;
mod light_sum;
mod marks;
mod rings;
mod shutter;
mod sweep;
mod track;
mod turn;
mod turning;

pub use exposure::Exposure;
pub use light_sum::LightSum;
pub use shutter::{Moment, Shutter, ShutterCurve};
pub use track::{Key, Pose, Smoothness, Track, TrackError};
pub use turn::{Easing, Ramp, Turn};
