use super::*;

#[test]
fn joint_names_and_limits_are_those_on_the_wire() {
    let model = RobotModel::baxter().unwrap();
    let arm = model.arm(Side::Left);
    assert_eq!(arm.side(), Side::Left);
    assert_eq!(arm.joint_names()[0], "left_s0");
    assert_eq!(arm.joint_names()[6], "left_w2");
    assert!((arm.limits().upper[3] - 2.618).abs() < 1e-12);
    assert!((arm.limits().lower[1] + 2.147).abs() < 1e-12);
}

#[test]
fn the_tip_is_where_the_tool_puts_it() {
    let middle = RobotModel::baxter().unwrap().arm(Side::Left).limits().middle();
    let tip = |tool: Tool| {
        let model = RobotModel::from_urdf(BAXTER_URDF, PerSide { left: tool, right: Tool::AsDescribed }).unwrap();
        model.arm(Side::Left).forward(&middle)
    };
    let hand = tip(Tool::Bare);
    for (tool, distance) in [
        (Tool::AsDescribed, 0.025),
        (Tool::ElectricExtended, 0.1577),
        (Tool::ElectricStandard, 0.12),
        (Tool::Distance(0.3), 0.3),
    ] {
        let expected = hand * Pose::translation(0.0, 0.0, distance);
        assert!((tip(tool).translation.vector - expected.translation.vector).norm() < 1e-12);
    }
}

#[test]
fn a_tool_of_no_sensible_length_is_refused() {
    for distance in [-0.1, 2.0, f64::NAN] {
        let tools = PerSide { left: Tool::AsDescribed, right: Tool::Distance(distance) };
        assert!(matches!(RobotModel::from_urdf(BAXTER_URDF, tools), Err(ModelError::Tool { side: Side::Right, .. })));
    }
}

fn refused(text: &str) -> ModelError {
    RobotModel::from_urdf(text, PerSide::default()).unwrap_err()
}

#[test]
fn a_text_that_is_no_description_is_refused() {
    assert!(matches!(refused("not XML at all"), ModelError::NotReadable { .. }));
    assert!(
        matches!(refused("<robot name='r'><link name='base'/></robot>"), ModelError::MissingLink { link } if link == "left_gripper")
    );
}

#[test]
fn a_description_that_lacks_a_joint_is_refused_by_name() {
    let text = BAXTER_URDF.replace("joint name=\"left_e1\"", "joint name=\"left_elbow\"");
    assert_eq!(refused(&text), ModelError::MissingJoint { joint: "left_e1".into() });
    let text =
        BAXTER_URDF.replace("<joint name=\"right_w1\" type=\"revolute\">", "<joint name=\"right_w1\" type=\"fixed\">");
    assert_eq!(refused(&text), ModelError::MissingJoint { joint: "right_w1".into() });
}

#[test]
fn a_description_with_a_moving_joint_too_many_is_refused_by_name() {
    let text = BAXTER_URDF
        .replace("<joint name=\"left_hand\" type=\"fixed\">", "<joint name=\"left_hand\" type=\"revolute\">");
    assert!(matches!(refused(&text), ModelError::UnknownJoint { side: Side::Left, joint } if joint == "left_hand"));
}

#[test]
fn limits_that_make_no_range_are_refused_by_name() {
    let text = BAXTER_URDF.replace("lower=\"-0.05\" upper=\"2.618\"", "lower=\"2.7\" upper=\"2.618\"");
    assert!(matches!(refused(&text), ModelError::Limits { joint, .. } if joint == "left_e1"));
}

#[test]
fn a_tree_that_bites_its_tail_is_refused() {
    let text = BAXTER_URDF.replace("<parent link=\"base\"/>", "<parent link=\"left_hand\"/>");
    assert!(matches!(refused(&text), ModelError::MissingLink { link } if link == "base"));
}
