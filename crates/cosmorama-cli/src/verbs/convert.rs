use std::ops::ControlFlow;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Result;
use cosmorama_convert::{Conversion, Decision, Diagnostic, Observer, Report, Stop, Work};

use crate::args::{ConvertArgs, ProgressStyle};
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::Piped;
use crate::progress::Progress;
use crate::report;

/// Converts, and reports the result.
pub(super) fn run(args: ConvertArgs, console: &mut Console) -> Result<ExitCode> {
    let output = args.named_output();
    let idle = args.camera.idle(&args.geometry, Some(&output)).or_else(|| args.shutter.idle());
    if let Some(idle) = idle.or_else(|| args.video.idle(&output)) {
        return Err(usage(idle));
    }
    let (progress, as_json) = (args.run.progress, args.run.json);
    let piped = Piped::open(args, console)?;
    let conversion = Conversion { sink: piped.sink.clone(), ..piped.args.clone().into() };
    let report = match convert(conversion.files(Arc::clone(&piped.files)), progress, console) {
        Err(_) if piped.is_closed() => return Ok(ExitCode::SUCCESS),
        made => made?,
    };
    piped.finish()?;
    if as_json {
        console.print(&report::to_json(&report)?)?;
    } else if progress.is_for_people() {
        report::tell(&report, console);
    }
    Ok(ExitCode::SUCCESS)
}

/// Converts, and prints diagnostics and progress meanwhile.
pub(super) fn convert(conversion: Conversion, style: ProgressStyle, console: &Console) -> Result<Report> {
    let mut watch = Watch::new(console, style);
    let checked = Conversion { unfinished: console.unfinished.clone(), ..conversion }.check_watched(&mut watch);
    watch.finish();
    console.tell_all(&checked);
    let report = checked.result?.run(&mut watch)?;
    watch.finish();
    Ok(report)
}

/// Observer that reports a conversion on standard error.
pub(super) struct Watch<'a> {
    console: &'a Console,
    style: ProgressStyle,
    progress: Option<Progress>,
}

impl<'a> Watch<'a> {
    /// Watches work that has not begun.
    pub(super) fn new(console: &'a Console, style: ProgressStyle) -> Self {
        Self { console, style: console.progress(style), progress: None }
    }

    /// Clears the bar from the terminal.
    pub(super) fn finish(&self) {
        self.progress.iter().for_each(Progress::finish);
    }
}

impl Observer for Watch<'_> {
    fn begin(&mut self, frames: Option<usize>) {
        self.finish();
        self.progress.insert(Progress::new(self.style, frames)).tell_nothing_to_do();
    }

    fn diagnostic(&mut self, diagnostic: &Diagnostic) {
        self.console.warn(diagnostic);
    }

    fn decided(&mut self, decision: &Decision) {
        self.console.decision(decision);
    }

    fn advance(&mut self, work: Work, fraction: f64) -> ControlFlow<Stop> {
        // What goes before the first frame is told where that is asked for, however many frames there are.
        let style = self.style;
        self.progress.get_or_insert_with(|| Progress::before(style)).advance(work, fraction);
        ControlFlow::Continue(())
    }

    fn frame_done(&mut self, frame: Option<u64>) -> ControlFlow<Stop> {
        self.progress.iter_mut().for_each(|progress| progress.frame_done(frame));
        ControlFlow::Continue(())
    }
}
