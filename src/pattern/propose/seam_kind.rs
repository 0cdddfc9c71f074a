//! Kinds of proposed seams. A seam is identified by its kind. Seam files and questions have the kind as text, which
//! only the `Display` of [`SeamKind`] writes.

use std::fmt;

use super::{Face, Hand};

/// Kind of a proposed seam, by the edges that it joins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamKind {
    Dart {
        piece: String,
        /// From 1.
        number: usize,
    },
    Side(Hand),
    /// Front or back to the side panel between them.
    SideOf(Face, Hand),
    Shoulder(Hand),
    Princess(Face, Hand),
    Centre(Face),
    /// A yoke over the shoulders to the pieces that hang from it.
    Yoke(Face),
    YokeCentre(Face),
    Armhole(Hand),
    Raglan(Face, Hand),
    Underarm(Hand),
    SleeveTop(Hand),
    SleeveUnderarm(Hand),
    Cuff(Hand),
    CuffHalf(Face, Hand),
    CuffEnds(Hand),
    /// Halves of a cuff. The second hand is the end of the front half.
    CuffSide(Hand, Hand),
    Collar,
    CollarBack,
    /// Band round the neck to itself.
    CollarEnds,
    Outseam(Hand),
    Inseam(Hand),
    Crotch(Face),
    SkirtSide(Hand),
    SkirtRound,
    /// Gore to the next one, with its number, from 1.
    Gore(usize),
    SkirtCentre(Face),
    /// Upper to lower pieces of front or back, with the number of the seam, from 1 at the top.
    WaistLevel(Face, usize),
    /// Pieces below it. `None` for a band all round.
    Waist(Option<Hand>),
    /// Pieces above it. `None` for a band all round.
    WaistAbove(Option<Hand>),
    Waistband,
    WaistbandSide(Hand),
    WaistbandCentre(Face),
    /// Pieces by their identifiers, with the number of the seam between them, from 1.
    Between {
        pieces: [String; 2],
        number: usize,
    },
}

impl SeamKind {
    pub(super) fn on_either_side(&self) -> String {
        let name = self.to_string();
        ["_right", "_left"].into_iter().fold(name, |name, side| name.replace(side, ""))
    }

    /// True for two halves that join at the centre: by a seam, an opening or a fold.
    pub fn is_centre(&self) -> bool {
        matches!(self, Self::Centre(_) | Self::YokeCentre(_) | Self::SkirtCentre(_))
    }
}

