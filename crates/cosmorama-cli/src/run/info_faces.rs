//! What `info` says of how faces lie.

use std::path::Path;

use anyhow::Result;
use cosmorama::raster::{Image, Rgba};
use cosmorama_io::FaceSet;
use serde_json::{Value, json};

use crate::job::{Continuity, FacePixels, Files, GivenFaces, Likely, existing_frames, light_of};
use crate::spec::Cube;

/// Of the first frame of a face set; `None` where its files have too few whole faces to tell.
pub(super) fn of_files(set: &FaceSet) -> Result<Option<Value>> {
    let lie: Vec<_> = set.faces().iter().map(|file| (file.face, file.placement)).collect();
    let Some(given) = GivenFaces::of_files(&Cube::default(), set.naming(), &lie) else { return Ok(None) };
    let mut pictures = Vec::new();
    for (index, file) in set.faces().iter().enumerate().filter(|(_, file)| file.present) {
        let files = Files::new(&file.path);
        let Some(picture) = light_of(&files.path(existing_frames(&files)?.first().copied())) else { return Ok(None) };
        pictures.push((index, picture));
    }
    // Crops have other borders than their faces.
    let size = |picture: &Image<Rgba>| (picture.width(), picture.height());
    if pictures.windows(2).any(|pair| size(&pair[0].1) != size(&pair[1].1)) {
        return Ok(None);
    }
    let lights: Vec<_> = pictures.iter().map(|(index, picture)| (*index, size(picture), pixel_of(picture))).collect();
    let pixels = lights.iter().map(|(index, size, light)| (*index, FacePixels { size: *size, light }));
    Ok(given.judge(&pixels.collect::<Vec<_>>()).as_ref().map(report))
}

/// Of faces in one image. Where its shape alone says that it may be one, it is if the borders do.
pub(super) fn of_image(path: &Path, likely: &Likely) -> Option<Value> {
    let picture = if likely.cubes.is_empty() { return None } else { light_of(path)? };
    let judged = likely.cubes.iter().filter_map(|cube| GivenFaces::of_image(cube)?.judge_image(&picture));
    let mut found: Vec<Continuity> = judged.filter(|judged| !likely.may_be_none || judged.fits.is_some()).collect();
    // Of several layouts the one that lies rightly.
    found.sort_by_key(|judged| judged.fits != Some(true));
    found.first().map(report)
}

fn pixel_of(picture: &Image<Rgba>) -> impl Fn(usize, usize) -> Rgba + '_ {
    |i, j| *picture.get(i, j)
}

fn report(continuity: &Continuity) -> Value {
    let mut report = json!({ "told": continuity.told, "fits": continuity.fits });
    if let Some(confidence) = continuity.confidence {
        report["confidence"] = json!(confidence);
    }
    if !continuity.changes.is_empty() {
        report["changes"] = json!(continuity.changes);
    }
    if let Some(spec) = &continuity.spec {
        report["spec"] = json!(spec);
    }
    report
}
