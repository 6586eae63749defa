use super::ahead::{Ahead, Complaint};
use super::decoder::{Decoded, Decoder, Ended, Next, Start};
use super::filters::check_memory;
use super::preceding::{Beside, DELAY, Damage, Looked, PATIENCE};
use super::{Damaged, Fault, FrameCondition, ReadOptions, VideoFrame};
use crate::probe::{AVI, GIF, Places, Uncounted};
use crate::{Announced, AnnouncedBy, CutShort, Ffmpeg, Timeline, VideoError, VideoInfo};
use cosmorama::raster::{EncodedImage, FramePool};

/// Frames of a video in the order in which they are shown. Dropped early, it ends its ffmpeg.
#[derive(Debug)]
pub struct VideoReader {
    ffmpeg: Ffmpeg,
    info: VideoInfo,
    options: ReadOptions,
    timeline: Timeline,
    /// Running ffmpeg; `None` once the frames have ended.
    decoder: Option<Decoder>,
    /// Number of the next frame.
    expected: u64,
    /// Frame that was decoded, while frames before it are missing.
    ahead: Option<Ahead>,
    /// Picture of the frame before, where it may be held.
    held: Option<EncodedImage>,
    /// Places for frames in an AVI, some of which may be empty.
    places: Places,
    /// Message of an error for which no frame is missed yet.
    complaint: Option<Complaint>,
    /// Number of frames, found at their end.
    total: Option<u64>,
    /// Time of the frame before.
    last: i64,
    may_restart: bool,
    /// Whether frames are decoded once more where something is heard that may be about others than those that are asked for.
    looks_again: bool,
    /// Number of the first frame around which that was not done yet.
    looked_to: u64,
    /// Whether that was not done yet for frames before the first.
    may_look_before: bool,
    /// Whether a place before the first frame has another size than an AVI's index tells, so that decoders may be silent about it.
    is_behind_resized: bool,
    /// Fault of the first frame, which was found so.
    own: Option<Fault>,
    faults: Vec<Fault>,
    /// Damaged frames beside those that are asked for.
    beside: Vec<Fault>,
    /// Damage that was found by decoding once more.
    foreseen: Vec<Fault>,
}

/// Frames in a row that are held at most. More are no gap, but a lie about times or numbers.
const LONGEST_HOLD: u64 = 100_000;

impl VideoReader {
    /// Starts to decode.
    ///
    /// # Errors
    /// When a frame is larger than permitted, the video is of a kind that cannot be read right (interlaced, or of a matrix that
    /// is no matrix), the frames asked for are not there, or ffmpeg cannot be run.
    pub fn open(ffmpeg: &Ffmpeg, info: &VideoInfo, options: ReadOptions) -> Result<Self, VideoError> {
        Self::started(ffmpeg, info, options, true)
    }

    /// Starts to decode, without a second look.
    pub(super) fn looking_no_further(
        ffmpeg: &Ffmpeg,
        info: &VideoInfo,
        options: ReadOptions,
    ) -> Result<Self, VideoError> {
        Self::started(ffmpeg, info, options, false)
    }

    fn started(ffmpeg: &Ffmpeg, info: &VideoInfo, options: ReadOptions, looks_again: bool) -> Result<Self, VideoError> {
        check_memory(info, &options)?;
        if let (Some(CutShort { expected, found }), None, Damaged::Error) = (info.cut, &options.frames, options.damaged)
        {
            return Err(VideoError::Cut { path: info.path.clone(), expected, found, is_described: true });
        }
        let timeline = ffmpeg.timeline(info)?;
        let counted = info.announced.filter(|told| told.by == AnnouncedBy::Count).map(|told| told.frames);
        // Of a cut file, the times of frames that it lacks may be lacking, too.
        let known = if info.cut.is_some() { counted.or(timeline.frames()) } else { timeline.frames().or(counted) };
        if let (Some(frames), Some(range)) = (known, &options.frames)
            && let Some(asked) = [range.start(), range.end()].into_iter().find(|frame| **frame >= frames)
        {
            return Err(VideoError::NoSuchFrame {
                path: info.path.clone(),
                asked: *asked,
                last: frames.saturating_sub(1),
            });
        }
        let first = options.frames.as_ref().map_or(0, |range| *range.start());
        let start = Start::at(first, info, &timeline);
        let decoder = Decoder::start(ffmpeg, info, &options, start)?;
        let mut reader = Self {
            ffmpeg: ffmpeg.clone(),
            info: info.clone(),
            options,
            timeline,
            decoder: Some(decoder),
            expected: first,
            ahead: None,
            held: None,
            places: Places::default(),
            complaint: None,
            total: None,
            last: 0,
            may_restart: start.seek.is_some(),
            looks_again,
            looked_to: 0,
            may_look_before: looks_again,
            is_behind_resized: false,
            own: None,
            faults: Vec::new(),
            beside: Vec::new(),
            foreseen: Vec::new(),
        };
        reader.compare_places(start.seek)?;
        Ok(reader)
    }

