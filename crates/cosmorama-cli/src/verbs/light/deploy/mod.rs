//! Everything that an engine loads, in its own conventions.

mod preset;

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use cosmorama::lighting::{HarmonicPreset, Lobe, StoredHarmonics};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_convert::{
    Conversion, Existing, GeometrySettings, LightLevel, LightNormalisation, LightSettings, WorldLight, check_apart,
    refuse_existing,
};
use cosmorama_io::Remark;
use cosmorama_io::pending::{PendingFolder, place};
use cosmorama_spec::Size;
use serde_json::{Value, json};

use crate::args::DeployArgs;
use crate::args::light::lobe::LobeName;
use crate::console::Console;
use crate::pipe::KeptStreams;
use crate::report;
use crate::verbs::light::{brdf, harmonics, maps};
use crate::verbs::{convert, make_parent};
use preset::{Part, Preset};

/// Columns of a face of the light on matt surfaces.
const DIFFUSE_EDGE: usize = 32;

/// Columns of a face from which on a level of the sky is a picture.
const SHARP_EDGE: usize = 16;

/// Writes a folder for an engine.
pub(super) fn run(mut args: DeployArgs, console: &mut Console) -> Result<ExitCode> {
    let mut kept = KeptStreams::default();
    args.input = kept.input(&args.input)?;
    let world: Conversion = args.clone().into();
    let world = Conversion { unfinished: console.unfinished.clone(), ..world }.files(kept.files());
    let checked = world.clone().check_light();
    console.tell_all(&checked);
    let light = checked.result?;

    let preset = Preset::of(args.preset);
    let name = name(&args.folder);
    let files: Vec<(String, Part)> =
        preset.parts.iter().map(|(file, part)| (preset::named(file, &name), *part)).collect();
    let _folders = check_places(&args, files.iter().map(|(file, _)| file.as_str()), &light, console)?;
    let pending = PendingFolder::create(&args.folder, &console.unfinished).with_context(|| {
        format!("the folder {} cannot be made; choose another, where you may write", args.folder.display())
    })?;
    files.iter().for_each(|(file, _)| console.call(&pending.path().join(file), file));
    let deployment = Deployment {
        args: &args,
        preset,
        name: &name,
        world,
        light,
        folder: pending.path(),
        console,
        harmonics: OnceCell::new(),
    };
    let mut outputs = Vec::new();
    for (file, part) in &files {
        let mut told = deployment.make(file, *part)?;
        told["file"] = json!(file);
        outputs.push(told);
    }
    pending.finish()?;
    if args.world.json {
        let json =
            json!({ "preset": args.preset.name(), "folder": args.folder.display().to_string(), "outputs": outputs });
        console.print(&(serde_json::to_string_pretty(&json)? + "\n"))?;
    } else if args.progress.is_for_people() {
        console.report(format_args!(
            "{} files in {}; README.txt says what is what",
            files.len(),
            args.folder.display()
        ));
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns the folder's own name.
fn name(folder: &Path) -> String {
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    real.file_name().map_or_else(|| "sky".to_owned(), |name| name.to_string_lossy().into_owned())
}

/// Checks that the files can have their names, and makes the folder above theirs.
fn check_places<'a>(
    args: &DeployArgs,
    files: impl Iterator<Item = &'a str>,
    light: &WorldLight,
    console: &Console,
) -> Result<Option<cosmorama_io::pending::NewFolders>> {
    let paths: Vec<PathBuf> = files.map(|file| args.folder.join(file)).collect();
    if !args.world.file.overwrite {
        refuse_existing(paths.iter().map(PathBuf::as_path))?;
    }
    for path in &paths {
        check_apart(path, light.files())?;
        place(path)?;
    }
    if args.folder.is_file() {
        anyhow::bail!("{} is a file, where a folder was expected; name another", args.folder.display());
    }
    make_parent(&args.folder, args.world.file, console)
}

/// Files of a folder under way.
struct Deployment<'a> {
    args: &'a DeployArgs,
    preset: &'static Preset,
    /// The folder's own name.
    name: &'a str,
    /// Settings by which the world is read.
    world: Conversion,
    light: WorldLight,
    folder: &'a Path,
    console: &'a Console,
    harmonics: OnceCell<(StoredHarmonics, Value)>,
}

