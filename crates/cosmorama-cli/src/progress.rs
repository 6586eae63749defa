use std::fmt::Write;
use std::io::IsTerminal;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressState, ProgressStyle as BarStyle};

use crate::args::ProgressStyle;
use crate::console::say;

/// Tells on standard error how far the work is.
pub(crate) struct Progress {
    form: Form,
    done: usize,
    total: usize,
    start: Instant,
}

enum Form {
    Bar(ProgressBar),
    Plain,
    Json,
    Openjd,
    Silent,
}

impl Progress {
    /// Progress of so many frames.
    pub(crate) fn new(style: ProgressStyle, total: usize) -> Self {
        let form = match style {
            ProgressStyle::Auto if std::io::stderr().is_terminal() => Form::Bar(bar(total)),
            // A single picture needs no running commentary in a log.
            ProgressStyle::Auto if total <= 1 => Form::Silent,
            ProgressStyle::Auto | ProgressStyle::Plain => Form::Plain,
            ProgressStyle::Bar => Form::Bar(bar(total)),
            ProgressStyle::Json => Form::Json,
            ProgressStyle::Openjd => Form::Openjd,
            ProgressStyle::None => Form::Silent,
        };
        Self { form, done: 0, total, start: Instant::now() }
    }

    /// One more frame is written.
    pub(crate) fn frame_done(&mut self, frame: Option<u64>) {
        self.done += 1;
        let (done, total) = (self.done, self.total);
        let rate = done as f64 / self.start.elapsed().as_secs_f64().max(1e-9);
        let left = (total - done) as f64 / rate;
        let number = frame.map_or_else(|| "frame".to_owned(), |frame| format!("frame {frame}"));
        match &self.form {
            Form::Bar(bar) => bar.inc(1),
            Form::Plain => {
                say(format_args!("{number}: {done} of {total} done, {} a second, {left:.0} s left", steady(rate)));
            }
            Form::Json => {
                let line = serde_json::json!({
                    "frame": frame, "done": done, "total": total, "frames_per_second": rate, "seconds_left": left,
                });
                say(line);
            }
            Form::Openjd => say(format_args!("openjd_progress: {:.2}", 100.0 * done as f64 / total as f64)),
            Form::Silent => {}
        }
    }

    /// Clears what should not stay.
    pub(crate) fn finish(&self) {
        if let Form::Bar(bar) = &self.form {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: usize) -> ProgressBar {
    let template = "{wide_bar} {pos}/{len} frames, {rate} a second, {eta} left";
    let style = BarStyle::with_template(template).unwrap_or_else(|_| BarStyle::default_bar());
    let style = style.with_key("rate", |state: &ProgressState, to: &mut dyn Write| {
        let _ = to.write_str(&steady(state.per_sec()));
    });
    ProgressBar::new(total as u64).with_style(style)
}

/// A rate in three digits, whether there are many a second or few.
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
}
