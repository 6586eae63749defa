use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};
use std::sync::mpsc::{self, Receiver};
use std::thread;

/// Bytes of a line of ffmpeg's messages.
const LONGEST_LINE: u64 = 1 << 16;

/// Complaints that are kept for the message.
const KEPT: usize = 20;

/// Event in ffmpeg's messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// A frame has passed the filter that says so, with its time in ticks if it has one.
    Frame(Option<i64>),
    /// The next frame was decoded with errors.
    Corrupt,
    /// A part of the stream with this number is lost or damaged, as its container tells.
    CorruptPacket(u32),
    /// A message of an error.
    Complaint(String),
}

/// Messages of ffmpeg, read by a thread of their own so that ffmpeg never waits for a reader.
#[derive(Debug)]
pub(crate) struct Log {
    events: Receiver<Event>,
    /// Last complaints.
    complaints: VecDeque<String>,
}

impl Log {
    /// Options that make ffmpeg write the messages as they are read here.
    pub(crate) const OPTIONS: [&'static str; 2] = ["-v", "repeat+level+warning"];

    /// Starts to read.
    pub(crate) fn of(pipe: Option<impl Read + Send + 'static>) -> Self {
        let (sender, events) = mpsc::channel();
        thread::spawn(move || {
            let Some(pipe) = pipe else { return };
            let mut pipe = BufReader::new(pipe);
            let mut line = Vec::new();
            while pipe.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line).is_ok_and(|read| read > 0) {
                for event in told_by(&String::from_utf8_lossy(&line)) {
                    // Nobody listens any more once the reader is dropped; the pipe is emptied all the same.
                    let _ = sender.send(event);
                }
                line.clear();
            }
        });
        Self { events, complaints: VecDeque::new() }
    }

    /// Waits for the next event; `None` once ffmpeg has ended.
    pub(crate) fn next(&mut self) -> Option<Event> {
        let event = self.events.recv().ok()?;
        if let Event::Complaint(text) = &event {
            self.complaints.truncate(KEPT - 1);
            self.complaints.push_front(text.clone());
        }
        Some(event)
    }

    /// Reads the rest, and returns the last words of ffmpeg that name a cause.
    pub(crate) fn last_words(&mut self) -> String {
        self.cause().unwrap_or_else(|| "it says nothing".to_owned())
    }

    /// Reads the rest, and returns the cause of what it complained of; `None` if it did not.
    pub(crate) fn cause(&mut self) -> Option<String> {
        while self.next().is_some() {}
        let cause = self.complaints.iter().find(|text| !CONSEQUENCES.iter().any(|words| text.contains(words)));
        cause.or(self.complaints.front()).cloned()
    }

    /// Reads the rest, and returns the cause that it tells, if it tells one.
    pub(crate) fn rest(&mut self) -> Option<String> {
        self.complaints.clear();
        self.cause()
    }
}

/// Messages that follow from others.
const CONSEQUENCES: [&str; 6] = [
    "Conversion failed",
    "Error marking filters as finished",
    "Error closing",
    "Terminating demuxer",
    "Error initializing output stream",
    "Error while opening encoder",
];

/// Marks of messages of errors.
const LEVELS: [&str; 3] = ["[error] ", "[fatal] ", "[panic] "];

/// Messages of the level of errors that are about nothing that is seen: pictures that a broken link or an early start takes away
/// are dropped, and then missed by their numbers; of two pictures of one time, the second is told of. One that is not in its packet is missed, too:
/// of that, a parser speaks long before its time. Where a seek fails, frames are read from elsewhere, and numbered by their times. Attached files are
/// no pictures.
const HARMLESS: [&str; 7] = [
    "co located POCs unavailable",
    "incomplete attachment",
    "mmco: unref short failure",
    "Last message repeated",
    "missing picture in access unit",
    "non monotonically increasing dts to muxer",
    "read_timestamp",
];

