//! What is printed is parsed again to the same value: of every projection, with every key that help lists.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

use std::fmt::{Debug, Display};
use std::str::FromStr;

use cosmorama_spec::{
    Colour, DepthName, FilterName, FrameRanges, KernelName, MemorySize, Missing, Size, Spec, SpecKind, TransferName,
};
use proptest::prelude::*;
use proptest::sample::select;

/// A projection with the keys that it takes, and what help says of their values.
#[derive(Clone, Debug)]
struct Kind {
    name: String,
    keys: Vec<(String, String)>,
}

/// Every projection with the keys that help lists.
fn kinds() -> Vec<Kind> {
    let with_keys = |kind: SpecKind| {
        // What says which eye goes with stereo=.
        let has_eyes = kind.key("stereo").is_some();
        let common = kind.common_keys().filter(|key| has_eyes || !matches!(key.name, "swap" | "eye"));
        let keys = kind.own_keys().iter().chain(common).map(|key| (key.name.to_owned(), key.value.to_owned()));
        Kind { name: kind.name().to_owned(), keys: keys.collect() }
    };
    let kinds: Vec<Kind> = SpecKind::all().map(with_keys).collect();
    assert!(kinds.len() >= 20 && kinds.iter().all(|kind| kind.keys.len() > 3));
    kinds
}

fn one_of(values: &'static [&'static str]) -> BoxedStrategy<String> {
    select(values).prop_map(str::to_owned).boxed()
}

/// Thousandths, as people type them, and numbers to the last bit.
fn number(range: std::ops::Range<f64>) -> BoxedStrategy<String> {
    let typed = range.clone().prop_map(|number| format!("{:.3}", number)).boxed();
    prop_oneof![typed, range.prop_map(|number| number.to_string())].boxed()
}

/// Angles of an orientation come back from three by three numbers: of few digits to the last bit.
fn turn(range: std::ops::Range<i32>) -> BoxedStrategy<String> {
    range.prop_map(|hundredths| (f64::from(hundredths) / 100.0).to_string()).boxed()
}

/// Values of a key; `key` is what help calls it, `like` what it says of its values.
fn values(kind: &str, key: &str, like: &str) -> BoxedStrategy<String> {
    match (kind, key, like) {
        (_, "yaw" | "roll" | "LENS.yaw" | "LENS.roll", _) => turn(-36000..36000),
        (_, "pitch" | "LENS.pitch", _) => turn(-8999..8999),
        (_, "feather", _) => number(0.001..180.0),
        (_, "overlap", _) => (1..2048_usize).prop_map(|half| (2 * half).to_string()).boxed(),
        ("cube", "fov", _) => number(90.001..170.0),
        ("hugin", "lens", _) => one_of(&["rectilinear", "fisheye", "orthographic", "stereographic", "equisolid"]),
        (_, "lens", _) => one_of(&[
            "equidistant",
            "equisolid",
            "stereographic",
            "orthographic",
            "polynomial,k=0:-0.02:0.0001",
            "kannala-brandt,k=-0.01:0.002",
            "ocam,k=-250:0:0.002",
            "ucm,k=0.55",
            "eucm,k=0.6:1.1",
            "double-sphere,k=-0.18:0.59",
            "fov,k=0.95",
        ]),
        (_, _, "A:B:C…") => number(0.01..0.99).prop_map(|alpha| format!("{alpha},lens=ucm")).boxed(),
        (_, "axis" | "tilt", "DEGREES") => number(-90.0..90.0),
        (_, _, "DEGREES") => number(0.001..360.0),
        (_, _, "DEGREES|none") => prop_oneof![number(0.001..90.0), Just("none".to_owned())].boxed(),
        (_, "sensor", _) => number(1.0..60.0).prop_map(|width| format!("{width},lens=polynomial,k=0:-0.02")).boxed(),
        (_, _, "PIXELS") => number(0.5..5000.0),
        (_, _, "X:Y") => (number(-9.0..5000.0), number(-9.0..5000.0)).prop_map(|(x, y)| format!("{x}:{y}")).boxed(),
        (_, _, "RADII|inf") => prop_oneof![number(1.001..90.0), Just("inf".to_owned())].boxed(),
        (_, "aspect" | "d", _) => number(0.1..9.0),
        ("hugin", "a" | "b" | "c" | "e", _) => number(-0.5..0.5),
        (_, _, "FILE" | "MAP") => one_of(&["camera.yml", "folder/map.exr", "/absolute name.json"]),
        (_, "order", "rludfb|PRESET") => one_of(&["rludfb", "ffmpeg", "openexr", "lux", "udlrfb"]),
        (_, "rotate", _) => "[0-3]{6}".boxed(),
        (_, "naming", _) => one_of(&["words", "cosmorama", "v360", "px", "envutil"]),
        (_, "faces", _) => one_of(&["front,left", "up", "front,right,back,left,up,down", "down+up"]),
        (_, _, "WxH+X+Y") => (1..9999usize, 1..9999usize, -999..999i64, -999..999i64)
            .prop_map(|(width, height, left, top)| format!("{width}x{height}{left:+}{top:+}"))
            .boxed(),
        (_, "base", _) => one_of(&[
            "hammer",
            "perspective:fov=60.5:yaw=9",
            "omnimax:center=983:921.5:radius=900",
            "fisheye:calibration=camera.json:fov=150",
        ]),
        (_, _, words) if words.contains('|') => select(words.split('|').map(str::to_owned).collect::<Vec<_>>()).boxed(),
        _ => panic!("{kind}:{key}={like}: the test has no such values yet"),
    }
}

