//! Records on standard error: lines for people, or JSON objects for programs.
//!
//! A log is a value that the console holds, and no state of the process: each record goes to it by name. Libraries return what there is
//! to say, and know nothing of it.

use std::fmt::{self, Debug, Write as _};
use std::io;

use cosmorama_convert::{Code, Topic};
use tracing::field::{Field, Visit};
use tracing::{Dispatch, Event, Level, Subscriber, dispatcher};
use tracing_subscriber::filter::{EnvFilter, FilterExt, FilterFn, ParseError};
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields, MakeWriter};
use tracing_subscriber::registry::LookupSpan;
use tracing_subscriber::{Layer, Registry, fmt as lines, layer::SubscriberExt};

use super::say_as_it_is;
use crate::parse::log_format::LogFormat;

/// Variable of the environment that says which records are wanted.
pub(crate) const VARIABLE: &str = "RUST_LOG";

/// Target of records that nobody has to ask for: the report at the end, and notes that explain an error.
const ALWAYS: &str = "cosmorama::report";

/// Target of warnings, notes and errors.
const TOLD: &str = "cosmorama::message";

// Targets of decisions, by their topics.
const INPUT: &str = "cosmorama::input";
const PROJECTION: &str = "cosmorama::projection";
const COLOUR: &str = "cosmorama::colour";
const FILTER: &str = "cosmorama::filter";
const GEOMETRY: &str = "cosmorama::geometry";
const MEMORY: &str = "cosmorama::memory";
const FRAMES: &str = "cosmorama::frames";
const CONVERSION: &str = "cosmorama::conversion";

/// Targets of all records.
const TARGETS: [&str; 10] = [ALWAYS, TOLD, INPUT, PROJECTION, COLOUR, FILTER, GEOMETRY, MEMORY, FRAMES, CONVERSION];

/// Log of a run. The default one tells warnings and errors, in lines for people.
#[derive(Clone)]
pub(crate) struct Log {
    records: Dispatch,
    format: LogFormat,
}

/// Returns what to say of the first topic of ours that is asked for and that no record has.
pub(crate) fn unknown_topic(asked: &str) -> Option<String> {
    let names = asked.split(',').map(|wish| wish.split(['=', '[']).next().unwrap_or_default().trim());
    let mut ours = names.filter(|name| name.starts_with("cosmorama::"));
    let unknown = ours.find(|name| !TARGETS.iter().any(|target| target.starts_with(name)))?;
    Some(format!("{unknown} is no topic; expected one of {}", TARGETS.join(", ")))
}

impl Default for Log {
    fn default() -> Self {
        let nothing_asked = EnvFilter::builder().parse_lossy("off");
        Self { records: records(nothing_asked, LogFormat::Text), format: LogFormat::Text }
    }
}

impl Debug for Log {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Log").field("format", &self.format).finish_non_exhaustive()
    }
}

impl Log {
    /// Creates the log for so many `-v`, and for what the variable of the environment asks for.
    ///
    /// # Errors
    /// When that cannot be understood.
    pub(crate) fn new(verbose: u8, asked: &str, format: LogFormat) -> Result<Self, ParseError> {
        let own = match verbose {
            0 => "",
            1 => "cosmorama=info,",
            _ => "cosmorama=debug,",
        };
        let filter = EnvFilter::builder().parse(format!("{own}{asked}"))?;
        Ok(Self { records: records(filter, format), format })
    }

    /// Returns whether records are for programs.
    pub(crate) fn is_json(&self) -> bool {
        self.format == LogFormat::Json
    }

    /// Tells why the work ends.
    pub(crate) fn error(&self, text: &str) {
        self.on(|| tracing::error!(target: TOLD, "{text}"));
    }

    /// Tells of something that may be wrong.
    pub(crate) fn warning(&self, code: Option<Code>, text: &str) {
        let code = code.map(tracing::field::debug);
        self.on(|| tracing::warn!(target: TOLD, code, "{text}"));
    }

