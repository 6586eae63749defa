//! Chains of maps of light: levels of half the size each, in one file or in files of their own.

use cosmorama_io::Format;
use cosmorama_spec::Size;

use crate::diagnostic::{Code, LEVELS, Result, SIZE, usage, usage_as};
use crate::settings::GeometrySettings;
use crate::source::Name;
use crate::target::{Sheet, Target, TargetFile, TargetView};

/// Mark for the number of a level in an output's name.
const MARK: &str = "{level}";

/// Returns the name of a level's output.
pub(crate) fn name_of_level(output: &Name, level: usize) -> Name {
    output.replacing(MARK, &level.to_string())
}

/// Returns how many levels files hold in which they go down to one pixel, as in OpenEXR; `None` where they end as asked.
pub(crate) fn whole_chain(output: &Name, target: &Target) -> Option<usize> {
    let is_whole = target.format == Format::Exr && !output.contains(MARK);
    let (width, height) = target.files.first()?.sheet.size;
    is_whole.then(|| width.max(height).max(1).ilog2() as usize + 1)
}

impl Target {
    /// Adds the further levels of a chain. `output` is the name as it was typed.
    pub(crate) fn with_chain(mut self, output: &Name, geometry: &GeometrySettings, levels: usize) -> Result<Self> {
        let has_mark = output.contains(MARK);
        check_format(output, self.format, (has_mark, levels))?;
        let whole = whole_chain(output, &self);
        if whole.is_some() && self.files.iter().any(|file| file.sheet.pieces.len() > 1) {
            return Err(usage(format!(
                "{output}: the levels of an OpenEXR file go down to one pixel, which is no cube of six faces; put {{face}} into the name, \
                 for a file of each, or name it .ktx2 or .dds"
            )));
        }
        let first = self.views.first().map_or((0, 0), |target| (target.view.width(), target.view.height()));
        let most =
            whole.unwrap_or_else(|| first.0.min(first.1).checked_ilog2().map_or(0, |halvings| halvings as usize + 1));
        if levels > most {
            return Err(usage(format!(
                "{LEVELS}: {levels} levels, each of half the size of the one before, but pictures of {}x{} pixels have {most} at most; \
                 give fewer, or a larger {SIZE}",
                first.0, first.1
            )));
        }
        for level in 1..levels {
            let halved = |pixels: usize| (pixels >> level).max(1);
            let asked =
                geometry.size.map(|Size { width, height }| Size { width: halved(width), height: height.map(halved) });
            let exact = Size { width: halved(first.0), height: Some(halved(first.1)) };
            let size = if whole.is_some() { Some(exact) } else { asked };
            let smaller =
                Self::resolve(&name_of_level(output, level), &GeometrySettings { size, ..geometry.clone() }, None)?;
            let before = self.views.len();
            let of_level =
                |view: TargetView| TargetView { level, name: format!("{}, level {level}", view.name), ..view };
            self.views.extend(smaller.views.into_iter().map(of_level));
            let moved = |sheet: Sheet| {
                let pieces = sheet.pieces.into_iter().map(|(index, corner)| (before + index, corner)).collect();
                Sheet { pieces, ..sheet }
            };
            if has_mark {
                let files = smaller.files.into_iter();
                self.files.extend(files.map(|file| TargetFile { sheet: moved(file.sheet), ..file }));
            } else {
                let sheets = self.files.iter_mut().zip(smaller.files);
                sheets.for_each(|(file, smaller)| file.mips.push(moved(smaller.sheet)));
            }
        }
        Ok(self)
    }
}

/// Checks that an output holds all levels of a chain.
fn check_format(output: &Name, format: Format, (has_mark, levels): (bool, usize)) -> Result<()> {
    if has_mark || format.holds_levels() {
        return Ok(());
    }
    let dot = output.rfind('.').unwrap_or(output.len());
    let (stem, extension) = output.split_at(dot);
    Err(usage_as(
        Code::OutputFormat,
        format!(
            "{output} is {format}, which holds one picture, but the chain has {levels} levels; name the output .ktx2, .dds or .exr, or put \
             {MARK} where the number of a level stands, as in {stem}_{MARK}{extension}"
        ),
    ))
}
