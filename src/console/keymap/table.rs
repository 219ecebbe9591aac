//! The key table: every action, its name, its default keys, where it is valid and what it does, in one place.
//!
//! Help, the key line, `valet keys` and the man page are made from it.

/// One of the screens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Screen {
    /// What the robot is doing.
    #[default]
    Trial,
    /// Force as it comes in and as the detector sees it.
    Force,
    /// Paths and way-points.
    Path,
    /// The strategies side by side.
    Strategies,
    /// Topics, master, robot, recorder.
    Health,
    /// What happened.
    Log,
}

impl Screen {
    /// All screens, in the order of their tabs.
    pub const ALL: [Self; 6] = [Self::Trial, Self::Force, Self::Path, Self::Strategies, Self::Health, Self::Log];

    /// The screen's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trial => "trial",
            Self::Force => "force",
            Self::Path => "path",
            Self::Strategies => "strategies",
            Self::Health => "health",
            Self::Log => "log",
        }
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// On which screens a key is valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scope(u8);

impl Scope {
    const ALL: Self = Self(0b11_1111);
    const TRIAL: Self = Self(Screen::Trial.bit());
    const FORCE: Self = Self(Screen::Force.bit());
    const PATH: Self = Self(Screen::Path.bit());
    const LOG: Self = Self(Screen::Log.bit());
    const ALL_BUT_LOG: Self = Self(Self::ALL.0 & !Self::LOG.0);

    /// True where the key is valid on a screen.
    #[must_use]
    pub const fn contains(self, screen: Screen) -> bool {
        self.0 & screen.bit() != 0
    }

    /// True where two scopes share a screen.
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The scope in words.
    #[must_use]
    pub fn words(self) -> String {
        if self == Self::ALL {
            return "everywhere".into();
        }
        let names: Vec<_> =
            Screen::ALL.iter().filter(|screen| self.contains(**screen)).map(|screen| screen.name()).collect();
        names.join(", ")
    }
}

/// What an action asks before it acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guard {
    /// Nothing: it cannot move the robot.
    None,
    /// Nothing, and nothing may come between: the emergency stop.
    Immediate,
    /// Enter on a dialog that names what will move; its default is No.
    Asks,
    /// A word to be typed.
    TypedWord,
}

impl Guard {
    /// The guard in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Immediate => "immediate",
            Self::Asks => "asks first",
            Self::TypedWord => "typed word",
        }
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What is done.
    pub action: Action,
    /// Its name in the configuration's `[console.keys]` table.
    pub name: &'static str,
    /// Its default keys.
    pub keys: &'static [&'static str],
    /// Where it is valid.
    pub scope: Scope,
    /// What it asks first.
    pub guard: Guard,
    /// A word for the key line; empty where it is not shown there.
    pub short: &'static str,
    /// What it does.
    pub text: &'static str,
}

macro_rules! actions {
    ($($action:ident $name:literal $keys:expr, $scope:ident, $guard:ident, $short:literal, $text:literal;)*) => {
        /// Everything that a key can do.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Action { $(#[doc = $text] $action,)* }

        /// The table, in the order in which help shows it.
        pub const TABLE: &[Entry] = &[$(Entry {
            action: Action::$action, name: $name, keys: &$keys, scope: Scope::$scope,
            guard: Guard::$guard, short: $short, text: $text,
        },)*];
    };
}