/// Keys of a lens or a face stand for several.
fn typed_key(key: &str) -> BoxedStrategy<String> {
    let each =
        |of: &'static [&'static str], rest: String| select(of).prop_map(move |name| format!("{name}{rest}")).boxed();
    match (key.strip_prefix("LENS"), key.strip_suffix("FACE")) {
        (Some(rest), _) => each(&["front", "back"], rest.to_owned()),
        (_, Some(_)) => each(&["canvas.front", "canvas.up"], String::new()),
        _ => Just(key.to_owned()).boxed(),
    }
}

/// Keys without which another means nothing.
fn beside(kind: &str, key: &str) -> &'static str {
    match (kind, key) {
        ("st-map", key) if key != "file" => "file=a.exr,",
        (_, "swap" | "eye") => "stereo=tb-half,",
        ("cube", "feather") => "fov=100,",
        ("cube", "overlap") => "layout=eac,",
        _ => "",
    }
}

/// A SPEC of a projection with some of its keys.
fn spec_of(kind: &Kind) -> BoxedStrategy<String> {
    let pair = |kind: String, (key, like): (String, String)| {
        (typed_key(&key), values(&kind, &key, &like)).prop_map(|(key, value)| format!("{key}={value}"))
    };
    let name = kind.name.clone();
    proptest::sample::subsequence(kind.keys.clone(), 0..=kind.keys.len().min(4))
        .prop_flat_map(move |keys| keys.into_iter().map(|key| pair(name.clone(), key)).collect::<Vec<_>>())
        .prop_map({
            let name = kind.name.clone();
            move |pairs| format!("{name}:{}", pairs.join(","))
        })
        .boxed()
}

fn any_spec() -> impl Strategy<Value = String> {
    select(kinds()).prop_flat_map(|kind| spec_of(&kind))
}

/// A projection with one of its keys, and what that needs.
fn any_key() -> impl Strategy<Value = String> {
    let each = |kind: Kind| kind.keys.clone().into_iter().map(move |(key, like)| (kind.name.clone(), key, like));
    select(kinds().into_iter().flat_map(each).collect::<Vec<_>>()).prop_flat_map(|(kind, key, like)| {
        let beside = beside(&kind, &key);
        (typed_key(&key), values(&kind, &key, &like))
            .prop_map(move |(key, value)| format!("{kind}:{beside}{key}={value}"))
    })
}

/// A value, and the value of what it prints.
fn there_and_back<T: FromStr + Display>(text: &str) -> (T, T)
where
    T::Err: Debug,
{
    let value: T = text.parse().unwrap_or_else(|error| panic!("{text}: {error:?}"));
    let printed = value.to_string();
    let back = printed.parse().unwrap_or_else(|error| panic!("{text} prints {printed}: {error:?}"));
    (value, back)
}

