use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use cosmorama::camera::CameraModel;
use cosmorama::layout::LensSide;

use super::alias::{ALIASES, refusal, tried, without_alias, without_colons};
use super::cube::Cube;
use super::fields::Fields;
use super::keys::Keys;
use super::projections::{KINDS, Key, Kind};
use super::shape::Shape;
use super::stereo::StereoSpec;
use crate::SpecError;
use crate::error::nearest;

/// The projection of a picture, parsed from `NAME[:key=value[,key=value]…]`.
///
/// ```
/// use cosmorama::camera::Mirror;
/// use cosmorama::layout::LayoutKind;
/// use cosmorama_spec::{Cube, Spec};
///
/// // Names of other programs are understood; values print in this one's words.
/// let spec: Spec = "c3x2:flip=x".parse()?;
/// assert_eq!(spec.to_string(), "cube:layout=3x2,flip=x");
///
/// // A value that a program made prints, too.
/// let spec = Spec::from(Cube { mirror: Mirror { x: false, y: true }, ..LayoutKind::CrossV.into() });
/// assert_eq!(spec.to_string(), "cube:layout=cross-v,flip=y");
/// # Ok::<(), cosmorama_spec::SpecError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// Name of the projection.
    pub name: &'static str,
    /// Pictures that the SPEC describes.
    pub shape: Shape,
    /// Division into the pictures of two eyes; `None` for one eye.
    pub stereo: Option<StereoSpec>,
    /// Files that the SPEC names.
    pub files: Vec<PathBuf>,
}

impl FromStr for Spec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        Self::parse_in(Path::new(""), text)
    }
}

impl Spec {
    /// Parses a SPEC; paths in it are relative to a folder.
    ///
    /// # Errors
    /// When the name is unknown, or a key or a value does not belong to it.
    pub fn parse_in(folder: &Path, text: &str) -> Result<Self, SpecError> {
        let text = without_alias(text);
        let (name, rest) = text.split_once(':').unwrap_or((&text, ""));
        if let Some(way) = refusal(name) {
            return Err(SpecError::NotOffered { name: name.to_owned(), way });
        }
        let kind = Kind::named(name).ok_or_else(|| unknown_name(name, rest))?;
        if let Some(instead) = without_colons(kind, rest) {
            let instead = Some(instead).filter(|spec| Self::parse_in(folder, spec).is_ok());
            return Err(SpecError::Colons { instead });
        }
        let pairs = pairs(kind, rest)?;
        for (index, (key, _)) in pairs.iter().enumerate() {
            check_key(kind, key)?;
            if pairs[..index].iter().any(|(earlier, _)| earlier == key) {
                return Err(SpecError::Twice { key: key.clone() });
            }
        }
        let fields = Fields::new(pairs, folder);
        let (shape, stereo) = ((kind.build)(&fields)?, StereoSpec::build(&fields)?);
        let mut files: Vec<PathBuf> = ["file", "calibration"].into_iter().filter_map(|key| fields.file(key)).collect();
        if let Shape::StMap(map) = &shape {
            files.extend(map.base_file().cloned());
        }
        Ok(Self { name: kind.name, shape, stereo, files })
    }
}

/// Makes the SPEC of a shape, with the shape's own name.
impl From<Shape> for Spec {
    fn from(shape: Shape) -> Self {
        let name = named(&shape).map_or("picture", |(kind, _)| kind.name);
        Self { name, shape, stereo: None, files: Vec::new() }
    }
}

/// Makes the SPEC of a cube.
impl From<Cube> for Spec {
    fn from(cube: Cube) -> Self {
        Shape::Cube(cube).into()
    }
}

/// Makes the SPEC of one image of a camera.
impl From<CameraModel> for Spec {
    fn from(frame: CameraModel) -> Self {
        Shape::Single(frame.into()).into()
    }
}