/// Returns the events that a line tells, in their order; none for other messages.
fn told_by(line: &str) -> Vec<Event> {
    // First, since names of files are part of it, and may look like anything.
    if line.contains("corrupt decoded frame") {
        return vec![Event::Corrupt];
    }
    if let Some((_, stream)) = line.rsplit_once("corrupt input packet in stream ") {
        return stream.trim().parse().map(Event::CorruptPacket).into_iter().collect();
    }
    let (words, time) = frame(line).map_or((line, None), |(before, time)| (before, Some(time)));
    let is_error = LEVELS.iter().any(|level| words.contains(level));
    let is_harmless = HARMLESS.iter().any(|harmless| words.contains(harmless));
    let complaint = (is_error && !is_harmless).then(|| Event::Complaint(without_marks(words)));
    complaint.into_iter().chain(time.map(Event::Frame)).collect()
}

/// Returns the time of a frame that a line tells at its end, and what stands before: decoders write messages in pieces, so that a frame
/// of another thread may come before the rest.
fn frame(line: &str) -> Option<(&str, Option<i64>)> {
    let (before, rest) = line.rsplit_once("frame:")?;
    let mut words = rest.split_whitespace();
    words.next()?.parse::<u64>().ok()?;
    let ticks = words.next()?.strip_prefix("pts:")?;
    words.next()?.strip_prefix("pts_time:")?;
    words.next().is_none().then(|| (before, ticks.parse().ok()))
}

/// Returns a message without addresses in memory and levels.
fn without_marks(line: &str) -> String {
    let mut text = line;
    for level in LEVELS {
        text = text.split_once(level).map_or(text, |(_, rest)| rest);
    }
    let text = if text.trim().is_empty() { "it names no cause" } else { text.trim() };
    text.chars().filter(|letter| !letter.is_control()).take(400).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_tell_frames_damage_and_errors() {
        let event = |line: &str| {
            let mut told = told_by(line);
            assert!(told.len() <= 1, "{told:?}");
            told.pop()
        };
        assert_eq!(event("frame:1    pts:512     pts_time:0.04\n"), Some(Event::Frame(Some(512))));
        assert_eq!(event("[png @ 0x5] frame:1    pts:NOPTS   pts_time:NOPTS"), Some(Event::Frame(None)));
        assert_eq!(event("c=1\n"), None);
        let damaged = "[warning] a.mov: corrupt decoded frame in stream 0";
        assert_eq!(event(damaged), Some(Event::Corrupt));
        let packet = "[warning] a.ts: corrupt input packet in stream 3\n";
        assert_eq!(event(packet), Some(Event::CorruptPacket(3)));
        let error = event("[png @ 0x55db] [error] chunk too big\n");
        assert_eq!(error, Some(Event::Complaint("chunk too big".to_owned())));
        assert_eq!(event("[swscaler @ 0x55db] [warning] deprecated pixel format used"), None);
        // Names of files are part of messages, and may look like others.
        let forged = "[error] /films/frame:7 pts:9.mkv: Invalid data found when processing input";
        assert!(matches!(event(forged), Some(Event::Complaint(text)) if text.contains("Invalid data")));
        let damaged = "[warning] frame:7 pts:9.mkv: corrupt decoded frame in stream 0";
        assert_eq!(event(damaged), Some(Event::Corrupt));
        assert_eq!(event("[warning] my frame: pts: of old"), None);
        assert_eq!(event("[h264 @ 0x55db] [error] co located POCs unavailable"), None);
    }

    // A decoder's thread has written a part of its message when another one tells a frame.
    #[test]
    fn a_frame_within_a_message_is_heard() {
        let both = |cause: &str| vec![Event::Complaint(cause.to_owned()), Event::Frame(Some(18432))];
        let frame = "frame:36   pts:18432   pts_time:1.44\n";
        let told = |begin: &str| told_by(&(begin.to_owned() + frame));
        assert_eq!(told("[png @ 0x55db] [error] CRC mismatch in chunk"), both("CRC mismatch in chunk"));
        assert_eq!(told("[png @ 0x55db] [error] "), both("it names no cause"));
        assert_eq!(told("[png @ 0x55db] "), [Event::Frame(Some(18432))]);
    }

    #[test]
    fn the_cause_is_told_and_not_what_follows() {
        let text = "[error] No space left on device\n[fatal] Conversion failed!\n";
        assert_eq!(Log::of(Some(text.as_bytes())).last_words(), "No space left on device");
        assert_eq!(Log::of(Some(&b""[..])).last_words(), "it says nothing");
    }
}
