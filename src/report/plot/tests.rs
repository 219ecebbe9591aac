//! Plots hold what was handed in: gaps stay gaps, cuts stay inside, both formats come out whole.

use super::axis::Axis;
use super::draw::Quartiles;
use super::layout::Frame;
use super::*;
use crate::geometry::Point;
use proptest::prelude::*;

fn forces() -> Figure {
    let raw = (0..400).map(|index| {
        let time = f64::from(index) * 0.05;
        [time, if (150..170).contains(&index) { f64::NAN } else { 4.0 * time.sin() + 0.6 * (7.0 * time).cos() }]
    });
    let raw: Vec<_> = raw.collect();
    let band = raw.iter().map(|[time, force]| [*time, force - 1.0, force + 1.0]);
    let force = Plot::new("force with a gap", Axis::new("time (s)"), Axis::new("force (N)"))
        .with(Layer::stretch("hold", 12.0, 13.5).coloured(Colour::Grey))
        .with(Layer::band("one deviation", band).coloured(Colour::Blue))
        .with(Layer::line("force", raw).coloured(Colour::Blue))
        .with(Layer::across("threshold 3 N", 3.0).coloured(Colour::Vermillion))
        .with(Layer::scatter("detection", [[1.6, 4.2], [14.0, 4.1]]).marked(Marker::Star).coloured(Colour::Vermillion))
        .with(Layer::upright("stop", 18.0));
    let energy = Plot::new("energy", Axis::new("iteration").whole(), Axis::new("energy (N)").including(0.0))
        .with(Layer::line("right", [[1.0, 22.2], [2.0, 8.5], [3.0, 0.0]]).marked(Marker::Disc))
        .with(Layer::line("left", [[1.0, 17.0], [2.0, 5.1], [3.0, 1.2]]).marked(Marker::Square).dashed(Dash::Dashed));
    let boxes = Plot::new("by method", Axis::categories("", ["sgd", "momentum", "adam"]), Axis::new("error (m)")).with(
        Layer::boxes(
            "error",
            0.5,
            (0..3).map(|method| {
                (
                    f64::from(method),
                    (0..40).map(|value| f64::from(value * (method + 1) % 17) * 0.01).chain([0.45]).collect(),
                )
            }),
        ),
    );
    let bars = Plot::new("by strategy", Axis::categories("", ["gmm", "force", "multimodal"]), Axis::new("score"))
        .with(Layer::bars("comfort", 0.35, [[-0.2, 3.0, 0.4], [0.8, 5.0, 0.5], [1.8, 6.0, 0.3]]))
        .with(Layer::bars("reach", 0.35, [[0.2, 6.1, 0.2], [1.2, 2.0, 0.3], [2.2, 5.5, 0.4]]));
    Figure::grid("All kinds of layers \u{2013} \u{3c3}, \u{b1}, \u{e9}", 2, [force, energy, boxes, bars])
}

fn paths() -> Figure {
    let path = [Point::new(0.5, -0.3, 0.2), Point::new(0.45, -0.25, 0.35), Point::new(0.3, -0.2, 0.5)];
    let covariance = [[0.002, 0.001, 0.0], [0.001, 0.003, -0.0015], [0.0, -0.0015, 0.002]];
    let plots = [View::Top, View::Front].map(|view| {
        let at = |point: &Point| project(view, point);
        view.plot(view.name())
            .with(Layer::ellipse("hand", at(&path[0]), covariance_in(view, &covariance), 2.0, 0.7))
            .with(Layer::ellipse("elbow", at(&path[1]), covariance_in(view, &covariance), 2.0, 0.3))
            .with(Layer::line("planned", path_in(view, &path)).dashed(Dash::Dashed).marked(Marker::Ring))
            .with(Layer::words(at(&path[1]), "2"))
    });
    Figure::grid("Paths", 2, plots).panel_size(480, 460)
}

