//! Roles instead of colours, and glyphs instead of letters in the code: four themes, Unicode and ASCII.
//!
//! State is always a word, a symbol and a colour together, so that taking any one away loses nothing.

use super::options::{ColourChoice, ConsoleOptions, GlyphChoice, ThemeName};
use crate::snapshot::Verdict;
use ratatui::style::{Color, Modifier, Style};

/// What a piece of the screen means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Ordinary text.
    Text,
    /// Less important.
    Muted,
    /// A heading.
    Title,
    /// Frames.
    Border,
    /// The frame that has the focus, and what is selected.
    Focus,
    /// As it should be.
    Good,
    /// Look at this.
    Late,
    /// Not fresh.
    Stale,
    /// Broken.
    Fault,
    /// The emergency stop.
    Stop,
    /// A threshold line.
    Threshold,
    /// Curves of force.
    Curve,
    /// Marks of resistance.
    Resistance,
    /// The path that was planned.
    Planned,
    /// The path that was travelled.
    Travelled,
    /// The path as it has become.
    Updated,
    /// The movement space.
    Space,
    /// The person.
    Person,
    /// A key in a hint.
    Key,
    /// What kind of run this is.
    Watermark,
}

/// How everything looks: theme and glyphs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Colours.
    pub theme: ThemeName,
    /// True where only ASCII may be written.
    pub ascii: bool,
}

/// Glyphs of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Glyphs {
    /// As it should be.
    pub good: char,
    /// Look at this.
    pub late: char,
    /// Not fresh.
    pub stale: char,
    /// Broken.
    pub fault: char,
    /// Stopped.
    pub stopped: char,
    /// A resistance.
    pub star: char,
    /// A gripper.
    pub gripper: char,
    /// A way-point.
    pub waypoint: char,
    /// Resistance on a time axis.
    pub mark: char,
    /// A gap in data.
    pub gap: char,
    /// A horizontal line of a threshold.
    pub dash: char,
    /// A full part of a bar.
    pub full: char,
    /// An empty part of a bar.
    pub hollow: char,
    /// Goes to.
    pub arrow: &'static str,
    /// Between two facts on a line.
    pub dot: &'static str,
    /// In the place of a value that is not known.
    pub none: &'static str,
}

const UNICODE: Glyphs = Glyphs {
    good: '●',
    late: '▲',
    stale: '◌',
    fault: '✖',
    stopped: '■',
    star: '★',
    gripper: '◆',
    waypoint: '○',
    mark: '▼',
    gap: '╱',
    dash: '┈',
    full: '█',
    hollow: '░',
    arrow: "→",
    dot: "·",
    none: "—",
};

const ASCII: Glyphs = Glyphs {
    good: 'o',
    late: '^',
    stale: '?',
    fault: 'X',
    stopped: '#',
    star: '*',
    gripper: '@',
    waypoint: 'o',
    mark: 'v',
    gap: '/',
    dash: '-',
    full: '#',
    hollow: '.',
    arrow: "->",
    dot: "|",
    none: "-",
};

impl Look {
    /// The look that options and surroundings ask for. `environment` looks up a variable of the process.
    #[must_use]
    pub fn from_options(options: &ConsoleOptions, environment: impl Fn(&str) -> Option<String>) -> Self {
        let set = |name: &str| environment(name).filter(|value| !value.is_empty());
        let colourless = set("NO_COLOR").is_some() || set("TERM").is_some_and(|term| term == "dumb");
        let mono = match options.colour {
            ColourChoice::Auto => colourless,
            ColourChoice::Always => false,
            ColourChoice::Never => true,
        };
        let ascii = match options.glyphs {
            GlyphChoice::Auto => !says_utf8(set),
            GlyphChoice::Unicode => false,
            GlyphChoice::Ascii => true,
        };
        Self { theme: if mono { ThemeName::Mono } else { options.theme }, ascii }
    }

    /// The glyphs.
    #[must_use]
    pub const fn glyphs(&self) -> &'static Glyphs {
        if self.ascii { &ASCII } else { &UNICODE }
    }

    /// The style of a role.
    #[must_use]
    pub fn style(&self, role: Role) -> Style {
        match self.theme {
            ThemeName::Terminal => terminal(role),
            ThemeName::HighContrast => high_contrast(role),
            ThemeName::Mono => mono(role),
            ThemeName::OkabeIto => okabe_ito(role),
        }
    }

    /// Symbol and role of a verdict.
    #[must_use]
    pub const fn verdict(&self, verdict: Verdict) -> (char, Role) {
        let glyphs = self.glyphs();
        match verdict {
            Verdict::Good => (glyphs.good, Role::Good),
            Verdict::Late => (glyphs.late, Role::Late),
            Verdict::Stale => (glyphs.stale, Role::Stale),
            Verdict::Fault => (glyphs.fault, Role::Fault),
        }
    }
}

/// The locale's own word, in the order in which a C library reads it.
fn says_utf8(set: impl Fn(&str) -> Option<String>) -> bool {
    let locale = set("LC_ALL").or_else(|| set("LC_CTYPE")).or_else(|| set("LANG")).unwrap_or_default();
    let locale = locale.to_ascii_lowercase();
    locale.contains("utf-8") || locale.contains("utf8")
}

