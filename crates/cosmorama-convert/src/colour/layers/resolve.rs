//! Choice of the further channels that a conversion keeps, and messages about them.

use cosmorama::camera::View;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama_io::{Format, Header, Layers};

use super::plan::data_in;
use super::{LayerContent, LayerPlan, LayerRules};
use crate::colour::Light;
use crate::diagnostic::{CHANNELS, Code, DEPTH_KIND, Diagnostic, NORMALS, PART, Result, usage, usage_as};
use crate::input::Input;
use crate::settings::{Conversion, LayerSettings};
use crate::settings::{DepthKind, NormalSpace};
use crate::target::Target;

/// Most names that are listed.
const SHOWN: usize = 12;

impl LayerPlan {
    /// Chooses the further channels that the output gets. A filter for labels applies to channels of labels alone, if
    /// there are any.
    pub(crate) fn resolve(
        settings: &Conversion,
        (input, target, light): (&Input, &Target, &Light),
        filter: &mut FilterSettings,
        told: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let headers: Vec<&Header> = input.present().map(|(_, header, _)| header).collect();
        let LayerSettings { depth, normals, .. } = settings.layers;
        if target.format != Format::Exr {
            check_light(input, &format!("{} files hold", target.format))?;
            told.extend(left_behind(target.format, &headers));
            told.extend(without_effect(settings, &Self::default()));
            return Ok(Self::default());
        }
        let mut rules = LayerRules { depth, normals: normals.unwrap_or_default(), ..LayerRules::default() };
        if let FilterKind::Labels(rule) = filter.kind {
            rules.labels = rule;
        }
        let (plan, lacking) = Self::of_files(&headers, light.channels, rules);
        if !lacking.is_empty() {
            let message = format!(
                "not in all files with one sample a pixel, and left out: {}; {CHANNELS} chooses others",
                listed(lacking.iter().map(String::as_str))
            );
            told.push(Diagnostic::warning(Code::ChannelsLost, message));
        }
        let has_labels = plan.groups.iter().any(|group| group.content == LayerContent::Labels);
        if has_labels && matches!(filter.kind, FilterKind::Labels(_)) {
            // The picture beside the labels is light.
            *filter = FilterSettings::DEFAULT;
        }
        if plan.leaves_picture_out() && plan.groups.is_empty() {
            return Err(usage(format!(
                "no channel is left that all files have with one sample a pixel; {CHANNELS} chooses"
            )));
        }
        plan.check_depths(input)?;
        told.extend(plan.depths(input, target));
        told.extend(plan.normals());
        told.extend(without_effect(settings, &plan));
        Ok(plan)
    }

    /// Checks that planar depths belong to flat pictures.
    fn check_depths(&self, input: &Input) -> Result<()> {
        if self.rules.depth != Some(DepthKind::Planar) || self.of(LayerContent::Depth).is_empty() {
            return Ok(());
        }
        match input.present().find(|(_, _, view)| !view.is_flat()) {
            Some((view, ..)) => Err(usage(format!(
                "{DEPTH_KIND} planar: {} is not flat, so that it has no plane to measure from; give {DEPTH_KIND} radial, or leave \
                 it out",
                view.name
            ))),
            None => Ok(()),
        }
    }

    /// Returns a diagnostic on the kind of depth that is read and written: a warning if the kind is a guess.
    fn depths(&self, input: &Input, target: &Target) -> Option<Diagnostic> {
        let names = self.of(LayerContent::Depth);
        let (view, output) = (input.present().next()?.2, &target.views.first()?.view);
        if names.is_empty() {
            return None;
        }
        let (names, read) = (listed(names.into_iter()), kind(self.rules.depth_of(view)));
        let written = kind(LayerRules::default().depth_of(output));
        if self.rules.depth.is_none() && view.is_flat() {
            let message = format!(
                "{names}: taken for {read}, as pictures like the input usually have it, and written as {written}; if it is \
                 the distance from the camera, give {DEPTH_KIND} radial"
            );
            return Some(Diagnostic::warning(Code::Guessed, message));
        }
        let message = format!("{names}: read as {read}, written as {written}");
        Some(Diagnostic::note(Code::Guessed, message))
    }

