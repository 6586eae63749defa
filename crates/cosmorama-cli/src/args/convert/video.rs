use std::path::Path;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use cosmorama_convert::{DamagedFrames, VideoSettings, is_video};
use cosmorama_io::FrameList;
use cosmorama_spec::{FrameRanges, FrameRate, TimeRanges};

/// Videos, read and made.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct VideoArgs {
    /// Codec of a video: h264, hevc, prores, dnxhr, ffv1, av1, vp9 [default: by the extension]
    ///
    /// Unless given, .mp4 is H.264, or HEVC for more than 8 bits, .mov ProRes, .mkv FFV1 (without loss), and .webm VP9 or AV1.
    #[arg(long, value_name = "NAME", hide_short_help = true, help_heading = "Video")]
    pub(crate) video_codec: Option<String>,
    /// Further arguments of ffmpeg for a video, as in '-crf 20 -preset slow'
    ///
    /// They come last, so that they count. Words with blanks stand in quotes.
    #[arg(long, value_name = "ARGS", value_parser = words, allow_hyphen_values = true, hide_short_help = true, help_heading = "Video")]
    pub(crate) video_args: Option<Words>,
    /// Damaged frames of a video: error (default), hold (the frame before again), skip
    #[arg(long, value_name = "HOW", value_parser = damaged(), hide_possible_values = true, hide_short_help = true, help_heading = "Video")]
    pub(crate) damaged: Option<DamagedFrames>,
}

/// Words of an argument.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Words(Vec<String>);

/// Frames that are asked for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum FramesAsked {
    /// By their numbers.
    Numbers(FrameList),
    /// By the times at which a video shows them.
    Times(TimeRanges),
}

impl FramesAsked {
    /// Reads a list of numbers or of times.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        if TimeRanges::are_meant(text) {
            return text.parse().map(Self::Times).map_err(|error: cosmorama_spec::TimeRangesError| error.to_string());
        }
        let numbers = |ranges: FrameRanges| Self::Numbers(FrameList::new(ranges.frames()));
        text.parse().map(numbers).map_err(|error: cosmorama_spec::FrameRangesError| error.to_string())
    }

    /// Returns the numbers, and the times; one of the two.
    pub(crate) fn parted(asked: Option<Self>) -> (Option<FrameList>, Option<TimeRanges>) {
        match asked {
            None => (None, None),
            Some(Self::Numbers(frames)) => (Some(frames), None),
            Some(Self::Times(times)) => (None, Some(times)),
        }
    }
}

impl VideoArgs {
    /// Returns the settings of videos at a rate.
    pub(super) fn settings(self, rate: Option<FrameRate>) -> VideoSettings {
        VideoSettings {
            rate,
            codec: self.video_codec,
            arguments: self.video_args.map_or_else(Vec::new, |words| words.0),
            damaged: self.damaged.unwrap_or_default(),
        }
    }

    /// Returns an option that has no effect on an output that is no video, and why.
    pub(crate) fn idle(&self, output: &Path) -> Option<String> {
        if is_video(output) {
            return None;
        }
        let given = [(self.video_codec.is_some(), "--video-codec"), (self.video_args.is_some(), "--video-args")];
        let (_, option) = given.into_iter().find(|(is_given, _)| *is_given)?;
        Some(format!(
            "{option} is for a video, but {} is none; leave {option} out, or name the output .mp4, .mov, .mkv or .webm",
            output.display()
        ))
    }
}

/// Reads the answer to damaged frames.
fn damaged() -> impl TypedValueParser<Value = DamagedFrames> {
    let answer = |word: String| match word.as_str() {
        "hold" => DamagedFrames::Hold,
        "skip" => DamagedFrames::Skip,
        _ => DamagedFrames::Error,
    };
    PossibleValuesParser::new(["error", "hold", "skip"]).map(answer)
}

/// Splits a text into words at blanks that are in no quotes.
fn words(text: &str) -> Result<Words, String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for letter in text.chars() {
        match (quote, letter) {
            (Some(open), _) if open == letter => quote = None,
            (None, '\'' | '"') => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (None, _) if letter.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    match quote {
        Some(open) => Err(format!("the quote {open} is not closed")),
        None => {
            words.extend(word);
            Ok(Words(words))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split_as_by_a_shell() {
        let split = |text: &str| words(text).map(|words| words.0);
        assert_eq!(split(" -crf 20  -preset slow "), Ok(["-crf", "20", "-preset", "slow"].map(str::to_owned).to_vec()));
        assert_eq!(
            split("-metadata 'title=A b' x\"\" \"it's\""),
            Ok(["-metadata", "title=A b", "x", "it's"].map(str::to_owned).to_vec())
        );
        assert_eq!((split(""), split("''")), (Ok(Vec::new()), Ok(vec![String::new()])));
        assert!(split("-vf 'a").is_err_and(|error| error.contains("' is not closed")));
    }

    #[test]
    fn frames_are_numbers_or_times() {
        assert!(matches!(FramesAsked::parse("1-3,5"), Ok(FramesAsked::Numbers(_))));
        assert!(matches!(FramesAsked::parse("00:01:00-00:01:10"), Ok(FramesAsked::Times(_))));
        assert!(FramesAsked::parse("00:01:00-5").is_err_and(|error| error.contains("hours:minutes:seconds")));
        assert!(FramesAsked::parse("a").is_err_and(|error| error.contains("frame number")));
    }
}
