//! Chains of maps of light: levels of half the size each, in one file or in files of their own.

use cosmorama_io::Format;
use cosmorama_spec::Size;

use crate::diagnostic::{Code, LEVELS, Result, SIZE, usage, usage_as};
use crate::settings::GeometrySettings;
use crate::target::{Sheet, Target, TargetFile, TargetView};

/// Mark for the number of a level in an output's name.
const MARK: &str = "{level}";

/// Returns the name of a level's output.
pub(crate) fn name_of_level(output: &str, level: usize) -> String {
    output.replace(MARK, &level.to_string())
}

impl Target {
    /// Adds the further levels of a chain. `output` is the name as it was typed.
    pub(crate) fn with_chain(mut self, output: &str, geometry: &GeometrySettings, levels: usize) -> Result<Self> {
        let has_mark = output.contains(MARK);
        check_format(output, self.format, (has_mark, levels))?;
        let first = self.views.first().map_or((0, 0), |target| (target.view.width(), target.view.height()));
        let most = first.0.min(first.1).checked_ilog2().map_or(0, |halvings| halvings as usize + 1);
        if levels > most {
            return Err(usage(format!(
                "{LEVELS}: {levels} levels, each of half the size of the one before, but pictures of {}x{} pixels have {most} at most; \
                 give fewer, or a larger {SIZE}",
                first.0, first.1
            )));
        }
        for level in 1..levels {
            let halved = |pixels: usize| (pixels >> level).max(1);
            let size =
                geometry.size.map(|Size { width, height }| Size { width: halved(width), height: height.map(halved) });
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
fn check_format(output: &str, format: Format, (has_mark, levels): (bool, usize)) -> Result<()> {
    if has_mark || format.holds_levels() {
        return Ok(());
    }
    let dot = output.rfind('.').unwrap_or(output.len());
    let (stem, extension) = output.split_at(dot);
    Err(usage_as(
        Code::OutputFormat,
        format!(
            "{output} is {format}, which holds one picture, but the chain has {levels} levels; name the output .ktx2 or .dds, or put \
             {MARK} where the number of a level stands, as in {stem}_{MARK}{extension}"
        ),
    ))
}
