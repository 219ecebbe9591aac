//! sRGB to CIE 1976 L*a*b* under the white of D65 (IEC 61966-2-1; CIE 15).

/// A colour in L*a*b*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    /// Lightness, 0 to 100.
    pub lightness: f64,
    /// From green to red.
    pub a: f64,
    /// From blue to yellow.
    pub b: f64,
}

/// The white of D65 with its luminance 1 (2-degree observer).
const WHITE: [f64; 3] = [0.950_47, 1.0, 1.088_83];
/// Linear sRGB to XYZ (IEC 61966-2-1).
const TO_XYZ: [[f64; 3]; 3] = [
    [0.412_456_4, 0.357_576_1, 0.180_437_5],
    [0.212_672_9, 0.715_152_2, 0.072_175_0],
    [0.019_333_9, 0.119_192_0, 0.950_304_1],
];

impl Lab {
    /// The CIE 1976 colour difference.
    #[must_use]
    pub fn difference(&self, other: &Self) -> f64 {
        let squares = [self.lightness - other.lightness, self.a - other.a, self.b - other.b].map(|d| d * d);
        squares.iter().sum::<f64>().sqrt()
    }
}

/// A colour of the screen in L*a*b*.
#[must_use]
pub fn lab(rgb: [u8; 3]) -> Lab {
    let [red, green, blue] = rgb.map(linear);
    let mut bent = [0.0; 3];
    for ((bent, row), white) in bent.iter_mut().zip(TO_XYZ).zip(WHITE) {
        let [from_red, from_green, from_blue] = row;
        *bent = bend((from_red * red + from_green * green + from_blue * blue) / white);
    }
    let [x, y, z] = bent;
    Lab { lightness: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) }
}

fn linear(value: u8) -> f64 {
    let value = f64::from(value) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The cube root, straight near black.
fn bend(value: f64) -> f64 {
    const EDGE: f64 = 6.0 / 29.0;
    if value > EDGE * EDGE * EDGE { value.cbrt() } else { value / (3.0 * EDGE * EDGE) + 4.0 / 29.0 }
}
