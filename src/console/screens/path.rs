//! The path of the focused arm from above and from the front, and the way-points that moved, with force and reason.

use crate::body::Joint;
use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::view::Tier;
use crate::console::widgets::dots::DotGrid;
use crate::console::widgets::text::{fill, line, put, span, title};
use crate::geometry::Point;
use crate::snapshot::{EllipseView, PathView, PoseQuality, Snapshot, WaypointRow};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// From where the scene is seen: which of x, y, z goes to the right and which goes up.
#[derive(Clone, Copy)]
struct Camera {
    name: &'static str,
    /// Axis to the right of the screen and its sign.
    right: (usize, f64),
    /// Axis to the top of the screen and its sign.
    up: (usize, f64),
}

/// From above: forward is up, the robot's left is left.
const TOP: Camera = Camera { name: "top (x up, y left)", right: (1, -1.0), up: (0, 1.0) };
/// From the front of the robot looking the way it looks: up is up, the robot's left is left.
const FRONT: Camera = Camera { name: "front (z up, y left)", right: (1, -1.0), up: (2, 1.0) };

impl Camera {
    fn project(&self, point: &Point) -> (f64, f64) {
        let axis = |(index, sign): (usize, f64)| point.coords.get(index).copied().unwrap_or(0.0) * sign;
        (axis(self.right), axis(self.up))
    }
}

/// From metres to dots, the same scale along both axes.
struct Projection {
    camera: Camera,
    middle: (f64, f64),
    dots_per_metre: f64,
    size: (f64, f64),
}

impl Projection {
    fn new(camera: Camera, points: &[Point], grid: &DotGrid) -> Self {
        let mut low = (f64::INFINITY, f64::INFINITY);
        let mut high = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for (right, up) in points.iter().map(|point| camera.project(point)) {
            low = (low.0.min(right), low.1.min(up));
            high = (high.0.max(right), high.1.max(up));
        }
        let size = (grid.width() as f64, grid.height() as f64);
        // A tenth of a metre at least, so that a single point has a scale too.
        let extent = ((high.0 - low.0).max(0.1) * 1.15, (high.1 - low.1).max(0.1) * 1.15);
        let dots_per_metre = (size.0 / extent.0).min(size.1 / extent.1);
        Self { camera, middle: (low.0.midpoint(high.0), low.1.midpoint(high.1)), dots_per_metre, size }
    }

    fn dot(&self, point: &Point) -> (f64, f64) {
        let (right, up) = self.camera.project(point);
        let x = self.size.0 / 2.0 + (right - self.middle.0) * self.dots_per_metre;
        let y = self.size.1 / 2.0 - (up - self.middle.1) * self.dots_per_metre;
        (x, y)
    }
}

/// Draws the screen.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let wide = scene.view.tier() == Tier::Wide;
    let rows = match (scene.view.large_table, wide) {
        (true, _) => Constraint::Percentage(70),
        (false, true) => Constraint::Length(12),
        (false, false) => Constraint::Length(6),
    };
    put(buffer, area, 0, &legend(scene));
    let area = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    let [views, table] = Layout::vertical([Constraint::Fill(1), rows]).areas(area);
    let [top, front] = Layout::horizontal([Constraint::Fill(1), Constraint::Fill(1)]).spacing(1).areas(views);
    draw_view(scene, TOP, top, buffer);
    draw_view(scene, FRONT, front, buffer);
    fill(buffer, table, table_lines(scene, table));
}

