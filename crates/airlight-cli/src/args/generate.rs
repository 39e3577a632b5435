//! Options of `airlight completions` and `airlight man`.

use clap::Args;
use clap_complete::Shell;
use std::path::PathBuf;

/// Options of `airlight completions`.
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS)]
pub struct CompletionsArgs {
    /// Shell that reads the completions
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

const COMPLETIONS: &str = "\
Examples:
  airlight completions bash > ~/.local/share/bash-completion/completions/airlight
  airlight completions zsh > ~/.zfunc/_airlight
  airlight completions fish > ~/.config/fish/completions/airlight.fish";

/// Options of `airlight man`.
#[derive(Debug, Args)]
#[command(after_help = MAN)]
pub struct ManArgs {
    /// Folder for the pages, such as ~/.local/share/man/man1; it is made if it does not exist
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
}

const MAN: &str = "\
Examples:
  airlight man ~/.local/share/man/man1 && man airlight-sky";
