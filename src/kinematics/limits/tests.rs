use super::*;

fn limits() -> JointLimits {
    JointLimits { lower: JointVector::repeat(-1.0), upper: JointVector::repeat(3.0), speed: JointVector::repeat(1.5) }
}

#[test]
fn a_breach_names_the_joint_and_its_value() {
    let mut joints = JointVector::zeros();
    assert_eq!(limits().breach(&joints, 0.0), None);
    joints[4] = 3.1;
    assert_eq!(limits().breach(&joints, 0.0), Some((4, 3.1)));
    assert_eq!(limits().breach(&joints, 0.2), None);
    joints[1] = f64::NAN;
    assert!(matches!(limits().breach(&joints, 0.2), Some((1, value)) if value.is_nan()));
}

#[test]
fn the_margin_is_one_in_the_middle_and_nothing_at_an_end() {
    let mut joints = limits().middle();
    assert!((limits().margin(&joints) - 1.0).abs() < 1e-12);
    joints[6] = 3.0;
    assert!(limits().margin(&joints).abs() < 1e-12);
}

#[test]
fn a_workspace_names_the_axis() {
    let workspace = MotionLimits::default().workspace;
    assert_eq!(workspace.breach(&Point::new(0.7, 0.0, 0.0)), None);
    assert_eq!(workspace.breach(&Point::new(0.7, 1.5, 0.0)), Some(1));
    assert_eq!(workspace.breach(&Point::new(0.7, 0.0, f64::NAN)), Some(2));
}

#[test]
fn limits_are_read_with_defaults_and_unknown_keys_are_refused() {
    let read: MotionLimits = serde_json::from_str(r#"{"speed": 0.05}"#).unwrap();
    assert_eq!(read, MotionLimits { speed: 0.05, ..MotionLimits::default() });
    assert!(serde_json::from_str::<MotionLimits>(r#"{"spede": 0.05}"#).is_err());
}