impl Deployment<'_> {
    /// Makes a file. Returns what there is to tell programs about it.
    fn make(&self, file: &str, part: Part) -> Result<Value> {
        let path = self.folder.join(file);
        let (size, sky) = (self.args.size, self.args.sky_size);
        match part {
            Part::Sky => self.map(&path, (self.preset.cube, sky), levels_of_sky(sky)?, Vec::new()),
            Part::Panorama => self.map(&path, ("equirect", 4 * sky), vec![LightLevel::Mirror], Vec::new()),
            Part::Diffuse => {
                self.map(&path, (self.preset.cube, DIFFUSE_EDGE), vec![LightLevel::Lobe(Lobe::LAMBERT)], Vec::new())
            }
            Part::Specular => self.map(&path, (self.preset.cube, size), self.chain()?, Vec::new()),
            Part::SpecularWith(basis) => {
                let (stored, _) = self.harmonics(basis)?;
                let text: String = stored.numbers().iter().map(|[r, g, b]| format!("{r} {g} {b}\n")).collect();
                self.map(&path, (self.preset.cube, size), self.chain()?, vec![Remark { name: "sh", text: text.into() }])
            }
            Part::Harmonics(basis) => {
                let (stored, told) = self.harmonics(basis)?;
                write(&path, &harmonics::as_json(stored, (basis.name(), basis.kind()))?)?;
                let mut told = told.clone();
                told["holds"] = json!("harmonics");
                Ok(told)
            }
            Part::Table { multiscatter } => {
                brdf::write_usual(&path, multiscatter, self.args.world.limits.threads, self.console)?;
                Ok(json!({ "holds": "brdf" }))
            }
            Part::Text(text) => {
                write(&path, &preset::named(text, self.name))?;
                Ok(json!({ "holds": "text" }))
            }
        }
    }

    /// Makes a map of light, or a chain of them.
    fn map(
        &self,
        path: &Path,
        (to, edge): (&str, usize),
        levels: Vec<LightLevel>,
        remarks: Vec<Remark>,
    ) -> Result<Value> {
        let [yaw, pitch] = self.preset.turn.map(Angle::from_degrees);
        let is_cube = to == self.preset.cube;
        let orientation = if is_cube {
            Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::from_degrees(0.0))
        } else {
            Orientation::IDENTITY
        };
        let geometry = GeometrySettings {
            to: Some(to.parse()?),
            size: Some(Size { width: edge, height: None }),
            orientation,
            ..self.world.geometry.clone()
        };
        let usual = LightSettings::map(Lobe::LAMBERT, LightNormalisation::Radiance);
        let light = LightSettings { levels, ..usual };
        let conversion = Conversion {
            output: path.into(),
            geometry,
            light: Some(light),
            existing: Existing::Replace,
            remarks,
            ..self.world.clone()
        };
        let report = convert::convert(conversion, self.args.progress, self.console)?;
        Ok(json!({ "holds": if is_cube { "cube" } else { "panorama" }, "light": report::light(&report)? }))
    }

    /// Returns the levels of the chain of roughness.
    fn chain(&self) -> Result<Vec<LightLevel>> {
        let levels = (self.args.size.ilog2() - self.preset.last) as usize + 1;
        maps::levels_by(LobeName::Ggx, self.preset.roughness, (levels, self.args.size))
    }

    /// Returns harmonics in the engine's form, and what they miss. They are summed once.
    fn harmonics(&self, basis: HarmonicPreset) -> Result<&(StoredHarmonics, Value)> {
        if let Some(found) = self.harmonics.get() {
            return Ok(found);
        }
        let (found, diagnostics) = self.light.harmonics((2, basis.basis()), None)?;
        diagnostics.iter().for_each(|diagnostic| self.console.warn(diagnostic));
        let stored = StoredHarmonics::of(basis, &found.harmonics, basis.kind())?;
        let accuracy = found.accuracy;
        let told = json!({
            "radiance": harmonics::missed(accuracy.radiance),
            "irradiance": harmonics::missed(accuracy.irradiance),
            "energy_in": found.light.mean,
        });
        Ok(self.harmonics.get_or_init(|| (stored, told)))
    }
}

/// Returns the levels of the sky: pictures of it, and soft ones where a sun's light would depend on where in a pixel it falls.
fn levels_of_sky(edge: usize) -> Result<Vec<LightLevel>> {
    let level = |level: u32| {
        let edge = edge >> level;
        if edge >= SHARP_EDGE {
            Ok(LightLevel::Mirror)
        } else {
            Ok(LightLevel::Lobe(Lobe::ggx((edge as f64).recip())?))
        }
    };
    (0..=edge.ilog2()).map(level).collect()
}

/// Writes a file of text.
fn write(path: &Path, text: &str) -> Result<()> {
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
