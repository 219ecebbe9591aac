//! The faults of the simulated world as arguments: `--fault` for a given one, `--fault-seed` for one that a seed draws.

use crate::sim::faults::{Fault, FaultPlan, TypedFaultError};

/// A fault that a seed draws begins within this time, in seconds: trials of both arms take 90 to 170 s.
const DRAWN_WITHIN_SECONDS: f64 = 90.0;

/// What goes wrong in the simulated world.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct FaultArguments {
    /// Something that goes wrong, any number of times: KIND[=VALUE]@SECONDS[+SECONDS][:SIDE], as in `stale_force@20+3:right`.
    ///
    /// Kinds: `stale_force`, `frozen_force`, `biased_force=X,Y,Z` (newtons), `not_a_number_force`, `lost_camera`, `lost_pose`,
    /// `late_commands=SECONDS`, `dropped_commands=SHARE`, `stale_joints`, `joint_fault`, `red_button`, snag, `garment_slip`,
    /// `pull_away=METRES`. Without +SECONDS it lasts, without a side it is both. Seconds count from the simulator's start.
    /// The table of a file of faults is taken too: `kind = "lost_pose", from_seconds = 20, duration_seconds = 5`.
    #[arg(long, value_name = "FAULT", value_parser = fault)]
    fault: Vec<Fault>,
    /// One more fault, drawn from this seed.
    #[arg(long, value_name = "SEED")]
    fault_seed: Option<u64>,
}

/// Reads a fault in its short form, or as the table of a file.
fn fault(text: &str) -> Result<Fault, String> {
    #[derive(serde::Deserialize)]
    struct Typed {
        fault: Fault,
    }
    if !text.trim_start().starts_with("kind") {
        return text.parse().map_err(|error: TypedFaultError| error.to_string());
    }
    let typed: Result<Typed, _> = toml::from_str(&format!("fault = {{ {text} }}"));
    typed.map(|typed| typed.fault).map_err(|error| error.message().to_owned())
}

impl FaultArguments {
    /// What the simulated world is told.
    pub(super) fn plan(&self) -> FaultPlan {
        let drawn = self.fault_seed.map(|seed| FaultPlan::from_seed(seed, DRAWN_WITHIN_SECONDS));
        let drawn = drawn.unwrap_or_default().faults;
        FaultPlan { faults: self.fault.iter().copied().chain(drawn).collect() }
    }

    /// The same as it is typed, for a simulator that is a process of its own.
    pub(super) fn typed(&self) -> Vec<String> {
        let faults = self.fault.iter().flat_map(|fault| ["--fault".to_owned(), fault.to_string()]);
        let seed = self.fault_seed.iter().flat_map(|seed| ["--fault-seed".to_owned(), seed.to_string()]);
        faults.chain(seed).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Typed {
        #[command(flatten)]
        faults: FaultArguments,
    }

    fn typed(arguments: &[String]) -> FaultArguments {
        Typed::parse_from(std::iter::once("valet".to_owned()).chain(arguments.iter().cloned())).faults
    }

    #[test]
    fn what_is_typed_reaches_the_simulators_process_unchanged() {
        let words = ["--fault", "biased_force=5,0,-1@20+3:right", "--fault", "snag@4.5", "--fault-seed", "7"];
        let here = typed(&words.map(str::to_owned));
        assert_eq!(here.plan().faults.len(), 3);
        assert_eq!(typed(&here.typed()).plan(), here.plan());
        assert_eq!(here.plan().faults[2..], FaultPlan::from_seed(7, DRAWN_WITHIN_SECONDS).faults);
    }

    #[test]
    fn the_table_of_a_file_says_the_same_as_the_short_form() {
        let table = "kind = \"lost_pose\", from_seconds = 20, duration_seconds = 5";
        assert_eq!(fault(table), fault("lost_pose@20+5"));
        let pulled = "kind = \"pull_away\", metres = 0.1, side = \"left\", from_seconds = 1";
        assert_eq!(fault(pulled), fault("pull_away=0.1@1:left"));
        for (typed, word) in
            [("kind = \"sneeze\", from_seconds = 1", "sneeze"), ("kind = \"lost_pose\"", "from_seconds")]
        {
            let refused = fault(typed).unwrap_err();
            assert!(refused.contains(word), "{refused}");
        }
        assert!(fault("gout@1").unwrap_err().contains("lost_pose"));
    }

    #[test]
    fn without_a_fault_nothing_goes_wrong() {
        assert!(typed(&[]).plan().faults.is_empty() && typed(&[]).typed().is_empty());
    }
}
