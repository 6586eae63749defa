use crate::raster::{Rgba, RowLayout};

/// Texels in a cache line of 64 bytes.
const LINE: usize = 8;

/// Shortest row that is padded: the cache holds whole regions of views with shorter rows.
const SHORT: usize = 128;

/// 15-bit linear light of a world's opaque texels. Red, green and blue are 0 to 32767, so a product of two fits in 32
/// bits.
///
/// Texels lie view by view and row by row. Rows may be padded, so that vertical neighbours do not compete for one set
/// of the processor's cache: see [`FixedLight::pitch`].
#[derive(Clone, Debug)]
pub struct FixedLight {
    /// Texels with an unused fourth sample. The padding is black.
    texels: Vec<[i16; 4]>,
    views: Vec<RowLayout>,
}

impl FixedLight {
    /// Sample value of white.
    pub(crate) const WHITE: f32 = i16::MAX as f32;

    /// Creates black views of these sizes, in columns and rows.
    pub fn black(sizes: impl IntoIterator<Item = [usize; 2]>) -> Self {
        let views = RowLayout::of(sizes, Self::pitch);
        Self { texels: vec![[0; 4]; views.last().map_or(0, RowLayout::end)], views }
    }

    /// Returns the number of texels from one row of a view to the next, for rows of this width.
    ///
    /// It is an odd number of cache lines. An even number would halve the cache sets that a column can use, and all
    /// rows of 2048 texels would fall into a single set.
    pub fn pitch(width: usize) -> usize {
        if width < SHORT { width } else { LINE.saturating_mul(width.div_ceil(LINE) | 1) }
    }

    /// Returns the columns and rows of each view.
    pub fn sizes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.views.iter().map(|view| view.size)
    }

    /// Returns the number of texels.
    pub fn len(&self) -> usize {
        self.sizes().map(|[columns, rows]| columns * rows).sum()
    }

    /// Returns whether there are no texels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Iterates over the views, each from its first row to its last, padding included.
    pub fn views_mut(&mut self) -> impl Iterator<Item = &mut [[i16; 4]]> {
        let mut rest = self.texels.as_mut_slice();
        self.views.iter().map(move |view| rest.split_off_mut(..view.end() - view.offset).expect("room for each view"))
    }

    /// Iterates over all texels in the world's order, without padding.
    pub fn texels_mut(&mut self) -> impl Iterator<Item = &mut [i16; 4]> {
        let Self { texels, views } = self;
        let pitches = views.iter().flat_map(|view| std::iter::repeat_n((view.pitch, view.size[0]), view.size[1]));
        let mut rest = texels.as_mut_slice();
        let rows =
            pitches.map(move |(pitch, width)| &mut rest.split_off_mut(..pitch).expect("room for each row")[..width]);
        rows.flatten()
    }

    /// Returns the place of each view.
    pub(crate) fn layout(&self) -> &[RowLayout] {
        &self.views
    }

    /// Returns all texels in memory order, padding included.
    pub(crate) fn as_laid_out(&self) -> &[[i16; 4]] {
        &self.texels
    }

    /// Returns one texel, by its index in the world.
    ///
    /// # Panics
    /// When the index is not below [`FixedLight::len`].
    pub fn rgba(&self, texel: usize) -> Rgba {
        let (mut views, mut within) = (self.views.iter(), texel);
        loop {
            let view = views.next().expect("a texel that there is");
            let [columns, rows] = view.size;
            if within < columns * rows {
                return Self::light(self.texels[view.index([within % columns, within / columns])]);
            }
            within -= columns * rows;
        }
    }

    /// Converts a texel's samples to linear light in floats.
    pub fn light(samples: [i16; 4]) -> Rgba {
        let [red, green, blue, _] = samples.map(|sample| f32::from(sample) / Self::WHITE);
        Rgba::opaque(red, green, blue)
    }

    /// Converts linear light, from black to white, to a texel's samples.
    pub fn texel(Rgba([red, green, blue, _]): Rgba) -> [i16; 4] {
        let [red, green, blue] =
            [red, green, blue].map(|light| (light * Self::WHITE).round().clamp(0.0, Self::WHITE) as i16);
        [red, green, blue, 0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_below_each_other_lie_all_over_a_cache() {
        // Number of sets of a cache: lines whose numbers are equal modulo this share a set.
        const PLACES: usize = 64;
        for width in SHORT..3000 {
            let pitch = FixedLight::pitch(width);
            assert!((width..width + 2 * LINE).contains(&pitch), "{width}: {pitch}");
            let mut places: Vec<usize> = (0..PLACES).map(|row| row * pitch / LINE % PLACES).collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..PLACES), "{width}: {pitch}");
        }
        assert!((0..SHORT).all(|width| FixedLight::pitch(width) == width));
    }

    #[test]
    fn texels_are_those_of_the_world_whatever_lies_between() {
        let sizes = [[130, 3], [5, 4], [256, 2]];
        let mut light = FixedLight::black(sizes);
        assert!(light.sizes().eq(sizes) && light.len() == 390 + 20 + 512);
        for (index, texel) in light.texels_mut().enumerate() {
            *texel = [index as i16 + 1; 4];
        }
        let red = |index: usize| (light.rgba(index).0[0] * FixedLight::WHITE).round() as usize;
        assert!((0..light.len()).all(|index| red(index) == index + 1));
        let rows: Vec<usize> = light.views_mut().zip(sizes).map(|(view, [_, rows])| view.len() / rows).collect();
        assert_eq!(rows, [136, 5, 264]);
        let [_, narrow, wide] = light.views_mut().collect::<Vec<_>>().try_into().expect("three views");
        assert_eq!([narrow[0], narrow[19], wide[255], wide[264]].map(|texel| texel[0]), [391, 410, 666, 667]);
        // The padding between rows is unchanged.
        assert!(wide[256..264].iter().all(|texel| *texel == [0; 4]));
    }

    #[test]
    #[should_panic(expected = "a texel that there is")]
    fn there_is_no_texel_after_the_last() {
        FixedLight::black([[130, 3], [5, 4]]).rgba(410);
    }
}