/// Prints the SPEC as users type it, without default values; the text parses to the same SPEC.
///
/// For a picture whose calibration or map has been read, it prints the file's path.
impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A fisheye that shows everything has two names: the one that was typed is kept.
        let own = Kind::named(self.name).and_then(|kind| Some((kind, (kind.write)(&self.shape)?)));
        let (name, keys) = match own.or_else(|| named(&self.shape)) {
            Some((kind, keys)) => (kind.name, keys),
            None => (self.name, self.read_from()),
        };
        let keys = self.shape.write_place(keys);
        let keys = match self.stereo {
            Some(stereo) => stereo.write(keys),
            None => keys,
        };
        if keys.is_empty() { f.write_str(name) } else { write!(f, "{name}:{keys}") }
    }
}

impl Spec {
    /// Returns the key for the file from which a picture's camera was read.
    fn read_from(&self) -> Keys {
        let key = if matches!(self.shape.camera(), Some(CameraModel::StMap(_))) { "file" } else { "calibration" };
        Keys::default().maybe(key, self.files.first().map(|file| file.display()))
    }
}

/// Finds the projection of a shape, and the keys that describe it.
fn named(shape: &Shape) -> Option<(&'static Kind, Keys)> {
    KINDS.iter().find_map(|kind| Some((kind, (kind.write)(shape)?)))
}

/// Returns the error for an unknown name, with suggestions: the SPEC of another program's word, a name followed by
/// something other than a colon, or a name with similar spelling.
fn unknown_name(name: &str, rest: &str) -> SpecError {
    let known: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
    let names: Vec<&str> = known.iter().copied().chain(ALIASES.iter().map(|(alias, _)| *alias)).collect();
    let digits = |letter: char| letter.is_ascii_digit();
    let numbered = [name.trim_end_matches(digits), name.trim_start_matches(digits)].into_iter();
    let mut numbered = numbered.map(|of| (of, name.trim_start_matches(of).trim_end_matches(of)));
    let with_keys = name.split_once([',', ';', ' ', '/', '=', '(', '-', '_']).filter(|(name, _)| names.contains(name));
    let with_keys = with_keys.or_else(|| numbered.find(|(of, number)| names.contains(of) && !number.is_empty()));
    let with_keys = with_keys.map(|(name, keys)| {
        let keys = keys.trim().trim_end_matches(')');
        let keys = [keys, rest].into_iter().filter(|keys| !keys.is_empty()).collect::<Vec<_>>().join(",");
        let spec = format!("{name}:{keys}");
        match spec.parse::<Spec>() {
            Ok(_) => vec![spec],
            Err(SpecError::NoValue { instead, .. }) => instead,
            Err(_) => Vec::new(),
        }
    });
    let meant = with_keys.filter(|specs| !specs.is_empty()).unwrap_or_else(|| {
        tried(name).map(str::to_owned).or_else(|| nearest(name, &names).map(str::to_owned)).into_iter().collect()
    });
    SpecError::UnknownName { name: name.to_owned(), meant, known }
}

/// Splits a SPEC into keys and values. A part without `=` continues the value before it: `faces=front,left`.
fn pairs(kind: &'static Kind, text: &str) -> Result<Vec<(String, String)>, SpecError> {
    let mut pairs: Vec<(String, String)> = Vec::new();
    for part in text.split(',').filter(|_| !text.is_empty()) {
        match (part.split_once('='), pairs.last_mut()) {
            (Some((key, value)), _) => pairs.push((spelled(key.trim()), value.trim().to_owned())),
            (None, Some((_, value))) => *value = format!("{value},{}", part.trim()),
            (None, None) => {
                return Err(SpecError::NoValue { part: part.to_owned(), instead: with_key(kind, part, text) });
            }
        }
    }
    Ok(pairs)
}

/// Returns the SPEC for a lone pair of angles, both fields of view or the axis of a theatre: `equirect:360x180`.
fn both_ways(kind: &'static Kind, part: &str, text: &str) -> Option<String> {
    let keys = match part.split_once('x') {
        _ if ["theatre", "theater"].contains(&part) => "axis=11".to_owned(),
        Some((width, height)) => {
            let names = ["hfov", "fov"];
            let across = names.into_iter().find(|name| kind.keys.iter().any(|key| key.name == *name))?;
            format!("{across}={width},vfov={height}")
        }
        None => return None,
    };
    let spec = format!("{}:{keys}{}", kind.name, &text[part.len()..]);
    spec.parse::<Spec>().is_ok().then_some(spec)
}