fn draw_view(scene: &Scene<'_>, camera: Camera, area: Rect, buffer: &mut Buffer) {
    let shown = scene.shown();
    let path = &shown.sides.get(scene.view.side).path;
    let heading = format!(" {} arm, {}", scene.view.side, camera.name);
    put(buffer, area, 0, &line(scene.look, Role::Title, heading));
    let plot = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    let points = everything(scene, shown, path);
    if points.is_empty() {
        put(buffer, plot, 0, &line(scene.look, Role::Muted, "no path yet"));
        return;
    }
    let mut grid = DotGrid::new(plot);
    let projection = Projection::new(camera, &points, &grid);
    for place in path.seen.iter() {
        grid.point(projection.dot(place), Role::Muted);
    }
    for ellipse in path.ellipses.iter() {
        draw_ellipse(&mut grid, &projection, ellipse);
    }
    draw_person(scene, shown, &mut grid, &projection);
    polyline(&mut grid, &projection, &path.planned, 3, Role::Planned);
    polyline(&mut grid, &projection, &path.travelled, 1, Role::Travelled);
    polyline(&mut grid, &projection, &path.updated, 2, Role::Updated);
    let glyphs = scene.look.glyphs();
    for point in path.updated.iter() {
        grid.glyph(projection.dot(point), glyphs.waypoint, Role::Updated);
    }
    for change in path.changes.iter() {
        grid.glyph(projection.dot(&change.old), glyphs.star, Role::Resistance);
    }
    if let Some(gripper) = &path.gripper {
        grid.glyph(projection.dot(gripper), glyphs.gripper, Role::Focus);
    }
    grid.draw(scene.look, plot, buffer);
}

/// What the marks of both views mean, short enough for 80 columns; the density of a line tells paths apart without colour.
fn legend<'a>(scene: &Scene<'a>) -> Line<'a> {
    let (look, glyphs) = (scene.look, scene.look.glyphs());
    let quality = scene.live.body.quality(scene.view.side, scene.live.now);
    let person = match quality {
        PoseQuality::Seen => span(look, Role::Good, format!("{} person seen ", glyphs.good)),
        PoseQuality::Inferred => span(look, Role::Late, format!("{} person inferred ", glyphs.late)),
        PoseQuality::Lost => span(look, Role::Stale, format!("{} person lost ", glyphs.stale)),
    };
    Line::from(vec![
        person,
        span(look, Role::Planned, "- - planned "),
        span(look, Role::Travelled, "--- travelled "),
        span(look, Role::Updated, format!("-{}- path now ", glyphs.waypoint)),
        span(look, Role::Resistance, format!("{} resistance ", glyphs.star)),
        span(look, Role::Focus, format!("{} gripper", glyphs.gripper)),
    ])
}

/// Every point that the view must hold.
fn everything(scene: &Scene<'_>, shown: &Snapshot, path: &PathView) -> Vec<Point> {
    let lines = [&path.planned, &path.travelled, &path.updated];
    let mut points: Vec<Point> = lines.iter().flat_map(|points| points.iter().copied()).collect();
    points.extend(path.gripper);
    points.extend(path.ellipses.iter().map(|ellipse| ellipse.mean));
    points.extend(path.seen.iter().copied());
    points.extend(sticks(scene, shown).into_iter().map(|(_, point)| point));
    points.retain(|point| point.coords.iter().all(|value| value.is_finite()));
    points
}

/// Hand, elbow and shoulder of the focused arm, as far as they are known freshly.
fn sticks(scene: &Scene<'_>, shown: &Snapshot) -> Vec<(Joint, Point)> {
    if !shown.body.freshness.is_fresh(shown.now) {
        return Vec::new();
    }
    let Some(pose) = &shown.body.pose else { return Vec::new() };
    let arm = pose.arms.get(scene.view.side);
    Joint::DRESSED.into_iter().filter_map(|joint| Some((joint, arm.position(joint)?))).collect()
}

fn draw_person(scene: &Scene<'_>, shown: &Snapshot, grid: &mut DotGrid, projection: &Projection) {
    let joints = sticks(scene, shown);
    for (start, end) in joints.iter().zip(joints.iter().skip(1)) {
        grid.line(projection.dot(&start.1), projection.dot(&end.1), Role::Person);
    }
    for (joint, point) in &joints {
        let letter = match joint {
            Joint::Hand => 'H',
            Joint::Elbow => 'E',
            _ => 'S',
        };
        grid.glyph(projection.dot(point), letter, Role::Person);
    }
}

