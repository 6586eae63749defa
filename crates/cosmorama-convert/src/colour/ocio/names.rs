use cosmorama_spec::nearest;
use ocio::Config;

use crate::diagnostic::{Mark, OCIO, Result, VIEW, usage};

/// Greatest number of names that are suggested.
const SUGGESTED: usize = 4;

/// Returns the name of a space that was given by its name, an alias or a role.
pub(super) fn space(config: &Config, (option, typed): (Mark, &str), path: &str) -> Result<String> {
    if let Some(space) = config.get_color_space(typed) {
        return Ok(space.name().to_owned());
    }
    let known: Vec<String> =
        (0..config.num_color_spaces()).map(|index| config.color_space_name_by_index(index).to_owned()).collect();
    Err(usage(format!("{option} {typed}: {path} has no colour space of this name; {}", suggestion(typed, &known))))
}

/// Returns the display and the view that `DISPLAY/VIEW` names. Either may hold a slash.
pub(super) fn display_and_view(config: &Config, typed: &str, path: &str) -> Result<(String, String)> {
    let displays: Vec<String> = (0..config.num_displays()).map(|index| config.display(index)).collect();
    let views = |display: &str| -> Vec<String> {
        (0..config.num_views(display)).map(|index| config.view(display, index)).collect()
    };
    let mut known_display = None;
    for (at, _) in typed.match_indices('/') {
        let (display, view) = (&typed[..at], &typed[at + 1..]);
        let Some(display) = displays.iter().find(|known| known.eq_ignore_ascii_case(display)) else { continue };
        if let Some(view) = views(display).into_iter().find(|known| known.eq_ignore_ascii_case(view)) {
            return Ok((display.clone(), view));
        }
        known_display = Some((display, view));
    }
    let all: Vec<String> = displays
        .iter()
        .flat_map(|display| views(display).into_iter().map(move |view| format!("{display}/{view}")))
        .collect();
    Err(usage(match known_display {
        Some((display, view)) => format!(
            "{VIEW} {typed}: in {path} the display {display} has no view of this name; {}",
            suggestion(view, &views(display))
        ),
        None => format!("{VIEW} {typed}: expected DISPLAY/VIEW as in {OCIO} {path}; {}", suggestion(typed, &all)),
    }))
}

/// Returns the names that are most like what was typed, or all of them if none is.
fn suggestion(typed: &str, known: &[String]) -> String {
    let (low, lower) = (typed.to_lowercase(), known.iter().map(|name| name.to_lowercase()).collect::<Vec<_>>());
    let close = nearest(&low, &lower.iter().map(String::as_str).collect::<Vec<_>>());
    let closest = lower.iter().position(|name| Some(name.as_str()) == close);
    let holding = (0..known.len()).filter(|index| !low.is_empty() && lower[*index].contains(&low));
    let mut like: Vec<&str> = closest.into_iter().chain(holding).map(|index| known[index].as_str()).collect();
    let mut seen = std::collections::BTreeSet::new();
    like.retain(|name| seen.insert(*name));
    like.truncate(SUGGESTED);
    if like.is_empty() {
        return format!("it has {}", known.join(", "));
    }
    let quoted: Vec<String> = like.iter().map(|name| format!("'{name}'")).collect();
    format!("did you mean {}?", quoted.join(" or "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::{ConvertError, IN_SPACE};

    fn config() -> Config {
        Config::create_from_builtin_config("cg-config-v2.2.0_aces-v1.3_ocio-v2.4").expect("a built-in config")
    }

    fn message(error: &ConvertError) -> String {
        error.to_string()
    }

    #[test]
    fn spaces_go_by_name_alias_and_role() {
        let named = |typed| space(&config(), (IN_SPACE, typed), "c").expect("a space");
        for typed in ["ACEScg", "acescg", "lin_ap1", "scene_linear"] {
            assert_eq!(named(typed), "ACEScg");
        }
    }

    #[test]
    fn unknown_spaces_are_answered_with_those_alike() {
        let refused = |typed| message(&space(&config(), (IN_SPACE, typed), "c").expect_err("no space"));
        assert!(refused("ACESgc").contains("did you mean 'ACEScg'"), "{}", refused("ACESgc"));
        assert!(refused("adobe").contains("AdobeRGB"), "{}", refused("adobe"));
        assert!(refused("zzzzzz").contains("it has ") && refused("zzzzzz").contains("ACES2065-1"));
    }

    #[test]
    fn views_go_with_their_display() {
        let found = display_and_view(&config(), "sRGB - Display/ACES 1.0 - SDR Video", "c").expect("a view");
        assert_eq!(found, ("sRGB - Display".to_owned(), "ACES 1.0 - SDR Video".to_owned()));
        let refused = |typed| message(&display_and_view(&config(), typed, "c").expect_err("no view"));
        assert!(refused("sRGB - Display/SDR Video").contains("'ACES 1.0 - SDR Video'"));
        assert!(refused("SDR Video").contains("expected DISPLAY/VIEW"));
        assert!(refused("SDR Video").contains("sRGB - Display/ACES 1.0 - SDR Video"));
    }
}
