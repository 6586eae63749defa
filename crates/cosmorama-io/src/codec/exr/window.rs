use exr::meta::header::Header as Part;

use crate::Window;

/// The part of the data window inside the display window. Pixels outside the display window are overscan, and are cut
/// off.
pub(super) struct Crop {
    /// Columns that remain.
    pub(super) width: usize,
    /// Rows that remain.
    pub(super) height: usize,
    /// Columns cut off on the left.
    left: usize,
    /// Rows cut off at the top.
    top: usize,
    /// Place of the remaining pixels in the display window, if they do not fill it.
    pub(super) window: Option<Window>,
}

impl Crop {
    /// Computes the crop; `None` if data and display window do not overlap.
    pub(super) fn of(part: &Part) -> Option<Self> {
        let data = part.own_attributes.layer_position;
        let display = part.shared_attributes.display_window;
        let (left, x, width) = overlap(data.x(), part.layer_size.width(), display.position.x(), display.size.width())?;
        let (top, y, height) =
            overlap(data.y(), part.layer_size.height(), display.position.y(), display.size.height())?;
        let (canvas_width, canvas_height) = (display.size.width(), display.size.height());
        let whole = (width, height) == (canvas_width, canvas_height);
        let window = (!whole).then_some(Window { canvas_width, canvas_height, x, y });
        Some(Self { width, height, left, top, window })
    }

    /// Returns the image's row for a row of the data.
    pub(super) fn row(&self, data_row: usize) -> Option<usize> {
        data_row.checked_sub(self.top).filter(|row| *row < self.height)
    }

    /// Returns the image's column for a column of the data.
    pub(super) fn column(&self, data_column: usize) -> Option<usize> {
        data_column.checked_sub(self.left).filter(|column| *column < self.width)
    }
}

/// Intersects two intervals, each given by start and length. Returns where the overlap begins in each, and its length.
fn overlap(data: i32, data_length: usize, display: i32, display_length: usize) -> Option<(usize, usize, usize)> {
    let (data, display) = (i64::from(data), i64::from(display));
    let start = data.max(display);
    let end = (data + i64::try_from(data_length).ok()?).min(display + i64::try_from(display_length).ok()?);
    let length = usize::try_from(end - start).ok().filter(|length| *length > 0)?;
    Some((usize::try_from(start - data).ok()?, usize::try_from(start - display).ok()?, length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlaps() {
        assert_eq!(overlap(0, 10, 0, 10), Some((0, 0, 10)));
        assert_eq!(overlap(2, 3, 0, 10), Some((0, 2, 3)));
        assert_eq!(overlap(-5, 20, 0, 10), Some((5, 0, 10)));
        assert_eq!(overlap(-5, 5, 0, 10), None);
        assert_eq!(overlap(i32::MAX, 1, i32::MIN, 1), None);
    }
}
