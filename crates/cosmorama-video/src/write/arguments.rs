//! Further arguments of ffmpeg: options of the one output, and nothing that would be a file of its own.

use crate::VideoError;

/// Options of ffmpeg that take no value, also with `no` before them. All others take one.
const WITHOUT_VALUE: [&str; 34] = [
    "accurate_seek",
    "an",
    "autorotate",
    "autoscale",
    "benchmark",
    "benchmark_all",
    "bitexact",
    "copy_unknown",
    "copyinkf",
    "copyts",
    "debug_ts",
    "dn",
    "dump",
    "find_stream_info",
    "fix_sub_duration",
    "hex",
    "hide_banner",
    "ignore_unknown",
    "isync",
    "n",
    "psnr",
    "qphist",
    "re",
    "recast_media",
    "report",
    "shortest",
    "sn",
    "start_at_zero",
    "stats",
    "stdin",
    "vn",
    "vstats",
    "xerror",
    "y",
];

/// Options that say what is said elsewhere, and where.
const ELSEWHERE: [(&str, &str); 2] =
    [("i", "the frames are the only input"), ("r", "frames are shown at the rate of their times")];

/// Refuses what is no option with its value: ffmpeg takes any other word for a file to write, and would replace it.
pub(super) fn check(arguments: &[String]) -> Result<(), VideoError> {
    let refuse =
        |word: &str, reason: &str| Err(VideoError::UnfitArgument { word: word.to_owned(), reason: reason.to_owned() });
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        let name = word.strip_prefix('-').filter(|name| !name.is_empty() && !name.starts_with('-'));
        let Some(name) = name else { return refuse(word, "it is no option, and would be a file of its own") };
        // Behind a colon stands the stream that is meant.
        let name = name.split(':').next().unwrap_or_default();
        if let Some((_, reason)) = ELSEWHERE.iter().find(|(refused, _)| *refused == name) {
            return refuse(word, reason);
        }
        let is_flag = |name: &str| WITHOUT_VALUE.contains(&name);
        let is_alone = is_flag(name) || name.strip_prefix("no").is_some_and(is_flag);
        if !is_alone && words.next().is_none() {
            return refuse(word, "its value is missing");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(text: &str) -> Result<(), String> {
        let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
        check(&words).map_err(|error| error.to_string())
    }

    #[test]
    fn words_that_would_be_files_are_refused() {
        for good in ["", "-crf 20", "-an -crf 20", "-metadata:s:v title=-", "-bf -1", "-nostats -shortest -preset fast"]
        {
            assert_eq!(checked(good), Ok(()), "{good}");
        }
        for (wrong, word) in [
            ("in.mp4", "in.mp4"),
            ("-crf 20 other.mp4", "other.mp4"),
            ("-an notes.mkv", "notes.mkv"),
            ("-noautorotate a.mkv", "a.mkv"),
            ("-xerror a.mkv", "a.mkv"),
            ("-y - -crf 3", "-"),
            ("-- a", "--"),
            ("-i in.mp4", "-i"),
            ("-r:v 10", "-r:v"),
            ("-preset fast -crf", "-crf"),
        ] {
            let error = checked(wrong).expect_err(wrong);
            assert!(error.contains(&format!(" {word}: ")), "{wrong}: {error}");
        }
    }
}
