//! The installed programs: found, asked for their version and encoders, and run.

mod child;
mod log;
mod version;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

use cosmorama_io::pending::Unfinished;

pub(crate) use child::{Child, Said};
pub(crate) use log::{Event, Log};
pub use version::Version;

use crate::VideoError;

/// The installed ffmpeg and ffprobe. Each value asks for the encoders once.
#[derive(Clone, Debug)]
pub struct Ffmpeg {
    ffmpeg: PathBuf,
    ffprobe: PathBuf,
    version: Version,
    encoders: OnceLock<Vec<String>>,
    unfinished: Unfinished,
    /// Function that answers for ffprobe.
    #[cfg(fuzzing)]
    answer: Option<fn(&[&str]) -> Vec<u8>>,
}

/// Containers that are read. Others are not even tried: play lists would have ffmpeg read further files, and patterns of pictures
/// are sequences.
const READ: &str = "mov,matroska,avi,mpegts,mpeg,flv,asf,ogg,mxf,nut,ivf,yuv4mpegpipe,h264,hevc,obu,av1,m4v,mpegvideo,dv,gxf,wtv,rm,gif,\
                    apng,mjpeg";

/// Options of the filter `scale`: rounding is exact, and chroma is filtered in full resolution.
pub(crate) const EXACT: &str = "flags=accurate_rnd+full_chroma_int+full_chroma_inp+bicubic+bitexact";

/// Time in which a program must say what it is.
const PATIENCE: Duration = Duration::from_secs(20);

/// Bytes of a program's answer about itself.
const ANSWER: usize = 4 << 20;

impl Ffmpeg {
    /// Oldest version that is used.
    pub const OLDEST: Version = Version { major: 4, minor: 4 };

    /// Finds ffmpeg and ffprobe on the search path of the process.
    ///
    /// # Errors
    /// When one is not installed, or older than 4.4; the message says how to install it.
    pub fn find() -> Result<Self, VideoError> {
        Self::at(PathBuf::from("ffmpeg"), PathBuf::from("ffprobe"))
    }

    /// Uses the programs at these places.
    ///
    /// # Errors
    /// When one is not there, or older than 4.4.
    pub fn at(ffmpeg: PathBuf, ffprobe: PathBuf) -> Result<Self, VideoError> {
        let version = version_of("ffmpeg", &ffmpeg)?;
        version_of("ffprobe", &ffprobe)?;
        Ok(Self {
            ffmpeg,
            ffprobe,
            version,
            encoders: OnceLock::new(),
            unfinished: Unfinished::default(),
            #[cfg(fuzzing)]
            answer: None,
        })
    }

    /// Asks a function, by ffprobe's arguments, instead of ffprobe: fuzzing starts no process for each input.
    #[cfg(fuzzing)]
    pub fn answered_by(answer: fn(&[&str]) -> Vec<u8>) -> Self {
        Self {
            ffmpeg: PathBuf::new(),
            ffprobe: PathBuf::new(),
            version: Self::OLDEST,
            encoders: OnceLock::new(),
            unfinished: Unfinished::default(),
            answer: Some(answer),
        }
    }

    /// Puts the programs that are started from now on a list, by which an interrupt ends them.
    #[must_use]
    pub fn ending_with(self, unfinished: &Unfinished) -> Self {
        Self { unfinished: unfinished.clone(), ..self }
    }

    /// Returns the list of programs that an interrupt ends.
    pub(crate) fn unfinished(&self) -> &Unfinished {
        &self.unfinished
    }

    /// Returns the version of ffmpeg.
    pub fn version(&self) -> Version {
        self.version
    }

    /// Returns the names of the encoders of this build.
    ///
    /// # Errors
    /// When ffmpeg cannot be run.
    pub fn encoders(&self) -> Result<&[String], VideoError> {
        if let Some(known) = self.encoders.get() {
            return Ok(known);
        }
        let mut command = self.ffmpeg_command();
        command.arg("-encoders");
        let said = child::output(command, ("ffmpeg", &self.unfinished), Path::new("ffmpeg"), ANSWER, PATIENCE)?;
        let found = names_of_encoders(&String::from_utf8_lossy(&said.stdout));
        Ok(self.encoders.get_or_init(|| found))
    }

    /// Returns a command that runs ffmpeg without a terminal, without questions, and without files of its own.
    pub(crate) fn ffmpeg_command(&self) -> Command {
        let mut command = quiet(&self.ffmpeg);
        command.arg("-nostdin");
        command
    }

