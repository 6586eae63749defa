use std::collections::BTreeMap;

use cosmorama_spec::Size;

use super::frame::{Found, Frame, Picture};
use crate::source::video::FrameDamage;

/// Faults of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults {
    /// Number of the frame.
    pub frame: u64,
    /// List of its faults.
    pub faults: Vec<Fault>,
}

/// A fault of a frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// There is no file.
    Missing,
    /// The file is no whole picture; the reason in words.
    Damaged(String),
    /// The picture has another size than it should have, or than most have.
    Size {
        /// Its columns and rows.
        found: (usize, usize),
        /// Columns and rows that it should have.
        expected: Size,
    },
    /// The picture has other channels or another depth than most; what it has, in words.
    Kind(String),
    /// The file says that it was made by other settings than most, or says nothing where most do.
    Settings,
    /// The file says that it was made of another frame of a film, in the place of a damaged one.
    Held,
    /// The file says that it was made of a frame of a film that takes after a damaged one, and may show traces of it.
    Traces,
    /// No colour differs from black.
    Black,
    /// All samples equal those of the frame before.
    Frozen,
    /// It differs from both neighbours far more than they do from each other.
    Flash,
}

impl Fault {
    /// Returns the fault's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::Damaged(_) => "damaged",
            Self::Size { .. } => "size",
            Self::Kind(_) => "kind",
            Self::Settings => "settings",
            Self::Held => "held",
            Self::Traces => "traces",
            Self::Black => "black",
            Self::Frozen => "frozen",
            Self::Flash => "flash",
        }
    }
}

/// Least root of the mean square, in parts of full scale, by which a flash differs from its neighbours.
const FLASH: f64 = 0.03;

/// Number of times as far as its neighbours are from each other that a flash is from either.
const TIMES: f64 = 3.0;

/// Judges frames in the order of their numbers. `size` is what they should have, if it is known.
pub(super) fn faults(frames: &[Frame], size: Option<Size>) -> Vec<Faults> {
    let usual = || most(frames.iter().filter_map(|frame| Some(frame.picture()?.size)));
    let size = size.or_else(|| usual().map(|(width, height)| Size { width, height: Some(height) }));
    let kind = most(frames.iter().filter_map(|frame| Some(frame.picture()?.kind.as_str())));
    let settings = UsualSettings::of(frames);
    let judged = frames.iter().enumerate().map(|(at, frame)| {
        let neighbour = |offset: isize| {
            let other = frames.get(at.checked_add_signed(offset)?)?;
            (frame.number.checked_add_signed(offset as i64) == Some(other.number)).then(|| other.picture()).flatten()
        };
        let faults = match &frame.found {
            Found::Nothing => vec![Fault::Missing],
            Found::Damage(reason) => vec![Fault::Damaged(reason.clone())],
            Found::Picture(picture) => of_picture(picture, (size, kind, &settings), [neighbour(-1), neighbour(1)]),
        };
        Faults { frame: frame.number, faults }
    });
    judged.filter(|judged| !judged.faults.is_empty()).collect()
}

/// Settings by which most frames were made.
struct UsualSettings<'a> {
    /// Settings that the most frames tell, if any do.
    usual: Option<&'a str>,
    /// Whether most frames tell theirs: one that does not was made otherwise, or its words are damaged.
    are_told: bool,
}

impl<'a> UsualSettings<'a> {
    fn of(frames: &'a [Frame]) -> Self {
        let pictures = || frames.iter().filter_map(Frame::picture);
        let told = || pictures().filter_map(|picture| picture.settings.as_deref());
        Self { usual: most(told()), are_told: 2 * told().count() > pictures().count() }
    }

    fn differ_from(&self, picture: &Picture) -> bool {
        match picture.settings.as_deref() {
            Some(own) => self.usual.is_some_and(|usual| usual != own),
            None => self.are_told,
        }
    }
}

