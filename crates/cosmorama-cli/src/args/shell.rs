use clap::Args;
use clap_complete::Shell;

/// Print a shell's completion script.
#[derive(Debug, Args)]
#[command(before_help = "Examples:
  cosmorama completions bash > ~/.local/share/bash-completion/completions/cosmorama
  cosmorama completions zsh > ~/.zfunc/_cosmorama")]
pub(crate) struct CompletionsArgs {
    /// Which shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}