fn polyline(grid: &mut DotGrid, projection: &Projection, points: &[Point], step: usize, role: Role) {
    for (start, end) in points.iter().zip(points.iter().skip(1)) {
        grid.dashes(projection.dot(start), projection.dot(end), step, role);
    }
}

/// The outline at two standard deviations, and the weight in tenths at the mean.
fn draw_ellipse(grid: &mut DotGrid, projection: &Projection, ellipse: &EllipseView) {
    const STEPS: u32 = 48;
    let (a, b) = (projection.camera.right, projection.camera.up);
    let entry =
        |row: usize, column: usize| ellipse.covariance.get(row).and_then(|row| row.get(column)).copied().unwrap_or(0.0);
    let (first, second) = (entry(a.0, a.0), entry(b.0, b.0));
    let mixed = entry(a.0, b.0) * a.1 * b.1;
    // Cholesky's factor of the projected covariance turns a circle into the ellipse.
    let root = first.max(1e-12).sqrt();
    let slope = mixed / root;
    let rest = (second - slope * slope).max(0.0).sqrt();
    let middle = projection.dot(&ellipse.mean);
    for step in 0..STEPS {
        let angle = f64::from(step) / f64::from(STEPS) * std::f64::consts::TAU;
        let (cosine, sine) = (angle.cos() * 2.0, angle.sin() * 2.0);
        let right = root * cosine * projection.dots_per_metre;
        let up = (slope * cosine + rest * sine) * projection.dots_per_metre;
        grid.point((middle.0 + right, middle.1 - up), Role::Space);
    }
    let tenths = (ellipse.weight.clamp(0.0, 0.99) * 10.0).floor();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a digit from 0 to 9")]
    let digit = char::from_digit(tenths as u32, 10).unwrap_or('?');
    grid.glyph(middle, digit, Role::Space);
}

fn table_lines<'a>(scene: &Scene<'a>, area: Rect) -> Vec<Line<'a>> {
    let decimals = if area.width < 100 { 2 } else { 3 };
    let changes = &scene.shown().sides.get(scene.view.side).path.changes;
    let heading = format!(
        "Way-points that moved, {} arm: {} (newest first; ellipses: weight in tenths)",
        scene.view.side,
        changes.len()
    );
    let mut lines = vec![title(scene.look, heading)];
    if changes.is_empty() {
        lines.push(line(scene.look, Role::Muted, "none moved yet"));
        return lines;
    }
    let width = 3 * (decimals + 4);
    let columns = format!("iter. point {:<width$}    {:<width$}      N  why", " old (m)", " new (m)");
    lines.push(line(scene.look, Role::Muted, columns));
    let found = changes.iter().rev().filter(|change| scene.view.passes(&change.reason));
    let skipped = scene.view.row.min(changes.len().saturating_sub(1));
    lines.extend(found.skip(skipped).take(usize::from(area.height)).map(|change| change_line(scene, change, decimals)));
    lines
}

fn change_line<'a>(scene: &Scene<'a>, change: &'a WaypointRow, decimals: usize) -> Line<'a> {
    let place = |point: &Point| {
        let axis = |value: f64| format!("{value:>width$.decimals$}", width = decimals + 4);
        format!("{}{}{}", axis(point.x), axis(point.y), axis(point.z))
    };
    Line::from(vec![
        span(scene.look, Role::Text, format!("{:>5} {:>5} ", change.iteration, change.index)),
        span(scene.look, Role::Muted, place(&change.old)),
        span(scene.look, Role::Muted, format!(" {:<2} ", scene.look.glyphs().arrow)),
        span(scene.look, Role::Updated, place(&change.new)),
        span(scene.look, Role::Resistance, format!(" {:>6.2}  ", change.force.norm())),
        span(scene.look, Role::Text, change.reason.as_str()),
    ])
}