fn comes_back<T: FromStr + Display + Debug + PartialEq>(text: &str)
where
    T::Err: Debug,
{
    let (value, back) = there_and_back::<T>(text);
    assert_eq!(back, value, "{text} prints {value}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2048) })]

    #[test]
    fn every_key_of_every_projection_is_printed(text in any_key()) {
        let (spec, back) = there_and_back::<Spec>(&text);
        prop_assert_eq!(&back, &spec, "{} prints {}", text, spec);
    }

    #[test]
    fn keys_together_are_printed(text in any_spec()) {
        // Some exclude one another, or need a third.
        if text.parse::<Spec>().is_ok() {
            let (spec, back) = there_and_back::<Spec>(&text);
            prop_assert_eq!(&back, &spec, "{} prints {}", text, spec);
        }
    }

    #[test]
    fn other_values_are_printed(
        numbers in any::<[u16; 4]>(), part in 0.001f64..100.0, bytes in 1u64..1 << 50, light in any::<[f32; 3]>(), alpha in 0.01f32..1.0,
    ) {
        let [a, b, c, d] = numbers.map(|number| usize::from(number) + 1);
        comes_back::<Size>(&format!("{a}x{b}"));
        comes_back::<Size>(&format!("{a}"));
        comes_back::<MemorySize>(&format!("{part}%"));
        comes_back::<MemorySize>(&format!("{}%", (part * 100.0).ceil() / 100.0));
        comes_back::<MemorySize>(&format!("{bytes}"));
        comes_back::<FilterName>(&format!("reference:samples={}", 1 + a % 64));
        comes_back::<TransferName>(&format!("gamma:{}", 0.1 + part * 0.09));
        comes_back::<KernelName>(&format!("gaussian:alpha={},cutoff={}", part.min(32.0), 1.0 + part / 100.0));
        comes_back::<KernelName>(&format!("lanczos3-sharp:scale={},floor={}", part.min(32.0), part / 9.0));
        let [red, green, blue] = light.map(|light| if light.is_finite() { light.abs() } else { 0.5 });
        comes_back::<Colour>(&format!("{red},{green},{blue}"));
        let [red, green, blue] = [red, green, blue].map(|light| light % 9.0);
        comes_back::<Missing>(&format!("{red},{green},{blue},{alpha}"));
        comes_back::<Colour>(&format!("#{:02x}{:02x}{:02x}{:02x}", a % 256, b % 256, c % 256, d % 256));
        comes_back::<FrameRanges>(&format!("{a},{b}-{},{c}-{}:{d}", a + b, c + d));
    }
}

#[test]
fn values_with_names_print_them() {
    for name in
        "adaptive gaussian mitchell robidoux robidoux-sharp catmull-rom lanczos2 lanczos3 lanczos3-sharp tent box light"
            .split(' ')
    {
        assert_eq!(name.parse::<KernelName>().unwrap().to_string(), name);
        comes_back::<KernelName>(&format!("{name}:floor=2.5"));
    }
    for name in ["ewa", "ewa-pyramid", "point", "bilinear", "reference"] {
        assert_eq!(name.parse::<FilterName>().unwrap().to_string(), name);
    }
    for name in ["auto", "srgb", "linear", "bt1886", "pq", "hlg", "gamma:2.2"] {
        assert_eq!(name.parse::<TransferName>().unwrap().to_string(), name);
    }
    for name in ["error", "transparent", "0,0,0"] {
        assert_eq!(name.parse::<Missing>().unwrap().to_string(), name);
    }
    DepthName::ALL.into_iter().for_each(|depth| assert_eq!(depth.to_string().parse(), Ok(depth)));
    assert_eq!("07%".parse::<MemorySize>().unwrap().to_string(), "7%");
}

#[test]
fn specs_print_as_they_are_typed() {
    for text in [
        "fisheye:fov=220,fit=width",
        "perspective:fov=60,yaw=30,pitch=-10",
        "omnimax",
        "fulldome:tilt=20",
        "equirect:hfov=180",
        "cube:layout=3x2,order=openexr",
        "cube:naming=bourke,faces=front,left,right,up",
        "dual-fisheye:fov=180,order=bf",
        "fisheye:lens=ucm,k=0.55",
        "angular-map:radius=512",
        "stereographic:pitch=-90",
        "octahedral:pitch=90",
        "perspective:calibration=camera.yml",
        "st-map:file=undistort.exr,base=perspective:fov=60:yaw=9",
        "equirect:canvas=8192x4096+1024+0,stereo=tb",
        "omnimax:center=983:921.5,radius=900",
    ] {
        assert_eq!(text.parse::<Spec>().unwrap().to_string(), text);
    }
}