/// Returns the SPEC for a key without `=`: `fulldome:tilt`, whose value is still to be written, `fulldome:tilt20`.
fn after_its_key(kind: &'static Kind, part: &str, text: &str) -> Option<String> {
    let letters = part.trim_end_matches(|letter: char| !letter.is_alphabetic());
    let key = kind.all_keys().find(|key| key.name == letters)?;
    let value = part[letters.len()..].trim_start_matches([':', ' ', '-', '_']);
    let spec = |value: &str| format!("{}:{}={value}{}", kind.name, key.name, &text[part.len()..]);
    let is_value = !value.is_empty() && spec(value).parse::<Spec>().is_ok();
    Some(spec(if is_value { value } else { key.value }))
}

/// Most SPECs that are suggested for a lone value.
const SUGGESTED: usize = 2;

/// Returns SPECs in which a lone value, the first part of a text, has its key: `cube:layout=3x2` for `cube:3x2`.
///
/// Only SPECs that parse are suggested, the projection's own keys first. The lean of a dome comes before all others,
/// since it is what people usually write after a dome.
fn with_key(kind: &'static Kind, part: &str, text: &str) -> Vec<String> {
    let is_file = |key: &Key| ["FILE", "MAP"].contains(&key.value);
    let mut keys: Vec<&Key> = kind.all_keys().filter(|key| is_file(key) == part.contains('.')).collect();
    keys.sort_by_key(|key| !["tilt", "axis"].contains(&key.name));
    let (own, common): (Vec<&Key>, Vec<&Key>) = keys.into_iter().partition(|key| kind.keys.contains(key));
    let specs = |key: &&Key| {
        let words: Vec<&str> = key.value.split('|').filter(|word| *word != key.value).collect();
        let begun = words.iter().copied().filter(|word| word.starts_with(part));
        let meant: Vec<&str> = [part].into_iter().chain(begun).chain(nearest(part, &words)).collect();
        let spec = |word: &str| format!("{}:{}={word}{}", kind.name, key.name, &text[part.len()..]);
        let mut found: Vec<String> = meant.into_iter().map(spec).filter(|spec| spec.parse::<Spec>().is_ok()).collect();
        // If the value is right as it is, longer suggestions are not needed.
        let most = if found.first() == Some(&spec(part)) { 1 } else { found.len() };
        found.truncate(most);
        found.dedup();
        found
    };
    if let Some(spec) = both_ways(kind, part, text).or_else(|| after_its_key(kind, part, text)) {
        return vec![spec];
    }
    let of = |keys: &[&Key]| keys.iter().flat_map(specs).take(SUGGESTED).collect::<Vec<String>>();
    Some(of(&own)).filter(|found| !found.is_empty()).unwrap_or_else(|| of(&common))
}

/// Returns a key in this program's spelling; `centre` becomes `center`.
fn spelled(key: &str) -> String {
    match key.strip_suffix("centre") {
        Some(of) if of.is_empty() || of.ends_with('.') => format!("{of}center"),
        _ => key.to_owned(),
    }
}

