//! What is drawn on a pair of axes.

/// Okabe and Ito's colours (Color Universal Design, 2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Colour {
    /// `#000000`
    Black,
    /// `#E69F00`
    Orange,
    /// `#56B4E9`
    SkyBlue,
    /// `#009E73`
    BluishGreen,
    /// `#F0E442`
    Yellow,
    /// `#0072B2`
    Blue,
    /// `#D55E00`
    Vermillion,
    /// `#CC79A7`
    ReddishPurple,
    /// `#7F7F7F`, for what is only there to compare with.
    Grey,
}

impl Colour {
    /// The colours in the order in which layers take them.
    pub const ORDER: [Self; 7] = [
        Self::Blue,
        Self::Vermillion,
        Self::BluishGreen,
        Self::Orange,
        Self::SkyBlue,
        Self::ReddishPurple,
        Self::Black,
    ];

    /// Red, green and blue, 0 to 255.
    #[must_use]
    pub const fn rgb(self) -> (u8, u8, u8) {
        match self {
            Self::Black => (0, 0, 0),
            Self::Orange => (230, 159, 0),
            Self::SkyBlue => (86, 180, 233),
            Self::BluishGreen => (0, 158, 115),
            Self::Yellow => (240, 228, 66),
            Self::Blue => (0, 114, 178),
            Self::Vermillion => (213, 94, 0),
            Self::ReddishPurple => (204, 121, 167),
            Self::Grey => (127, 127, 127),
        }
    }
}

/// How a line is broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    #[default]
    Solid,
    /// Long dashes.
    Dashed,
    /// Short dashes.
    Dotted,
}

/// The sign at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marker {
    /// A filled circle.
    #[default]
    Disc,
    /// An empty circle.
    Ring,
    /// A filled square.
    Square,
    /// A filled triangle.
    Triangle,
    /// Two crossed strokes.
    Cross,
    /// A star of three strokes.
    Star,
}

impl Marker {
    /// The markers in the order in which layers take them.
    pub(super) const ORDER: [Self; 6] = [Self::Disc, Self::Square, Self::Triangle, Self::Ring, Self::Cross, Self::Star];
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Line { points: Vec<[f64; 2]>, marked: bool },
    Scatter { points: Vec<[f64; 2]> },
    Band { rows: Vec<[f64; 3]> },
    Ellipse { outline: Vec<[f64; 2]> },
    Bars { bars: Vec<Bar>, width: f64 },
    Boxes { boxes: Vec<(f64, Vec<f64>)>, width: f64 },
    Across { y: f64 },
    Upright { x: f64 },
    Stretch { from: f64, to: f64 },
    Words { at: [f64; 2], text: String },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bar {
    pub(super) at: f64,
    pub(super) height: f64,
    pub(super) error: f64,
}

/// One thing that is drawn, with its name in the legend and its looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    pub(super) label: String,
    pub(super) shape: Shape,
    pub(super) colour: Option<Colour>,
    pub(super) marker: Option<Marker>,
    pub(super) dash: Dash,
    pub(super) width: f64,
    pub(super) strength: f64,
}

impl Layer {
    fn new(label: impl Into<String>, shape: Shape) -> Self {
        let label = label.into();
        Self { label, shape, colour: None, marker: None, dash: Dash::Solid, width: 1.8, strength: 1.0 }
    }

    /// A line through points (x, y). A point that is not finite interrupts it.
    pub fn line(label: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        Self::new(label, Shape::Line { points: points.into_iter().collect(), marked: false })
    }

    /// A mark at each point (x, y).
    pub fn scatter(label: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        Self::new(label, Shape::Scatter { points: points.into_iter().collect() })
    }

    /// A filled band: rows of x, lower y and upper y.
    pub fn band(label: impl Into<String>, rows: impl IntoIterator<Item = [f64; 3]>) -> Self {
        Self { strength: 0.22, ..Self::new(label, Shape::Band { rows: rows.into_iter().collect() }) }
    }

    /// The ellipse of a normal distribution, `deviations` standard deviations wide; `strength` from 0 to 1 is how dense it
    /// is filled (a component's weight, for example).
    pub fn ellipse(
        label: impl Into<String>,
        centre: [f64; 2],
        covariance: [[f64; 2]; 2],
        deviations: f64,
        strength: f64,
    ) -> Self {
        let outline = outline_of(centre, covariance, deviations);
        Self { strength: strength.clamp(0.0, 1.0), width: 1.2, ..Self::new(label, Shape::Ellipse { outline }) }
    }

    /// Bars: place on the x axis, height, and half the length of the error bar (0 for none). `width` in units of x.
    pub fn bars(label: impl Into<String>, width: f64, bars: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let bars = bars.into_iter().map(|[at, height, error]| Bar { at, height, error }).collect();
        Self::new(label, Shape::Bars { bars, width })
    }