    /// Returns the next frame; `None` after the last.
    ///
    /// # Errors
    /// When a frame is damaged or missing and neither held nor skipped, or there are fewer than the file announces.
    pub fn next_frame(&mut self) -> Result<Option<VideoFrame>, VideoError> {
        self.next_frame_in(&FramePool::default())
    }

    /// Returns the next frame, in memory of a pool; `None` after the last.
    ///
    /// # Errors
    /// As [`next_frame`](Self::next_frame).
    pub fn next_frame_in(&mut self, pool: &FramePool) -> Result<Option<VideoFrame>, VideoError> {
        let result = self.found_next(pool);
        if !matches!(result, Ok(Some(_))) {
            self.decoder = None;
        }
        result
    }

    /// Returns the frames so far that were held or skipped.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Returns damaged frames beside those that are asked for, after which some of these may take, and show traces.
    pub fn faults_beside(&self) -> &[Fault] {
        &self.beside
    }

    /// Returns damage that was found by decoding once more, when something was heard, perhaps before its frames come: some that come before
    /// may take after them, too.
    pub fn foreseen(&self) -> &[Fault] {
        &self.foreseen
    }

    /// Returns the times of the frames.
    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    fn found_next(&mut self, pool: &FramePool) -> Result<Option<VideoFrame>, VideoError> {
        loop {
            if let Some(last) =
                self.options.frames.as_ref().map(|range| *range.end()).filter(|last| self.expected > *last)
            {
                self.settle_at_the_end(last)?;
                return Ok(None);
            }
            if self.ahead.is_none() {
                self.decode(pool)?;
            }
            let found = match self.ahead.take() {
                Some(Ahead { index, frame }) if index == self.expected && !frame.is_corrupt => {
                    Some(self.whole(index, frame))
                }
                Some(ahead) if self.is_behind_none(&ahead)? => self.repeat_before(Some(ahead))?,
                Some(ahead) => self.gap(ahead)?,
                None if self.expected < self.total.unwrap_or(0) && self.is_at_empty_place() => {
                    self.repeat_before(None)?
                }
                None if self.expected < self.total.unwrap_or(0) => self.gap_at_the_end()?,
                None => return Ok(None),
            };
            if found.is_some() {
                return Ok(found);
            }
        }
    }

    fn whole(&mut self, index: u64, frame: Decoded) -> VideoFrame {
        self.expected = index + 1;
        let may_hold = self.options.damaged == Damaged::Hold || self.is_empty_place(self.expected);
        self.held = may_hold.then(|| frame.image.clone());
        let time = frame.time.unwrap_or_else(|| self.time(index));
        self.last = time;
        VideoFrame { index, time, image: frame.image, condition: FrameCondition::Whole }
    }

