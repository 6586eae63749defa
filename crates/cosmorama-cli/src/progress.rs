use std::fmt::Write;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use cosmorama_convert::Work;
use indicatif::{ProgressBar, ProgressState, ProgressStyle as BarStyle};

use crate::args::ProgressStyle;
use crate::console::say;

/// Time between lines while one picture, or the geometry of all, is made.
const PAUSE: Duration = Duration::from_secs(2);

/// Time before a bar shows such work.
const SHORT: Duration = Duration::from_secs(1);

/// Number of steps of a bar that shows a single picture.
const STEPS: u64 = 1000;

/// Progress of the work on standard error.
pub(crate) struct Progress {
    /// Name of a thing that is made, for one without a number.
    noun: &'static str,
    form: Form,
    done: usize,
    /// Number of things to make; `None` while they go on until a stream ends.
    total: Option<usize>,
    start: Instant,
    /// Time of the last line, or of the start if there is none yet.
    said: Instant,
    /// Current work, and the time when it began.
    current: Option<(Work, Instant)>,
    /// Number of frames reported as done, with parts of one.
    told: f64,
}

enum Form {
    Bar(ProgressBar),
    Plain,
    Json,
    Openjd,
    Silent,
}

/// Progress of one piece of work.
#[derive(Clone, Copy)]
struct Advance {
    work: Work,
    fraction: f64,
    seconds_left: f64,
}

impl Progress {
    /// Starts the progress of this number of frames; `None` if they go on until a stream ends.
    pub(crate) fn new(style: ProgressStyle, total: impl Into<Option<usize>>) -> Self {
        Self::of("frame", style, total)
    }

    /// Starts the progress of one work before the first thing that is made. In a log, it is told if it takes long.
    pub(crate) fn before(style: ProgressStyle) -> Self {
        let is_bar = std::io::stderr().is_terminal();
        Self::of("frame", if style == ProgressStyle::Auto && !is_bar { ProgressStyle::Plain } else { style }, 1)
    }

    /// Starts the progress of this number of things of a name.
    pub(crate) fn of(noun: &'static str, style: ProgressStyle, total: impl Into<Option<usize>>) -> Self {
        let total = total.into();
        let form = match style {
            ProgressStyle::Auto if std::io::stderr().is_terminal() => Form::Bar(bar(noun, total)),
            // A single picture needs no running commentary in a log.
            ProgressStyle::Auto if !are_many(total) => Form::Silent,
            ProgressStyle::Auto | ProgressStyle::Plain => Form::Plain,
            ProgressStyle::Bar => Form::Bar(bar(noun, total)),
            ProgressStyle::Json => Form::Json,
            ProgressStyle::Openjd => Form::Openjd,
            ProgressStyle::None => Form::Silent,
        };
        let start = Instant::now();
        Self { noun, form, done: 0, total, start, said: start, current: None, told: 0.0 }
    }

    /// Reports that all is done where there is nothing to make, for those who wait for it.
    pub(crate) fn tell_nothing_to_do(&self) {
        if self.total == Some(0) && matches!(self.form, Form::Openjd) {
            say("openjd_progress: 100.00".to_owned());
        }
    }

    /// Reports that a fraction of some work is done. Short work is not reported.
    pub(crate) fn advance(&mut self, work: Work, fraction: f64) {
        self.advance_at(Instant::now(), work, fraction).into_iter().for_each(say);
    }

    /// Moves the bar, or returns the next line if it is due.
    fn advance_at(&mut self, now: Instant, work: Work, fraction: f64) -> Option<String> {
        let since = match self.current {
            Some((current, since)) if current == work => since,
            _ => {
                self.current = Some((work, now));
                now
            }
        };
        let elapsed = now.duration_since(since);
        let seconds_left = elapsed.as_secs_f64() * (1.0 - fraction) / fraction.max(1e-9);
        let advance = Advance { work, fraction, seconds_left };
        if let Form::Bar(bar) = &self.form {
            if are_many(self.total) {
                bar.set_message(if elapsed < SHORT { String::new() } else { format!(" ({advance})") });
            } else if elapsed >= SHORT {
                bar.set_position((fraction * STEPS as f64) as u64);
                bar.set_message(advance.to_string());
            }
            return None;
        }
        if now.duration_since(self.said) < PAUSE {
            return None;
        }
        self.said = now;
        self.line(advance)
    }

