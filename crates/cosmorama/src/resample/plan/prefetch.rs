use super::band::Run;
use super::mirrors::Mirrors;
use super::texels;

/// Asks for the texels that these runs will read, so that they are near by then: lines of memory that are asked for one after
/// the other, as they are needed, take most of the time.
#[inline(always)]
pub(super) fn prefetch<T>(texels: &[T], mirrors: &Mirrors, runs: &[Run]) {
    for image in &mirrors.images {
        for run in runs {
            let walk = image.view(usize::from(run.view)).walk(run.corner());
            let span = run.span() as u32;
            let mut first = walk.first;
            for _ in 0..run.height {
                let last = if walk.is_reversed { first.wrapping_sub(span) } else { first.wrapping_add(span) };
                texels::prefetch(texels, first);
                texels::prefetch(texels, last);
                first = first.wrapping_add_signed(walk.down);
            }
        }
    }
}