/// Weight that every theme shares: the mono theme is this and nothing else.
fn mono(role: Role) -> Style {
    let style = Style::new();
    match role {
        Role::Stop => style.add_modifier(Modifier::REVERSED | Modifier::BOLD),
        Role::Fault | Role::Stale | Role::Focus | Role::Watermark => style.add_modifier(Modifier::REVERSED),
        Role::Late | Role::Title | Role::Key | Role::Resistance => style.add_modifier(Modifier::BOLD),
        Role::Threshold => style.add_modifier(Modifier::UNDERLINED),
        Role::Muted | Role::Border | Role::Planned | Role::Space => style.add_modifier(Modifier::DIM),
        Role::Text | Role::Good | Role::Curve | Role::Travelled | Role::Updated | Role::Person => style,
    }
}

/// The terminal's own palette. No blue on the terminal's background: it is unreadable on many.
fn terminal(role: Role) -> Style {
    let style = mono(role);
    match role {
        Role::Stop => Style::new().fg(Color::White).bg(Color::Red).add_modifier(Modifier::BOLD),
        Role::Fault | Role::Resistance => style.fg(Color::Red),
        Role::Late | Role::Threshold => style.fg(Color::Yellow),
        Role::Stale | Role::Watermark | Role::Space => style.fg(Color::Magenta),
        Role::Good | Role::Updated => style.fg(Color::Green),
        Role::Focus | Role::Key | Role::Curve | Role::Travelled => style.fg(Color::Cyan),
        Role::Text | Role::Title | Role::Muted | Role::Border | Role::Planned | Role::Person => style,
    }
}

fn high_contrast(role: Role) -> Style {
    let style = mono(role).remove_modifier(Modifier::DIM).bg(Color::Black);
    match role {
        Role::Stop => Style::new().fg(Color::White).bg(Color::Red).add_modifier(Modifier::BOLD),
        Role::Fault | Role::Resistance => style.fg(Color::LightRed),
        Role::Late | Role::Threshold => style.fg(Color::LightYellow),
        Role::Stale | Role::Watermark | Role::Space => style.fg(Color::LightMagenta),
        Role::Good | Role::Updated => style.fg(Color::LightGreen),
        Role::Focus | Role::Key | Role::Curve | Role::Travelled => style.fg(Color::LightCyan),
        Role::Text | Role::Title | Role::Muted | Role::Border | Role::Planned | Role::Person => style.fg(Color::White),
    }
}

/// Okabe and Ito, "Color Universal Design" (2008): told apart with every common form of colour vision.
fn okabe_ito(role: Role) -> Style {
    const ORANGE: Color = Color::Rgb(230, 159, 0);
    const SKY_BLUE: Color = Color::Rgb(86, 180, 233);
    const BLUISH_GREEN: Color = Color::Rgb(0, 158, 115);
    const VERMILLION: Color = Color::Rgb(213, 94, 0);
    const REDDISH_PURPLE: Color = Color::Rgb(204, 121, 167);
    let style = mono(role);
    match role {
        Role::Stop => Style::new().fg(Color::Rgb(255, 255, 255)).bg(VERMILLION).add_modifier(Modifier::BOLD),
        Role::Fault | Role::Resistance => style.fg(VERMILLION),
        Role::Late | Role::Threshold => style.fg(ORANGE),
        Role::Stale | Role::Watermark | Role::Space => style.fg(REDDISH_PURPLE),
        Role::Good | Role::Updated => style.fg(BLUISH_GREEN),
        Role::Focus | Role::Key | Role::Curve | Role::Travelled => style.fg(SKY_BLUE),
        Role::Text | Role::Title | Role::Muted | Role::Border | Role::Planned | Role::Person => style,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(options: &ConsoleOptions, variables: &[(&str, &str)]) -> Look {
        Look::from_options(options, |name| {
            variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn no_color_means_the_mono_theme_and_not_an_empty_colour() {
        let options = ConsoleOptions::default();
        assert_eq!(look(&options, &[("NO_COLOR", "1")]).theme, ThemeName::Mono);
        assert_eq!(look(&options, &[("NO_COLOR", "")]).theme, ThemeName::Terminal);
        assert_eq!(look(&options, &[("TERM", "dumb")]).theme, ThemeName::Mono);
        let always = ConsoleOptions { colour: ColourChoice::Always, ..options };
        assert_eq!(look(&always, &[("NO_COLOR", "1")]).theme, ThemeName::Terminal);
    }

    #[test]
    fn the_locale_decides_on_glyphs_unless_told() {
        let options = ConsoleOptions::default();
        assert!(!look(&options, &[("LANG", "en_GB.UTF-8")]).ascii);
        assert!(look(&options, &[("LC_ALL", "C"), ("LANG", "en_GB.UTF-8")]).ascii);
        assert!(look(&options, &[]).ascii);
        let told = ConsoleOptions { glyphs: GlyphChoice::Unicode, ..options };
        assert!(!look(&told, &[]).ascii);
    }

    #[test]
    fn the_mono_theme_has_no_colour_and_still_tells_a_stop_from_text() {
        let mono = Look { theme: ThemeName::Mono, ascii: false };
        for role in [Role::Stop, Role::Fault, Role::Late, Role::Stale, Role::Good, Role::Threshold, Role::Key] {
            let style = mono.style(role);
            assert_eq!((style.fg, style.bg), (None, None), "{role:?}");
        }
        assert_ne!(mono.style(Role::Stop), mono.style(Role::Text));
    }
}
