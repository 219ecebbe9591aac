//! What a seed brings: the person, the settings, the faults, the lane, the clock and the operator of one trial.

use super::lane::LanePlan;
use crate::sim::WorldSetup;
use crate::sim::faults::FaultPlan;
use crate::strategy::StrategyKind;
use crate::supervisor::Setup;
use crate::time::Stamp;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::time::Duration;

/// Stream of the seed's generator from which the plan is drawn; lane and operator have their own.
const PLAN_STREAM: u64 = 101;

/// A step of the computer's clock.
#[derive(Clone, Copy, Debug)]
struct ClockJump {
    at_seconds: f64,
    by_seconds: f64,
}

/// One trial before it begins.
#[derive(Clone, Debug)]
pub(super) struct TrialPlan {
    pub(super) setup: Setup,
    pub(super) world: WorldSetup,
    pub(super) lane: LanePlan,
    /// Beats of 10 ms after which the trial's time is up.
    pub(super) beats: u32,
    /// Share of the operator's looks at which something is done that makes no sense.
    pub(super) errs: f64,
    jump: Option<ClockJump>,
    /// When the robot's computer goes down, in seconds: it comes back with its motors off.
    restart: Option<f64>,
}

impl TrialPlan {
    pub(super) fn from_seed(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(PLAN_STREAM);
        // Two in five trials are calm, and long enough for passes of the garment; the others are rough and short.
        let calm = random.random_bool(0.4);
        let seconds = if calm { random.random_range(40.0..120.0) } else { random.random_range(8.0..45.0) };
        let mut setup = Setup { seed, ..Setup::default() };
        // Without a person's movement space there are chapter 4's strategy and none other.
        setup.settings.strategy = StrategyKind::Force;
        setup.settings.trial.goal_interval_seconds = random.random_range(0.0..3.0);
        let mut world = WorldSetup { seed, ..WorldSetup::default() };
        if random.random_bool(0.7) {
            world.faults = FaultPlan::from_seed(seed, seconds);
        }
        if random.random_bool(0.3) {
            world.faults.faults.extend(FaultPlan::from_seed(seed ^ 0x5EED, seconds).faults);
        }
        world.wrench.noise_newtons = random.random_range(0.05..if calm { 0.4 } else { 2.0 });
        let mut lane = if calm { LanePlan::default() } else { LanePlan::draw(&mut random, seconds) };
        let errs = if !calm && random.random_bool(0.5) { random.random_range(0.0..0.2) } else { 0.0 };
        let jump = random.random_bool(0.2).then(|| ClockJump::draw(&mut random, seconds));
        let restart = random.random_bool(0.1).then(|| random.random_range(1.0..seconds));
        if let Some(at) = restart {
            lane.silence_everything(at, at + random.random_range(0.5..5.0));
        }
        Self { setup, world, lane, beats: beats(seconds), errs, jump, restart }
    }

    /// True in the beat in which the robot's computer goes down.
    pub(super) fn restarts(&self, seconds: f64) -> bool {
        self.restart.is_some_and(|at| (at..at + 0.01).contains(&seconds))
    }

    /// What this computer's clock shows when the robot's shows `world_time`.
    pub(super) fn clock(&self, start: Stamp, world_time: Stamp) -> Stamp {
        let Some(jump) = self.jump.filter(|jump| world_time.since(start).as_secs_f64() >= jump.at_seconds) else {
            return world_time;
        };
        let by = Duration::from_secs_f64(jump.by_seconds.abs());
        if jump.by_seconds >= 0.0 {
            return world_time + by;
        }
        let back = world_time.since(Stamp::ZERO).saturating_sub(by);
        Stamp::ZERO + back
    }
}

impl ClockJump {
    fn draw(random: &mut impl Rng, seconds: f64) -> Self {
        let by: f64 = random.random_range(0.05..20.0);
        let back = random.random_bool(0.5);
        Self { at_seconds: random.random_range(1.0..seconds), by_seconds: if back { -by } else { by } }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand beats")]
fn beats(seconds: f64) -> u32 {
    (seconds * 100.0) as u32
}
