//! Seams at and near the waist: yokes, bodices, waistbands, skirts and legs.

use super::sew::{Chain, EASED_DOUBT, PLAIN_DOUBT, Tailor};
use super::worn_pieces::Worn;
use super::{Class, Face, Hand, Label, SeamKind};

impl<'w> Tailor<'w, '_, '_> {
    /// In the counter-clockwise order of their lower edges.
    pub fn row(&self, class: Class, face: Face) -> Vec<&'w Worn> {
        let order = if face == Face::Front { Hand::BOTH } else { [Hand::Left, Hand::Right] };
        let mut row: Vec<&Worn> = Vec::new();
        for worn in order.iter().filter_map(|&hand| self.find(class, Some(face), hand)) {
            if !row.iter().any(|other| other.id == worn.id) {
                row.push(worn);
            }
        }
        if class == Class::Body && !row.is_empty() {
            let [first, last] = order.map(|hand| self.find(Class::SidePanel, Some(face), hand));
            row = first.into_iter().chain(row).chain(last).collect();
        }
        row
    }

    pub fn yoke(&mut self, face: Face) {
        let (yokes, bodies) = (self.row(Class::Yoke, face), self.row(Class::Body, face));
        let a: Chain<'_> = yokes.iter().flat_map(|worn| worn.chain(Label::Lower, None)).collect();
        let b: Chain<'_> = bodies.iter().flat_map(|worn| worn.chain_back(Label::Top, None)).collect();
        let pieces: Vec<&Worn> = yokes.iter().chain(&bodies).copied().collect();
        self.add(SeamKind::Yoke(face), a, b, &pieces, EASED_DOUBT);
    }

    /// Joins upper to lower pieces of front or back: bodice, waistband, yoke, skirt or legs.
    pub fn waist(&mut self, face: Face) {
        let level = |class: Class| match self.row(class, face) {
            row if row.is_empty() && class == Class::Skirt => self.gores(face),
            row => row,
        };
        let levels: Vec<Vec<&Worn>> = [Class::Body, Class::Waistband, Class::Yoke, Class::Skirt, Class::Leg]
            .into_iter()
            .map(level)
            .filter(|row| row.iter().any(|worn| worn.class != Class::Yoke || worn.has(Label::Waist)))
            .collect();
        let has_band_round = !self.bands_round().is_empty();
        for (index, pair) in levels.windows(2).enumerate() {
            let (above, below) = (&pair[0], &pair[1]);
            if above.iter().any(|worn| worn.class == Class::Body) && has_band_round {
                continue;
            }
            let a = above.iter().flat_map(|worn| worn.chain(lower_edge(worn), None)).collect();
            let b = below.iter().flat_map(|worn| worn.chain_back(upper_edge(worn), None)).collect();
            let pieces: Vec<&Worn> = above.iter().chain(below).copied().collect();
            self.add(SeamKind::WaistLevel(face, index + 1), a, b, &pieces, EASED_DOUBT);
        }
    }

    /// Joins a skirt of one piece to itself, or gores to each other.
    pub fn ring(&mut self) {
        let skirt = self.skirt_round();
        for (k, &worn) in skirt.iter().enumerate() {
            let next = skirt[(k + 1) % skirt.len()];
            let (a, b) = ends(worn, next, Label::Side);
            let kind = if worn.is_gore { SeamKind::Gore(k + 1) } else { SeamKind::SkirtRound };
            self.add(kind, a, b, &[worn, next], PLAIN_DOUBT);
        }
    }

    /// Gores from left to right, seen from outside, or a skirt of one piece.
    fn skirt_round(&self) -> Vec<&'w Worn> {
        let is_round = |worn: &&Worn| worn.class == Class::Skirt && worn.face.is_none() && worn.hand.is_none();
        self.worn.iter().filter(is_round).collect()
    }

    fn gores(&self, face: Face) -> Vec<&'w Worn> {
        let gores: Vec<&Worn> = self.skirt_round().into_iter().filter(|worn| worn.is_gore).collect();
        let [front, back] = [&gores[..gores.len().div_ceil(2)], &gores[gores.len().div_ceil(2)..]];
        if face == Face::Front { front.to_vec() } else { back.to_vec() }
    }

    fn bands_round(&self) -> Vec<&'w Worn> {
        self.worn.iter().filter(|worn| worn.class == Class::Waistband && worn.face.is_none()).collect()
    }

    /// Joins waistbands of one piece, or a right and a left one, to the pieces above and below, and their ends to each
    /// other. A pattern does not show where a band begins: a seam at centre front is preferred, then one at centre
    /// back, then a side.
    pub fn waistbands(&mut self) {
        let bands = self.bands_round();
        let side = |hand: Hand| bands.iter().copied().find(|band| band.hand == Some(hand));
        if let Some(band) = bands.iter().copied().find(|band| band.hand.is_none()) {
            self.asker.tell(format!("where does `{}` open, and at which seam does it begin?", band.id));
            self.band(band, None);
            // A skirt of one piece closes its waist. The band may overlap there.
            if self.skirt_round().is_empty() {
                let (a, b) = ends(band, band, Label::End);
                self.add(SeamKind::Waistband, a, b, &[band], PLAIN_DOUBT);
            }
        } else if let [Some(right), Some(left)] = Hand::BOTH.map(side) {
            self.asker.tell("where do the waistbands open? They are taken to meet at centre front and back".to_owned());
            for band in [right, left] {
                self.band(band, band.hand);
            }
            // Each band runs to the wearer's left: the right one from the back, the left one from the front.
            for (face, [band, next]) in Face::BOTH.into_iter().zip([[right, left], [left, right]]) {
                let (a, b) = ends(band, next, Label::End);
                self.add(SeamKind::WaistbandCentre(face), a, b, &[band, next], PLAIN_DOUBT);
            }
        }
    }

    fn band(&mut self, band: &'w Worn, hand: Option<Hand>) {
        let below = [Class::Skirt, Class::Leg].map(|class| self.round(class, hand));
        if let Some(below) = below.iter().find(|pieces| !pieces.is_empty()) {
            let b: Chain<'_> = below.iter().flat_map(|worn| worn.chain_back(Label::Waist, None)).collect();
            let pieces: Vec<&Worn> = below.iter().copied().chain([band]).collect();
            self.add(SeamKind::Waist(hand), band.chain(Label::Lower, None), b, &pieces, EASED_DOUBT);
        }
        let above = self.round(Class::Body, hand);
        let a: Chain<'_> = above.iter().flat_map(|worn| worn.chain(Label::Hem, None)).collect();
        let pieces: Vec<&Worn> = above.iter().copied().chain([band]).collect();
        self.add(SeamKind::WaistAbove(hand), a, band.chain_back(Label::Top, None), &pieces, EASED_DOUBT);
    }

    /// Pieces of a kind round the body, or round one side of it, in the order of their lower edges. A yoke on a skirt
    /// or legs takes the place of the pieces that carry it.
    fn round(&self, class: Class, hand: Option<Hand>) -> Vec<&'w Worn> {
        let of_face = |face: Face| {
            let yokes = self.row(Class::Yoke, face);
            let has_yoke = class != Class::Body && yokes.iter().any(|worn| worn.has(Label::Waist));
            if has_yoke && !self.row(class, face).is_empty() { yokes } else { self.row(class, face) }
        };
        let of_hands = |hands: &[Hand]| hands.iter().filter_map(|&hand| self.whole_leg(hand)).collect::<Vec<_>>();
        if class == Class::Leg && self.whole_leg(Hand::Right).is_some() {
            // From centre front to the wearer's left.
            return hand.map_or_else(|| of_hands(&[Hand::Left, Hand::Right]), |hand| of_hands(&[hand]));
        }
        let [fronts, backs] = Face::BOTH.map(of_face);
        if class == Class::Skirt && fronts.is_empty() && backs.is_empty() {
            return self.skirt_round();
        }
        let is_of = |worn: &&Worn, hand: Hand| worn.hand == Some(hand);
        match hand {
            Some(hand) => {
                let order = if hand == Hand::Right { [backs, fronts] } else { [fronts, backs] };
                order.concat().into_iter().filter(|worn| is_of(worn, hand)).collect()
            }
            None if fronts.len() > 1 => {
                // From centre front to the wearer's left.
                let (right, left): (Vec<&Worn>, Vec<&Worn>) =
                    fronts.into_iter().partition(|worn| is_of(worn, Hand::Right));
                [left, backs, right].concat()
            }
            None => {
                let (right, left): (Vec<&Worn>, Vec<&Worn>) =
                    backs.into_iter().partition(|worn| is_of(worn, Hand::Right));
                [right, fronts, left].concat()
            }
        }
    }
}

/// Side `a` at the right end of a piece as drawn, and side `b` at the left end of the next piece.
fn ends<'w>(worn: &'w Worn, next: &'w Worn, label: Label) -> (Chain<'w>, Chain<'w>) {
    (worn.chain(label, Some(Hand::Left)), next.chain_back(label, Some(Hand::Right)))
}

fn lower_edge(worn: &Worn) -> Label {
    if matches!(worn.class, Class::Body | Class::SidePanel) { Label::Hem } else { Label::Lower }
}

fn upper_edge(worn: &Worn) -> Label {
    if worn.class == Class::Waistband { Label::Top } else { Label::Waist }
}
