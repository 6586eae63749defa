use cosmorama::filter::FilterSettings;
use cosmorama::raster::Rgba;
use cosmorama::render::{Beyond, Progress, Share};
use cosmorama::sphere::Direction;
use cosmorama::world::{Source, World, WorldView};
use cosmorama_spec::{Missing, Size};

use super::gaps::{Shot, empty, find_gaps};
use crate::diagnostic::{Code, Diagnostic, MISSING, Result, bail, failed_as, usage};
use crate::input::{Input, InputView};
use crate::source::MemoryBudget;

/// Treatment of pixels that look where no view does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coverage {
    /// There are no such pixels.
    Complete,
    /// Such pixels are filled with a colour.
    Fill(Rgba),
    /// Such pixels are filled with what stands beyond the edge of the world.
    Continue(Beyond),
}

/// Refuses whole pictures that are too large.
pub(crate) fn check_pictures(input: &Input, memory: MemoryBudget) -> Result<()> {
    memory.check_pictures(input)?;
    input.views().try_for_each(check_sides)
}

/// Returns the worlds of whole pictures, even if files are missing: one, or one for each eye.
pub(crate) fn whole_worlds(input: &Input) -> Result<Vec<World>> {
    let world =
        |views: &Vec<InputView>| Ok(World::blended(views.iter().map(|view| view.world_view(view.nominal.clone())))?);
    input.worlds.iter().map(world).collect()
}

/// Refuses a canvas that is longer than any picture: thin enough, it would fit into memory, and take minutes.
fn check_sides(view: &InputView) -> Result<()> {
    let (width, height) = (view.nominal.width(), view.nominal.height());
    if width.max(height) <= Size::MOST {
        return Ok(());
    }
    let path = view.files.path(None);
    let found = format!("{}: its canvas of {width}x{height} pixels is longer than any picture", path.display());
    Err(failed_as(Code::WrongSize, format!("{found}; sides are 1 to {} pixels", Size::MOST)))
}

impl Coverage {
    /// Compares what the target needs with what the input holds, before any pixel is computed. Also returns the worlds
    /// that the files actually hold.
    pub(crate) fn check(
        input: &mut Input,
        nominal: Vec<World>,
        shots: &[Shot],
        filter: &FilterSettings,
        missing: Missing,
        (warnings, progress): (&mut Vec<Diagnostic>, &dyn Progress),
    ) -> Result<(Self, Vec<World>)> {
        let mut gaps = Vec::new();
        let count = nominal.len();
        for (index, (views, nominal)) in input.worlds.iter_mut().zip(&nominal).enumerate() {
            let progress = &Share::of(progress, (index, count));
            gaps.extend(find_gaps(views, (nominal, index, count), shots, filter, (warnings, progress))?);
        }
        let coverage = match missing {
            _ if gaps.is_empty() => Self::Complete,
            Missing::Fill(colour) => Self::Fill(colour),
            Missing::Continue(beyond) => Self::Continue(beyond),
            Missing::Error => bail!(
                Uncovered: "the input does not cover what the output shows:\n  {}\nadd what is missing, or fill it with {MISSING} \
                 COLOR or {MISSING} transparent",
                gaps.join("\n  ")
            ),
        };
        let worlds: Result<_> =
            input.worlds.iter().zip(nominal).map(|(views, nominal)| held_world(views, nominal)).collect();
        Ok((coverage, worlds?))
    }
}

impl Coverage {
    /// Compares the whole sphere, all of which sheds light, with what the input holds. Also returns the worlds that the files
    /// actually hold.
    pub(crate) fn of_sphere(input: &mut Input, nominal: Vec<World>, missing: Missing) -> Result<(Self, Vec<World>)> {
        input.worlds.iter_mut().flatten().for_each(|view| view.wanted = true);
        let absent: Vec<String> = input.worlds.iter().flatten().filter_map(absence).collect();
        if input.present().next().is_none() {
            return Err(empty(&absent));
        }
        let worlds: Result<Vec<World>> =
            input.worlds.iter().zip(nominal).map(|(views, nominal)| held_world(views, nominal)).collect();
        let worlds = worlds?;
        let gaps: Vec<String> = absent.into_iter().chain(worlds.iter().filter_map(dark_side)).collect();
        match missing {
            _ if gaps.is_empty() => Ok((Self::Complete, worlds)),
            Missing::Fill(colour) => Ok((Self::Fill(colour), worlds)),
            Missing::Continue(_) => {
                Err(usage(format!("{MISSING} mirror and stretch are for pictures; give a colour, as {MISSING} black")))
            }
            Missing::Error => bail!(
                Uncovered: "light comes from all sides, but the input does not show all:\n  {}\nadd what is missing, or fill it \
                 with {MISSING} COLOR, as {MISSING} black, or {MISSING} transparent",
                gaps.join("\n  ")
            ),
        }
    }
}

/// Describes a view without a file.
fn absence(view: &InputView) -> Option<String> {
    let path = view.files.path(None);
    let is_absent = view.present().is_none();
    is_absent.then(|| {
        let why = if view.files.is_folder() { "a folder, not an image" } else { "missing" };
        format!("{}: {} is {why}", view.name, path.display())
    })
}

/// Directions that are tested for light.
const DIRECTIONS: usize = 4000;

/// Describes where a world shows nothing.
fn dark_side(world: &World) -> Option<String> {
    let dark: Vec<Direction> =
        Direction::spread(DIRECTIONS).filter(|direction| world.owner(*direction).is_none()).collect();
    let middle = Direction::new(dark.iter().map(|direction| direction.vector()).sum())?;
    let (yaw, pitch) = middle.longitude_latitude();
    let part = 100.0 * dark.len() as f64 / DIRECTIONS as f64;
    Some(format!(
        "{part:.1} % of the sphere, around yaw {:.0}° and pitch {:.0}°, is in no view",
        yaw.degrees(),
        pitch.degrees()
    ))
}

/// Returns the world that the files hold, often equal to that of the whole pictures.
fn held_world(views: &[InputView], nominal: World) -> Result<World> {
    let held = || views.iter().filter_map(InputView::present).map(|(view, _, held)| view.world_view(held.clone()));
    let is_same = |(part, source): (WorldView, &Source)| {
        part.name == source.name && part.view == source.view && part.blend == source.blend && part.mask == source.mask
    };
    if held().next().is_none() {
        return Err(empty(&["none of its pixels sees a texel of the input, which may be too small".to_owned()]));
    }
    if held().count() == nominal.sources().len() && held().zip(nominal.sources()).all(is_same) {
        return Ok(nominal);
    }
    Ok(nominal.with_views(held())?)
}
