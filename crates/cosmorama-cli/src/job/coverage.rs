use anyhow::{Result, bail};
use cosmorama::raster::Rgba;
use cosmorama::resample::{Filter, Need, Needs};
use cosmorama::world::{Canvas, PixelRect, World};

use super::{Input, InputView, Target};
use crate::args::Missing;

/// What becomes of pixels that look where no view does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coverage {
    /// There are none.
    Complete,
    /// They are filled.
    Fill(Rgba),
}

/// The world of whole pictures, whether their files are there or not.
pub(crate) fn nominal_world(input: &Input) -> Result<World> {
    Ok(World::new(input.views.iter().map(|view| (view.name.clone(), view.nominal)))?)
}

impl Coverage {
    /// Compares what the target needs with what the input holds, before any pixel is computed. Also gives the world that
    /// the input holds of it.
    pub(crate) fn check(
        input: &mut Input,
        target: &Target,
        filter: &Filter,
        missing: Missing,
        warnings: &mut Vec<String>,
    ) -> Result<(Self, World)> {
        let nominal = nominal_world(input)?;
        if let [view] = input.views.as_mut_slice()
            && view.nominal.covers_sphere()
            && view.window.as_ref().is_some_and(|(held, _)| *held == view.nominal)
        {
            // A whole panorama lacks nothing, whatever is asked of it.
            view.wanted = true;
            return Ok((Self::Complete, nominal));
        }
        let needs = Needs::of(&nominal, &target.geometry(), filter);
        let mut gaps = Vec::new();
        for (view, need) in input.views.iter_mut().zip(&needs.views) {
            view.wanted = need.read.is_some();
            gaps.extend(shortfall(view, need));
            warnings.extend(frayed(view, need));
        }
        if let Some(uncovered) = needs.uncovered {
            let vector = uncovered.direction.vector();
            gaps.push(format!(
                "no view at all covers {} pixels of the output, such as {},{} of {}, which looks to {:.3}, {:.3}, {:.3}",
                uncovered.pixels,
                uncovered.column,
                uncovered.row,
                target.views[uncovered.target].name,
                vector.x,
                vector.y,
                vector.z
            ));
        }
        if !input.views.iter().any(|view| view.wanted && view.window.is_some()) {
            gaps.push("nothing of what the input shows is in the output's field of view".to_owned());
            bail_without_any(&gaps)?;
        }
        let coverage = match missing {
            _ if gaps.is_empty() => Self::Complete,
            Missing::Fill(colour) => Self::Fill(colour),
            Missing::Error => bail!(
                "the input does not cover what the output shows:\n  {}\nadd what is missing, or fill it with --missing \
                 COLOR or --missing transparent",
                gaps.join("\n  ")
            ),
        };
        Ok((coverage, held_world(input, nominal)?))
    }
}

/// The world of what files hold: often that of the whole pictures.
fn held_world(input: &Input, nominal: World) -> Result<World> {
    let held = || input.present().map(|(view, _, held)| (view.name.clone(), *held));
    let whole = nominal.sources().iter().map(|source| (source.name.clone(), source.view));
    if held().eq(whole) { Ok(nominal) } else { Ok(World::new(held())?) }
}

/// Without any view there is nothing to fill up.
fn bail_without_any(gaps: &[String]) -> Result<()> {
    bail!(
        "the output would be empty:\n  {}\nturn it with --yaw, --pitch and --roll, or add the views",
        gaps.join("\n  ")
    )
}

/// What pixels of the output look at and the file does not hold.
fn shortfall(view: &InputView, need: &Need) -> Option<String> {
    let seen = need.seen?;
    match &view.window {
        None => Some(format!(
            "{}: {seen} of its {}x{} pixels are needed, but {} is missing",
            view.name,
            view.nominal.width(),
            view.nominal.height(),
            view.files.path(None).display()
        )),
        Some((held, canvas)) => {
            let held = rect(canvas, held.width(), held.height());
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

/// Where all that pixels look at is there, but not all that the filter would read around it.
fn frayed(view: &InputView, need: &Need) -> Option<String> {
    let (seen, read, (held, canvas)) = (need.seen?, need.read?, view.window.as_ref()?);
    let held = rect(canvas, held.width(), held.height());
    (held.contains(&seen) && !held.contains(&read)).then(|| {
        format!(
            "{}: the filter would read {read}, but the file holds {held}; pixels at its edge go without the rest",
            view.name
        )
    })
}

/// The part of its canvas that an image shows.
fn rect(canvas: &Canvas, width: usize, height: usize) -> PixelRect {
    let edge = |at: i64, size: usize| at.clamp(0, size as i64) as usize;
    PixelRect {
        left: edge(canvas.left, canvas.width),
        top: edge(canvas.top, canvas.height),
        right: edge(canvas.left + width as i64, canvas.width),
        bottom: edge(canvas.top + height as i64, canvas.height),
    }
}