fn of_picture(
    picture: &Picture,
    (size, kind, settings): (Option<Size>, Option<&str>, &UsualSettings),
    [before, after]: [Option<&Picture>; 2],
) -> Vec<Fault> {
    let (width, height) = picture.size;
    let of_size = size.filter(|size| size.width != width || size.height.is_some_and(|rows| rows != height));
    let of_kind = kind.filter(|kind| *kind != picture.kind);
    let is_frozen = !picture.is_black && before.is_some_and(|before| before.equals(picture));
    let is_flash = before.zip(after).is_some_and(|(before, after)| {
        let nearest = distance_squared(picture, before).min(distance_squared(picture, after));
        nearest > (FLASH * FLASH).max(TIMES * TIMES * distance_squared(before, after))
    });
    [
        of_size.map(|expected| Fault::Size { found: picture.size, expected }),
        of_kind.map(|_| Fault::Kind(picture.kind.clone())),
        settings.differ_from(picture).then_some(Fault::Settings),
        picture.damage.map(|damage| match damage {
            FrameDamage::Held => Fault::Held,
            FrameDamage::Traces => Fault::Traces,
        }),
        picture.is_black.then_some(Fault::Black),
        is_frozen.then_some(Fault::Frozen),
        is_flash.then_some(Fault::Flash),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Returns the mean square of two pictures' difference, in parts of full scale.
fn distance_squared(one: &Picture, other: &Picture) -> f64 {
    let pairs = one.cells.as_flattened().iter().zip(other.cells.as_flattened());
    let squares: f64 = pairs.map(|(a, b)| ((f64::from(*a) - f64::from(*b)) / 255.0).powi(2)).sum();
    squares / (3 * one.cells.len()).max(1) as f64
}

/// Returns the value that most have; of several, the least.
fn most<T: Ord + Copy>(values: impl Iterator<Item = T>) -> Option<T> {
    let mut counts: BTreeMap<T, usize> = BTreeMap::new();
    values.for_each(|value| *counts.entry(value).or_default() += 1);
    counts.into_iter().rev().max_by_key(|(_, count)| *count).map(|(value, _)| value)
}

#[cfg(test)]
mod tests {
    use super::super::frame::CELLS;
    use super::*;

    /// Makes a picture of one grey.
    fn grey(code: u8) -> Picture {
        Picture {
            size: (8, 4),
            kind: "RGB, depth 8".to_owned(),
            settings: None,
            damage: None,
            hash: code.into(),
            is_black: code == 0,
            cells: vec![[code; 3]; CELLS * CELLS],
        }
    }

    fn judged(pictures: impl IntoIterator<Item = Option<Picture>>) -> Vec<(u64, Vec<&'static str>)> {
        let found = |picture: Option<Picture>| picture.map_or(Found::Nothing, Found::Picture);
        let frames =
            (1..).zip(pictures).map(|(number, picture)| Frame { number, found: found(picture), thumbnail: None });
        let faults = faults(&frames.collect::<Vec<_>>(), None).into_iter();
        faults.map(|of| (of.frame, of.faults.iter().map(Fault::name).collect())).collect()
    }

    #[test]
    fn each_fault_is_told_of_its_frame() {
        let made_by = |settings: &str, code: u8| Some(Picture { settings: Some(settings.to_owned()), ..grey(code) });
        let (wide, deep) =
            (Picture { size: (9, 4), ..grey(21) }, Picture { kind: "RGB, depth 16".to_owned(), ..grey(22) });
        let pictures =
            [made_by("a", 20), None, Some(wide), Some(deep), Some(grey(23)), Some(grey(23)), made_by("a", 24)];
        let hurt = |damage: FrameDamage, code: u8| Some(Picture { damage: Some(damage), ..grey(code) });
        let rest = [made_by("b", 25), Some(grey(0)), Some(grey(0)), Some(grey(26)), Some(grey(200)), Some(grey(27))];
        let last = [hurt(FrameDamage::Traces, 28), hurt(FrameDamage::Held, 28)];
        let expected = [
            (2, vec!["missing"]),
            (3, vec!["size"]),
            (4, vec!["kind"]),
            (6, vec!["frozen"]),
            (8, vec!["settings"]),
            (9, vec!["black"]),
            (10, vec!["black"]),
            (12, vec!["flash"]),
            (14, vec!["traces"]),
            (15, vec!["held", "frozen"]),
        ];
        assert_eq!(judged(pictures.into_iter().chain(rest).chain(last)), expected);
    }

    #[test]
    fn a_frame_that_says_nothing_among_those_that_do_was_made_otherwise() {
        let told = |code: u8| Some(Picture { settings: Some("a".to_owned()), ..grey(code) });
        assert_eq!(judged([told(20), told(21), Some(grey(22)), told(23)]), [(3, vec!["settings"])]);
        assert_eq!(judged([told(20), Some(grey(21)), Some(grey(22)), told(23)]), []);
    }

    #[test]
    fn a_flash_is_none_of_a_cut_or_a_fade() {
        let shot = |codes: &[u8]| judged(codes.iter().map(|code| Some(grey(*code))));
        assert_eq!(shot(&[100, 102, 180, 104, 106]), [(3, vec!["flash"])]);
        assert_eq!(shot(&[100, 102, 0, 104, 106]), [(3, vec!["black", "flash"])]);
        // A cut, and a quick fade to black.
        assert_eq!(shot(&[100, 101, 180, 181]), []);
        assert_eq!(shot(&[120, 80, 40]), []);
        assert_eq!(shot(&[40, 0, 0]), [(2, vec!["black"]), (3, vec!["black"])]);
    }
}
