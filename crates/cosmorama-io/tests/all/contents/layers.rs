//! Channels beside a picture's, and files of several parts.

use std::io::Cursor;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Samples};
use cosmorama_io::{
    Choice, Header, IoError, LayeredImage, Limits, Plane, PlaneSamples, SampleKind, WriteOptions, open, probe_chosen,
    probe_from, read_chosen, read_from, read_layers, write_layers,
};
use half::f16;

/// Planes of every type with values that only that type holds, beside a picture named like a layer.
fn planes() -> Vec<Plane> {
    let plane = |name: &str, samples| Plane { name: name.to_owned(), samples };
    vec![
        plane("N.X", PlaneSamples::Half(vec![f16::from_f32(-0.333); 6])),
        plane("Z", PlaneSamples::Float((0..6).map(|k| 1e9 + k as f32 * 64.0).collect())),
        plane("id", PlaneSamples::Uint((0..6).map(|k| u32::MAX - k).collect())),
    ]
}

fn layered() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("layers.exr");
    let samples = Samples::Half((0..18).map(|k| f16::from_f32(k as f32)).collect());
    let image = EncodedImage::new(3, 2, Channels::Rgb, Depth::Half, samples).unwrap();
    let names = ["R", "G", "B"].map(|name| format!("beauty.{name}")).to_vec();
    let layered = LayeredImage { size: (3, 2), picture: Some(&image), names, planes: planes() };
    write_layers(&path, layered, &WriteOptions::default()).unwrap();
    std::fs::read(&path).unwrap()
}

fn probe(bytes: &[u8], choice: &Choice) -> Result<Header, IoError> {
    probe_chosen(Cursor::new(bytes), "in memory", choice)
}

fn channels(channels: &[&str]) -> Choice {
    Choice { channels: channels.iter().map(ToString::to_string).collect(), ..Choice::default() }
}

#[test]
fn names_types_and_values_come_back() {
    let bytes = layered();
    let header = probe(&bytes, &Choice::default()).unwrap();
    let layers = &header.metadata.layers;
    assert_eq!(layers.picture, ["beauty.R", "beauty.G", "beauty.B"]);
    let kinds: Vec<_> = layers.further.iter().map(|channel| (channel.name.as_str(), channel.kind)).collect();
    assert_eq!(kinds, [("N.X", SampleKind::Half), ("Z", SampleKind::Float), ("id", SampleKind::Uint)]);
    let names = ["N.X", "Z", "id"];
    let limits = Limits::default();
    let read = read_layers(Cursor::new(&bytes), "in memory", &limits, (&Choice::default(), &names)).unwrap();
    assert_eq!(read, planes());
    let one = read_layers(Cursor::new(&bytes), "in memory", &limits, (&Choice::default(), &["id"])).unwrap();
    assert_eq!(one, planes()[2..]);
    let little = read_layers(Cursor::new(&bytes), "in memory", &Limits::memory(50), (&Choice::default(), &names));
    assert!(matches!(little, Err(IoError::TooLarge { .. })), "memory is checked first");
    let picture = read_from(Cursor::new(&bytes), "in memory", &limits).unwrap();
    assert_eq!((picture.image.channels(), picture.image.depth()), (Channels::Rgb, Depth::Half));
}

#[test]
fn a_choice_leaves_what_it_names() {
    let bytes = layered();
    let told = |choice: &Choice| probe(&bytes, choice).unwrap_err().to_string();
    assert!(told(&channels(&["zz"])).contains("no channel is called zz; there are N.X, Z, beauty.B"));
    assert!(told(&channels(&["beauty.*", "beauty.R"])).contains("beauty.R is named twice"));
    assert!(told(&channels(&["N.X", "Z"])).contains("holds the channels"), "no picture is left");

    let only = probe(&bytes, &channels(&["beauty.*", "Z"])).unwrap().metadata.layers;
    assert_eq!((only.picture.len(), only.further.len()), (3, 1));
    let data = Choice { without_picture: true, ..channels(&["N.X", "id"]) };
    let header = probe(&bytes, &data).unwrap();
    assert_eq!((header.channels, header.depth), (Channels::Grey, Depth::Half));
    assert!(header.metadata.layers.no_picture.is_some() && header.metadata.layers.further.len() == 2);
    let number = Choice { without_picture: true, ..channels(&["id"]) };
    let file = read_chosen(Cursor::new(&bytes), "in memory", (&Limits::default(), &FramePool::default()), &number);
    assert_eq!(file.err().map(|error| error.to_string()), None);
}