    /// Returns a diagnostic on the coordinate frame in which normals are taken to be.
    fn normals(&self) -> Option<Diagnostic> {
        let names = self.of(LayerContent::Normal);
        let told = match self.rules.normals {
            NormalSpace::World => "normals in the world's frame, which no view turns",
            NormalSpace::Camera => "normals in each view's own frame: turned from the input's to the output's",
        };
        let message = format!("{}: {told} ({NORMALS})", listed(names.iter().copied()));
        (!names.is_empty()).then(|| Diagnostic::note(Code::Guessed, message))
    }
}

impl LayerRules {
    /// Returns the kind of a view's depth: as set, else the usual one.
    pub(crate) fn depth_of(&self, view: &View) -> DepthKind {
        self.depth.unwrap_or(if view.is_flat() { DepthKind::Planar } else { DepthKind::Radial })
    }
}

fn kind(kind: DepthKind) -> &'static str {
    match kind {
        DepthKind::Planar => "planar depth (from the camera's plane)",
        DepthKind::Radial => "radial depth (from the camera)",
    }
}

/// Warns about channels that an output's format cannot hold.
fn left_behind(format: Format, headers: &[&Header]) -> Option<Diagnostic> {
    let mut names: Vec<&str> = Vec::new();
    for name in headers.iter().flat_map(|header| &header.metadata.layers.further).map(|channel| channel.name.as_str()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let message = format!(
        "{format} files hold one picture: left out are the channels {}; OpenEXR files hold them",
        listed(names.iter().copied())
    );
    (!names.is_empty()).then(|| Diagnostic::warning(Code::ChannelsLost, message))
}

/// Warns about settings for channels that are not there.
fn without_effect(settings: &Conversion, plan: &LayerPlan) -> Vec<Diagnostic> {
    let given = [
        (
            settings.layers.depth.is_some(),
            LayerContent::Depth,
            format!("{DEPTH_KIND} has no effect: no channel of depth"),
        ),
        (
            settings.layers.normals.is_some(),
            LayerContent::Normal,
            format!("{NORMALS} has no effect: no channels of normals"),
        ),
    ];
    let idle = given.into_iter().filter(|(is_given, content, _)| *is_given && plan.of(*content).is_empty());
    idle.map(|(_, _, told)| Diagnostic::warning(Code::NoEffect, format!("{told} go into the output"))).collect()
}

/// Checks that the picture is light, for outputs that hold nothing else.
pub(crate) fn check_light(input: &Input, output: &str) -> Result<()> {
    let first = input.frames.first().copied().flatten();
    let data = input.present().find_map(|(view, header, _)| Some((view, header, data_in(header)?)));
    data.map_or(Ok(()), |(view, header, content)| {
        let message = format!(
            "{output} light, but {} of {} holds {}; write OpenEXR, which keeps it, or choose light with {CHANNELS}",
            listed(header.metadata.layers.picture.iter().map(String::as_str)),
            view.files.path(first).display(),
            content.word()
        );
        Err(usage_as(Code::OutputFormat, message))
    })
}

/// Checks that files have the parts and channels that are chosen, and tells of files with parts that are not read.
pub(crate) fn check_choice(settings: &Conversion, input: &Input, told: &mut Vec<Diagnostic>) -> Result<()> {
    let first = input.frames.first().copied().flatten();
    for (view, header, _) in input.present() {
        for (is_given, option) in [(settings.part.is_some(), PART), (!settings.channels.is_empty(), CHANNELS)] {
            if is_given && header.format != Format::Exr {
                let path = view.files.path(first).display().to_string();
                return Err(usage(format!(
                    "{option} is for OpenEXR files, but {path} is {}; leave it out",
                    header.format
                )));
            }
        }
    }
    let mut in_parts = input.present().filter(|(_, header, _)| !header.metadata.layers.parts.is_empty());
    // One message does for all faces of a cube.
    if let (None, Some((view, header, _))) = (&settings.part, in_parts.next()) {
        let path = view.files.path(first).display().to_string();
        told.push(unread_parts(&path, &header.metadata.layers));
    }
    Ok(())
}

/// Returns the warning about a file of several parts.
fn unread_parts(path: &str, layers: &Layers) -> Diagnostic {
    let labels: Vec<_> = layers.parts.iter().enumerate().map(|(index, part)| part.label(index)).collect();
    let message = format!(
        "{path} has {} parts, of which {} is read; choose with {PART}: {}",
        labels.len(),
        labels[layers.part],
        listed(labels.iter().map(String::as_str))
    );
    Diagnostic::warning(Code::Parts, message).about(path)
}

/// Lists names, and how many more there are.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.len().saturating_sub(SHOWN) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names[..SHOWN].join(", ")),
    }
}