    /// Tells what is good to know where nothing is wrong, to those who ask, or to all.
    pub(crate) fn note(&self, code: Code, text: &str, is_for_all: bool) {
        self.on(|| {
            if is_for_all {
                tracing::info!(target: ALWAYS, ?code, "{text}");
            } else {
                tracing::info!(target: TOLD, ?code, "{text}");
            }
        });
    }

    /// Tells what was done, whoever asks.
    pub(crate) fn report(&self, text: &str) {
        self.on(|| tracing::info!(target: ALWAYS, "{text}"));
    }

    /// Tells what was decided.
    pub(crate) fn decision(&self, topic: Topic, is_detail: bool, text: &str) {
        macro_rules! tell {
            ($target:ident) => {
                if is_detail {
                    tracing::debug!(target: $target, "{text}")
                } else {
                    tracing::info!(target: $target, "{text}")
                }
            };
        }
        self.on(|| match topic {
            Topic::Input => tell!(INPUT),
            Topic::Projection => tell!(PROJECTION),
            Topic::Colour => tell!(COLOUR),
            Topic::Filter => tell!(FILTER),
            Topic::Geometry => tell!(GEOMETRY),
            Topic::Memory => tell!(MEMORY),
            Topic::Frames => tell!(FRAMES),
            _ => tell!(CONVERSION),
        });
    }

    fn on(&self, tell: impl FnOnce()) {
        dispatcher::with_default(&self.records, tell);
    }
}

/// Creates what takes records: those that the filter lets through, and in any case warnings, errors and reports.
fn records(filter: EnvFilter, format: LogFormat) -> Dispatch {
    let always = FilterFn::new(|about| *about.level() <= Level::WARN || about.target() == ALWAYS);
    let wanted = filter.or(always);
    let layer = lines::layer().with_writer(StandardError).with_ansi(false);
    match format {
        LogFormat::Text => Dispatch::new(Registry::default().with(layer.event_format(ForPeople).with_filter(wanted))),
        LogFormat::Json => {
            let layer = layer.json().flatten_event(true).with_current_span(false).with_span_list(false);
            Dispatch::new(Registry::default().with(layer.with_filter(wanted)))
        }
    }
}

/// Standard error, whose lines hold no control characters.
struct StandardError;

impl<'a> MakeWriter<'a> for StandardError {
    type Writer = Self;

    fn make_writer(&'a self) -> Self {
        Self
    }
}

/// Takes whole records: the layer writes each at once.
impl io::Write for StandardError {
    fn write(&mut self, record: &[u8]) -> io::Result<usize> {
        say_as_it_is(&String::from_utf8_lossy(record));
        Ok(record.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Form of a record for people: its kind and its text. Further lines of a text are indented, so that none of them passes for a record, or
/// for a line of progress.
struct ForPeople;

impl<S, N> FormatEvent<S, N> for ForPeople
where
    S: Subscriber + for<'s> LookupSpan<'s>,
    N: for<'s> FormatFields<'s> + 'static,
{
    fn format_event(&self, _: &FmtContext<'_, S, N>, mut line: Writer<'_>, event: &Event<'_>) -> fmt::Result {
        let mut text = Text::default();
        event.record(&mut text);
        let about = event.metadata();
        let kind = match (*about.level(), about.target()) {
            (Level::ERROR, _) => "error: ",
            (Level::WARN, _) => "warning: ",
            (_, ALWAYS) if !text.is_of_a_kind => "",
            (_, ALWAYS | TOLD) => "note: ",
            (_, topic) => &format!("{}: ", topic.rsplit(':').next().unwrap_or(topic)),
        };
        writeln!(line, "{kind}{}", text.message.replace('\n', "\n  "))
    }
}

/// Text of a record.
#[derive(Default)]
struct Text {
    message: String,
    /// Whether it has the code of a diagnostic.
    is_of_a_kind: bool,
}

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        match field.name() {
            "message" => {
                let _ = write!(self.message, "{value:?}");
            }
            _ => self.is_of_a_kind = true,
        }
    }
}