impl fmt::Display for SeamKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dart { piece, number } => write!(f, "{piece}_dart_{number}"),
            Self::Side(hand) => write!(f, "side_{hand}"),
            Self::SideOf(face, hand) => write!(f, "side_{face}_{hand}"),
            Self::Shoulder(hand) => write!(f, "shoulder_{hand}"),
            Self::Princess(face, hand) => write!(f, "princess_{face}_{hand}"),
            Self::Centre(face) => write!(f, "centre_{face}"),
            Self::Yoke(face) => write!(f, "yoke_{face}"),
            Self::YokeCentre(face) => write!(f, "yoke_centre_{face}"),
            Self::Armhole(hand) => write!(f, "armhole_{hand}"),
            Self::Raglan(face, hand) => write!(f, "raglan_{face}_{hand}"),
            Self::Underarm(hand) => write!(f, "underarm_{hand}"),
            Self::SleeveTop(hand) => write!(f, "sleeve_top_{hand}"),
            Self::SleeveUnderarm(hand) => write!(f, "sleeve_underarm_{hand}"),
            Self::Cuff(hand) => write!(f, "cuff_{hand}"),
            Self::CuffHalf(face, hand) => write!(f, "cuff_{face}_{hand}"),
            Self::CuffEnds(hand) => write!(f, "cuff_{hand}_ends"),
            Self::CuffSide(hand, Hand::Right) => write!(f, "cuff_{hand}_a"),
            Self::CuffSide(hand, Hand::Left) => write!(f, "cuff_{hand}_b"),
            Self::Collar => f.write_str("collar"),
            Self::CollarBack => f.write_str("collar_back"),
            Self::CollarEnds => f.write_str("collar_ends"),
            Self::Outseam(hand) => write!(f, "outseam_{hand}"),
            Self::Inseam(hand) => write!(f, "inseam_{hand}"),
            Self::Crotch(face) => write!(f, "crotch_{face}"),
            Self::SkirtSide(hand) => write!(f, "skirt_side_{hand}"),
            Self::SkirtRound => f.write_str("skirt_side"),
            Self::Gore(number) => write!(f, "skirt_side_{number}"),
            Self::SkirtCentre(face) => write!(f, "skirt_centre_{face}"),
            Self::WaistLevel(face, number) => write!(f, "waist_{face}_{number}"),
            Self::Waist(None) => f.write_str("waist"),
            Self::Waist(Some(hand)) => write!(f, "waist_{hand}"),
            Self::WaistAbove(None) => f.write_str("waist_above"),
            Self::WaistAbove(Some(hand)) => write!(f, "waist_above_{hand}"),
            Self::Waistband => f.write_str("waistband"),
            Self::WaistbandSide(hand) => write!(f, "waistband_{hand}"),
            Self::WaistbandCentre(face) => write!(f, "waistband_{face}"),
            Self::Between { pieces: [a, b], number: 1 } => write!(f, "{a}_{b}"),
            Self::Between { pieces: [a, b], number } => write!(f, "{a}_{b}_{number}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seam_files_have_every_seam_by_its_own_name() {
        use Face::{Back, Front};
        use Hand::{Left, Right};
        let table = [
            (SeamKind::Dart { piece: "front_left".to_owned(), number: 2 }, "front_left_dart_2"),
            (SeamKind::Side(Right), "side_right"),
            (SeamKind::SideOf(Front, Right), "side_front_right"),
            (SeamKind::Shoulder(Left), "shoulder_left"),
            (SeamKind::Princess(Front, Right), "princess_front_right"),
            (SeamKind::Centre(Back), "centre_back"),
            (SeamKind::Yoke(Back), "yoke_back"),
            (SeamKind::YokeCentre(Back), "yoke_centre_back"),
            (SeamKind::Armhole(Left), "armhole_left"),
            (SeamKind::Raglan(Back, Left), "raglan_back_left"),
            (SeamKind::Underarm(Right), "underarm_right"),
            (SeamKind::SleeveTop(Right), "sleeve_top_right"),
            (SeamKind::SleeveUnderarm(Left), "sleeve_underarm_left"),
            (SeamKind::Cuff(Right), "cuff_right"),
            (SeamKind::CuffHalf(Front, Right), "cuff_front_right"),
            (SeamKind::CuffEnds(Left), "cuff_left_ends"),
            (SeamKind::CuffSide(Left, Right), "cuff_left_a"),
            (SeamKind::CuffSide(Left, Left), "cuff_left_b"),
            (SeamKind::Collar, "collar"),
            (SeamKind::CollarBack, "collar_back"),
            (SeamKind::CollarEnds, "collar_ends"),
            (SeamKind::Outseam(Right), "outseam_right"),
            (SeamKind::Inseam(Left), "inseam_left"),
            (SeamKind::Crotch(Front), "crotch_front"),
            (SeamKind::SkirtSide(Left), "skirt_side_left"),
            (SeamKind::SkirtRound, "skirt_side"),
            (SeamKind::Gore(3), "skirt_side_3"),
            (SeamKind::SkirtCentre(Front), "skirt_centre_front"),
            (SeamKind::WaistLevel(Front, 1), "waist_front_1"),
            (SeamKind::Waist(None), "waist"),
            (SeamKind::Waist(Some(Right)), "waist_right"),
            (SeamKind::WaistAbove(None), "waist_above"),
            (SeamKind::WaistAbove(Some(Left)), "waist_above_left"),
            (SeamKind::Waistband, "waistband"),
            (SeamKind::WaistbandSide(Right), "waistband_right"),
            (SeamKind::WaistbandCentre(Front), "waistband_front"),
        ];
        for (kind, name) in table {
            assert_eq!(kind.to_string(), name);
            assert_eq!(kind.is_centre(), name.contains("centre"), "{name}");
        }
    }
}
