//! Long work tells how far it is, and can be stopped; who watches it changes no pixel.

use std::ops::ControlFlow;
use std::sync::Mutex;

use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::Rgba;
use cosmorama::render::{Arithmetic, Progress, Resampler, Share, Stopped};
use testkit::Dome;

/// Keeps what it is told, and stops work after so many reports.
struct Notes {
    fractions: Mutex<Vec<f64>>,
    most: usize,
}

impl Notes {
    fn of(most: usize) -> Self {
        Self { fractions: Mutex::default(), most }
    }

    fn count(&self) -> usize {
        self.fractions.lock().unwrap().len()
    }

    /// Checks that the reports rise to the end.
    fn check(&self, least: usize, what: &str) {
        let fractions = self.fractions.lock().unwrap();
        assert!(fractions.is_sorted_by(|a, b| a < b), "{what}: {fractions:?}");
        assert!(fractions[0] > 0.0 && fractions.last() == Some(&1.0), "{what}: {fractions:?}");
        assert!(fractions.len() >= least, "{what}: {fractions:?}");
    }
}

impl Progress for Notes {
    fn advance(&self, fraction: f64) -> ControlFlow<()> {
        let mut fractions = self.fractions.lock().unwrap();
        fractions.push(fraction);
        if fractions.len() < self.most { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

const KINDS: [FilterKind; 4] =
    [FilterKind::Ewa, FilterKind::Bilinear, FilterKind::EwaPyramid, FilterKind::Reference { samples: 1 }];

fn by(dome: &Dome, kind: FilterKind) -> Resampler<'_> {
    dome.resampler().by(FilterSettings { kind, ..FilterSettings::DEFAULT })
}

fn texels(dome: &Dome) -> Vec<Rgba> {
    (0..dome.world.texel_count()).map(|texel| dome.light.rgba(texel)).collect()
}

#[test]
fn reports_rise_to_the_end_and_leave_pixels_as_they_are() {
    let dome = Dome::new(256);
    let texels = texels(&dome);
    for kind in KINDS {
        let (resampler, what) = (by(&dome, kind), format!("{kind:?}"));
        let notes = Notes::of(usize::MAX);
        assert!(resampler.watched(&notes).render(&texels) == Ok(resampler.render(&texels)), "{what}");
        notes.check(4, &what);
        let notes = Notes::of(usize::MAX);
        let codes = resampler.watched(&notes).render_fixed(&dome.light, &dome.codec);
        assert!(codes == Ok(resampler.render_fixed(&dome.light, &dome.codec)), "{what}");
        notes.check(4, &what);
        let notes = Notes::of(usize::MAX);
        let plan = resampler.watched(&notes).plan(Arithmetic::Float).unwrap();
        assert!(
            plan.map(|plan| plan.apply(&texels)) == resampler.plan(Arithmetic::Float).map(|plan| plan.apply(&texels))
        );
        notes.check(if kind == KINDS[3] { 1 } else { 4 }, &what);
    }
}

#[test]
fn work_that_is_stopped_ends_at_once() {
    let dome = Dome::new(256);
    let texels = texels(&dome);
    for kind in KINDS {
        let resampler = by(&dome, kind);
        for most in [1, 3] {
            let notes = Notes::of(most);
            assert!(resampler.watched(&notes).render(&texels) == Err(Stopped), "{kind:?}");
            assert_eq!(notes.count(), most, "{kind:?}");
            let notes = Notes::of(most);
            assert!(resampler.watched(&notes).render_fixed(&dome.light, &dome.codec) == Err(Stopped), "{kind:?}");
            assert_eq!(notes.count(), most, "{kind:?}");
        }
        let notes = Notes::of(1);
        assert_eq!(resampler.watched(&notes).plan(Arithmetic::Float).err(), Some(Stopped), "{kind:?}");
        assert_eq!(notes.count(), 1, "{kind:?}");
    }
}

#[test]
fn a_share_of_longer_work_covers_its_stretch() {
    let dome = Dome::new(128);
    let notes = Notes::of(usize::MAX);
    for (from, to) in [(0.0, 0.3), (0.3, 1.0)] {
        let share = Share { whole: &notes, from, to };
        dome.resampler().watched(&share).render_fixed(&dome.light, &dome.codec).unwrap();
        assert_eq!(notes.fractions.lock().unwrap().last(), Some(&to));
    }
    notes.check(4, "two shares");
}
