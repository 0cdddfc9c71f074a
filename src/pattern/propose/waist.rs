//! What is sewn to what from the waist up and down: yokes, bodices, waistbands, skirts and legs.

use super::sew::{Chain, EASED_DOUBT, PLAIN_DOUBT, Tailor};
use super::worn::Worn;
use super::{Class, Face, Hand, Label, SeamKind};

impl<'w> Tailor<'w, '_, '_> {
    /// Pieces of a kind and face, as their lower edges follow one another counter-clockwise.
    pub fn row(&self, class: Class, face: Face) -> Vec<&'w Worn> {
        let order = if face == Face::Front { Hand::BOTH } else { [Hand::Left, Hand::Right] };
        let mut row: Vec<&Worn> = Vec::new();
        for one in order.iter().filter_map(|&hand| self.find(class, Some(face), hand)) {
            if !row.iter().any(|other| other.id == one.id) {
                row.push(one);
            }
        }
        if class == Class::Body && !row.is_empty() {
            let [first, last] = order.map(|hand| self.find(Class::SidePanel, Some(face), hand));
            row = first.into_iter().chain(row).chain(last).collect();
        }
        row
    }

    /// A yoke over the shoulders to what hangs from it.
    pub fn yoke(&mut self, face: Face) {
        let (yokes, bodies) = (self.row(Class::Yoke, face), self.row(Class::Body, face));
        let a: Chain<'_> = yokes.iter().flat_map(|one| one.chain(Label::Lower, None)).collect();
        let b: Chain<'_> = bodies.iter().flat_map(|one| one.chain_back(Label::Top, None)).collect();
        let pieces: Vec<&Worn> = yokes.iter().chain(&bodies).copied().collect();
        self.add(SeamKind::Yoke(face), a, b, &pieces, EASED_DOUBT);
    }

    /// Lower edge of what is above to the upper edge of what is below, of one face: bodice, waistband, yoke, skirt or legs.
    pub fn waist(&mut self, face: Face) {
        let level = |class: Class| match self.row(class, face) {
            row if row.is_empty() && class == Class::Skirt => self.gores(face),
            row => row,
        };
        let levels: Vec<Vec<&Worn>> = [Class::Body, Class::Waistband, Class::Yoke, Class::Skirt, Class::Leg]
            .into_iter()
            .map(level)
            .filter(|row| row.iter().any(|one| one.class != Class::Yoke || one.has(Label::Waist)))
            .collect();
        let has_band_round = !self.bands_round().is_empty();
        for (index, pair) in levels.windows(2).enumerate() {
            let (above, below) = (&pair[0], &pair[1]);
            if above.iter().any(|one| one.class == Class::Body) && has_band_round {
                continue;
            }
            let a = above.iter().flat_map(|one| one.chain(lower_edge(one), None)).collect();
            let b = below.iter().flat_map(|one| one.chain_back(upper_edge(one), None)).collect();
            let pieces: Vec<&Worn> = above.iter().chain(below).copied().collect();
            self.add(SeamKind::WaistLevel(face, index + 1), a, b, &pieces, EASED_DOUBT);
        }
    }

    /// A skirt of one piece, sewn to itself, or gores to each other.
    pub fn ring(&mut self) {
        let skirt = self.skirt_round();
        for (k, &one) in skirt.iter().enumerate() {
            let next = skirt[(k + 1) % skirt.len()];
            let (a, b) = ends(one, next, Label::Side);
            let kind = if one.is_gore { SeamKind::Gore(k + 1) } else { SeamKind::SkirtRound };
            self.add(kind, a, b, &[one, next], PLAIN_DOUBT);
        }
    }

    /// Gores, as they follow one another to the right seen from outside, or a skirt of one piece.
    fn skirt_round(&self) -> Vec<&'w Worn> {
        let is_round = |one: &&Worn| one.class == Class::Skirt && one.face.is_none() && one.hand.is_none();
        self.worn.iter().filter(is_round).collect()
    }

    /// Gores below the front or the back of a band in halves.
    fn gores(&self, face: Face) -> Vec<&'w Worn> {
        let gores: Vec<&Worn> = self.skirt_round().into_iter().filter(|one| one.is_gore).collect();
        let [front, back] = [&gores[..gores.len().div_ceil(2)], &gores[gores.len().div_ceil(2)..]];
        if face == Face::Front { front.to_vec() } else { back.to_vec() }
    }

    /// Waistbands that belong to no face: one all round, or one for each side.
    fn bands_round(&self) -> Vec<&'w Worn> {
        self.worn.iter().filter(|one| one.class == Class::Waistband && one.face.is_none()).collect()
    }

    /// Waistbands of one piece, or of a right and a left one, to what is above and below, and their ends to each other. A
    /// pattern does not say where a band begins: in the middle of the front if that is a seam, or of the back, else at a side.
    pub fn waistbands(&mut self) {
        let bands = self.bands_round();
        let side = |hand: Hand| bands.iter().copied().find(|band| band.hand == Some(hand));
        if let Some(band) = bands.iter().copied().find(|band| band.hand.is_none()) {
            self.asker.tell(format!("where does `{}` open, and at which seam does it begin?", band.id));
            self.band(band, None);
            // On a skirt of one piece the waist is closed by the skirt; the band may well lap over there.
            if self.skirt_round().is_empty() {
                let (a, b) = ends(band, band, Label::End);
                self.add(SeamKind::Waistband, a, b, &[band], PLAIN_DOUBT);
            }
        } else if let [Some(right), Some(left)] = Hand::BOTH.map(side) {
            self.asker.tell("where do the waistbands open? They are taken to meet at centre front and back".to_owned());
            for band in [right, left] {
                self.band(band, band.hand);
            }
            // Each runs to the wearer's left: the right one from behind, the left one from the front.
            for (face, [one, other]) in Face::BOTH.into_iter().zip([[right, left], [left, right]]) {
                let (a, b) = ends(one, other, Label::End);
                self.add(SeamKind::WaistbandCentre(face), a, b, &[one, other], PLAIN_DOUBT);
            }
        }
    }

    /// One band to all that is above and below it, of one side or all round.
    fn band(&mut self, band: &'w Worn, hand: Option<Hand>) {
        let below = [Class::Skirt, Class::Leg].map(|class| self.round(class, hand));
        if let Some(below) = below.iter().find(|pieces| !pieces.is_empty()) {
            let b: Chain<'_> = below.iter().flat_map(|one| one.chain_back(Label::Waist, None)).collect();
            let pieces: Vec<&Worn> = below.iter().copied().chain([band]).collect();
            self.add(SeamKind::Waist(hand), band.chain(Label::Lower, None), b, &pieces, EASED_DOUBT);
        }
        let above = self.round(Class::Body, hand);
        let a: Chain<'_> = above.iter().flat_map(|one| one.chain(Label::Hem, None)).collect();
        let pieces: Vec<&Worn> = above.iter().copied().chain([band]).collect();
        self.add(SeamKind::WaistAbove(hand), a, band.chain_back(Label::Top, None), &pieces, EASED_DOUBT);
    }

    /// Pieces of a kind all round the body, or round one side of it, as their lower edges follow one another; a yoke on a skirt
    /// or legs stands for what it lies on.
    fn round(&self, class: Class, hand: Option<Hand>) -> Vec<&'w Worn> {
        let of_face = |face: Face| {
            let yokes = self.row(Class::Yoke, face);
            let has_yoke = class != Class::Body && yokes.iter().any(|one| one.has(Label::Waist));
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
        let is_of = |one: &&Worn, hand: Hand| one.hand == Some(hand);
        match hand {
            Some(hand) => {
                let order = if hand == Hand::Right { [backs, fronts] } else { [fronts, backs] };
                order.concat().into_iter().filter(|one| is_of(one, hand)).collect()
            }
            None if fronts.len() > 1 => {
                // From centre front to the wearer's left.
                let (right, left): (Vec<&Worn>, Vec<&Worn>) =
                    fronts.into_iter().partition(|one| is_of(one, Hand::Right));
                [left, backs, right].concat()
            }
            None => {
                let (right, left): (Vec<&Worn>, Vec<&Worn>) =
                    backs.into_iter().partition(|one| is_of(one, Hand::Right));
                [right, fronts, left].concat()
            }
        }
    }
}

/// Side `a` at the right end of one band as drawn, and side `b` at the left end of the other that follows it.
fn ends<'w>(one: &'w Worn, next: &'w Worn, label: Label) -> (Chain<'w>, Chain<'w>) {
    (one.chain(label, Some(Hand::Left)), next.chain_back(label, Some(Hand::Right)))
}

fn lower_edge(one: &Worn) -> Label {
    if matches!(one.class, Class::Body | Class::SidePanel) { Label::Hem } else { Label::Lower }
}

fn upper_edge(one: &Worn) -> Label {
    if one.class == Class::Waistband { Label::Top } else { Label::Waist }
}
