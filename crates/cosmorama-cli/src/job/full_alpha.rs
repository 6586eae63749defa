//! Alpha that is full nowhere: pictures that cover nothing wholly are rare, and multipliers are kept there, too.

use cosmorama::raster::Rgba;

/// Nothing more is full, in floats that were made of codes.
const FULL: f32 = 0.999;

/// The greatest alpha of some pixels; `None` where one is full, or there are none.
pub(crate) fn greatest_alpha(mut pixels: impl Iterator<Item = Rgba>) -> Option<f32> {
    let first = pixels.next()?.alpha();
    let greatest = pixels.try_fold(first, |greatest, pixel| (greatest < FULL).then(|| greatest.max(pixel.alpha())))?;
    (greatest < FULL).then_some(greatest)
}

/// What is told of a picture with no more alpha than that.
pub(crate) fn told_of_alpha(greatest: f32) -> String {
    format!(
        "no pixel's alpha is full: it is {:.0} % at most. If it is a multiplier of the colours, as in RGBM and RGBD, and no \
         coverage, what is made of it is almost transparent: make plain colours of it first, with the tool that wrote it",
        100.0 * greatest
    )
}
