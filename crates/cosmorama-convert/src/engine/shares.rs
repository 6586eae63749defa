use cosmorama::camera::View;
use cosmorama::render::{Progress, Share};

/// Splits the progress of work on several views by their pixels, in the order in which they are made.
pub(crate) struct Shares<'a> {
    whole: &'a dyn Progress,
    pixels: usize,
    begun: usize,
}

impl<'a> Shares<'a> {
    pub(crate) fn new<'v>(whole: &'a dyn Progress, views: impl Iterator<Item = &'v View>) -> Self {
        Self { whole, pixels: views.map(pixels).sum(), begun: 0 }
    }

    /// Returns the share of the next view.
    pub(crate) fn next(&mut self, view: &View) -> Share<'a> {
        let at = |begun: usize| begun as f64 / self.pixels as f64;
        let (from, to) = (at(self.begun), at(self.begun + pixels(view)));
        self.begun += pixels(view);
        Share { whole: self.whole, from, to }
    }
}

fn pixels(view: &View) -> usize {
    view.width() * view.height()
}
