use cosmorama::raster::Depth;
use cosmorama::sphere::Direction;

use super::balance;
use super::frame_light::FrameLight;
use crate::job::ConvertJob;

/// The part of a world's light in suns from which their change shows in what it lights.
const MUCH: f64 = 0.1;

/// Directions by which it is found whether outputs show the whole world.
const DIRECTIONS: usize = 500;

/// Where a whole world is made of light of which much comes from suns, few filters keep it.
pub(super) fn warning(job: &ConvertJob, light: &FrameLight) -> Option<String> {
    if balance::is_asked_for(job) || !is_of_any_range(job) || !shows_the_world(job) {
        return None;
    }
    let parts = job.worlds.iter().enumerate();
    let part = parts.map(|(index, world)| world.light_of_suns(|texel| light.texels().rgba(index, texel)));
    let part = part.fold(0.0, f64::max);
    (part > MUCH).then(|| {
        format!(
            "{:.0} % of the light comes from suns or lamps, over a hundred times as bright as the mean; this filter \
             may add light to them or take some away. Where the picture is to light a scene, --filter ewa --kernel light \
             keeps what there is, and is a little softer",
            100.0 * part
        )
    })
}

/// Whether some input holds more than white.
fn is_of_any_range(job: &ConvertJob) -> bool {
    job.input.present().any(|(_, header, _)| matches!(header.depth, Depth::Half | Depth::Float))
}

/// Whether the outputs show all directions, or all but a few.
fn shows_the_world(job: &ConvertJob) -> bool {
    let sees = |direction: &Direction| job.target.views.iter().any(|target| target.view.sees(*direction));
    let seen = Direction::spread(DIRECTIONS).filter(sees).count();
    100 * seen >= 99 * DIRECTIONS
}
