//! `valet shell`: man page and shell completions, for packagers; both come from the command line and the key table.

use super::CommandLine;
use super::exit::Failure;
use super::keys;
use clap::CommandFactory;
use clap_complete::Shell;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Man page and shell completions, for packagers.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// Print the completions of this shell.
    #[arg(long, value_name = "SHELL", conflicts_with = "man")]
    completions: Option<Shell>,
    /// Print the man page.
    #[arg(long)]
    man: bool,
    /// Write the man pages and the completions of all shells into this folder instead.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["man", "completions"])]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(folder) = &arguments.out {
        return write_all(folder);
    }
    let text = match (arguments.completions, arguments.man) {
        (Some(shell), _) => completions(shell),
        (None, true) => man_page()?,
        (None, false) => {
            let help = "shell: say --man, --completions bash (or zsh, fish, ...) or --out DIR";
            return Err(Failure::Configuration(help.into()));
        }
    };
    match std::io::stdout().write_all(&text) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::fault(error)),
        _ => Ok(()),
    }
}

fn completions(shell: Shell) -> Vec<u8> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut CommandLine::command(), "valet", &mut text);
    text
}

/// The man page of the whole command, with the key table as a section of its own.
fn man_page() -> Result<Vec<u8>, Failure> {
    let command = CommandLine::command();
    let mut text = Vec::new();
    clap_mangen::Man::new(command).render(&mut text).map_err(Failure::fault)?;
    // A leading dot or quote would be taken for a request by roff; a backslash for an escape.
    let escaped = |row: &str| row.replace('\\', "\\e").replace('-', "\\-");
    let rows: Vec<String> = keys::as_text().lines().map(|row| format!("\\&{}", escaped(row))).collect();
    text.extend_from_slice(b".SH \"KEYS OF THE CONSOLE\"\n.nf\n");
    text.extend_from_slice(rows.join("\n").as_bytes());
    text.extend_from_slice(b"\n.fi\n");
    Ok(text)
}

fn write_all(folder: &Path) -> Result<(), Failure> {
    let tell = |path: &Path, error: std::io::Error| Failure::Fault(format!("cannot write {}: {error}", path.display()));
    std::fs::create_dir_all(folder).map_err(|error| tell(folder, error))?;
    let write = |name: &str, text: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| tell(&path, error))
    };
    write("valet.1", &man_page()?)?;
    write("valet.bash", &completions(Shell::Bash))?;
    write("_valet", &completions(Shell::Zsh))?;
    write("valet.fish", &completions(Shell::Fish))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_man_page_has_the_stop_key_and_the_exit_codes() {
        let page = String::from_utf8(man_page().unwrap()).unwrap();
        assert!(page.contains("Emergency stop") && page.contains("KEYS OF THE CONSOLE"), "{page}");
        assert!(page.contains("no ROS master"), "{page}");
    }

    #[test]
    fn completions_know_the_commands() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let text = String::from_utf8(completions(shell)).unwrap();
            assert!(text.contains("torture") && text.contains("doctor"), "{shell}");
        }
    }

    #[test]
    fn everything_is_written_for_a_package() {
        let folder = tempfile::tempdir().unwrap();
        write_all(folder.path()).unwrap();
        for name in ["valet.1", "valet.bash", "_valet", "valet.fish"] {
            assert!(folder.path().join(name).metadata().unwrap().len() > 500, "{name}");
        }
    }
}
