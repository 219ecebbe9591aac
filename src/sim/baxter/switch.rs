//! Baxter's switch: enabled, stopped, the red button and what clears what (`baxter_core_msgs/AssemblyState`).

use crate::assembly::{RedButton, RobotState, StopSource, SwitchRequest};
use crate::time::Stamp;
use std::time::Duration;

/// How long after Enable the robot says that it is not yet ready (homing), an assumption.
const HOMING: Duration = Duration::from_millis(500);

/// The robot's switch. A stop latches; Reset clears it only where its cause is gone, and leaves the robot disabled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switch {
    enabled: bool,
    enabled_since: Option<Stamp>,
    stopped: bool,
    button: RedButton,
    source: StopSource,
    fault_present: bool,
}

impl Switch {
    /// True where the motors are on.
    #[must_use]
    pub const fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// What somebody asks of the switch at `now`. What the robot would ignore is ignored here.
    pub fn ask(&mut self, request: SwitchRequest, now: Stamp) {
        match request {
            SwitchRequest::Stop => self.software_stop(),
            SwitchRequest::Reset => self.reset(),
            SwitchRequest::Enable => self.enable(now),
            SwitchRequest::Disable => self.motors_off(),
        }
    }

    /// The red button goes down (`true`) or comes up.
    pub fn press_red_button(&mut self, down: bool) {
        if down {
            self.motors_off();
            (self.stopped, self.button, self.source) = (true, RedButton::Pressed, StopSource::User);
        } else if self.button == RedButton::Pressed {
            self.button = RedButton::Released;
        }
    }

    /// A joint's fault appears (`true`) or goes away; the latch stays until Reset.
    pub fn joint_fault(&mut self, present: bool) {
        if present && !self.fault_present {
            self.motors_off();
            self.stopped = true;
            if self.button != RedButton::Pressed {
                self.source = StopSource::Fault;
            }
        }
        self.fault_present = present;
    }

    /// The state as the robot reports it at `now`.
    #[must_use]
    pub fn state(&self, now: Stamp) -> RobotState {
        let homed = self.enabled_since.is_some_and(|since| now.since(since) >= HOMING);
        RobotState {
            stamp: now,
            ready: Some(self.enabled && homed),
            enabled: self.enabled,
            stopped: self.stopped,
            error: self.fault_present,
            button: self.button,
            source: self.source,
        }
    }

    fn software_stop(&mut self) {
        self.motors_off();
        self.stopped = true;
        // A stop by software does not hide a pressed button or a fault.
        if matches!(self.source, StopSource::None) {
            (self.button, self.source) = (RedButton::Unknown, StopSource::Unknown);
        }
    }

    fn reset(&mut self) {
        self.motors_off();
        if self.button != RedButton::Pressed && !self.fault_present {
            (self.stopped, self.button, self.source) = (false, RedButton::Unpressed, StopSource::None);
        }
    }

    fn enable(&mut self, now: Stamp) {
        if !self.stopped && !self.enabled {
            self.enabled = true;
            self.enabled_since = Some(now);
        }
    }

    const fn motors_off(&mut self) {
        self.enabled = false;
        self.enabled_since = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: Stamp = Stamp::from_nanoseconds(1_000_000_000);

    fn enabled() -> Switch {
        let mut switch = Switch::default();
        switch.ask(SwitchRequest::Enable, NOW);
        switch
    }

    #[test]
    fn a_stopped_robot_is_not_enabled_before_reset_and_reset_leaves_it_disabled() {
        let mut switch = enabled();
        switch.ask(SwitchRequest::Stop, NOW);
        let state = switch.state(NOW);
        assert_eq!((state.enabled, state.stopped), (false, true));
        assert_eq!((state.button, state.source), (RedButton::Unknown, StopSource::Unknown));
        switch.ask(SwitchRequest::Enable, NOW);
        assert!(!switch.is_enabled());
        switch.ask(SwitchRequest::Reset, NOW);
        assert!(!switch.state(NOW).stopped && !switch.is_enabled());
        switch.ask(SwitchRequest::Enable, NOW);
        assert!(switch.is_enabled());
    }

    #[test]
    fn the_red_button_latches_until_it_is_up_and_reset() {
        let mut switch = enabled();
        switch.press_red_button(true);
        switch.ask(SwitchRequest::Reset, NOW);
        assert_eq!(switch.state(NOW).button, RedButton::Pressed);
        assert!(switch.state(NOW).stopped);
        switch.press_red_button(false);
        assert_eq!((switch.state(NOW).button, switch.state(NOW).source), (RedButton::Released, StopSource::User));
        assert!(switch.state(NOW).stopped);
        switch.ask(SwitchRequest::Reset, NOW);
        assert_eq!(switch.state(NOW), RobotState { stamp: NOW, ready: Some(false), ..RobotState::default() });
    }

    #[test]
    fn a_software_stop_does_not_hide_a_pressed_button() {
        let mut switch = enabled();
        switch.press_red_button(true);
        switch.ask(SwitchRequest::Stop, NOW);
        assert_eq!((switch.state(NOW).button, switch.state(NOW).source), (RedButton::Pressed, StopSource::User));
    }

    #[test]
    fn a_joint_fault_cannot_be_reset_while_it_lasts() {
        let mut switch = enabled();
        switch.joint_fault(true);
        assert_eq!(switch.state(NOW).source, StopSource::Fault);
        switch.ask(SwitchRequest::Reset, NOW);
        assert!(switch.state(NOW).stopped && switch.state(NOW).error);
        switch.joint_fault(false);
        switch.ask(SwitchRequest::Reset, NOW);
        assert!(!switch.state(NOW).stopped);
    }

    #[test]
    fn ready_comes_after_homing() {
        let switch = enabled();
        assert_eq!(switch.state(NOW).ready, Some(false));
        assert_eq!(switch.state(NOW + HOMING).ready, Some(true));
    }
}
