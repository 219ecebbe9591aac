use super::super::shape::Shape;
use super::*;
use proptest::prelude::*;

/// The depth at which one ray first meets a shape.
fn met(shape: &Shape, ray: &Vector) -> Option<f64> {
    let mut depth = [0.0];
    shape.prepare().meet(&[ray.x], ray.y, &mut depth);
    Some(depth[0]).filter(|depth| depth.is_finite())
}

#[test]
fn a_ray_meets_the_near_side_of_each_shape() {
    let ray = Vector::new(0.0, 0.0, 1.0);
    let ball = Shape::ellipsoid(Point::new(0.0, 0.0, 2.0), &Matrix3::identity(), Vector::new(0.3, 0.2, 0.5));
    assert!((met(&ball, &ray).unwrap() - 1.5).abs() < 1e-12);
    let block = Shape::block(Point::new(0.05, 0.0, 2.0), &Matrix3::identity(), Vector::new(0.3, 0.2, 0.25));
    assert!((met(&block, &ray).unwrap() - 1.75).abs() < 1e-12);
    assert_eq!(met(&block, &Vector::new(0.5, 0.0, 1.0)), None);
}

#[test]
fn a_cone_s_surface_is_its_radius_away_from_its_axis() {
    let (start, end) = (Point::new(-0.3, 0.0, 1.5), Point::new(0.3, 0.1, 1.8));
    let cone = Shape::Cone { start, end, start_radius: 0.05, end_radius: 0.05 };
    let mut hits = 0;
    for step in 0..200 {
        let ray = Vector::new(f64::from(step) * 0.003 - 0.3, 0.02, 1.0);
        if let Some(depth) = met(&cone, &ray) {
            let point = Point::from(ray * depth);
            let foot = crate::geometry::closest_on_segment(&point, &start, &end);
            assert!(((point - foot).norm() - 0.05).abs() < 1e-9);
            hits += 1;
        }
    }
    assert!(hits > 50);
}

#[test]
fn a_tapering_cone_touches_its_own_sphere_at_every_hit() {
    let (start, end) = (Point::new(-0.2, 0.0, 1.5), Point::new(0.3, 0.1, 1.4));
    let cone = Shape::Cone { start, end, start_radius: 0.07, end_radius: 0.03 };
    for step in 0..400 {
        let ray = Vector::new(f64::from(step) * 0.0015 - 0.25, 0.0, 1.0);
        let Some(depth) = met(&cone, &ray) else { continue };
        let point = ray * depth;
        let gap = (0..=10_000)
            .map(|share| {
                let share = f64::from(share) / 10_000.0;
                (point - (start + (end - start) * share).coords).norm() - (0.07 - 0.04 * share)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(gap.abs() < 1e-5, "{gap}");
    }
}

fn direction() -> impl Strategy<Value = Vector> {
    (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64)
        .prop_map(|(x, y, z)| Vector::new(x, y, z))
        .prop_filter("a direction", |vector| vector.norm() > 0.1)
}

fn shape() -> impl Strategy<Value = Shape> {
    let place = (-0.6..0.6_f64, -0.4..0.4_f64, 0.6..2.5_f64).prop_map(|(x, y, z)| Point::new(x, y, z));
    let size = || 0.01..0.3_f64;
    (place, direction(), direction(), size(), size(), size(), 0..3_u8).prop_filter_map(
        "axes that stand on each other",
        |(centre, along, other, a, b, c, kind)| {
            let first = along.normalize();
            let second = first.cross(&other).try_normalize(1e-3)?;
            let axes = Matrix3::from_columns(&[first, second, first.cross(&second)]);
            let half = Vector::new(a, b, c);
            Some(match kind {
                0 => Shape::ellipsoid(centre, &axes, half),
                1 => Shape::block(centre, &axes, half),
                _ => {
                    Shape::Cone { start: centre, end: centre + along * 0.4, start_radius: a * 0.4, end_radius: b * 0.4 }
                }
            })
        },
    )
}

proptest! {
    /// What is left out of a row because a shape cannot be there is never met.
    #[test]
    fn no_ray_outside_of_a_row_s_span_meets_the_shape(shape in shape(), y in -0.45..0.45_f64) {
        let across: Vec<f64> = (0..640).map(|column| (f64::from(column) - 319.5) / 545.0).collect();
        let mut depths = vec![0.0; across.len()];
        let prepared = shape.prepare();
        prepared.meet(&across, y, &mut depths);
        let span = prepared.span(y, (across[0], across[639]));
        for (x, depth) in across.iter().zip(&depths) {
            let inside = span.is_some_and(|(low, high)| (low..=high).contains(x));
            prop_assert!(inside || *depth == f64::INFINITY, "{x} {depth} {span:?}");
        }
    }

    /// The same for the rectangle of the image that a shape is looked for in.
    #[test]
    fn no_ray_outside_of_the_window_meets_the_shape(shape in shape()) {
        let camera = crate::vision::Intrinsics::default();
        let window = shape.window(&camera, 640, 480);
        let (prepared, mut depth) = (shape.prepare(), [0.0]);
        for row in (0..480_usize).step_by(7) {
            for column in (0..640_usize).step_by(5) {
                let (x, y) = ((column as f64 - camera.cx) / camera.fx, (row as f64 - camera.cy) / camera.fy);
                prepared.meet(&[x], y, &mut depth);
                let inside = (window.columns.0..window.columns.1).contains(&column)
                    && (window.rows.0..window.rows.1).contains(&row);
                prop_assert!(inside || depth[0] == f64::INFINITY, "{column} {row} {window:?}");
            }
        }
    }
}
