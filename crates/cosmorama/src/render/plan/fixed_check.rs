//! What makes the weights of a plan in integers safe to work with, wherever they come from.

use super::band::Run;
use super::window_order::are_all_there;
use crate::render::apply::fixed::weights::{Header, Shape, mark_words};

/// Whether the numbers of a group are all there and its windows lie within a view of this size, columns and rows.
pub(crate) fn is_sound(numbers: &[u32], group: &[Run], view: [usize; 2]) -> bool {
    are_all_there(numbers, group, |numbers, run, lane| window(numbers, run, lane, view))
}

/// Goes past the numbers of a lane's window, if they are sound.
fn window(numbers: &mut &[u32], run: &Run, lane: usize, view: [usize; 2]) -> Option<()> {
    let header = Header(*numbers.split_off_first()?);
    let shape = match Shape::SMALL.get(header.shape() as usize) {
        Some(shape) => *shape,
        None => {
            let large = Shape::of_run(run);
            numbers.split_off(..run.rows_under().len() * mark_words(large.pairs))?;
            large
        }
    };
    let weights = numbers.split_off(..shape.pairs * shape.height)?;
    let halves = weights.iter().flat_map(|pair| [*pair as i16, (*pair >> 16) as i16]);
    let size: i64 = halves.map(|weight| i64::from(weight).abs()).sum();
    // Sums of products with 15 bits must fit into 32.
    let is_sound = (14..=15).contains(&header.bits())
        && size < 1 << 16
        && run.is_within(lane, [2 * shape.pairs, shape.height], view);
    is_sound.then_some(())
}
