//! Which edges belong together.
//!
//! Every piece is seen from outside, so both sides of a seam run against each other: `a` is walked counter-clockwise
//! round its piece, `b` clockwise, and a chain over several pieces is written in the order of the walk.

use super::notched::{self, Evidence};
use super::worn::Worn;
use super::{Class, Face, Hand, Label, ProposedSeam};
use crate::pattern::seams::{DEFAULT_LENGTH_TOLERANCE_MM, SeamEntry};
use crate::units::mm;

/// Difference of length, share of the longer side, at which a seam of straight edges is not believed.
const PLAIN_DOUBT: f64 = 0.06;
/// The same for a sleeve, which is eased into its armhole, and a waist, which may be gathered or open.
const EASED_DOUBT: f64 = 0.15;
/// Confidence in a seam at centre front or back.
const CENTRE_CONFIDENCE: f64 = 0.7;
/// Least confidence of a seam that is proposed; less sure ones are asked about.
const LEAST_CONFIDENCE: f64 = 0.25;

/// Share of the remaining doubt that matching notches take away.
const NOTCHED_GAIN: f64 = 0.4;
/// Confidence in a seam whose notches match better the other way round.
const NOTCHED_DOUBT: f64 = 0.6;

/// Edges in order with their lengths, m.
type Chain = Vec<(String, f64)>;

/// Proposes the seams of a garment.
pub fn sew(worn: &[Worn], questions: &mut Vec<String>) -> Vec<ProposedSeam> {
    let mut tailor = Tailor { worn, seams: Vec::new(), questions };
    tailor.darts();
    for hand in Hand::BOTH {
        tailor.sides(hand);
        tailor.sleeve(hand);
        tailor.cuff(hand);
    }
    for face in Face::BOTH {
        tailor.centre(face);
        tailor.waist(face);
    }
    tailor.waistband();
    tailor.seams
}

/// Edges in no seam that may well be openings.
pub fn open(worn: &[Worn], seams: &[ProposedSeam]) -> Vec<String> {
    let is_sewn = |name: &String| seams.iter().any(|seam| seam.entry.a.contains(name) || seam.entry.b.contains(name));
    let may_be_open = |label: Label| {
        matches!(label, Label::Hem | Label::Neck | Label::Armhole | Label::Waist | Label::Lower | Label::Top)
    };
    let edges = worn.iter().flat_map(|one| {
        let free = one.edges.iter().filter(|edge| edge.label.is_some_and(may_be_open));
        free.map(|edge| format!("{}.{}", one.id, edge.name))
    });
    edges.filter(|name| !is_sewn(name)).collect()
}

struct Tailor<'w, 'q> {
    worn: &'w [Worn],
    seams: Vec<ProposedSeam>,
    questions: &'q mut Vec<String>,
}

