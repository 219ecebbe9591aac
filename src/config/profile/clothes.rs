//! What a profile says about a person's coloured clothes (thesis section 3.2.2): the colour of each part, for labels to train from.

use crate::body::PerSide;
use crate::vision::labels::SampleColours;
use serde::{Deserialize, Serialize};

/// The colour that each part wears: red, green and blue from 0 to 255, as the camera sees them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArmClothes {
    /// Shoulder, with the trunk's half.
    pub shoulder: [u8; 3],
    /// Upper arm.
    pub upper_arm: [u8; 3],
    /// Forearm.
    pub forearm: [u8; 3],
    /// Hand: a glove, or skin.
    pub hand: [u8; 3],
}

/// The clothes of both arms.
pub type Clothes = PerSide<ArmClothes>;

/// The sample colours in the order of labels.
#[must_use]
pub fn sample_colours(clothes: &Clothes) -> SampleColours {
    let of = |arm: &ArmClothes| [arm.shoulder, arm.upper_arm, arm.forearm, arm.hand];
    let ([a, b, c, d], [e, f, g, h]) = (of(&clothes.left), of(&clothes.right));
    SampleColours([a, b, c, d, e, f, g, h])
}

/// Sample colours as a profile says them.
#[must_use]
pub fn clothes_of(colours: &SampleColours) -> Clothes {
    let [a, b, c, d, e, f, g, h] = colours.0;
    let arm = |[shoulder, upper_arm, forearm, hand]: [[u8; 3]; 4]| ArmClothes { shoulder, upper_arm, forearm, hand };
    PerSide { left: arm([a, b, c, d]), right: arm([e, f, g, h]) }
}

/// The first value that cannot be used: its key and why.
pub(super) fn check(clothes: &Clothes) -> Result<(), (String, String)> {
    sample_colours(clothes).check().map_err(|error| ("clothes".to_owned(), error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_come_back_from_a_profile_in_the_order_of_labels() {
        let colours = SampleColours([
            [220, 30, 30],
            [30, 200, 30],
            [30, 30, 220],
            [220, 220, 30],
            [220, 30, 220],
            [30, 220, 220],
            [240, 240, 240],
            [90, 60, 20],
        ]);
        let clothes = clothes_of(&colours);
        assert_eq!((clothes.left.hand, clothes.right.shoulder), ([220, 220, 30], [220, 30, 220]));
        let text = toml::to_string(&clothes).unwrap();
        assert_eq!(sample_colours(&toml::from_str(&text).unwrap()).0, colours.0);
    }
}
