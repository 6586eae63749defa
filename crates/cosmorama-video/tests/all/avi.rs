//! Places for frames in an AVI: empty ones, and those that are lost, of which its index tells.

use cosmorama_video::{Damaged, Fault, FrameCondition, ReadOptions, VideoError, VideoFrame, VideoReader};

use crate::common::{ffmpeg, frames, moving, of, run};
use crate::damage::{damage, packet, with};

/// An empty place in an AVI repeats the frame before. Its index tells whether there was one.
#[test]
fn a_frame_that_an_avi_lost_is_no_empty_place() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.avi");
    run(&format!("{} -f lavfi -i sine=duration=2 -c:v mjpeg -c:a libmp3lame", moving(64, 32, "25", 40)), &path);
    let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    assert!(whole.len() == 41 && whole[1].image == whole[0].image);
    let (place, _) = packet(&path, 20);
    let mut bytes = std::fs::read(&path).unwrap();
    assert_eq!(&bytes[place - 8..place - 4], b"00dc");
    bytes[place - 4..place].fill(0);
    std::fs::write(&path, bytes).unwrap();
    let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
    assert!(matches!(error, VideoError::DamagedFrame { frame: 21, .. }), "{error}");
    let held = frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap();
    assert!(held[21].condition == FrameCondition::Held && held[22..] == whole[22..]);
    // Without the index, nothing tells that a place is empty.
    let mut bytes = std::fs::read(&path).unwrap();
    let index = bytes.windows(4).rposition(|name| name == b"idx1").unwrap();
    bytes[index..index + 4].copy_from_slice(b"JUNK");
    std::fs::write(&path, bytes).unwrap();
    let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
    assert!(matches!(error, VideoError::DamagedFrame { frame: 1, .. }), "{error}");
}

/// ffmpeg counts the frames of an AVI: where the mark of one is destroyed, those behind it come too early. The index tells.
#[test]
fn frames_behind_a_destroyed_mark_of_an_avi_are_told() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.avi");
    run(&format!("{} -c:v mpeg4 -g 12 -bf 0", moving(64, 32, "25", 60)), &path);
    let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    let (place, _) = packet(&path, 30);
    let bytes = std::fs::read(&path).unwrap();
    let write = |at: usize, new: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + new.len()].copy_from_slice(new);
        std::fs::write(&path, bytes).unwrap();
    };
    for (at, new) in [(place - 8, &b"XXXX"[..]), (place - 4, &[0xff; 3])] {
        write(at, new);
        let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
        assert!(matches!(error, VideoError::DamagedFrame { frame: 30, .. }), "{error}");
        assert!(frames(&ffmpeg, &path, of(31, 35)).is_err());
        assert!(frames(&ffmpeg, &path, of(2, 29)).unwrap() == whole[2..30]);
        // By the index ffmpeg seeks to a key frame behind it, and counts from there.
        assert!(frames(&ffmpeg, &path, of(55, 59)).unwrap() == whole[55..60]);
        let info = ffmpeg.probe(&path).unwrap();
        let mut reader = VideoReader::open(&ffmpeg, &info, with(Damaged::Hold)).unwrap();
        let mut count = 0;
        while reader.next_frame().unwrap().is_some() {
            count += 1;
        }
        let [Fault { frame: 30, count: 30, is_given: true, .. }, Fault { frame: 59, count: 1, is_given: false, .. }] =
            reader.faults()
        else {
            panic!("{:?}", reader.faults())
        };
        assert_eq!(count, 60);
    }
    // A frame without a byte is passed over by decoders, and others take after it.
    write(place - 4, &[0; 4]);
    let error = frames(&ffmpeg, &path, of(31, 34)).unwrap_err();
    assert!(matches!(error, VideoError::DamagedFrame { frame: 30, .. }), "{error}");
    assert!(frames(&ffmpeg, &path, of(38, 40)).unwrap() == whole[38..=40]);
}

/// Where MPEG-4 lost all bytes of a frame, its decoder gives the one before once more in that place.
#[test]
fn no_frame_passes_for_one_that_lost_its_bytes() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.avi");
    run(&format!("{} -c:v mpeg4 -g 12 -bf 2", moving(64, 32, "25", 36)), &path);
    let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    for number in [4, 7, 16] {
        std::fs::write(&path, &bytes).unwrap();
        let (place, _) = packet(&path, number);
        let mut damaged = bytes.clone();
        damaged[place - 4..place].fill(0);
        std::fs::write(&path, damaged).unwrap();
        for frame in number as u64 - 2..number as u64 + 6 {
            if let Ok(part) = frames(&ffmpeg, &path, of(frame, frame)) {
                assert!(part == whole[frame as usize..=frame as usize], "place {number}: frame {frame}");
            }
        }
        let info = ffmpeg.probe(&path).unwrap();
        let mut reader = VideoReader::open(&ffmpeg, &info, with(Damaged::Hold)).unwrap();
        let mut held = Vec::new();
        while let Some(frame) = reader.next_frame().unwrap() {
            held.push(frame);
        }
        let damaged: Vec<_> = reader.faults().iter().map(|fault| fault.frame..fault.frame + fault.count).collect();
        let traces = ffmpeg.coded_order(&info).unwrap().unwrap().traces(&damaged);
        let is_passed =
            |frame: &&VideoFrame| frame.condition == FrameCondition::Whole && !traces.contains(&frame.index);
        for frame in held.iter().filter(is_passed) {
            assert!(frame.image == whole[frame.index as usize].image, "place {number}: frame {}", frame.index);
        }
        assert!(held.len() == whole.len() && held.iter().filter(is_passed).count() > 20, "place {number}");
    }
}

/// Two places at the end of an AVI are empty: what they repeat is whole, but not where another frame stands for a damaged one.
#[test]
fn empty_places_at_the_end_of_an_avi_repeat_its_last_frame() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.avi");
    run(&format!("{} -c:v mjpeg", moving(64, 32, "25", 40)), &path);
    let mut bytes = std::fs::read(&path).unwrap();
    let index = bytes.windows(4).rposition(|name| name == b"idx1").unwrap();
    for number in [38, 39] {
        let (place, _) = packet(&path, number);
        bytes[place - 4..place].fill(0);
        let entry = index + 8 + 16 * number;
        bytes[entry + 12..entry + 16].fill(0);
    }
    std::fs::write(&path, bytes).unwrap();
    let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    assert_eq!(whole.iter().map(|frame| frame.index).collect::<Vec<_>>(), (0..40).collect::<Vec<_>>());
    assert!(whole[38..].iter().all(|frame| frame.image == whole[37].image && frame.condition == FrameCondition::Whole));
    assert!(frames(&ffmpeg, &path, of(38, 39)).unwrap() == whole[38..]);
    damage(&path, 37);
    let held = frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap();
    assert_eq!(held.len(), 40);
    assert!(held[37..].iter().all(|frame| frame.condition == FrameCondition::Held), "{:?}", held[38].condition);
}
