//! Warnings about the light of a frame: bright sources that filters do not keep, alpha that is nowhere full, and a lens's
//! circle that is elsewhere than assumed.

use std::collections::BTreeMap;
use std::path::PathBuf;

use cosmorama::filter::FilterKind;
use cosmorama::sphere::Direction;
use cosmorama_spec::Spec;

use crate::colour::ThinAlpha;
use crate::detect::disc;
use crate::diagnostic::{Code, Diagnostic, FILTER, KERNEL, Remedy, Setting};
use crate::engine::{FrameLight, balance};
use crate::job::ConvertJob;

/// Fraction of a world's light in bright sources above which a change of it shows in lighting.
const MUCH: f64 = 0.1;

/// Number of directions that are tested to see whether outputs show the whole world.
const DIRECTIONS: usize = 500;

/// Warns of colours outside of the outputs' primaries that are clipped there, with their share of each file.
pub(crate) fn clipped<'a>(
    job: &'a ConvertJob,
    frame: Option<u64>,
    light: &'a FrameLight,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let views = job.input.present().zip(light.outside()).filter(|(_, count)| job.light.clips && **count > 0);
    views.map(move |((view, header, _), count)| {
        let path = view.files.path(frame);
        let pixels = header.width.saturating_mul(header.height).max(1);
        let message = format!(
            "{}: {:.2} % of its pixels lie outside of the output's primaries, {}: they are clipped to what those can show",
            path.display(),
            100.0 * *count as f64 / pixels as f64,
            job.light.working.primaries
        );
        Diagnostic::warning(Code::OutOfGamut, message).about(path.display())
    })
}

/// Warns where a whole world is made from light with bright sources, which few filters keep.
pub(crate) fn suns(job: &ConvertJob, light: &FrameLight) -> Option<Diagnostic> {
    if job.lighting.is_some() || balance::is_asked_for(job) || !is_of_any_range(job) || !shows_the_world(job) {
        return None;
    }
    let parts = job.worlds.iter().enumerate();
    let part = parts.map(|(index, world)| world.light_of_suns(|texel| light.texels().rgba(index, texel)));
    let part = part.fold(0.0, f64::max);
    (part > MUCH).then(|| {
        // The default filter needs no naming.
        let filter = if job.filter.kind == FilterKind::Ewa { String::new() } else { format!("{FILTER} ewa ") };
        let message = format!(
            "{:.0} % of the light comes from suns or lamps, over a hundred times as bright as the mean; this filter \
             may add light to them or take some away. Where the picture is to light a scene, {filter}{KERNEL} light \
             keeps what there is, and is a little softer",
            100.0 * part
        );
        Diagnostic::warning(Code::Suns, message).with_remedy(Remedy::Set(Setting::Kernel, "light".to_owned()))
    })
}

/// Returns whether some input holds light beyond white. Numbers in one channel are no light but depth, or a mask.
fn is_of_any_range(job: &ConvertJob) -> bool {
    job.input.present().any(|(_, header, _)| header.depth.is_float() && header.channels.is_colour())
}

/// Returns whether the outputs show all directions, or nearly all.
fn shows_the_world(job: &ConvertJob) -> bool {
    let sees = |direction: &Direction| job.target.views.iter().any(|target| target.view.sees(*direction));
    let seen = Direction::spread(DIRECTIONS).filter(sees).count();
    100 * seen >= 99 * DIRECTIONS
}

/// Warns about files of a frame in which no pixel has full alpha.
pub(crate) fn thin_alpha(job: &ConvertJob, frame: Option<u64>, light: &FrameLight) -> Vec<Diagnostic> {
    if !job.light.input_alpha {
        return Vec::new();
    }
    // A file may hold several views, of which some may be thin.
    let mut files: BTreeMap<PathBuf, Option<ThinAlpha>> = BTreeMap::new();
    let worlds = job.worlds.iter().enumerate();
    let sources = worlds.flat_map(|(index, world)| world.sources().iter().map(move |source| (index, source)));
    for ((view, header, _), (world, source)) in job.input.present().zip(sources) {
        let path = view.files.path(frame);
        let known = files.get(&path).copied();
        if !header.channels.has_alpha() || known == Some(None) {
            continue;
        }
        let texels = source.offset..source.offset + source.texels().len();
        let found = ThinAlpha::of(texels.map(|texel| light.texels().rgba(world, texel)));
        let both = found.map(|found| known.flatten().map_or(found, |known| known.with(found)));
        files.insert(path, both);
    }
    let told = |(path, alpha): (PathBuf, Option<ThinAlpha>)| {
        let path = path.display();
        Some(Diagnostic::warning(Code::AlphaThin, format!("{path}: {}", alpha?.told()?)).about(path))
    };
    files.into_iter().filter_map(told).collect()
}

/// Warns where a lens has left its circle elsewhere than `--from` assumes, which does not place it.
pub(crate) fn circle(job: &ConvertJob, from: &Spec, light: &FrameLight) -> Option<Diagnostic> {
    let (view, _, held) = job.input.present().next().filter(|(_, header, _)| header.window.is_none())?;
    let (width, height) = (held.width(), held.height());
    disc::elsewhere(from, (&view.name, (width, height)), |i, j| light.texels().rgba(0, j * width + i))
}