/// A file of two parts with a picture each, of which the second has a depth.
fn parts() -> Vec<u8> {
    use exr::prelude::*;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("parts.exr");
    let channel = |name: &str, value: f32| AnyChannel::new(name, FlatSamples::F32(vec![value; 8]));
    let layer = |name: &str, channels: &[(&str, f32)]| {
        let list = channels.iter().map(|(name, value)| channel(name, *value)).collect();
        Layer::new((4, 2), LayerAttributes::named(name), Encoding::UNCOMPRESSED, AnyChannels::sort(list))
    };
    let left = layer("left", &[("R", 0.5), ("G", 0.25), ("B", 1.0)]);
    let right = layer("right", &[("R", 5.0), ("G", 0.25), ("B", 1.0), ("Z", 7.0)]);
    let image = Image::from_layers(ImageAttributes::new(IntegerBounds::from_dimensions((4, 2))), vec![left, right]);
    image.write().to_file(&path).unwrap();
    std::fs::read(&path).unwrap()
}

#[test]
fn parts_are_chosen_by_number_or_name_and_the_first_is_usual() {
    let bytes = parts();
    let header = probe_from(Cursor::new(&bytes), "in memory").unwrap();
    let layers = header.metadata.layers;
    assert_eq!((layers.part, layers.parts.len(), layers.further.len()), (0, 2, 0));
    assert_eq!(layers.parts[1].label(1), "1 (right)");
    let part = |name: &str| Choice { part: Some(name.to_owned()), ..Choice::default() };
    for (name, expected) in [("0", 0.5), ("left", 0.5), ("1", 5.0), ("right", 5.0)] {
        let pool = FramePool::default();
        let file = read_chosen(Cursor::new(&bytes), "in memory", (&Limits::default(), &pool), &part(name)).unwrap();
        assert_eq!(file.to_light().get(0, 0).0[0], expected, "{name}");
    }
    let error = probe(&bytes, &part("2")).unwrap_err().to_string();
    assert!(error.contains("no part is called 2; there are 0 (left), 1 (right)"), "{error}");
    // A channel that only one part has says which.
    let choice = channels(&["R", "G", "B", "Z"]);
    assert_eq!(probe(&bytes, &choice).unwrap().metadata.layers.part, 1);
    let planes = read_layers(Cursor::new(&bytes), "in memory", &Limits::default(), (&choice, &["Z"])).unwrap();
    assert_eq!(planes[0].samples, PlaneSamples::Float(vec![7.0; 8]));
}

#[test]
fn files_of_other_formats_have_no_named_channels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("red.png");
    let image = EncodedImage::new(1, 1, Channels::Rgb, Depth::Eight, Samples::U8(vec![255, 0, 0])).unwrap();
    cosmorama_io::write(&path, &image, &WriteOptions::default()).unwrap();
    let read = read_layers(open(&path).unwrap(), &path, &Limits::default(), (&Choice::default(), &["Z"]));
    assert!(matches!(read, Err(IoError::NoSuchChannel { .. })));
    let layered = LayeredImage { size: (1, 1), picture: Some(&image), names: Vec::new(), planes: Vec::new() };
    let written = write_layers(folder.path().join("more.png"), layered, &WriteOptions::default());
    assert!(matches!(written, Err(IoError::CannotHold { .. })));
}
