//! How the screen looks, as typed: over what the configuration file says, and read anew when the process is told to.

use crate::config::{Places, Settings};
use crate::console::{ColourChoice, ConsoleOptions, GlyphChoice, ThemeName};
use std::path::PathBuf;

/// The screen.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct ScreenArguments {
    /// The colours of the screen.
    #[arg(long, value_enum)]
    theme: Option<Theme>,
    /// Whether colours are used at all.
    #[arg(long, value_enum, value_name = "WHEN")]
    color: Option<Colour>,
    /// Draw with ASCII alone.
    #[arg(long)]
    ascii: bool,
    /// Frames a second at the most; 10 is right for a slow ssh line.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=30))]
    fps: Option<u32>,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Theme {
    Terminal,
    HighContrast,
    Mono,
    OkabeIto,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Colour {
    Auto,
    Always,
    Never,
}

impl ScreenArguments {
    /// The options of the file with what was typed over them.
    pub(super) fn over(&self, file: &ConsoleOptions) -> ConsoleOptions {
        let mut options = file.clone();
        if let Some(theme) = self.theme {
            options.theme = match theme {
                Theme::Terminal => ThemeName::Terminal,
                Theme::HighContrast => ThemeName::HighContrast,
                Theme::Mono => ThemeName::Mono,
                Theme::OkabeIto => ThemeName::OkabeIto,
            };
        }
        if let Some(colour) = self.color {
            options.colour = match colour {
                Colour::Auto => ColourChoice::Auto,
                Colour::Always => ColourChoice::Always,
                Colour::Never => ColourChoice::Never,
            };
        }
        if self.ascii {
            options.glyphs = GlyphChoice::Ascii;
        }
        options.frames_per_second = self.fps.unwrap_or(options.frames_per_second);
        options
    }

    /// Reads the configuration file again, for theme and keys.
    pub(super) fn reader(&self, config: Option<PathBuf>) -> impl FnMut() -> Result<ConsoleOptions, String> + use<> {
        let typed = self.clone();
        move || {
            let settings = Settings::find(config.as_deref(), &Places::of_this_machine());
            settings.map(|settings| typed.over(settings.console())).map_err(|error| error.to_string())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_stands_over_the_file_and_the_rest_is_kept() {
        let file = ConsoleOptions { frames_per_second: 10, bell: true, ..ConsoleOptions::default() };
        let typed = ScreenArguments { theme: Some(Theme::OkabeIto), ascii: true, ..ScreenArguments::default() };
        let options = typed.over(&file);
        assert_eq!((options.theme, options.glyphs), (ThemeName::OkabeIto, GlyphChoice::Ascii));
        assert_eq!((options.frames_per_second, options.bell), (10, true));
        let never = ScreenArguments { color: Some(Colour::Never), fps: Some(5), ..ScreenArguments::default() };
        assert_eq!((never.over(&file).colour, never.over(&file).frames_per_second), (ColourChoice::Never, 5));
        assert_eq!(ScreenArguments::default().over(&file), file);
    }
}