    /// Returns the options of an output that has every frame once, whatever the rate.
    pub(crate) fn every_frame_once(&self) -> [&'static str; 2] {
        const RENAMED: Version = Version { major: 5, minor: 1 };
        [if self.version >= RENAMED { "-fps_mode" } else { "-vsync" }, "passthrough"]
    }

    /// Runs ffprobe on a file and returns what it prints, `limit` bytes at most.
    ///
    /// # Errors
    /// When it cannot be run, prints more, or does not end within `patience`.
    pub(crate) fn ffprobe(
        &self,
        path: &Path,
        arguments: &[&str],
        limit: usize,
        patience: Duration,
    ) -> Result<Said, VideoError> {
        #[cfg(fuzzing)]
        if let Some(answer) = self.answer {
            let mut stdout = answer(arguments);
            stdout.truncate(limit);
            return Ok(Said { is_success: true, stdout, stderr: String::new() });
        }
        let mut command = quiet(&self.ffprobe);
        command.args(["-v", "error"]).args(input_limits()).args(arguments).arg("-i").arg(url(path));
        child::output(command, ("ffprobe", &self.unfinished), path, limit, patience)
    }

    /// Runs ffprobe on a file, and gives each line that it prints to `each`.
    ///
    /// # Errors
    /// When it cannot be run, or fails, or `each` does.
    pub(crate) fn ffprobe_lines(
        &self,
        path: &Path,
        arguments: &[&str],
        each: impl FnMut(&str) -> Result<(), VideoError>,
    ) -> Result<(), VideoError> {
        #[cfg(fuzzing)]
        if let Some(answer) = self.answer {
            let failed = |source| VideoError::Run { program: "ffprobe".to_owned(), source };
            return child::lines_of(answer(arguments).as_slice(), failed, each);
        }
        let mut command = quiet(&self.ffprobe);
        command.args(["-v", "error"]).args(input_limits()).args(arguments).arg("-i").arg(url(path));
        child::lines(command, ("ffprobe", &self.unfinished), path, each)
    }
}

/// Returns options for an input: only files are opened, of known containers.
pub(crate) fn input_limits() -> [&'static str; 4] {
    ["-protocol_whitelist", "file,pipe", "-format_whitelist", READ]
}

/// Returns a file's name as ffmpeg can take for nothing else: no option, protocol or pattern.
pub(crate) fn url(path: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(path);
    url
}

fn quiet(program: &Path) -> Command {
    let mut command = Command::new(program);
    // A report would be a file that nobody asked for; colours would be letters in messages.
    command.env_remove("FFREPORT").env("AV_LOG_FORCE_NOCOLOR", "1").arg("-hide_banner");
    command
}

fn version_of(name: &'static str, program: &Path) -> Result<Version, VideoError> {
    let mut command = quiet(program);
    command.arg("-version");
    let said =
        child::output(command, (name, &Unfinished::default()), program, ANSWER, PATIENCE).map_err(
            |error| match error {
                VideoError::Run { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                    VideoError::NotInstalled { program: name }
                }
                other => other,
            },
        )?;
    let found = Version::of_words(&String::from_utf8_lossy(&said.stdout));
    if found.is_none() && !said.is_success {
        // Too little memory for its libraries, for example.
        let source = std::io::Error::other(said.last_words());
        return Err(VideoError::Run { program: name.to_owned(), source });
    }
    found.filter(|version| *version >= Ffmpeg::OLDEST).ok_or_else(|| VideoError::TooOld {
        program: name,
        found: found.map_or_else(|| "unknown".to_owned(), |version| version.to_string()),
        needed: Ffmpeg::OLDEST.to_string(),
    })
}

/// Returns the names in ffmpeg's list of encoders, which has a column of flags before them.
fn names_of_encoders(list: &str) -> Vec<String> {
    let rows = list.lines().skip_while(|line| !line.trim_start().starts_with("---")).skip(1);
    rows.filter_map(|row| row.split_whitespace().nth(1)).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoders_are_listed_below_the_line() {
        let list = "Encoders:\n V..... = Video\n ------\n V....D libx264   H.264 (codec h264)\n A....D aac   AAC\n";
        assert_eq!(names_of_encoders(list), ["libx264", "aac"]);
    }

    #[test]
    fn names_are_never_options_or_patterns() {
        assert_eq!(url(Path::new("-y")), OsString::from("file:-y"));
        assert_eq!(url(Path::new("http://x/%d.png")), OsString::from("file:http://x/%d.png"));
    }
}