impl<'w> Tailor<'w, '_> {
    /// The piece of a kind for a side; a whole piece is for both.
    fn find(&self, class: Class, face: Option<Face>, hand: Hand) -> Option<&'w Worn> {
        self.worn
            .iter()
            .find(|one| one.class == class && one.face == face && (one.hand == Some(hand) || one.hand.is_none()))
    }

    fn add(&mut self, name: String, a: Chain, b: Chain, pieces: &[&Worn], doubt: f64) {
        let length = |chain: &Chain| chain.iter().map(|(_, length)| mm(*length)).sum::<f64>();
        let (a_mm, b_mm) = (length(&a), length(&b));
        if a.is_empty() || b.is_empty() {
            return;
        }
        let difference = (a_mm - b_mm).abs() / a_mm.max(b_mm);
        let sure = pieces.iter().map(|piece| piece.confidence).fold(1.0, f64::min);
        // Half pieces say nothing of how they are joined in the middle.
        let known = if name.contains("centre") { CENTRE_CONFIDENCE } else { 1.0 };
        let mut confidence = known * sure / (1.0 + (difference / doubt).powi(2));
        match notched::evidence(self.worn, &a, &b) {
            Evidence::For => confidence += NOTCHED_GAIN * (1.0 - confidence),
            Evidence::Turned => {
                confidence *= NOTCHED_DOUBT;
                self.questions
                    .push(format!("{name}: its notches match better with one side turned round; which is it?"));
            }
            Evidence::None => {}
        }
        if confidence < LEAST_CONFIDENCE {
            self.questions.push(format!(
                "{name}: sides of {a_mm:.0} and {b_mm:.0} mm look as if they do not belong together; what is sewn there?"
            ));
            return;
        }
        let names = |chain: Chain| chain.into_iter().map(|(name, _)| name).collect();
        let excess = ((a_mm - b_mm) * 10.0).round() / 10.0;
        let ease_mm = if excess.abs() > 0.5 * DEFAULT_LENGTH_TOLERANCE_MM { excess } else { 0.0 };
        let entry = SeamEntry { name, a: names(a), b: names(b), same_direction: false, ease_mm };
        self.seams.push(ProposedSeam { entry, a_mm, b_mm, confidence });
    }

    fn darts(&mut self) {
        for one in self.worn {
            for (number, [a, b]) in one.darts.iter().enumerate() {
                let leg = |name: &String| {
                    let length = one.edges.iter().find(|edge| edge.name == *name).map_or(0.0, |edge| edge.length);
                    vec![(format!("{}.{name}", one.id), length)]
                };
                let name = format!("{}_dart_{}", one.id, number + 1);
                self.add(name, leg(a), leg(b), &[one], PLAIN_DOUBT);
            }
        }
    }

    /// Front to back: side, shoulder, outseam, inseam, and the lengthwise edges of half sleeves and bands.
    fn sides(&mut self, hand: Hand) {
        let pairs = [
            (Class::Body, Label::Side),
            (Class::Body, Label::Shoulder),
            (Class::Skirt, Label::Side),
            (Class::Leg, Label::Outseam),
            (Class::Leg, Label::Inseam),
            (Class::Sleeve, Label::Top),
            (Class::Sleeve, Label::Underarm),
            (Class::Waistband, Label::End),
        ];
        for (class, label) in pairs {
            let found = [Face::Front, Face::Back].map(|face| self.find(class, Some(face), hand));
            if let [Some(front), Some(back)] = found {
                let name = match class {
                    Class::Body | Class::Leg => format!("{}_{}", label.as_str(), hand.as_str()),
                    Class::Skirt => format!("skirt_{}_{}", label.as_str(), hand.as_str()),
                    Class::Waistband => format!("waistband_{}", hand.as_str()),
                    _ => format!("sleeve_{}_{}", label.as_str(), hand.as_str()),
                };
                let (a, b) = (front.chain(label, Some(hand)), back.chain_back(label, Some(hand)));
                self.add(name, a, b, &[front, back], PLAIN_DOUBT);
            }
        }
    }

    /// A sleeve to itself and to its armhole.
    fn sleeve(&mut self, hand: Hand) {
        let whole = self.worn.iter().find(|one| one.class == Class::Sleeve && one.is_whole && one.hand == Some(hand));
        // Counter-clockwise round a right sleeve the cap runs from its front to its back.
        let order = if hand == Hand::Right { Face::BOTH } else { [Face::Back, Face::Front] };
        let mut pieces: Vec<&Worn> = Vec::new();
        let mut cap = Chain::new();
        if let Some(sleeve) = whole {
            let front = sleeve.chain(Label::Underarm, Some(Hand::Right));
            let back = sleeve.chain_back(Label::Underarm, Some(Hand::Left));
            self.add(format!("underarm_{}", hand.as_str()), front, back, &[sleeve], PLAIN_DOUBT);
            pieces.push(sleeve);
            cap = sleeve.chain(Label::Cap, None);
        } else {
            for half in order.iter().filter_map(|&face| self.find(Class::Sleeve, Some(face), hand)) {
                pieces.push(half);
                cap.extend(half.chain(Label::Cap, None));
            }
        }
        let mut armhole = Chain::new();
        for body in order.iter().filter_map(|&face| self.find(Class::Body, Some(face), hand)) {
            pieces.push(body);
            armhole.extend(body.chain_back(Label::Armhole, Some(hand)));
        }
        self.add(format!("armhole_{}", hand.as_str()), cap, armhole, &pieces, EASED_DOUBT);
    }

    /// Cuffs in halves to half sleeves, and to each other.
    fn cuff(&mut self, hand: Hand) {
        let halves = Face::BOTH
            .map(|face| (self.find(Class::Cuff, Some(face), hand), self.find(Class::Sleeve, Some(face), hand)));
        for (face, (cuff, sleeve)) in Face::BOTH.into_iter().zip(halves) {
            let (Some(cuff), Some(sleeve)) = (cuff, sleeve) else { continue };
            let name = format!("cuff_{}_{}", face.as_str(), hand.as_str());
            self.add(
                name,
                sleeve.chain(Label::Hem, None),
                cuff.chain_back(Label::Top, None),
                &[cuff, sleeve],
                EASED_DOUBT,
            );
        }
        let sleeve = self.worn.iter().find(|one| one.class == Class::Sleeve && one.is_whole && one.hand == Some(hand));
        let cuff =
            self.worn.iter().find(|one| one.class == Class::Cuff && one.face.is_none() && one.hand == Some(hand));
        if let (Some(sleeve), Some(cuff)) = (sleeve, cuff) {
            let (a, b) = (sleeve.chain(Label::Hem, None), cuff.chain_back(Label::Top, None));
            self.add(format!("cuff_{}", hand.as_str()), a, b, &[cuff, sleeve], EASED_DOUBT);
        }
        if let [(Some(front), _), (Some(back), _)] = halves {
            for (name, of_front, of_back) in [("a", Hand::Right, Hand::Left), ("b", Hand::Left, Hand::Right)] {
                let (a, b) = (front.chain(Label::End, Some(of_front)), back.chain_back(Label::End, Some(of_back)));
                self.add(format!("cuff_{}_{name}", hand.as_str()), a, b, &[front, back], PLAIN_DOUBT);
            }
        }
    }

    /// Left to right half of the same face.
    fn centre(&mut self, face: Face) {
        for (class, label, name) in [
            (Class::Body, Label::Centre, "centre"),
            (Class::Skirt, Label::Centre, "skirt_centre"),
            (Class::Leg, Label::Crotch, "crotch"),
        ] {
            let found = Hand::BOTH.map(|hand| self.find(class, Some(face), hand));
            if let [Some(right), Some(left)] = found.map(|one| one.filter(|one| one.hand.is_some())) {
                let (a, b) = (right.chain(label, None), left.chain_back(label, None));
                let name = format!("{name}_{}", face.as_str());
                if label == Label::Centre {
                    self.questions.push(format!("{name}: a seam, a fold, or an opening? A seam is proposed"));
                }
                self.add(name, a, b, &[right, left], PLAIN_DOUBT);
            }
        }
    }

    /// Pieces of a kind and face, as their lower edges follow one another counter-clockwise.
    fn row(&self, class: Class, face: Face) -> Vec<&'w Worn> {
        let order = if face == Face::Front { Hand::BOTH } else { [Hand::Left, Hand::Right] };
        let mut row: Vec<&Worn> = Vec::new();
        for one in order.iter().filter_map(|&hand| self.find(class, Some(face), hand)) {
            if !row.iter().any(|other| other.id == one.id) {
                row.push(one);
            }
        }
        row
    }

    /// Lower edge of what is above to the upper edge of what is below: bodice, waistband, skirt or legs.
    fn waist(&mut self, face: Face) {
        let levels: Vec<Vec<&Worn>> = [Class::Body, Class::Waistband, Class::Skirt, Class::Leg]
            .into_iter()
            .map(|class| self.row(class, face))
            .filter(|row| !row.is_empty())
            .collect();
        for (index, pair) in levels.windows(2).enumerate() {
            let (above, below) = (&pair[0], &pair[1]);
            let lower = if above[0].class == Class::Body { Label::Hem } else { Label::Lower };
            let upper = if below[0].class == Class::Waistband { Label::Top } else { Label::Waist };
            let a = above.iter().flat_map(|one| one.chain(lower, None)).collect();
            let b = below.iter().flat_map(|one| one.chain_back(upper, None)).collect();
            let pieces: Vec<&Worn> = above.iter().chain(below).copied().collect();
            self.add(format!("waist_{}_{}", face.as_str(), index + 1), a, b, &pieces, EASED_DOUBT);
        }
    }

    /// A waistband of one piece: where it begins depends on the opening, which a pattern does not say.
    fn waistband(&mut self) {
        let alone =
            |class: Class| self.worn.iter().find(|one| one.class == class && one.face.is_none() && one.hand.is_none());
        let [skirt, band] = [Class::Skirt, Class::Waistband].map(alone);
        let ends =
            |one: &Worn, label: Label| (one.chain(label, Some(Hand::Right)), one.chain_back(label, Some(Hand::Left)));
        if let Some(skirt) = skirt {
            let (a, b) = ends(skirt, Label::Side);
            self.add("skirt_side".to_owned(), a, b, &[skirt], PLAIN_DOUBT);
        }
        if let (Some(skirt), Some(band)) = (skirt, band) {
            let (a, b) = (skirt.chain(Label::Waist, None), band.chain_back(Label::Lower, None));
            self.add("waist".to_owned(), a, b, &[skirt, band], EASED_DOUBT);
        }
        let band = self.worn.iter().find(|one| one.class == Class::Waistband && one.face.is_none());
        if let Some(band) = band {
            self.questions.push(format!("where does `{}` open, and at which seam does it begin?", band.id));
        }
    }
}