    fn line(&mut self, advance: Advance) -> Option<String> {
        let Advance { work, fraction, seconds_left } = advance;
        match (&self.form, work) {
            (Form::Plain, _) => Some(advance.to_string()),
            (Form::Json, _) => {
                let (work, frame) = match work {
                    Work::Render(frame) => ("render", frame),
                    Work::Filters => ("filters", None),
                    Work::Path => ("path", None),
                    _ => ("plan", None),
                };
                let line = serde_json::json!({
                    "work": work, "frame": frame, "fraction": fraction, "done": self.done, "total": self.total,
                    "seconds_left": seconds_left,
                });
                Some(line.to_string())
            }
            // Earlier frames may not be written yet, so that the figure must not fall when they are.
            (Form::Openjd, Work::Render(_)) => {
                let progress = self.openjd(self.done as f64 + fraction);
                Some(progress.unwrap_or_else(|| format!("openjd_status: {advance}")))
            }
            (Form::Openjd, _) => Some(format!("openjd_status: {advance}")),
            (Form::Bar(_) | Form::Silent, _) => None,
        }
    }

    /// Returns the line about the part that is done; `None` while nobody knows of how much it is a part.
    fn openjd(&mut self, frames: f64) -> Option<String> {
        self.told = self.told.max(frames);
        Some(format!("openjd_progress: {:.2}", 100.0 * self.told / self.total? as f64))
    }

    /// Reports that another frame is written.
    pub(crate) fn frame_done(&mut self, frame: Option<u64>) {
        self.done += 1;
        self.said = Instant::now();
        let rate = self.done as f64 / self.start.elapsed().as_secs_f64().max(1e-9);
        match &self.form {
            Form::Bar(bar) if are_many(self.total) => bar.inc(1),
            _ => self.done_line(frame, rate).into_iter().for_each(say),
        }
    }

    /// Returns the line about a frame that is written, when so many are made a second.
    fn done_line(&mut self, frame: Option<u64>, rate: f64) -> Option<String> {
        let (done, total) = (self.done, self.total);
        let left = total.map(|total| (total - done) as f64 / rate);
        let number = frame.map_or_else(|| self.noun.to_owned(), |frame| format!("frame {frame}"));
        match &self.form {
            Form::Plain => {
                let of = total.map_or_else(String::new, |total| format!(" of {total}"));
                let left = left.map_or_else(String::new, |left| format!(", {left:.0} s left"));
                Some(format!("{number}: {done}{of} done, {} a second{left}", steady(rate)))
            }
            Form::Json => {
                let line = serde_json::json!({
                    "frame": frame, "done": done, "total": total, "frames_per_second": rate, "seconds_left": left,
                });
                Some(line.to_string())
            }
            Form::Openjd => {
                let progress = self.openjd(done as f64);
                Some(progress.unwrap_or_else(|| format!("openjd_status: {number}: {done} done")))
            }
            Form::Bar(_) | Form::Silent => None,
        }
    }

    /// Clears the bar from the terminal.
    pub(crate) fn finish(&self) {
        if let Form::Bar(bar) = &self.form {
            bar.finish_and_clear();
        }
    }
}

impl std::fmt::Display for Advance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { work, fraction, seconds_left } = *self;
        match work {
            Work::Render(None) => f.write_str("picture")?,
            Work::Render(Some(frame)) => write!(f, "frame {frame}")?,
            Work::Filters => f.write_str("filters")?,
            Work::Path => f.write_str("camera's path")?,
            _ => f.write_str("geometry")?,
        }
        match work {
            Work::Render(_) if fraction >= 1.0 => f.write_str(": rendered, being written"),
            _ => write!(f, ": {:.0} % done, {seconds_left:.0} s left", (100.0 * fraction).floor()),
        }
    }
}

/// Returns whether there may be more than one.
fn are_many(total: Option<usize>) -> bool {
    total.is_none_or(|total| total > 1)
}

fn bar(noun: &str, total: Option<usize>) -> ProgressBar {
    let (template, length) = match total {
        None => (format!("{{spinner}} {{pos}} {noun}s, {{rate}} a second{{msg}}"), None),
        Some(0 | 1) => ("{wide_bar} {msg}".to_owned(), Some(STEPS)),
        Some(total) => {
            let template = format!("{{wide_bar}} {{pos}}/{{len}} {noun}s, {{rate}} a second, {{eta}} left{{msg}}");
            (template, Some(total as u64))
        }
    };
    let style = BarStyle::with_template(&template).unwrap_or_else(|_| BarStyle::default_bar());
    let style = style.with_key("rate", |state: &ProgressState, to: &mut dyn Write| {
        let _ = to.write_str(&steady(state.per_sec()));
    });
    length.map_or_else(ProgressBar::no_length, ProgressBar::new).with_style(style)
}