#[test]
fn both_formats_come_out_whole() {
    let folder = tempfile::tempdir().unwrap();
    forces().save(folder.path(), "forces").unwrap();
    paths().save(folder.path(), "paths").unwrap();
    for stem in ["forces", "paths"] {
        let svg = std::fs::read_to_string(folder.path().join(format!("{stem}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        let file = std::fs::File::open(folder.path().join(format!("{stem}.png"))).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert!(info.width > 800 && info.height > 400);
        // Words and strokes were drawn, and most of the sheet is still white.
        let dark = pixels.iter().filter(|value| **value < 100).count();
        assert!(dark > pixels.len() / 500 && dark < pixels.len() / 4, "{dark} of {}", pixels.len());
    }
    if let Ok(keep) = std::env::var("VALET_KEEP_PLOTS") {
        forces().save(keep.as_ref(), "forces").unwrap();
        paths().save(keep.as_ref(), "paths").unwrap();
    }
}

#[test]
fn a_figure_is_drawn_the_same_each_time() {
    assert_eq!(forces().svg().unwrap(), forces().svg().unwrap());
    assert_eq!(paths().png().unwrap(), paths().png().unwrap());
}

#[test]
fn one_name_has_one_colour_in_all_plots() {
    let plot = |first: &str, second: &str| {
        Plot::new("", Axis::new("x"), Axis::new("y"))
            .line(first, [[0.0, 0.0], [1.0, 1.0]])
            .line(second, [[0.0, 1.0], [1.0, 0.0]])
    };
    let svg = Figure::grid("", 2, [plot("a", "b"), plot("b", "a")]).svg().unwrap();
    // Two plots and one legend entry each: three strokes a colour.
    for colour in [Colour::Blue, Colour::Vermillion] {
        let (red, green, blue) = colour.rgb();
        let strokes = svg.matches(&format!("stroke=\"#{red:02X}{green:02X}{blue:02X}\"")).count();
        assert_eq!(strokes, 3, "{colour:?}");
    }
}

#[test]
fn nothing_finite_still_makes_a_figure() {
    let plot = Plot::new("empty", Axis::new("x"), Axis::new("y"))
        .line("nothing", [[f64::NAN, 1.0], [f64::INFINITY, 2.0]])
        .with(Layer::boxes("none", 0.5, [(0.0, vec![f64::NAN])]));
    assert!(Figure::single(plot).svg().unwrap().contains("nothing"));
    assert!(Figure::grid("no plots", 3, []).png().is_ok());
}

#[test]
fn a_gap_interrupts_the_line() {
    let with = |middle: f64| {
        let plot = Plot::new("", Axis::new("x"), Axis::new("y")).with(
            Layer::line("", [[0.0, 0.0], [1.0, 1.0], [2.0, middle], [3.0, 1.0], [4.0, 0.0]]).coloured(Colour::Orange),
        );
        Figure::single(plot).svg().unwrap().matches("#E69F00").count()
    };
    assert_eq!(with(2.0), 1);
    assert_eq!(with(f64::NAN), 2);
}

#[test]
fn quartiles_are_those_of_the_book() {
    let summary = Quartiles::of(&[1.0, 2.0, 3.0, 4.0, f64::NAN, 5.0, 100.0]).unwrap();
    assert_eq!((summary.first, summary.median, summary.third), (2.25, 3.5, 4.75));
    assert_eq!((summary.lowest, summary.highest), (1.0, 5.0));
    assert_eq!(summary.beyond, [100.0]);
    assert_eq!(Quartiles::of(&[]), None);
}

#[test]
fn marks_are_round_numbers_with_the_digits_they_need() {
    let words: Vec<_> = Axis::new("x").marks([-0.31, 0.62], 5).into_iter().map(|(_, text)| text).collect();
    assert_eq!(words, ["\u{2212}0.2", "0.0", "0.2", "0.4", "0.6"]);
    let words: Vec<_> = Axis::new("x").marks([0.0, 10.0], 4).into_iter().map(|(_, text)| text).collect();
    assert_eq!(words, ["0.0", "2.5", "5.0", "7.5", "10.0"]);
}

#[test]
fn an_ellipse_reaches_as_far_as_its_deviations() {
    let plot = Layer::ellipse("", [1.0, 2.0], [[4.0, 0.0], [0.0, 1.0]], 2.0, 1.0);
    let extent = plot.extent();
    let right = extent.iter().map(|point| point[0]).fold(f64::MIN, f64::max);
    let top = extent.iter().map(|point| point[1]).fold(f64::MIN, f64::max);
    assert!((right - 5.0).abs() < 1e-9 && (top - 4.0).abs() < 1e-9, "{right} {top}");
}

proptest! {
    #[test]
    fn a_cut_stroke_stays_inside_its_frame(from in prop::array::uniform2(-50.0..50.0), to in prop::array::uniform2(-50.0..50.0)) {
        let frame = Frame { left: -10.0, top: -5.0, right: 12.0, bottom: 9.0 };
        if let Some((from, to)) = frame.cut(from, to) {
            prop_assert!(frame.contains(from) && frame.contains(to));
        }
    }

    #[test]
    fn a_span_holds_its_data_and_marks_lie_inside(low in -1e6..1e6, length in 0.0..1e6) {
        let axis = Axis::new("x");
        let span = axis.span(Some([low, low + length]));
        prop_assert!(span[0] <= low && span[1] >= low + length && span[0] < span[1]);
        for (mark, _) in axis.marks(span, 6) {
            prop_assert!(mark >= span[0] - 1e-9 * length && mark <= span[1] + 1e-9 * length);
        }
    }
}