fn check_key(kind: &'static Kind, typed: &str) -> Result<(), SpecError> {
    // canvas.FACE stands for a key for each face; the value's reader knows the faces. LENS.fov stands for a key for
    // each lens.
    let of_lens = LensSide::ALL.iter().find_map(|side| typed.strip_prefix(side.name())?.strip_prefix('.'));
    let generic = match of_lens {
        Some(key) => format!("LENS.{key}"),
        None if typed.starts_with("canvas.") => "canvas.FACE".to_owned(),
        None => typed.to_owned(),
    };
    if kind.all_keys().any(|key| key.name == generic) && !typed.starts_with("LENS.") {
        return Ok(());
    }
    if let Some(why) = kind.refusal(typed) {
        return Err(SpecError::Refused { name: kind.name, key: typed.to_owned(), why });
    }
    let known = kind.all_keys().map(|key| key.name).collect();
    Err(SpecError::UnknownKey { name: kind.name, key: typed.to_owned(), known })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{StMapBase, StMapSpec};

    fn refused(text: &str) -> String {
        text.parse::<Spec>().unwrap_err().to_string()
    }

    #[test]
    fn wrong_keys_and_names_are_answered_from_the_table() {
        let message = refused("fisheye:fvo=180");
        assert!(
            message.starts_with("unknown key 'fvo' for fisheye; did you mean 'fov'? It takes fov, lens"),
            "{message}"
        );
        assert!(refused("perspective:hfov=90").contains("did you mean 'fov'?"));
        assert!(refused("omnimx").contains("did you mean 'omnimax'?"));
        assert!(refused("globe").contains("there are cube, perspective, equirect, fisheye, stereographic"));
        assert!(refused("cube:aspect=2").starts_with("cube takes no aspect=: what it shows is given both ways"));
    }

    #[test]
    fn wrong_values_say_what_was_expected() {
        assert!(refused("fisheye:fov=wide").contains("fov=wide: expected an angle in degrees"));
        assert!(refused("fisheye:fov=10,fov=20").contains("fov= is given twice"));
        assert!(refused("fisheye:180").contains("'180' is no key=value; write fisheye:fov=180"));
        assert!(refused("fisheye:fit=tight").contains("short, long, width, height, diagonal"));
        assert!(refused("fisheye:fit=widht").contains("did you mean 'width'?"));
        assert!(refused("cube:naming=blendr").contains("one of words, cosmorama, bourke"));
        assert!(refused("cube:naming=cube2dom").contains("did you mean 'cube2dome'?"));
        assert!(refused("fisheye:center=3").contains("X:Y"));
        assert!(refused("fisheye:lens=ucm").contains("alpha, as in k=0.55"));
        assert!(refused("fisheye:lens=ucm,k=2").contains("k=2: alpha is 2; it must be from 0 to 1"));
        assert!(refused("fisheye:lens=ucm,k=0.5:1").contains("expected alpha"));
        assert!(refused("fisheye:k=1").contains("only measured lenses"));
        assert!(refused("fisheye:lens=polynomial,k=0:0.02").contains("k1 of the polynomial is 0.02"));
        assert!(refused("fisheye:lens=stereographic,sensor=36").contains("lens=polynomial"));
        assert!(refused("fisheye:focal=300,fit=width").contains("cannot both"));
        assert!(refused("fisheye:fit=width,radius=99").contains("fit= and radius= cannot both"));
        assert!(refused("omnimax:framing=fit,center=9:9").contains("framing= and center= cannot both"));
        assert!(refused("omnimax:radius=9,framing=circle").contains("framing= and radius= cannot both"));
        assert!(refused("mercator:lat=80,aspect=2").contains("aspect= and lat= cannot both"));
        assert!(refused("mirror-ball:distance=1").contains("more than 1, or inf"));
        assert!(refused("octahedral:kind=round").contains("equal-area, plain"));
        assert!(refused("pannini:d=-1").contains("0 or more"));
        assert!(refused("hammer:fov=90").contains("unknown key 'fov' for hammer"));
        assert!(refused("perspective:fov=90,dfov=100").contains("cannot both"));
        assert!(refused("cube:faces=front,top hat").contains("top hat"));
        assert!(refused("st-map:invert=yes").contains("st-map needs file="));
        assert!(refused("st-map:file=a.exr,base=perspective:fvo=60").contains("did you mean 'fov'"));
        assert!(refused("st-map:file=a.exr,base=cube").contains("base=cube: expected the SPEC of one picture"));
        assert!(refused("cube:canvas.nose=1x1+0+0").contains("nose"));
        assert!(refused("omnimax:canvas=10x10").contains("WxH+X+Y"));
        assert!(refused("equirect:canvas=10x10+9223372036854775807+0").contains("WxH+X+Y"));
        for aspect in ["0", "-1", "nan", "0.0001", "9223372036854775807"] {
            assert!(refused(&format!("stereographic:aspect={aspect}")).contains("from 0.001 to 1000"), "{aspect}");
        }
    }

    #[test]
    fn names_of_other_programs_are_understood_or_refused_by_name() {
        let spec = |text: &str| text.parse::<Spec>().unwrap();
        for (theirs, ours) in [
            ("e", "equirect"),
            ("hequirect:vfov=90", "equirect:hfov=180,vfov=90"),
            ("flat:fov=70", "perspective:fov=70"),
            ("sg", "stereographic"),
            ("ball", "fisheye:lens=equisolid,fov=360"),
            ("octahedron:yaw=3", "octahedral:kind=plain,yaw=3"),
        ] {
            assert_eq!(spec(theirs), spec(ours), "{theirs}");
        }
        let message = refused("tetrahedron");
        assert!(message.contains("'tetrahedron' of other programs is not on offer") && message.contains("v360=input="));
        let message = refused("biatan6:layout=3x2");
        assert!(message.contains("envutil") && message.contains("cube:layout=eac") && !message.contains("ffmpeg"));
        // Typed keys follow those of the SPEC that the name stands for.
        assert_eq!(spec("little-planet:pitch=-60"), spec("stereographic:pitch=-60"));
        assert_eq!(spec("dfisheye:fov=195"), spec("dual-fisheye:order=bf,fov=195"));
        assert_eq!(spec("he:stereo=sbs"), spec("equirect:hfov=180,stereo=sbs"));
        assert_eq!(spec("vr180"), spec("equirect:hfov=180,stereo=sbs"));
        assert_eq!(spec("gopro-max:yaw=3"), spec("cube:layout=eac,overlap=32,yaw=3"));
        assert_eq!(spec("insta360:fov=191.5"), spec("dual-fisheye:fov=191.5"));
        assert_eq!(spec("theta:fov=200"), spec("dual-fisheye:fov=200,front.roll=90,back.roll=-90"));
        assert!(refused("gopro").contains("did you mean 'gopro-max'?"), "{}", refused("gopro"));
        assert!(refused("cube:overlap=32").contains("layout=eac"));
        assert!(refused("cube:layout=3x2,overlap=32").contains("layout=eac"));
        assert!(refused("cube:layout=eac,overlap=31").contains("even number"));
        assert!(refused("cube:layout=eac,overlap=32,half=up").contains("half= and overlap= cannot both"));
        assert_eq!(spec("vr180:stereo=tb,eye=left"), spec("equirect:hfov=180,stereo=tb,eye=left"));
    }

    /// Every projection of `ffmpeg -h filter=v360`, in its order, with its SPEC here; `None` if it is refused by name.
    const V360: [(&str, Option<&str>); 33] = [
        ("e", Some("equirect")),
        ("equirect", Some("equirect")),
        ("c3x2", Some("cube:layout=3x2")),
        ("c6x1", Some("cube:layout=strip-h")),
        ("eac", Some("cube:layout=eac")),
        ("dfisheye", Some("dual-fisheye:order=bf,fov=180")),
        ("flat", Some("perspective")),
        ("rectilinear", Some("perspective")),
        ("gnomonic", Some("perspective")),
        ("barrel", None),
        ("fb", None),
        ("c1x6", Some("cube:layout=strip-v")),
        ("sg", Some("stereographic")),
        ("mercator", Some("mercator")),
        ("ball", Some("fisheye:lens=equisolid,fov=360")),
        ("hammer", Some("hammer")),
        ("sinusoidal", Some("sinusoidal")),
        ("fisheye", Some("fisheye")),
        ("pannini", Some("pannini")),
        ("cylindrical", Some("cylinder")),
        // ffmpeg's view of a globe from outside: the only one of its names that means something else here.
        ("perspective", Some("perspective")),
        ("tetrahedron", None),
        ("barrelsplit", None),
        ("tsp", None),
        ("hequirect", Some("equirect:hfov=180")),
        ("he", Some("equirect:hfov=180")),
        ("equisolid", Some("fisheye:lens=equisolid")),
        ("og", Some("fisheye:lens=orthographic")),
        ("octahedron", Some("octahedral:kind=plain")),
        ("cylindricalea", Some("equal-area")),
        // ffmpeg's documentation spells it so.
        ("stereographic", Some("stereographic")),
        ("orthographic", Some("fisheye:lens=orthographic")),
        ("equidistant", Some("fisheye")),
    ];

    #[test]
    fn every_projection_of_v360_is_understood_or_refused_by_name() {
        for (theirs, ours) in V360 {
            match (theirs.parse::<Spec>(), ours) {
                (Ok(found), Some(ours)) => assert_eq!(found.shape, ours.parse::<Spec>().unwrap().shape, "{theirs}"),
                (Err(error), None) => {
                    let message = error.to_string();
                    assert!(message.contains(&format!("'{theirs}'")) && message.contains("output=e"), "{message}");
                }
                (found, _) => panic!("{theirs} is {found:?}"),
            }
        }
    }

    #[test]
    fn names_and_keys_that_people_have_for_the_same() {
        let same = |theirs: &str, ours: &str| {
            assert_eq!(theirs.parse::<Spec>().unwrap(), ours.parse::<Spec>().unwrap(), "{theirs}");
        };
        for name in ["equirectangular", "latlong", "latlon", "panorama", "spherical"] {
            same(&format!("{name}:hfov=180"), "equirect:hfov=180");
        }
        for name in ["tinyplanet", "tiny-planet", "littleplanet", "little-planet"] {
            same(name, "stereographic:pitch=-90");
        }
        same("fisheye:centre=3:4,radius=9", "fisheye:center=3:4,radius=9");
        same("dual-fisheye:front.centre=3:4", "dual-fisheye:front.center=3:4");
        same("equirect:samples=centers", "equirect:samples=centres");
        same("cube:half=top", "cube:half=up");
        same("cube:faces=top,bottom", "cube:faces=up,down");
        same("cube:canvas.bottom=9x9+0+0", "cube:canvas.down=9x9+0+0");
        same("cube:layout=3x2,order=rltdfb", "cube:layout=3x2,order=rludfb");
        same("cube:layout=3x2,order=right,left,top,bottom,front,back", "cube:layout=3x2,order=rludfb");
        assert!(refused("fisheye:center=1:2,centre=3:4").contains("given twice"));
        assert!(refused("cube:order=right,left,top").contains("six letters"));
    }

    #[test]
    fn ffmpegs_colons_are_answered_by_what_to_write() {
        for (typed, written) in [
            ("flat:h_fov=90:v_fov=60", "perspective:fov=90,vfov=60"),
            ("e:ih_fov=180:iv_fov=90", "equirect:hfov=180,vfov=90"),
            ("fisheye:h_fov=190:v_fov=190:yaw=3", "fisheye:fov=190,yaw=3"),
            ("omnimax:center=3:4:radius=9", "omnimax:center=3:4,radius=9"),
        ] {
            assert_eq!(refused(typed), format!("keys are separated by commas here, not by colons; write {written}"));
        }
        assert!(refused("fulldome:tilt=a:fov=b").contains("as in fisheye:fov=220"));
        assert!(refused("flat:h_fov=90,v_fov=60").contains("unknown key 'h_fov' for perspective; did you mean 'fov'?"));
        assert!("fisheye:calibration=a:b=c.yml".parse::<Spec>().is_ok());
    }

    #[test]
    fn what_follows_a_name_without_a_colon() {
        for typed in ["fulldome,tilt=20", "fulldome tilt=20", "fulldome;tilt=20", "fulldome/tilt=20"] {
            let message = refused(typed);
            assert!(message.contains("did you mean 'fulldome:tilt=20'?"), "{message}");
        }
        assert!(refused("Fulldome").contains("did you mean 'fulldome'?"));
        assert!(refused("panarama").contains("did you mean 'panorama'?"));
    }

    #[test]
    fn a_lone_value_is_answered_by_the_keys_that_it_fits() {
        for (typed, written) in [
            ("cube:3x2", "cube:layout=3x2"),
            ("cube:cross", "cube:layout=cross-h or cube:layout=cross-v"),
            ("cube:3x2,order=rludfb", "cube:layout=3x2,order=rludfb"),
            ("cube:bourke", "cube:naming=bourke"),
            ("cube:front,left", "cube:faces=front,left"),
            ("fulldome:20", "fulldome:tilt=20 or fulldome:fov=20"),
            ("fulldome:200", "fulldome:fov=200"),
            ("omnimax:11", "omnimax:axis=11 or omnimax:lower=11"),
            ("fisheye:equisolid", "fisheye:lens=equisolid"),
            ("fisheye:cam.yml", "fisheye:calibration=cam.yml"),
            ("flat:60", "perspective:fov=60 or perspective:vfov=60"),
            ("equirect:sbs", "equirect:stereo=sbs"),
            ("st-map:warp.exr", "st-map:file=warp.exr"),
            ("equirect:360x90", "equirect:hfov=360,vfov=90"),
            ("perspective:90x60,yaw=3", "perspective:fov=90,vfov=60,yaw=3"),
            ("omnimax:theatre", "omnimax:axis=11"),
            ("fulldome:tilt20,fov=200", "fulldome:tilt=20,fov=200"),
            ("fulldome:fov", "fulldome:fov=DEGREES"),
        ] {
            let value = typed.split([':', ',']).nth(1).unwrap();
            assert_eq!(refused(typed), format!("'{value}' is no key=value; write {written}"));
        }
        assert!(refused("cube:nonsense").contains("as in fisheye:fov=220,fit=width"));
        assert!(refused("fulldome=20").contains("did you mean 'fulldome:tilt=20' or 'fulldome:fov=20'?"));
        for name in ["fisheye180", "180fisheye"] {
            assert!(refused(name).contains("did you mean 'fisheye:fov=180' or"), "{}", refused(name));
        }
        assert!(refused("cube-3x2").contains("did you mean 'cube:layout=3x2'?"));
        assert!(refused("fulldome(tilt=20)").contains("did you mean 'fulldome:tilt=20'?"));
    }

    #[test]
    fn words_for_the_same_thing_are_nearer_than_words_of_like_spelling() {
        for (typed, key) in [
            ("omnimax:tilt=11", "axis"),
            ("fulldome:axis=20", "tilt"),
            ("perspective:tilt=20", "pitch"),
            ("fulldome:mirror=x", "flip"),
            ("fisheye:angle=200", "fov"),
            ("equirect:fov=180", "hfov"),
        ] {
            assert!(refused(typed).contains(&format!("did you mean '{key}'?")), "{}", refused(typed));
        }
        for (typed, spec) in [("planet", "little-planet"), ("180", "he"), ("imax", "omnimax"), ("360", "equirect")] {
            assert!(refused(typed).contains(&format!("did you mean '{spec}'?")), "{}", refused(typed));
        }
    }

    #[test]
    fn what_belongs_to_a_lens_or_an_eye() {
        assert!("dual-fisheye:front.yaw=1,back.center=3:4,back.fov=190".parse::<Spec>().is_ok());
        assert!(refused("dual-fisheye:LENS.fov=3").contains("did you mean 'front.fov' or 'back.fov'?"));
        assert!(refused("dual-fisheye:left.yaw=3").contains("'front.yaw' or 'back.yaw'"));
        assert!(refused("dual-fisheye:front.center=3").contains("front.center=3: expected X:Y"));
        assert!(refused("fisheye:front.fov=3").contains("unknown key 'front.fov' for fisheye"));
        assert!(refused("fisheye:eye=left").contains("stereo= beside it"));
    }

    #[test]
    fn a_spec_within_a_spec_has_colons_for_commas() {
        let base = |text: &str| match text.parse::<Spec>().unwrap().shape {
            Shape::StMap(StMapSpec { base: Some(StMapBase::Single(single)), .. }) => Shape::Single(single),
            other => panic!("{other:?} is no st map"),
        };
        let same = |text: &str| text.parse::<Spec>().unwrap().shape;
        assert_eq!(base("st-map:file=a.exr,base=hammer"), same("hammer"));
        let typed = "st-map:file=a.exr,base=omnimax:center=983:921.5:radius=900,invert=yes";
        assert_eq!(base(typed), same("omnimax:center=983:921.5,radius=900"));
    }

    #[test]
    fn values_may_hold_colons_and_commas() {
        assert!("omnimax:center=983:921.5,radius=900".parse::<Spec>().is_ok());
        let Shape::Cube(cube) = "cube:faces=front,left,naming=bourke".parse::<Spec>().unwrap().shape else {
            panic!("a cube is a cube");
        };
        assert_eq!(cube.faces.len(), 2);
        assert_eq!(cube.naming.map(|naming| naming.name), Some("bourke"));
    }
}
