//! The port to whoever plans motions, and the planner that valet brings along.
//!
//! A planner only plans. Its motion is carried out by valet's own streaming, so that the chain of the stop stays the same.

use crate::body::PerSide;
use crate::kinematics::{JointVector, MotionLimits, MotionRefusal, PairMotion, RobotModel, Scene, Target, plan_pair};

/// What is to be planned.
#[derive(Clone, Debug)]
pub struct PlanRequest<'a> {
    /// What surrounds the robot.
    pub scene: &'a Scene,
    /// Where the arms are, radians.
    pub start: &'a PerSide<JointVector>,
    /// Where the grippers are to go.
    pub targets: &'a PerSide<Option<Target>>,
    /// How the arms may move.
    pub limits: &'a MotionLimits,
}

/// Plans motions of both arms.
pub trait Planner {
    /// What the planner is called on the screen.
    fn name(&self) -> &str;

    /// A motion that fulfils the request.
    ///
    /// # Errors
    /// A [`MotionRefusal`]; nothing has moved.
    fn plan(&mut self, request: &PlanRequest<'_>) -> Result<PairMotion, MotionRefusal>;
}

/// valet's own planner: straight lines in step.
#[derive(Clone, Debug)]
pub struct BuiltInPlanner {
    model: RobotModel,
}

impl BuiltInPlanner {
    /// A planner for a robot.
    #[must_use]
    pub const fn new(model: RobotModel) -> Self {
        Self { model }
    }
}

impl Planner for BuiltInPlanner {
    fn name(&self) -> &'static str {
        "built in"
    }

    fn plan(&mut self, request: &PlanRequest<'_>) -> Result<PairMotion, MotionRefusal> {
        plan_pair(&self.model, request.scene, request.start, request.targets, request.limits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::kinematics::dressing_orientation;
    use crate::kinematics::start_postures;

    #[test]
    fn the_planner_behind_the_port_plans_what_the_function_plans() {
        let model = RobotModel::baxter().unwrap();
        let (scene, limits) = (Scene::default(), MotionLimits::default());
        let place = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
        let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
        let start = start_postures(&model, &scene, &[place], &orientations, &limits).unwrap();
        let targets = PerSide { left: None, right: Some(Target::position(Point::new(0.7, -0.25, 0.0))) };
        let mut planner: Box<dyn Planner> = Box::new(BuiltInPlanner::new(model.clone()));
        assert_eq!(planner.name(), "built in");
        let request = PlanRequest { scene: &scene, start: &start, targets: &targets, limits: &limits };
        let through_port = planner.plan(&request).unwrap();
        let direct = plan_pair(&model, &scene, &start, &targets, &limits).unwrap();
        let middle = direct.duration() / 2;
        assert_eq!(through_port.sample(middle), direct.sample(middle));
    }
}
