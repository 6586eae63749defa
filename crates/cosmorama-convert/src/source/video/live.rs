//! Pictures of a stream whose bytes come once. A thread reads them, one behind the other, and no further than they are taken.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};

use cosmorama::raster::EncodedImage;
use cosmorama_io::{IoError, Limits};
use cosmorama_video::VideoError;

use super::raw::{Bytes, RawInfo, RawReader, foreign};
use super::read::Shared;
use super::{Coming, RawKind};

/// Pictures of a stream that is read as it comes.
#[derive(Debug)]
pub(super) struct Live {
    name: PathBuf,
    pictures: Receiver<Result<EncodedImage, VideoError>>,
    /// Pictures that have come, and are not taken yet.
    come: BTreeMap<u64, EncodedImage>,
    /// Number of the picture that comes next.
    next: u64,
    /// Picture that was asked for first. It is looked at before the work begins, and again by its first warnings.
    first: Option<(u64, Option<EncodedImage>)>,
    /// End of the stream, or the fault after which nothing comes.
    end: Option<End>,
}

/// End of a stream.
#[derive(Clone, Debug)]
enum End {
    Whole,
    Fault(Shared),
}

/// Pictures after the first asked for, when that is no longer kept, nor any before it.
const FORGOTTEN: u64 = 64;

impl Live {
    /// Begins to read a stream, and waits for its first picture, which tells what all are.
    pub(super) fn open(kind: RawKind, bytes: Bytes, name: &Path) -> Result<(Self, RawInfo), IoError> {
        let told = name.display().to_string();
        let mut reader = RawReader::open(kind, bytes, &told, Limits::default().memory).map_err(foreign)?;
        let (first, info) = reader.begin(kind, &told).map_err(foreign)?;
        // Nothing waits between the two threads, so that only as much is read ahead as the frames in flight ask for.
        let (sender, pictures) = sync_channel(0);
        std::thread::spawn(move || read_on(&mut reader, &told, &sender));
        let come = BTreeMap::from([(0, first)]);
        let live = Self { name: name.to_owned(), pictures, come, next: 1, first: None, end: None };
        Ok((live, info))
    }

    /// Tells whether a picture has come, and waits for it if that is wanted.
    pub(super) fn coming(&mut self, number: u64, may_wait: bool) -> Coming {
        while self.next <= number && self.end.is_none() {
            let picture = if may_wait {
                self.pictures.recv().map_err(|_| TryRecvError::Disconnected)
            } else {
                self.pictures.try_recv()
            };
            match picture {
                Ok(Ok(picture)) => {
                    // Those before it were not asked for.
                    if self.next == number {
                        self.come.insert(number, picture);
                    }
                    self.next += 1;
                }
                Ok(Err(fault)) => self.end = Some(End::Fault(Shared(Arc::new(fault)))),
                Err(TryRecvError::Empty) => return Coming::Later,
                Err(TryRecvError::Disconnected) => self.end = Some(End::Whole),
            }
        }
        match &self.end {
            Some(End::Whole) if self.next <= number => Coming::Never,
            // A fault is told to whoever takes the picture.
            _ => Coming::Here,
        }
    }

    /// Takes a picture; waits for it if it has not come.
    pub(super) fn take(&mut self, number: u64) -> Result<EncodedImage, IoError> {
        self.coming(number, true);
        let picture = self.come.remove(&number);
        let (first, kept) = self.first.get_or_insert_with(|| (number, picture.clone()));
        if *first + FORGOTTEN < number {
            *kept = None;
            self.come = self.come.split_off(first);
        }
        let again = || kept.clone().filter(|_| *first == number);
        picture.or_else(again).ok_or_else(|| self.without(number))
    }

    /// Returns the error about a picture that does not come.
    fn without(&self, asked: u64) -> IoError {
        match &self.end {
            Some(End::Fault(fault)) if asked >= self.next => IoError::Video(Box::new(fault.clone())),
            _ => {
                let last = self.next.saturating_sub(1);
                foreign(VideoError::NoSuchFrame { path: self.name.clone(), asked, last })
            }
        }
    }
}

/// Reads pictures until the stream ends, or nobody takes them.
fn read_on(reader: &mut RawReader, name: &str, pictures: &SyncSender<Result<EncodedImage, VideoError>>) {
    while let Some(picture) = reader.next_picture(name).transpose() {
        let is_last = picture.is_err();
        if pictures.send(picture).is_err() || is_last {
            break;
        }
    }
}
