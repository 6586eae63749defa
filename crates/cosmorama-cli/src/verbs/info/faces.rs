//! Report of `info` on how faces lie.

use anyhow::Result;
use cosmorama::raster::{Image, Rgba};
use cosmorama_convert::{Continuity, FacePixels, Files, GivenFaces, ViewFiles, existing_frames, light_of};
use cosmorama_io::FaceSet;
use cosmorama_spec::Cube;
use serde_json::{Value, json};

use crate::console::in_options;

/// Reports whether the faces in the first frame of a face set fit. `None` if its files have too few whole faces to
/// tell.
pub(super) fn of_files(inputs: &dyn Files, set: &FaceSet) -> Result<Option<Value>> {
    let lie: Vec<_> = set.faces().iter().map(|file| (file.face, file.placement)).collect();
    let Some(given) = GivenFaces::of_files(&Cube::default(), set.naming(), &lie) else { return Ok(None) };
    let mut pictures = Vec::new();
    for (index, file) in set.faces().iter().enumerate().filter(|(_, file)| file.present) {
        let files = ViewFiles::new(&file.path);
        let Some(picture) = light_of(inputs, &files.path(existing_frames(&files, inputs)?.first().copied())) else {
            return Ok(None);
        };
        pictures.push((index, picture));
    }
    // Crops have other borders than whole faces.
    let size = |picture: &Image<Rgba>| (picture.width(), picture.height());
    if pictures.windows(2).any(|pair| size(&pair[0].1) != size(&pair[1].1)) {
        return Ok(None);
    }
    let lights: Vec<_> = pictures.iter().map(|(index, picture)| (*index, size(picture), pixel_of(picture))).collect();
    let pixels = lights.iter().map(|(index, size, light)| (*index, FacePixels { size: *size, light }));
    Ok(given.judge(&pixels.collect::<Vec<_>>()).as_ref().map(report))
}

fn pixel_of(picture: &Image<Rgba>) -> impl Fn(usize, usize) -> Rgba + '_ {
    |i, j| *picture.get(i, j)
}

/// Returns the findings from the borders of faces as JSON.
pub(super) fn report(continuity: &Continuity) -> Value {
    let mut report = json!({ "told": in_options(&continuity.told), "fits": continuity.fits });
    if let Some(confidence) = continuity.confidence {
        report["confidence"] = json!(confidence);
    }
    if !continuity.changes.is_empty() {
        report["changes"] = json!(continuity.changes);
    }
    if let Some(spec) = &continuity.spec {
        report["spec"] = json!(spec.to_string());
    }
    report
}