actions! {
    Stop "stop" ["space"], ALL, Immediate, "EMERGENCY STOP",
        "Emergency stop (software), at once, in every dialog and text field too";
    StopAndQuit "stop_and_quit" ["ctrl-c"], ALL, Immediate, "",
        "Emergency stop (software), then ask whether to quit; a second time quits";
    HoldOrContinue "hold" ["p"], ALL, Asks, "hold/continue", "Hold at once; when holding, continue (asks first); in a replay: pause or go on";
    Run "run" ["c"], ALL, None, "run", "Hold to run, where it is chosen: the arms move only as long as this key is held down";
    GoAhead "go_ahead" ["enter"], TRIAL, Asks, "go ahead", "Answer what the trial waits for: names what will move";
    NextStep "next_step" ["n"], TRIAL, Asks, "next step", "Next step of the table";
    PreviousStep "previous_step" ["b"], TRIAL, Asks, "", "Previous step of the table: by withdrawing the garment";
    NextIteration "next_iteration" ["i"], TRIAL, Asks, "iteration", "Run the next iteration";
    FinishAfterThis "finish" ["I"], TRIAL, None, "finish", "Finish the arm after this iteration";
    Withdraw "withdraw" ["W"], ALL, Asks, "withdraw", "Withdraw the garment along the travelled path";
    Abort "abort" ["A"], ALL, Asks, "abort", "Give the trial up; the arms hold where they are";
    Start "start" ["S"], ALL, Asks, "start", "Start a trial, or take it up again";
    Reset "reset" ["R"], ALL, TypedWord, "reset", "Clear the stop: moves nothing, the robot stays disabled";
    Enable "enable" ["E"], ALL, Asks, "enable", "Switch the robot's motors on";
    Disable "disable" ["D"], ALL, Asks, "", "Switch the robot's motors off: the arms may sink";
    StrategyGmm "strategy_gmm" ["3"], ALL, Asks, "gmm", "Strategy of chapter 3, at the next safe point";
    StrategyForce "strategy_force" ["4"], ALL, Asks, "force", "Strategy of chapter 4, at the next safe point";
    StrategyMultimodal "strategy_multimodal" ["5"], ALL, Asks, "multimodal", "Strategy of chapter 5, at the next safe point";
    StrategyList "strategies" ["s"], ALL_BUT_LOG, Asks, "strategies", "Choose from all strategies";
    Profile "profile" ["u"], TRIAL, None, "profile", "Choose the person's profile, before a trial";
    Garment "garment" ["v"], TRIAL, None, "garment", "Choose the garment, before a trial";
    FirstArm "first_arm" ["y"], TRIAL, None, "arm", "Choose which arm is dressed first, before a trial";
    Settings "settings" [","], ALL, None, "settings", "Thresholds and step size: change within limits, undo";
    RecordMovement "record_movement" ["M"], TRIAL, None, "movement", "Record the person's movement for the movement space";
    Tare "tare" ["t"], FORCE, None, "tare", "Take the present force of the focused arm as zero; only when still";
    SignCheck "sign_check" ["z"], FORCE, None, "sign check", "Check the sign of the focused arm's wrench";
    Record "record" ["r"], ALL, None, "record", "Recording on; off asks first";
    Note "note" ["o"], ALL, None, "note", "Write a note into the record (type _ for a space)";
    Trial "trial" ["T"], ALL, None, "", "Screen: trial";
    Force "force" ["F"], ALL, None, "", "Screen: force";
    Path "path" ["P"], ALL, None, "", "Screen: path";
    Strategies "compare" ["C"], ALL, None, "", "Screen: strategies compared";
    Health "health" ["H"], ALL, None, "", "Screen: health";
    Log "log" ["L"], ALL, None, "", "Screen: log";
    Waypoints "waypoints" ["w"], PATH, None, "way-points", "Way-point table large or small";
    Freeze "freeze" ["f"], ALL, None, "freeze", "Freeze plots, paths and log; the stop state stays live";
    ZoomIn "zoom_in" ["+", "="], FORCE, None, "zoom", "Show a shorter time";
    ZoomOut "zoom_out" ["-"], FORCE, None, "", "Show a longer time";
    ZoomReset "zoom_reset" ["0"], FORCE, None, "", "Show the usual time";
    FixedScale "fixed_scale" ["a"], FORCE, None, "scale", "Force axis fixed or fitted to the data";
    PreviousMark "previous_mark" ["["], FORCE, None, "mark", "Select the resistance before";
    NextMark "next_mark" ["]"], FORCE, None, "", "Select the resistance after";
    OpenMark "open_mark" ["enter"], FORCE, None, "to its line", "Show the log line of the selected resistance";
    LogLevel "log_level" ["v"], LOG, None, "level", "Least grave level that is shown";
    LogSolo "log_solo" ["s"], LOG, None, "solo", "Show only the source of the selected line, or all again";
    LogMute "log_mute" ["x"], LOG, None, "mute", "Hide the source of the selected line, or show all again";
    LogInvert "log_invert" ["!"], LOG, None, "invert", "Show what the filter would hide";
    Filter "filter" ["/"], ALL, None, "filter", "Filter the list of this screen";
    NextPane "next_pane" ["tab"], ALL, None, "arm", "Focus the other arm";
    PreviousPane "previous_pane" ["shift-tab"], ALL, None, "", "Focus the other arm";
    Up "up" ["up", "k"], ALL, None, "", "Up";
    Down "down" ["down", "j"], ALL, None, "", "Down";
    Left "left" ["left", "h"], ALL, None, "", "The screen to the left";
    Right "right" ["right", "l"], ALL, None, "", "The screen to the right";
    PageUp "page_up" ["page-up"], ALL, None, "", "A page up";
    PageDown "page_down" ["page-down"], ALL, None, "", "A page down";
    Top "top" ["g", "home"], ALL, None, "", "To the top";
    Bottom "bottom" ["G", "end"], ALL, None, "", "To the bottom; the log follows again";
    ReplayStep "replay_step" ["."], ALL, None, "step", "Replay: one step";
    ReplaySlower "replay_slower" ["{"], ALL, None, "slower", "Replay: half the speed";
    ReplayFaster "replay_faster" ["}"], ALL, None, "faster", "Replay: twice the speed";
    ReplayBack "replay_back" ["<"], ALL, None, "back", "Replay: ten seconds back";
    ReplayForward "replay_forward" [">"], ALL, None, "on", "Replay: ten seconds on";
    Help "help" ["?", "f1"], ALL, None, "help", "This help";
    Back "back" ["esc"], ALL, None, "", "Clear the filter, close the dialog, go back; never stops or starts anything";
    Redraw "redraw" ["ctrl-l"], ALL, None, "", "Draw everything anew";
    Mouse "mouse" ["m"], ALL, None, "", "Mouse on or off: it only focuses and scrolls";
    Suspend "suspend" ["ctrl-z"], ALL, None, "", "Leave the screen for the shell; refused while an arm may move";
    Quit "quit" ["q"], ALL, Asks, "quit", "Leave; while a trial runs the arm holds first and it asks";
}

impl Action {
    /// The action's row of the table.
    #[must_use]
    pub fn entry(self) -> Option<&'static Entry> {
        TABLE.iter().find(|entry| entry.action == self)
    }
}
