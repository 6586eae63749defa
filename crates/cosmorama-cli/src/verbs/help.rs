use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use cosmorama_convert::refuse_existing;
use cosmorama_io::pending::Pending;
use cosmorama_spec::{SpecKind, did_you_mean};

use super::make_folder;
use crate::args::light;
use crate::args::{Args, CompletionsArgs, HelpArgs, ManArgs, SPEC_TOPIC, builtins, examples, verbs};
use crate::console::Console;
use crate::failure::usage;

/// Prints the help of a verb, or of SPECs.
pub(super) fn help(args: &HelpArgs, console: &Console) -> Result<ExitCode> {
    let mut command = built();
    let text = match (args.topic.as_deref(), args.projection.as_deref()) {
        (Some(SPEC_TOPIC), None) => cosmorama_spec::help(),
        (Some(SPEC_TOPIC), Some(spec)) => of_projection(spec)?,
        (_, Some(extra)) => {
            return Err(usage(format!("unexpected argument '{extra}'; only 'help spec' takes a projection")));
        }
        (Some(topic), None) => match command.find_subcommand_mut(topic) {
            Some(verb) => verb.render_long_help().to_string(),
            None => of_projection(topic)?,
        },
        (None, None) => command.render_help().to_string(),
    };
    console.print(&(text.trim_end().to_owned() + "\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the keys of one projection.
fn of_projection(name: &str) -> Result<String> {
    let Some(kind) = SpecKind::of(name) else {
        let topics: Vec<&str> = verbs().chain([SPEC_TOPIC]).chain(SpecKind::all().map(SpecKind::name)).collect();
        let meant = did_you_mean(name, &topics);
        return Err(usage(format!("no help on '{name}'{meant}; topics are {}", topics.join(", "))));
    };
    Ok(format!("{} is {}.\n\n{}", kind.name(), kind.about(), kind.help()))
}

/// Prints a completion script.
pub(super) fn completions(args: &CompletionsArgs, console: &Console) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "cosmorama", &mut script);
    let mut script = String::from_utf8_lossy(&script).into_owned();
    if args.shell == Shell::Fish {
        script += &words_for_fish(&Args::command());
    }
    console.print(&script)?;
    Ok(ExitCode::SUCCESS)
}

/// Returns lines of fish's script for the words of arguments without an option, which `clap_complete` leaves out.
fn words_for_fish(command: &Command) -> String {
    let mut lines = String::new();
    for verb in command.get_subcommands() {
        for argument in verb.get_positionals() {
            let values = argument.get_possible_values();
            let words: Vec<&str> = values.iter().map(|value| value.get_name()).collect();
            if !words.is_empty() {
                let (verb, words) = (verb.get_name(), words.join(" "));
                lines += &format!(
                    "complete -c cosmorama -n \"__fish_cosmorama_using_subcommand {verb}\" -f -a \"{words}\"\n"
                );
            }
        }
    }
    lines
}

/// Prints the manual pages one after the other, or writes each into a file.
pub(super) fn man(args: &ManArgs, console: &Console) -> Result<ExitCode> {
    let pages = pages()?;
    let Some(folder) = &args.dir else {
        console.print(&pages.into_iter().map(|page| page.text).collect::<String>())?;
        return Ok(ExitCode::SUCCESS);
    };
    let files: Vec<_> = pages.iter().map(|page| folder.join(&page.file)).collect();
    if !args.overwrite {
        refuse_existing(files.iter().map(|file| file.as_path()))?;
    }
    let folders = SECTIONS.map(|section| make_folder(&folder.join(section), console));
    let _folders = folders.into_iter().collect::<Result<Vec<_>>>()?;
    for (file, page) in files.iter().zip(&pages) {
        write_page(file, &page.text, console)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn write_page(file: &Path, text: &str, console: &Console) -> Result<()> {
    let mut pending = Pending::create(file, &console.unfinished)?;
    pending.writer().write_all(text.as_bytes())?;
    pending.finish()?;
    console.print(&format!("{}\n", file.display()))
}

/// Returns the whole command line, with all that its parts inherit.
fn built() -> Command {
    let mut command = Args::command();
    command.build();
    command
}

/// Folders of the manual's sections: programs, and topics that belong to no program.
const SECTIONS: [&str; 2] = ["man1", "man7"];

/// A manual page.
struct Page {
    /// File of the page, in the folder of its section.
    file: PathBuf,
    /// Text of the page, for `man`.
    text: String,
}

/// Returns the pages: the program's own, one for each verb, and one for SPECs.
fn pages() -> Result<Vec<Page>> {
    let command = built();
    let mut pages = vec![page(&command, None)?];
    for verb in command.get_subcommands() {
        pages.push(page(verb, Some(examples(Some(verb.get_name()))))?);
        for part in verb.get_subcommands() {
            pages.push(page(part, Some(light::examples(part.get_name())))?);
        }
    }
    pages.push(spec_page());
    Ok(pages)
}

/// Returns the page of a command: of a verb with its examples, or of the program itself.
fn page(command: &Command, of_verb: Option<&[&str]>) -> Result<Page> {
    let man = Man::new(command.clone());
    let mut text = Vec::new();
    man.render_title(&mut text)?;
    man.render_name_section(&mut text)?;
    man.render_synopsis_section(&mut text)?;
    man.render_description_section(&mut text)?;
    let mut text = String::from_utf8_lossy(&text).into_owned();
    text += &verbatim("EXAMPLES", &of_verb.unwrap_or(examples(None)).join("\n"));
    let mut rest = Vec::new();
    man.render_options_section(&mut rest)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut rest)?;
    }
    text += &String::from_utf8_lossy(&rest);
    text += match of_verb {
        None => ".SH \"SEE ALSO\"\ncosmorama\\-spec(7): projections and their keys\n",
        Some(_) => ".SH \"SEE ALSO\"\ncosmorama(1), cosmorama\\-spec(7)\n",
    };
    Ok(Page { file: Path::new(SECTIONS[0]).join(man.get_filename()), text })
}

fn spec_page() -> Page {
    let mut text =
        ".TH cosmorama\\-spec 7\n.SH NAME\ncosmorama\\-spec \\- projections, their keys and other names\n".to_owned();
    text += &verbatim("DESCRIPTION", &cosmorama_spec::help());
    text += &verbatim("WORLDS BY FORMULA", &builtins());
    text += ".SH \"SEE ALSO\"\ncosmorama(1), cosmorama\\-convert(1)\n";
    Page { file: Path::new(SECTIONS[1]).join("cosmorama-spec.7"), text }
}

/// Returns a section whose lines stay as they are.
fn verbatim(heading: &str, text: &str) -> String {
    let line = |line: &str| {
        let escaped = line.replace('\\', "\\e").replace('-', "\\-");
        // A point or an apostrophe at its beginning would make it a command.
        if escaped.starts_with(['.', '\'']) { format!("\\&{escaped}\n") } else { escaped + "\n" }
    };
    format!(".SH \"{heading}\"\n.nf\n{}.fi\n", text.trim_end().lines().map(line).collect::<String>())
}