    /// Decodes a frame into `ahead`, or finds the number of all frames.
    fn decode(&mut self, pool: &FramePool) -> Result<(), VideoError> {
        loop {
            let Some(decoder) = &mut self.decoder else { return Ok(()) };
            let mut frame = match decoder.next(&self.info, pool)? {
                Next::Frame(frame) => frame,
                Next::End(_) if std::mem::take(&mut self.may_restart) => {
                    self.restart(None)?;
                    continue;
                }
                Next::End(ended) => return self.ended(ended),
            };
            let is_doubtful = decoder.take_doubt();
            let index = self.number(&frame);
            if index > self.expected && std::mem::take(&mut self.may_restart) {
                // The seek has gone too far, or a frame is missing: from the beginning it is certain.
                self.restart(None)?;
                continue;
            }
            let has_sought = std::mem::take(&mut self.may_restart);
            if (is_doubtful || self.is_behind_resized) && std::mem::take(&mut self.may_look_before) {
                let from = self.look_before()?;
                if has_sought {
                    // Some decoders make up frames that they lack: decoding begins again, farther before.
                    self.restart(Start::at(from, &self.info, &self.timeline).seek)?;
                    continue;
                }
            }
            if index < self.info.early {
                (frame.is_corrupt, frame.complaint) = (true, None);
            }
            if let Some(Fault { reason, .. }) = self.own.take() {
                frame.is_corrupt |= index == self.expected;
                frame.complaint = Some(reason);
            }
            if let Some(text) = frame.complaint.take() {
                self.look_ahead(index)?;
                // The first names the cause.
                self.complaint.get_or_insert(Complaint { frame: index, meant: frame.meant, text });
            }
            if index < self.expected {
                let reason = "a second picture has its time".to_owned();
                self.tell(Fault { frame: index, count: 1, reason, is_given: true })?;
                continue;
            }
            self.ahead = Some(Ahead { index, frame });
            return self.settle(index);
        }
    }

    /// Returns the number of a frame. A damaged one may have a time behind the last.
    fn number(&self, frame: &Decoded) -> u64 {
        let number = frame.time.map_or(self.expected, |time| self.timeline.frame(time));
        match self.looked().sure_last().filter(|_| frame.is_corrupt) {
            Some(last) => number.min(last),
            None => number,
        }
    }

    fn restart(&mut self, seek: Option<f64>) -> Result<(), VideoError> {
        let start = Start { seek, ..Start::at(self.expected, &self.info, &self.timeline) };
        // The old one is ended first.
        self.decoder = None;
        self.decoder = Some(Decoder::start(&self.ffmpeg, &self.info, &self.options, start)?);
        self.may_restart = seek.is_some();
        self.tell_of_uncounted(seek)
    }

    /// Finds out what is damaged around the first frame that is asked for. Returns the frame from which was looked.
    fn look_before(&mut self) -> Result<u64, VideoError> {
        let first = self.expected;
        let damage = self.looked().damage(first)?;
        self.own = damage.of(first).filter(|_| !damage.is_given).cloned();
        let from = damage.start;
        self.foresee(damage)?;
        Ok(from)
    }

    /// Finds out what is damaged around a frame before which something was heard.
    fn look_ahead(&mut self, frame: u64) -> Result<(), VideoError> {
        if !self.looks_again || frame < self.looked_to {
            return Ok(());
        }
        let damage = self.looked().damage(frame)?;
        self.foresee(damage)
    }

    /// Notes damage that was found around a frame, or fails for it.
    fn foresee(&mut self, damage: Damage) -> Result<(), VideoError> {
        // What is heard near the end of a look may be about frames behind it.
        self.looked_to = (damage.last + 1).saturating_sub(DELAY).max(damage.frame + 1);
        let (own, beside) = (damage.of_looked_at(&self.options).cloned(), damage.beside(self.looked()));
        if self.options.damaged == Damaged::Error {
            let first = beside.and_then(|Beside { faults, traced }| Some((faults.into_iter().next()?, traced)));
            return match (first, own) {
                (Some((fault, traced)), own) if own.as_ref().is_none_or(|own| fault.frame < own.frame) => {
                    let reason = format!("{}; frame {traced}, which is asked for, may take after it", fault.reason);
                    self.note(Fault { reason, ..fault })
                }
                (_, Some(own)) => self.note(own),
                _ => Ok(()),
            };
        }
        if let Some(Beside { faults, .. }) = beside {
            let is_new = |fault: &Fault| !self.beside.contains(fault);
            let new: Vec<Fault> = faults.into_iter().filter(is_new).collect();
            self.beside.extend(new);
        }
        self.foreseen.extend(damage.faults);
        Ok(())
    }