/// Returns a rate with three digits, for many frames a second or few.
fn steady(rate: f64) -> String {
    let decimals = if rate < 10.0 { 2 } else { usize::from(rate < 100.0) };
    format!("{rate:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_have_three_digits() {
        assert_eq!([0.0712, 1.5, 12.345, 347.8].map(steady), ["0.07", "1.50", "12.3", "348"]);
    }

    /// Returns the lines about work that advances by a hundredth every tenth of a second.
    fn said(style: ProgressStyle, total: usize, work: Work) -> Vec<String> {
        let mut progress = Progress::new(style, total);
        let at = |hundredth: u32| progress.start + Duration::from_millis(100) * hundredth;
        let times: Vec<Instant> = (1..=100).map(at).collect();
        let fractions = (1..=100).map(|hundredth| f64::from(hundredth) / 100.0);
        times.into_iter().zip(fractions).filter_map(|(now, done)| progress.advance_at(now, work, done)).collect()
    }

    #[test]
    fn long_work_is_told_of_every_other_second() {
        let lines = said(ProgressStyle::Plain, 1, Work::Render(None));
        assert_eq!(lines.len(), 5, "{lines:?}");
        assert_eq!(lines[1], "picture: 40 % done, 6 s left");
        assert_eq!(lines[4], "picture: rendered, being written");
        assert_eq!(said(ProgressStyle::Plain, 9, Work::Render(Some(7)))[0], "frame 7: 20 % done, 8 s left");
        let lines = said(ProgressStyle::Plain, 9, Work::Plan);
        assert_eq!((&*lines[0], &*lines[4]), ("geometry: 20 % done, 8 s left", "geometry: 100 % done, 0 s left"));
        assert_eq!(said(ProgressStyle::Plain, 1, Work::Path)[0], "camera's path: 20 % done, 8 s left");
        assert_eq!(said(ProgressStyle::Openjd, 4, Work::Render(None))[1], "openjd_progress: 10.00");
        assert_eq!(said(ProgressStyle::Openjd, 4, Work::Plan)[0], "openjd_status: geometry: 20 % done, 8 s left");
        let line: serde_json::Value =
            serde_json::from_str(&said(ProgressStyle::Json, 4, Work::Render(Some(7)))[1]).unwrap_or_default();
        assert_eq!((&line["work"], &line["frame"], &line["fraction"]), (&"render".into(), &7.into(), &0.4.into()));
        assert_eq!(said(ProgressStyle::None, 1, Work::Render(None)), [""; 0]);
    }

    #[test]
    fn where_no_end_is_known_none_is_told() {
        let line = |style| {
            let mut progress = Progress::new(style, None);
            progress.done = 3;
            progress.done_line(Some(2), 2.0)
        };
        assert_eq!(line(ProgressStyle::Plain).as_deref(), Some("frame 2: 3 done, 2.00 a second"));
        assert_eq!(line(ProgressStyle::Openjd).as_deref(), Some("openjd_status: frame 2: 3 done"));
        let line: serde_json::Value = serde_json::from_str(&line(ProgressStyle::Json).unwrap()).unwrap();
        assert_eq!((&line["done"], &line["total"], &line["seconds_left"]), (&3.into(), &().into(), &().into()));
        let known = |style| Progress { done: 3, ..Progress::new(style, 4) }.done_line(Some(2), 2.0);
        assert_eq!(known(ProgressStyle::Plain).as_deref(), Some("frame 2: 3 of 4 done, 2.00 a second, 0 s left"));
        assert_eq!(known(ProgressStyle::Openjd).as_deref(), Some("openjd_progress: 75.00"));
    }

    #[test]
    fn of_short_work_nothing_is_said() {
        let mut progress = Progress::new(ProgressStyle::Plain, 1);
        let now = progress.start + Duration::from_millis(1900);
        assert_eq!(progress.advance_at(now, Work::Render(None), 0.9), None);
        assert_eq!(progress.advance_at(now, Work::Render(None), 1.0), None);
    }

    #[test]
    fn a_bar_of_a_single_picture_moves_after_a_second() {
        let mut progress = Progress::new(ProgressStyle::Bar, 1);
        let mut at = |tenths: u32, fraction: f64| {
            let now = progress.start + Duration::from_millis(100) * tenths;
            progress.advance_at(now, Work::Render(None), fraction);
            let Form::Bar(bar) = &progress.form else { return (0, String::new()) };
            (bar.position(), bar.message())
        };
        assert_eq!((at(0, 0.0), at(9, 0.1)), ((0, String::new()), (0, String::new())));
        assert_eq!(at(20, 0.25), (250, "picture: 25 % done, 6 s left".to_owned()));
    }

    #[test]
    fn what_openjd_was_told_is_not_taken_back() {
        let mut progress = Progress::new(ProgressStyle::Openjd, 4);
        let mut at = |seconds: u64, frame: u64, fraction: f64| {
            progress.advance_at(progress.start + Duration::from_secs(seconds), Work::Render(Some(frame)), fraction)
        };
        assert_eq!(at(2, 1, 0.8).as_deref(), Some("openjd_progress: 20.00"));
        assert_eq!(at(4, 2, 0.1).as_deref(), Some("openjd_progress: 20.00"), "the first is not written yet");
    }
}
