//! Manual pages.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use clap::Command;
use clap_mangen::Man;
use cosmorama_convert::refuse_existing;
use cosmorama_io::pending::Pending;
use cosmorama_spec::SpecKind;

use super::built;
use crate::args::{ManArgs, builtins, examples, light, verbs};
use crate::console::Console;
use crate::failure::usage;
use crate::verbs::make_folder;

/// Prints the manual pages one after the other, or writes each into a file.
pub(in crate::verbs) fn man(args: &ManArgs, console: &Console) -> Result<ExitCode> {
    let pages = pages()?;
    let Some(folder) = &args.dir else {
        console.print(&pages.into_iter().map(|page| page.text).collect::<String>())?;
        return Ok(ExitCode::SUCCESS);
    };
    let files: Vec<_> = pages.iter().map(|page| folder.join(&page.file)).collect();
    refuse_topic(folder)?;
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

/// Refuses a folder that has the name of a verb: `man convert` is more likely meant to show a page.
fn refuse_topic(folder: &Path) -> Result<()> {
    let topic = folder.to_str().filter(|name| verbs().any(|verb| verb == *name) || SpecKind::of(name).is_some());
    let Some(topic) = topic else { return Ok(()) };
    Err(usage(format!(
        "man takes a folder for its pages, but {topic} is a topic of help: 'cosmorama help {topic}' prints it; for a folder of \
         this name write ./{topic}"
    )))
}

fn write_page(file: &Path, text: &str, console: &Console) -> Result<()> {
    let mut pending = Pending::create(file, &console.unfinished)?;
    pending.writer().write_all(text.as_bytes())?;
    pending.finish()?;
    console.print(&format!("{}\n", file.display()))
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
        // A full stop or an apostrophe at the beginning of a line would make it a command.
        if escaped.starts_with(['.', '\'']) { format!("\\&{escaped}\n") } else { escaped + "\n" }
    };
    format!(".SH \"{heading}\"\n.nf\n{}.fi\n", text.trim_end().lines().map(line).collect::<String>())
}
