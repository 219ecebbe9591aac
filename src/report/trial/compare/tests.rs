use super::*;
use crate::record::{Header, JournalWriter};
use crate::strategy::IterationSummary;
use crate::supervisor::{Effect, Input, Setup};
use crate::time::Stamp;

fn pass(side: Side, strategy: StrategyKind, iteration: u32, energy: f64) -> Effect {
    let path = vec![crate::geometry::Point::new(0.8, -0.4, 0.1), crate::geometry::Point::new(0.7, -0.2, 0.3)];
    let summary = IterationSummary {
        iteration,
        contacts: 2,
        energy,
        mean_resistance: None,
        reachability: Some(0.5),
        path,
        ignored: 0,
        inside_share: None,
        finished: None,
    };
    Effect::Iteration { side, strategy, summary, duration_seconds: 10.0 }
}

/// A journal in which a strategy brings an arm from one energy to another.
fn trial(folder: &Path, strategy: StrategyKind, energies: [f64; 2]) -> TrialRecord {
    let mut writer = JournalWriter::create(folder, &Header::of(&Setup::default(), "", 0).unwrap()).unwrap();
    for (number, energy) in (1_u32..).zip(energies) {
        let now = Stamp::from_nanoseconds(u64::from(number) * 20_000_000_000);
        writer.step(now, &Input::Tick, &[pass(Side::Right, strategy, number, energy)], 0).unwrap();
    }
    // What the core decides now is another matter: the report says how many steps differ.
    let mut gathered = TrialRecord::gather(&writer.finish().unwrap()).unwrap();
    assert_eq!(gathered.differences, 2);
    gathered.iterations = energies
        .into_iter()
        .zip(1..)
        .map(|(energy, number)| {
            let Effect::Iteration { side, strategy, summary, duration_seconds } =
                pass(Side::Right, strategy, number, energy)
            else {
                panic!("an iteration")
            };
            let (planned, travelled, ellipses) = (summary.path.clone(), summary.path.clone(), Vec::new());
            Iteration { side, strategy, summary, duration_seconds, planned, travelled, ellipses }
        })
        .collect();
    gathered
}

#[test]
fn three_strategies_stand_side_by_side_with_their_means() {
    let folder = tempfile::tempdir().unwrap();
    let mut trials = vec![
        trial(folder.path(), StrategyKind::Gmm, [30.0, 21.0]),
        trial(folder.path(), StrategyKind::Force, [20.0, 10.0]),
        trial(folder.path(), StrategyKind::Force, [22.0, 12.0]),
        trial(folder.path(), StrategyKind::Multimodal, [18.0, 5.5]),
    ];
    for (number, trial) in (0..).zip(&mut trials) {
        trial.name = format!("trial-{number}");
    }
    let html = std::fs::read_to_string(compare(&trials, folder.path()).unwrap()).unwrap();
    let at = html.find("Strategies side by side</h2>").unwrap();
    let table = &html[at..];
    let heads: Vec<_> = ["gmm", "force", "multimodal"].map(|name| table.find(&format!(">{name}<")).unwrap()).into();
    assert!(heads.is_sorted(), "{heads:?}");
    for value in ["21.00", "11.00", "5.50", "0.50"] {
        assert!(table.contains(&format!(">{value}<")), "{value}");
    }
    assert!(
        folder.path().join("compared-energy.svg").exists() && folder.path().join("trial-3-last-right.png").exists()
    );
}

#[test]
fn a_strategy_that_was_not_run_has_no_column() {
    let folder = tempfile::tempdir().unwrap();
    let trials =
        [trial(folder.path(), StrategyKind::Gmm, [3.0, 2.0]), trial(folder.path(), StrategyKind::Gmm, [3.0, 2.0])];
    let html = std::fs::read_to_string(compare(&trials, folder.path()).unwrap()).unwrap();
    assert!(!html.contains(">multimodal<"));
}

#[test]
fn first_and_last_energy_of_a_trial_are_those_of_both_arms() {
    let folder = tempfile::tempdir().unwrap();
    let mut both = trial(folder.path(), StrategyKind::Force, [20.25, 10.5]);
    let other = trial(folder.path(), StrategyKind::Force, [7.25, 1.0]);
    let left = other.iterations.into_iter().map(|pass| Iteration { side: Side::Left, ..pass });
    both.iterations.extend(left);
    let row = trial_row(&both);
    assert_eq!(row[5..7], ["27.50".to_owned(), "11.50".to_owned()], "{row:?}");
}
