//! Body sizes from ANSUR II (US Army, 2012, public data): regressions on stature and mass with their residual spread.
//!
//! The people measured there were fit adults, not elderly or disabled persons.

use super::super::random::{Purpose, Random};
use super::{ArmSizes, PersonError};
use serde::{Deserialize, Serialize};

/// Which of ANSUR II's two tables holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Sex {
    /// 1,986 women.
    #[default]
    Female,
    /// 4,082 men.
    Male,
}

/// Sizes of a body: stature and mass, and by how many standard deviations the other sizes differ from what those let expect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BodySizes {
    /// Which table.
    pub sex: Sex,
    /// Stature in metres.
    pub stature_metres: f64,
    /// Mass in kilograms.
    pub mass_kilograms: f64,
    /// Upper arm, in standard deviations of the residual.
    pub upper_arm_deviation: f64,
    /// Forearm, likewise.
    pub forearm_deviation: f64,
    /// Hand, likewise.
    pub hand_deviation: f64,
    /// Breadth between the shoulder joints, likewise.
    pub breadth_deviation: f64,
    /// Girth of the upper arm, likewise.
    pub girth_deviation: f64,
}

impl Default for BodySizes {
    /// The median woman of ANSUR II.
    fn default() -> Self {
        Self {
            sex: Sex::Female,
            stature_metres: 1.626,
            mass_kilograms: 66.8,
            upper_arm_deviation: 0.0,
            forearm_deviation: 0.0,
            hand_deviation: 0.0,
            breadth_deviation: 0.0,
            girth_deviation: 0.0,
        }
    }
}

/// A regression: size in millimetres = slope x predictor + offset, with the residual's standard deviation.
#[derive(Clone, Copy)]
struct Regression {
    slope: f64,
    offset: f64,
    deviation: f64,
}

impl Regression {
    fn metres(self, predictor: f64, deviations: f64) -> f64 {
        (self.slope * predictor + self.offset + self.deviation * deviations) / 1000.0
    }
}

/// One sex' row of regressions: lengths on stature in millimetres, girth on mass in kilograms.
struct Table {
    stature: (f64, f64),
    mass: (f64, f64),
    upper_arm: Regression,
    forearm: Regression,
    hand: Regression,
    breadth: Regression,
    girth: Regression,
    /// Median radii of wrist and forearm in metres.
    wrist_radius: f64,
    forearm_radius: f64,
    hand_radius: f64,
}

const fn regression(slope: f64, offset: f64, deviation: f64) -> Regression {
    Regression { slope, offset, deviation }
}

const WOMEN: Table = Table {
    stature: (1628.5, 64.2),
    mass: (67.8, 11.0),
    upper_arm: regression(0.2120, -34.0, 10.5),
    forearm: regression(0.1632, -24.5, 11.1),
    hand: regression(0.1012, 16.2, 7.7),
    breadth: regression(0.1612, 102.8, 15.1),
    girth: regression(2.40, 143.0, 16.0),
    wrist_radius: 0.0245,
    forearm_radius: 0.042,
    hand_radius: 0.030,
};

const MEN: Table = Table {
    stature: (1756.2, 68.6),
    mass: (85.5, 14.2),
    upper_arm: regression(0.2028, -20.9, 10.6),
    forearm: regression(0.1608, -14.4, 10.8),
    hand: regression(0.0977, 21.7, 7.4),
    breadth: regression(0.1486, 154.6, 16.2),
    girth: regression(1.98, 189.0, 20.0),
    wrist_radius: 0.028,
    forearm_radius: 0.049,
    hand_radius: 0.034,
};

impl Sex {
    const fn table(self) -> &'static Table {
        match self {
            Self::Female => &WOMEN,
            Self::Male => &MEN,
        }
    }
}

impl BodySizes {
    /// A body drawn at random: stature and mass as in ANSUR II, the segments round what those let expect.
    ///
    /// Residuals of upper arm, forearm and hand share what the published correlations leave beside stature (about 0.2).
    #[must_use]
    pub fn sampled(sex: Sex, seed: u64) -> Self {
        let mut random = Random::new(seed, Purpose::Body);
        let mut normal = || random.normal().clamp(-2.5, 2.5);
        let table = sex.table();
        let stature = normal();
        // Mass and stature correlate at about 0.5 in ANSUR II.
        let mass = 0.5 * stature + 0.75_f64.sqrt() * normal();
        let (shared, alone) = (0.2_f64.sqrt() * normal(), 0.8_f64.sqrt());
        Self {
            sex,
            stature_metres: (table.stature.0 + table.stature.1 * stature) / 1000.0,
            mass_kilograms: (table.mass.0 + table.mass.1 * mass).max(40.0),
            upper_arm_deviation: shared + alone * normal(),
            forearm_deviation: shared + alone * normal(),
            hand_deviation: shared + alone * normal(),
            breadth_deviation: normal(),
            girth_deviation: normal(),
        }
    }

    /// Lengths and radii of an arm.
    #[must_use]
    pub fn arm_sizes(&self) -> ArmSizes {
        let table = self.sex.table();
        let stature = self.stature_metres * 1000.0;
        let girth = table.girth.metres(self.mass_kilograms, self.girth_deviation);
        // Forearm and wrist grow with the upper arm, about half as much in relation.
        let median = table.girth.metres(table.mass.0, 0.0);
        let share = f64::midpoint(1.0, girth / median);
        ArmSizes {
            upper_arm_metres: table.upper_arm.metres(stature, self.upper_arm_deviation),
            forearm_metres: table.forearm.metres(stature, self.forearm_deviation),
            hand_metres: table.hand.metres(stature, self.hand_deviation),
            upper_arm_radius_metres: girth / std::f64::consts::TAU,
            forearm_radius_metres: table.forearm_radius * share,
            wrist_radius_metres: table.wrist_radius * share,
            hand_radius_metres: table.hand_radius * share,
            mass_kilograms: self.mass_kilograms * if self.sex == Sex::Female { 0.0449 } else { 0.0494 },
        }
    }

    /// Distance between the centres of the shoulder joints in metres.
    ///
    /// The biacromial breadth less twice 30 mm: the joint's centre lies below and inside the acromion (an assumption).
    #[must_use]
    pub fn shoulder_breadth_metres(&self) -> f64 {
        self.sex.table().breadth.metres(self.stature_metres * 1000.0, self.breadth_deviation) - 0.06
    }

    pub(super) fn check(&self) -> Result<(), PersonError> {
        PersonError::range("body.stature_metres", self.stature_metres, (1.35, 2.10))?;
        PersonError::range("body.mass_kilograms", self.mass_kilograms, (35.0, 180.0))?;
        let index = self.mass_kilograms / self.stature_metres.powi(2);
        PersonError::range("body.mass_kilograms over stature squared (kg/m2)", index, (13.0, 55.0))?;
        for (name, value) in [
            ("upper_arm", self.upper_arm_deviation),
            ("forearm", self.forearm_deviation),
            ("hand", self.hand_deviation),
            ("breadth", self.breadth_deviation),
            ("girth", self.girth_deviation),
        ] {
            PersonError::range(format!("body.{name}_deviation"), value, (-4.0, 4.0))?;
        }
        Ok(())
    }
}
