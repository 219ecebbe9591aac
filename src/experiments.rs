//! The thesis' tables and figures, and valet's own, each from a command that anyone can run.
//!
//! [`EXPERIMENTS`] is the list: an experiment is a name and a function from a seed to [`Findings`]; writing them down as
//! lines, CSV files, plots and a page is done once for all. Nothing here is used while a trial runs.

pub mod chapter_5;
pub mod detectors;
pub mod figure_4_5;
pub mod findings;
pub mod garments;
pub mod joints;
pub mod mixtures;
pub mod synthetic;
pub mod table_3_2;
pub mod table_4_1;
pub mod table_4_2;
pub mod torture;
pub mod whole_arm;

pub use findings::{Drawing, ExperimentError, Findings, Row};

/// One experiment that `valet reproduce` can run.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// What is typed to run it.
    pub name: &'static str,
    /// Its heading on the page.
    pub title: &'static str,
    /// Runs it with a seed.
    pub run: fn(u64) -> Result<Findings, ExperimentError>,
}

/// All experiments, in the order in which `all` runs them: what trains on thousands of images comes last.
pub const EXPERIMENTS: &[Experiment] = &[
    Experiment { name: "table-4.1", title: "Table 4.1: optimisers on synthetic paths", run: table_4_1::run },
    Experiment { name: "figure-4.5", title: "Figure 4.5: examples of the iterations", run: figure_4_5::run },
    Experiment { name: "table-4.2", title: "Table 4.2: twelve simulated people", run: table_4_2::run },
    Experiment { name: "figure-4.6", title: "Figure 4.6: energy by iteration", run: table_4_2::energy_by_iteration },
    Experiment {
        name: "figure-4.7",
        title: "Figure 4.7: execution time by iteration",
        run: table_4_2::duration_by_iteration,
    },
    Experiment { name: "figures-4.9", title: "Figures 4.9 to 4.15: a worked example", run: table_4_2::worked_example },
    Experiment { name: "figures-5", title: "Figures 5.2 to 5.7: four scenes", run: chapter_5::figures },
    Experiment {
        name: "figures-5-real",
        title: "Figures 5.8 to 5.10: three kinds of movement limits",
        run: table_4_2::figures_5_real,
    },
    Experiment { name: "table-5", title: "Chapter 5 on 200 scenes", run: chapter_5::table },
    Experiment { name: "whole-arm", title: "One mixture for the whole arm", run: whole_arm::run },
    Experiment { name: "joints", title: "Joints of simulated people nobody has seen", run: joints::run },
    Experiment { name: "mixtures", title: "How many Gaussians the fit finds", run: mixtures::run },
    Experiment { name: "garments", title: "Both models of the garment against each other", run: garments::run },
    Experiment { name: "detectors", title: "Detectors of resistance on measured pulls", run: detectors::run },
    Experiment { name: "table-3.2", title: "Table 3.2: body parts by number of images", run: table_3_2::run },
];