    fn looked(&self) -> Looked<'_> {
        Looked { ffmpeg: &self.ffmpeg, info: &self.info, timeline: &self.timeline, options: &self.options }
    }

    /// Tells of a message that was heard within the last frames that are asked for, if one of them is damaged: decoders work ahead, and may
    /// mean one that comes later.
    fn settle_at_the_end(&mut self, last: u64) -> Result<(), VideoError> {
        let Some(Complaint { frame, meant, text }) = self.complaint.take() else { return Ok(()) };
        if !self.looks_again {
            let may_be_later = frame + DELAY > last && self.looked().last().is_some_and(|end| last < end);
            let fault = Fault { frame, count: meant, reason: text, is_given: true };
            return if may_be_later { Ok(()) } else { self.tell(fault) };
        }
        let found = self.foreseen.clone().into_iter();
        let told = found.filter(|fault| fault.frame <= last && fault.frame + fault.count > frame);
        for fault in told {
            if !self.is_told(fault.frame) {
                self.tell(Fault { is_given: true, ..fault })?;
            }
        }
        Ok(())
    }

    /// Tells of a message after which no frame was missed for long.
    fn settle(&mut self, index: u64) -> Result<(), VideoError> {
        match self.complaint.take_if(|complaint| index > complaint.frame + PATIENCE) {
            Some(Complaint { frame, meant, text }) => {
                self.tell(Fault { frame, count: meant, reason: text, is_given: true })
            }
            None => Ok(()),
        }
    }

    /// Answers frames that are missing, or damaged, before the one that comes, or in its place.
    fn gap(&mut self, ahead: Ahead) -> Result<Option<VideoFrame>, VideoError> {
        let (first, is_corrupt) = (self.expected, ahead.frame.is_corrupt);
        let end = if is_corrupt { ahead.index + 1 } else { ahead.index };
        if !self.is_told(first) {
            let usual = if is_corrupt { "it was decoded with errors" } else { "there is no picture of its time" };
            let reason = self.reason(first, usual);
            let count = end.min(self.end_of_range()).saturating_sub(first).max(1);
            self.tell(Fault { frame: first, count, reason, is_given: false })?;
        }
        if self.options.damaged == Damaged::Hold {
            if self.held.is_none() && self.looks_again && first == self.first_asked() {
                self.held = self.looked().shown_before(first)?;
            }
            if is_corrupt && self.held.is_none() {
                // The next one is shown instead.
                return Ok(None);
            }
            let image = self.held.clone().unwrap_or_else(|| ahead.frame.image.clone());
            self.ahead = (!is_corrupt || end > first + 1).then_some(ahead);
            return Ok(Some(self.hold(image)));
        }
        self.expected = end;
        self.ahead = (!is_corrupt).then_some(ahead);
        Ok(None)
    }

    /// Returns whether the next frame comes behind a place that is left empty, or behind the end of a film that was cut out.
    fn is_behind_none(&self, ahead: &Ahead) -> Result<bool, VideoError> {
        let missing = self.expected..ahead.index;
        if ahead.frame.is_corrupt || !(1..=LONGEST_HOLD).contains(&(missing.end.saturating_sub(missing.start))) {
            return Ok(false);
        }
        Ok(self.is_at_empty_place() || (self.is_untold() && self.looked().lacks_from_its_end(&missing)?))
    }

    /// Returns whether the next frame is a place that an AVI leaves empty, behind a frame that is whole: there the frame before is shown on.
    fn is_at_empty_place(&self) -> bool {
        self.is_untold() && self.is_empty_place(self.expected)
    }

    /// Returns whether nothing is told of the next frame and the one before.
    fn is_untold(&self) -> bool {
        let is_told = |frame: u64| self.is_told(frame);
        self.complaint.is_none() && !is_told(self.expected) && !self.expected.checked_sub(1).is_some_and(is_told)
    }

    fn is_empty_place(&self, frame: u64) -> bool {
        let is_empty = |time| self.places.is_empty(time, self.info.delay);
        !self.info.is_variable && self.timeline.time(frame).is_some_and(is_empty)
    }

    /// Compares an AVI with its index, as far as frames are asked for.
    fn compare_places(&mut self, seek: Option<f64>) -> Result<(), VideoError> {
        if self.info.container != AVI {
            return Ok(());
        }
        // A tick is a place, and what is shown later may be decoded before.
        let place = |frame: u64| self.timeline.time(frame).and_then(|time| u64::try_from(time).ok());
        let last = self.options.frames.as_ref().and_then(|range| place(*range.end()));
        let count = last.map_or(u64::MAX, |last| last.saturating_add(DELAY));
        let count = if self.looks_again { count } else { 0 };
        self.places = Places::compared(&self.info.path, self.info.stream, count);
        self.is_behind_resized = place(self.expected).is_some_and(|first| self.places.is_resized_before(first));
        self.tell_of_uncounted(seek)
    }

    /// Tells of frames behind a place of an AVI that ffmpeg does not count, where it begins to read before that place.
    fn tell_of_uncounted(&mut self, seek: Option<f64>) -> Result<(), VideoError> {
        /// Seconds that ffmpeg seeks farther back for codecs that keep frames back (3/23, `fftools/ffmpeg_opt.c`), and more.
        const BACK: f64 = 0.2;
        let ticks = |seek: f64| (seek + self.info.file_start - BACK) / self.info.time_base.to_f64();
        let from = seek.map_or(0, |seek| ticks(seek) as i64);
        let Some(Uncounted { place, byte }) = self.places.take_uncounted_from(from) else { return Ok(()) };
        let frame = self.timeline.frame(place).max(self.first_asked());
        let end = self.looked().last().map_or(frame, |last| last.max(frame)) + 1;
        if !self.options.looks_at_any(&(frame..end)) {
            return Ok(());
        }
        let reason = format!(
            "the file's index tells of a frame at byte {byte}, where none begins; those behind it come too early"
        );
        self.note(Fault { frame, count: end.min(self.end_of_range()) - frame, reason, is_given: true })
    }

    /// Repeats the frame before, which is decoded once more if it is not there.
    fn repeat_before(&mut self, ahead: Option<Ahead>) -> Result<Option<VideoFrame>, VideoError> {
        if self.held.is_none() && self.looks_again {
            self.held = self.looked().shown_before(self.expected)?;
        }
        let Some(image) = self.held.clone() else {
            return match ahead {
                Some(ahead) => self.gap(ahead),
                None => self.gap_at_the_end(),
            };
        };
        self.ahead = ahead;
        Ok(Some(VideoFrame { condition: FrameCondition::Whole, ..self.hold(image) }))
    }

    /// Takes the reason for which a frame is missing or damaged: what was heard, or else what is usual.
    fn reason(&mut self, frame: u64, usual: &str) -> String {
        let heard = self.complaint.take().map(|complaint| complaint.text);
        if frame < self.info.early { EARLY.to_owned() } else { heard.unwrap_or_else(|| usual.to_owned()) }
    }

    /// Returns whether a frame belongs to a gap that was told already.
    fn is_told(&self, frame: u64) -> bool {
        let holds = |fault: &Fault| (fault.frame..fault.frame + fault.count).contains(&frame);
        self.faults.last().is_some_and(|fault| !fault.is_given && holds(fault))
    }

    fn first_asked(&self) -> u64 {
        self.options.frames.as_ref().map_or(0, |range| *range.start())
    }

    /// Returns the number behind the last frame that is asked for.
    fn end_of_range(&self) -> u64 {
        self.options.frames.as_ref().map_or(u64::MAX, |range| range.end().saturating_add(1))
    }

    /// Answers frames that are announced, but missing at the end.
    fn gap_at_the_end(&mut self) -> Result<Option<VideoFrame>, VideoError> {
        let (found, announced) = (self.expected, self.total.unwrap_or(0));
        let fewer = || VideoError::FewerFrames { path: self.info.path.clone(), found, announced };
        let can_go_on = match self.options.damaged {
            Damaged::Error => false,
            Damaged::Hold => self.held.is_some(),
            Damaged::Skip => found > 0,
        };
        let is_named = self.options.damaged == Damaged::Error && self.complaint.is_some() && self.info.cut.is_none();
        if !can_go_on && !is_named {
            return Err(fewer());
        }
        let is_shown = can_go_on && self.options.damaged == Damaged::Hold;
        let image = self.held.clone().filter(|_| is_shown);
        if image.is_none() {
            self.total = None;
        }
        if image.is_none() || !self.is_told(found) {
            let reason = self.reason(found, ENDS);
            let count = announced.min(self.end_of_range()) - found;
            self.tell(Fault { frame: found, count, reason, is_given: false })?;
        }
        Ok(image.map(|image| self.hold(image)))
    }

    fn hold(&mut self, image: EncodedImage) -> VideoFrame {
        let index = self.expected;
        self.expected += 1;
        self.last = self.time(index);
        VideoFrame { index, time: self.last, image, condition: FrameCondition::Held }
    }

    /// Returns the time of a frame that says none itself.
    fn time(&self, index: u64) -> i64 {
        let later = || self.last.saturating_add(self.info.rate.inverse().rescale(1, self.info.time_base).max(1));
        self.timeline.time(index).unwrap_or_else(later)
    }

    /// Notes a fault, or fails for it. Where nobody looks at its frames, those that take after them count.
    fn tell(&mut self, fault: Fault) -> Result<(), VideoError> {
        if self.options.looks_at_any(&(fault.frame..fault.frame.saturating_add(fault.count))) {
            self.note(fault)
        } else {
            self.look_ahead(fault.frame)
        }
    }

    /// Notes a fault, or fails for it, whoever looks at its frames.
    fn note(&mut self, fault: Fault) -> Result<(), VideoError> {
        let is_too_long = self.options.damaged == Damaged::Hold && !fault.is_given && fault.count > LONGEST_HOLD;
        if self.options.damaged == Damaged::Error || is_too_long {
            let Fault { frame, reason, .. } = fault;
            return Err(VideoError::DamagedFrame { path: self.info.path.clone(), frame, reason });
        }
        self.faults.push(fault);
        Ok(())
    }

    /// Finds at the end whether there should have been more frames, and whether all was well.
    fn ended(&mut self, ended: Ended) -> Result<(), VideoError> {
        self.decoder = None;
        let heard = ended.complaint.map(|text| Complaint { frame: self.expected, meant: 1, text });
        self.complaint = self.complaint.take().or(heard);
        let total = self.all_frames()?;
        if self.expected < total {
            self.total = Some(total);
            return Ok(());
        }
        let path = self.info.path.clone();
        let range = self.options.frames.as_ref();
        if let Some(asked) = range.map(|range| *range.end()).filter(|last| *last >= self.expected) {
            return Err(VideoError::NoSuchFrame { path, asked, last: self.expected.saturating_sub(1) });
        }
        if let Some(CutShort { expected, found }) = self.info.cut.filter(|_| self.options.damaged == Damaged::Error) {
            return Err(VideoError::Cut { path, expected, found, is_described: true });
        }
        let reason = match self.complaint.take() {
            Some(Complaint { frame, meant, text }) if self.expected > 0 => {
                // Where frames are counted, what is heard behind the last is about one of them.
                let frame = self.looked().sure_last().map_or(frame, |last| frame.min(last));
                let (count, is_given) = (meant.min(self.expected.saturating_sub(frame)).max(1), frame < self.expected);
                return self.tell(Fault { frame, count, reason: text, is_given });
            }
            Some(Complaint { text, .. }) => text,
            None if ended.is_success && self.expected > 0 => return Ok(()),
            None => "it gives no frame".to_owned(),
        };
        Err(VideoError::Decode { path, reason })
    }

    /// Returns the number of frames that the file should give.
    fn all_frames(&self) -> Result<u64, VideoError> {
        let announced = self.info.announced;
        let is_lacking = self.info.cut.is_some() && self.end_of_range() > self.expected;
        Ok(match (self.timeline.frames(), announced) {
            (_, Some(Announced { frames, by: AnnouncedBy::Count })) if self.info.cut.is_some() => frames,
            (Some(frames), Some(told)) if self.info.container == AVI => frames.max(told.frames),
            (Some(frames), _) => frames,
            (None, Some(Announced { frames, by: AnnouncedBy::Count }))
                if self.expected < frames && ![AVI, GIF].contains(&self.info.container.as_str()) =>
            {
                // Some frames may be there for others alone, as where a video was cut without coding it anew.
                frames.min(self.ffmpeg.packet_times(&self.info)?.len() as u64)
            }
            (None, Some(Announced { frames, by: AnnouncedBy::Count })) => frames,
            // A duration may be rounded up, if nothing was said of damage.
            (None, Some(Announced { frames, by: AnnouncedBy::Duration }))
                if frames <= self.expected + 1 && self.complaint.is_none() && !is_lacking =>
            {
                self.expected
            }
            (None, Some(Announced { frames, by: AnnouncedBy::Duration })) => frames,
            (None, None) => self.expected,
        })
    }
}

/// Reason of a frame that lacks what it takes after.
const EARLY: &str = "it comes before the first key frame: the video was cut out between key frames";

/// Reason of a frame that is missing where nothing is said of it.
const ENDS: &str = "the video ends before it";
