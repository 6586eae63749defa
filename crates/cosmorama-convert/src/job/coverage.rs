use cosmorama::camera::{Canvas, PixelRect, View};
use cosmorama::filter::FilterSettings;
use cosmorama::raster::Rgba;
use cosmorama::render::{Accuracy, Need, Needs};
use cosmorama::sphere::Direction;
use cosmorama::world::{Source, World, WorldView};
use cosmorama_spec::{Missing, Size};

use crate::diagnostic::{Code, ConvertError, Diagnostic, MISSING, PITCH, ROLL, Result, YAW, bail, failed_as};
use crate::input::{Input, InputView};
use crate::source::MemoryBudget;
use crate::target::{Target, TargetView};

/// Treatment of pixels that look where no view does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coverage {
    /// There are no such pixels.
    Complete,
    /// Such pixels are filled with a colour.
    Fill(Rgba),
}

/// Returns the worlds of whole pictures, even if files are missing: one, or one for each eye.
pub(crate) fn whole_worlds(input: &Input, memory: MemoryBudget) -> Result<Vec<World>> {
    memory.check_pictures(input)?;
    input.views().try_for_each(check_sides)?;
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
        target: &Target,
        filter: &FilterSettings,
        missing: Missing,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(Self, Vec<World>)> {
        let mut gaps = Vec::new();
        let count = nominal.len();
        for (index, (views, nominal)) in input.worlds.iter_mut().zip(&nominal).enumerate() {
            gaps.extend(find_gaps(views, nominal, &target.of_world(index, count), filter, warnings)?);
        }
        let coverage = match missing {
            _ if gaps.is_empty() => Self::Complete,
            Missing::Fill(colour) => Self::Fill(colour),
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

/// Finds what is missing in the views of a world, and marks the views that are needed.
fn find_gaps(
    views: &mut [InputView],
    nominal: &World,
    targets: &[&TargetView],
    filter: &FilterSettings,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<String>> {
    if let [view] = views
        && view.nominal.covers_sphere()
        && view.mask.is_none()
        && view.window.as_ref().is_some_and(|(held, _)| *held == view.nominal)
    {
        // A whole panorama lacks nothing, whatever the target needs.
        view.wanted = true;
        return Ok(Vec::new());
    }
    let geometry: Vec<View> = targets.iter().map(|target| target.view.clone()).collect();
    let uncovered = |needs: &Needs| needs.uncovered.map(|gap| format!("{}: {gap}", targets[gap.target].name));
    let needs = Needs::of(nominal, &geometry, filter, Accuracy::Bounds);
    if needs.views.iter().any(|need| need.seen.is_some()) && views.iter().zip(&needs.views).all(holds) {
        views.iter_mut().zip(&needs.views).for_each(|(view, need)| view.wanted = need.read.is_some());
        return Ok(uncovered(&needs).into_iter().collect());
    }
    let needs = Needs::of(nominal, &geometry, filter, Accuracy::Exact);
    let mut gaps = Vec::new();
    for (view, need) in views.iter_mut().zip(&needs.views) {
        view.wanted = need.read.is_some();
        gaps.extend(shortfall(view, need));
        warnings.extend(frayed(view, need));
    }
    gaps.extend(uncovered(&needs));
    if !views.iter().any(|view| view.wanted && view.window.is_some()) {
        gaps.push("nothing of what the input shows is in the output's field of view".to_owned());
        return Err(empty(&gaps));
    }
    Ok(gaps)
}

/// Returns whether all that may be needed of a view is there.
fn holds((view, need): (&InputView, &Need)) -> bool {
    let held = view.window.as_ref().map(|(held, canvas)| rect(canvas, held));
    need.read.is_none_or(|read| held.is_some_and(|held| held.contains(&read)))
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

/// Returns the error for an input without any view, which cannot be filled up.
fn empty(gaps: &[String]) -> ConvertError {
    let gaps = gaps.join("\n  ");
    let message =
        format!("the output would be empty:\n  {gaps}\nturn it with {YAW}, {PITCH} and {ROLL}, or add the views");
    failed_as(Code::Uncovered, message)
}

/// Describes what pixels of the output look at and the file does not hold.
fn shortfall(view: &InputView, need: &Need) -> Option<String> {
    let seen = need.seen?;
    match &view.window {
        None => Some(format!(
            "{}: {seen} of its {}x{} pixels are needed, but {} is {}",
            view.name,
            view.nominal.width(),
            view.nominal.height(),
            view.files.path(None).display(),
            if view.files.is_folder() { "a folder, not an image" } else { "missing" }
        )),
        Some((held, canvas)) => {
            let held = rect(canvas, held);
            (!held.contains(&seen)).then(|| {
                format!(
                    "{}: {seen} of its {}x{} pixels are needed, but {} holds only {held}",
                    view.name,
                    view.nominal.width(),
                    view.nominal.height(),
                    view.files.path(None).display()
                )
            })
        }
    }
}

/// Returns a warning where everything that pixels look at is there, but not all that the filter would read around it.
fn frayed(view: &InputView, need: &Need) -> Option<Diagnostic> {
    let (seen, read, (held, canvas)) = (need.seen?, need.read?, view.window.as_ref()?);
    let held = rect(canvas, held);
    (held.contains(&seen) && !held.contains(&read)).then(|| {
        let message = format!(
            "{}: the filter would read {read}, but the file holds {held}; pixels at its edge go without the rest",
            view.name
        );
        Diagnostic::warning(Code::Frayed, message).about(&view.name)
    })
}

/// Returns the part of its canvas that an image shows. One that goes all the way round shows every column, wherever it
/// begins.
fn rect(canvas: &Canvas, held: &View) -> PixelRect {
    let edge = |at: i64, size: usize| at.clamp(0, size as i64) as usize;
    let goes_round = held.period().is_some_and(|period| held.width() >= period);
    let left = if goes_round { 0 } else { canvas.left };
    PixelRect {
        left: edge(left, canvas.width),
        top: edge(canvas.top, canvas.height),
        right: edge(left + held.width() as i64, canvas.width),
        bottom: edge(canvas.top + held.height() as i64, canvas.height),
    }
}