    /// Box plots: place on the x axis and the values themselves. Box: quartiles and median; whiskers: the last value within
    /// 1.5 interquartile ranges of the box (Tukey 1977); circles: values beyond. `width` in units of x.
    pub fn boxes(label: impl Into<String>, width: f64, boxes: impl IntoIterator<Item = (f64, Vec<f64>)>) -> Self {
        Self::new(label, Shape::Boxes { boxes: boxes.into_iter().collect(), width })
    }

    /// A straight line across the plot at height `y`: a threshold, for example. It widens the axis to be seen.
    pub fn across(label: impl Into<String>, y: f64) -> Self {
        Self::new(label, Shape::Across { y }).dashed(Dash::Dashed)
    }

    /// A straight upright line at `x`: an event, for example.
    pub fn upright(label: impl Into<String>, x: f64) -> Self {
        Self::new(label, Shape::Upright { x }).dashed(Dash::Dotted)
    }

    /// A stretch of the x axis, shaded over the whole height.
    pub fn stretch(label: impl Into<String>, from: f64, to: f64) -> Self {
        Self { strength: 0.15, ..Self::new(label, Shape::Stretch { from, to }) }
    }

    /// Words in the plot, beginning beside a point.
    pub fn words(at: [f64; 2], text: impl Into<String>) -> Self {
        Self::new("", Shape::Words { at, text: text.into() }).coloured(Colour::Black)
    }

    /// Takes this colour instead of the next free one.
    #[must_use]
    pub const fn coloured(mut self, colour: Colour) -> Self {
        self.colour = Some(colour);
        self
    }

    /// Breaks the line.
    #[must_use]
    pub const fn dashed(mut self, dash: Dash) -> Self {
        self.dash = dash;
        self
    }

    /// Takes this marker instead of the next one; on a line it also marks its points.
    #[must_use]
    pub fn marked(mut self, marker: Marker) -> Self {
        self.marker = Some(marker);
        if let Shape::Line { marked, .. } = &mut self.shape {
            *marked = true;
        }
        self
    }

    /// Draws lines this many points wide.
    #[must_use]
    pub const fn wide(mut self, width: f64) -> Self {
        self.width = width;
        self
    }

    /// Draws it with this opacity, from 0 to 1.
    #[must_use]
    pub const fn faint(mut self, strength: f64) -> Self {
        self.strength = strength;
        self
    }

    /// Every point that the axes must hold.
    pub(super) fn extent(&self) -> Vec<[f64; 2]> {
        let nowhere = f64::NAN;
        match &self.shape {
            Shape::Line { points, .. } | Shape::Scatter { points } | Shape::Ellipse { outline: points } => {
                points.clone()
            }
            Shape::Band { rows } => rows.iter().flat_map(|[x, low, high]| [[*x, *low], [*x, *high]]).collect(),
            Shape::Bars { bars, width } => bars.iter().flat_map(|bar| bar_extent(bar, *width)).collect(),
            Shape::Boxes { boxes, width } => boxes
                .iter()
                .flat_map(|(at, values)| values.iter().flat_map(move |y| [[at - width, *y], [at + width, *y]]))
                .collect(),
            Shape::Across { y } => vec![[nowhere, *y]],
            Shape::Upright { x } => vec![[*x, nowhere]],
            Shape::Stretch { from, to } => vec![[*from, nowhere], [*to, nowhere]],
            Shape::Words { at, .. } => vec![*at],
        }
    }
}

fn bar_extent(bar: &Bar, width: f64) -> [[f64; 2]; 3] {
    let error = if bar.error.is_finite() { bar.error } else { 0.0 };
    [[bar.at - width, 0.0], [bar.at + width, bar.height + error], [bar.at, bar.height - error]]
}

/// The outline of a normal distribution at `deviations` standard deviations, as a closed polygon.
fn outline_of(centre: [f64; 2], covariance: [[f64; 2]; 2], deviations: f64) -> Vec<[f64; 2]> {
    let [[a, b], [_, d]] = covariance;
    // Eigenvalues and direction of a symmetric 2 by 2 matrix.
    let middle = f64::midpoint(a, d);
    let swing = ((a - d) / 2.0).hypot(b);
    let long = (middle + swing).max(0.0).sqrt() * deviations;
    let short = (middle - swing).max(0.0).sqrt() * deviations;
    let (sine, cosine) = (0.5 * (2.0 * b).atan2(a - d)).sin_cos();
    (0..=72)
        .map(|step| {
            let (up, along) = (f64::from(step) * std::f64::consts::TAU / 72.0).sin_cos();
            let (along, up) = (along * long, up * short);
            [centre[0] + along * cosine - up * sine, centre[1] + along * sine + up * cosine]
        })
        .collect()
}
