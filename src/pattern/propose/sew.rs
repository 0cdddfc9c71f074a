//! Proposal of seams between the edges of recognised pieces.
//!
//! Every piece is seen from outside, so both sides of a seam run in opposite directions: side `a` is walked
//! counter-clockwise round its piece, `b` clockwise. A chain that spans several pieces is in the order of the walk.

use super::ask::Asker;
use super::notched::{self, Evidence};
use super::worn_pieces::{Along, Worn};
use super::{Class, Face, Hand, Label, ProposedSeam, SeamKind};
use crate::seams::{DEFAULT_LENGTH_TOLERANCE_MM, Ease, SeamEntry};
use geom::units::mm;

/// Relative length difference at which the confidence in a seam of straight edges is halved.
pub(super) const PLAIN_DOUBT: f64 = 0.06;
/// The same for sleeves, which are eased into the armhole, and waists, which may be gathered or open.
pub(super) const EASED_DOUBT: f64 = 0.15;
/// The same for the end of a sleeve, which is pleated or gathered into its cuff.
const GATHERED_DOUBT: f64 = 0.3;
/// Factor on the confidence in a seam at centre front or back.
pub(super) const CENTRE_CONFIDENCE: f64 = 0.7;
/// Least confidence of a proposed seam. Less likely seams become questions.
const LEAST_CONFIDENCE: f64 = 0.25;

/// Confidence in what the user has confirmed.
pub(super) const ANSWERED: f64 = 0.9;
/// Share of the remaining doubt that matching notches remove.
const NOTCHED_GAIN: f64 = 0.4;
/// Factor on the confidence in a seam whose notches match better reversed.
const NOTCHED_DOUBT: f64 = 0.6;

pub(super) type Chain<'w> = Vec<Along<'w>>;
type Joined<Place> = (Class, Label, fn(Place) -> SeamKind);

pub fn sew(worn: &[Worn], asker: &mut Asker<'_>) -> Vec<ProposedSeam> {
    let mut tailor = Tailor::new(worn, asker);
    tailor.darts();
    for hand in Hand::BOTH {
        tailor.princess(hand);
        tailor.sides(hand);
        tailor.sleeve(hand);
        tailor.cuff(hand);
    }
    tailor.whole_legs();
    for face in Face::BOTH {
        tailor.centre(face);
        tailor.yoke(face);
        tailor.waist(face);
    }
    tailor.ring();
    tailor.waistbands();
    tailor.collar();
    tailor.seams
}

/// Names of edges that are in no seam and probably openings.
pub fn open(worn: &[Worn], seams: &[ProposedSeam]) -> Vec<String> {
    let is_sewn = |name: &String| seams.iter().any(|seam| seam.entry.a.contains(name) || seam.entry.b.contains(name));
    let may_be_open = |label: Label| {
        matches!(label, Label::Hem | Label::Neck | Label::Armhole | Label::Waist | Label::Lower | Label::Top)
    };
    let edges = worn.iter().flat_map(|worn| {
        let free = worn.edges.iter().filter(|edge| edge.label.is_some_and(may_be_open));
        free.map(|edge| Along { piece: worn, edge }.to_string())
    });
    edges.filter(|name| !is_sewn(name)).collect()
}

pub(super) struct Tailor<'w, 'q, 'a> {
    pub worn: &'w [Worn],
    seams: Vec<ProposedSeam>,
    pub asker: &'q mut Asker<'a>,
}

fn centre_question(kind: &SeamKind) -> String {
    format!("{kind}: a seam, a fold, or an opening?")
}

impl<'w, 'q, 'a> Tailor<'w, 'q, 'a> {
    pub fn new(worn: &'w [Worn], asker: &'q mut Asker<'a>) -> Self {
        Self { worn, seams: Vec::new(), asker }
    }
}

impl<'w> Tailor<'w, '_, '_> {
    /// A whole piece serves both sides.
    pub fn find(&self, class: Class, face: Option<Face>, hand: Hand) -> Option<&'w Worn> {
        self.worn
            .iter()
            .find(|worn| worn.class == class && worn.face == face && (worn.hand == Some(hand) || worn.hand.is_none()))
    }

    pub fn add(&mut self, kind: SeamKind, a: Chain<'_>, b: Chain<'_>, pieces: &[&Worn], doubt: f64) {
        let length = |chain: &[Along<'_>]| chain.iter().map(|along| mm(along.edge.length)).sum::<f64>();
        let (a_mm, b_mm) = (length(&a), length(&b));
        if a.is_empty() || b.is_empty() {
            return;
        }
        let about = || a.iter().chain(&b).map(Along::to_string).collect::<Vec<_>>();
        let difference = (a_mm - b_mm).abs() / a_mm.max(b_mm);
        let sure = pieces.iter().map(|piece| piece.confidence).fold(1.0, f64::min);
        // Half pieces do not show how they are joined at the centre. The user's answer does.
        let is_known = !kind.is_centre() || self.asker.is_answered(&centre_question(&kind));
        let known = if is_known { 1.0 } else { CENTRE_CONFIDENCE };
        let mut confidence = known * sure / (1.0 + (difference / doubt).powi(2));
        let mut is_turned = false;
        match notched::evidence(&a, &b) {
            Evidence::For => confidence += NOTCHED_GAIN * (1.0 - confidence),
            Evidence::Turned => {
                let text = format!(
                    "{}: its notches match better with one side turned round; which is it?",
                    kind.on_either_side()
                );
                let choices = ["as the outlines lie", "with one side turned round"];
                is_turned = self.asker.ask_at(about(), text, choices, Some(0)) == Some(1);
                confidence *= NOTCHED_DOUBT;
            }
            Evidence::None => {}
        }
        if confidence < LEAST_CONFIDENCE {
            // Lengths stand in the choices: the question is the same in every size.
            let text = format!(
                "{}: its sides look as if they do not belong together; what is sewn there?",
                kind.on_either_side()
            );
            let nothing = format!("nothing: they are {:.0} and {:.0} mm long", a_mm.min(b_mm), a_mm.max(b_mm));
            let eased = format!("one to the other, {:.0} mm eased in", (a_mm - b_mm).abs());
            if self.asker.ask_at(about(), text, [nothing, eased], Some(0)) != Some(1) {
                return;
            }
            confidence = ANSWERED;
        }
        let names = |chain: Chain<'_>| chain.iter().map(Along::to_string).collect();
        let excess = ((a_mm - b_mm) * 10.0).round() / 10.0;
        let ease_mm = Ease::Same(if excess.abs() > 0.5 * DEFAULT_LENGTH_TOLERANCE_MM { excess } else { 0.0 });
        let entry = SeamEntry { name: kind.to_string(), a: names(a), b: names(b), same_direction: is_turned, ease_mm };
        self.seams.push(ProposedSeam { entry, kind, a_mm, b_mm, confidence });
    }

    fn darts(&mut self) {
        for worn in self.worn {
            for (number, [a, b]) in worn.darts.iter().enumerate() {
                let leg = |name: &String| {
                    worn.edges
                        .iter()
                        .filter(|edge| edge.name == *name)
                        .map(|edge| Along { piece: worn, edge })
                        .collect()
                };
                let kind = SeamKind::Dart { piece: worn.id.clone(), number: number + 1 };
                self.add(kind, leg(a), leg(b), &[worn], PLAIN_DOUBT);
            }
        }
    }

    fn sides(&mut self, hand: Hand) {
        let pairs: [Joined<Hand>; 8] = [
            (Class::Body, Label::Side, SeamKind::Side),
            (Class::Body, Label::Shoulder, SeamKind::Shoulder),
            (Class::Skirt, Label::Side, SeamKind::SkirtSide),
            (Class::Leg, Label::Outseam, SeamKind::Outseam),
            (Class::Leg, Label::Inseam, SeamKind::Inseam),
            (Class::Sleeve, Label::Top, SeamKind::SleeveTop),
            (Class::Sleeve, Label::Underarm, SeamKind::SleeveUnderarm),
            (Class::Waistband, Label::End, SeamKind::WaistbandSide),
        ];
        for (class, label, kind) in pairs {
            if label == Label::Side && class == Class::Body && self.side_panel(hand) {
                continue;
            }
            let [front, back] = Face::BOTH.map(|face| self.along(class, label, face, hand));
            if !front.is_empty() && !back.is_empty() {
                let a = front.iter().flat_map(|(worn, label)| worn.chain(*label, Some(hand))).collect();
                let b = back.iter().flat_map(|(worn, label)| worn.chain_back(*label, Some(hand))).collect();
                let pieces: Vec<&Worn> = front.iter().chain(&back).map(|(worn, _)| *worn).collect();
                self.add(kind(hand), a, b, &pieces, PLAIN_DOUBT);
            }
        }
    }

    /// Joins a panel between front and back to both. False without such a panel.
    fn side_panel(&mut self, hand: Hand) -> bool {
        let Some(panel) = self.find(Class::SidePanel, None, hand) else { return false };
        // Seen from outside, the front lies on the right of a right panel, and on the left of a left one.
        for (face, side) in [(Face::Front, hand), (Face::Back, hand.other())] {
            let beside = self.along(Class::Body, Label::Side, face, hand);
            let pieces: Vec<&Worn> = beside.iter().map(|(worn, _)| *worn).chain([panel]).collect();
            let a = beside.iter().flat_map(|(worn, label)| worn.chain(*label, Some(hand))).collect();
            self.add(SeamKind::SideOf(face, hand), a, panel.chain_back(Label::Side, Some(side)), &pieces, PLAIN_DOUBT);
        }
        true
    }

    /// Pieces of front or back along a seam of one side, each with its label there, in the order of the walk. A yoke
    /// over the shoulders has the shoulder of the pieces that hang from it. A yoke below the waist has the upper end of
    /// the seams of the pieces that it is sewn onto.
    fn along(&self, class: Class, label: Label, face: Face, hand: Hand) -> Vec<(&'w Worn, Label)> {
        let Some(main) = self.find(class, Some(face), hand) else { return Vec::new() };
        let panel = self.find(Class::SidePanel, Some(face), hand).filter(|panel| panel.has(label));
        let yoke = self.find(Class::Yoke, Some(face), hand);
        match yoke {
            _ if class == Class::Body && panel.is_some() => {
                let mut walk = vec![main];
                walk.extend(panel);
                walk.retain(|worn| worn.has(label));
                // On the right, the walk goes from the neck outwards.
                if hand == Hand::Left {
                    walk.reverse();
                }
                walk.into_iter().map(|worn| (worn, label)).collect()
            }
            Some(yoke) if label == Label::Shoulder && !main.has(label) => vec![(yoke, label)],
            Some(yoke) if label != Label::Inseam && class != Class::Body && yoke.has(Label::Waist) => {
                let is_middle = matches!(label, Label::Crotch | Label::Centre);
                let of_yoke = if is_middle { Label::Centre } else { Label::Side };
                let mut walk = vec![(yoke, of_yoke), (main, label)];
                // On the outer side, the walk goes down on the right and up on the left. At the centre, down behind and
                // up in front.
                if if is_middle { face == Face::Front } else { hand == Hand::Left } {
                    walk.reverse();
                }
                walk
            }
            _ => vec![(main, label)],
        }
    }

    fn princess(&mut self, hand: Hand) {
        for face in Face::BOTH {
            let piece_of = |class: Class| self.find(class, Some(face), hand);
            if let (Some(panel), Some(middle)) = (piece_of(Class::SidePanel), piece_of(Class::Body)) {
                let (a, b) = (panel.chain(Label::Princess, None), middle.chain_back(Label::Princess, Some(hand)));
                self.add(SeamKind::Princess(face, hand), a, b, &[panel, middle], PLAIN_DOUBT);
            }
        }
    }

    fn raglan(&mut self, sleeve: &'w Worn, hand: Hand) {
        for (face, side) in [(Face::Front, hand), (Face::Back, hand.other())] {
            let Some(body) = self.find(Class::Body, Some(face), hand) else { continue };
            let (a, b) = (sleeve.chain(Label::Cap, Some(side)), body.chain_back(Label::Armhole, Some(hand)));
            self.add(SeamKind::Raglan(face, hand), a, b, &[sleeve, body], EASED_DOUBT);
        }
    }

    fn sleeve(&mut self, hand: Hand) {
        let whole =
            self.worn.iter().find(|worn| worn.class == Class::Sleeve && worn.is_whole && worn.hand == Some(hand));
        // Counter-clockwise, the cap of a right sleeve runs from front to back.
        let order = if hand == Hand::Right { Face::BOTH } else { [Face::Back, Face::Front] };
        let mut pieces: Vec<&Worn> = Vec::new();
        let mut cap = Chain::new();
        if let Some(sleeve) = whole {
            let front = sleeve.chain(Label::Underarm, Some(Hand::Right));
            let back = sleeve.chain_back(Label::Underarm, Some(Hand::Left));
            self.add(SeamKind::Underarm(hand), front, back, &[sleeve], PLAIN_DOUBT);
            if sleeve.has(Label::Neck) {
                self.raglan(sleeve, hand);
                return;
            }
            pieces.push(sleeve);
            cap = sleeve.chain(Label::Cap, None);
        } else {
            for half in order.iter().filter_map(|&face| self.find(Class::Sleeve, Some(face), hand)) {
                pieces.push(half);
                cap.extend(half.chain(Label::Cap, None));
            }
        }
        // The armhole begins and ends in the middle of a panel between front and back.
        let panel = self.find(Class::SidePanel, None, hand);
        let half = |side: Hand| panel.map_or(Chain::new(), |panel| panel.chain_back(Label::Armhole, Some(side)));
        let mut armhole = half(Hand::Right);
        pieces.extend(panel);
        // The walk goes up the first face, across both yokes, and down the second face.
        let up = [Class::SidePanel, Class::Body, Class::Yoke].map(|class| (class, order[0]));
        let down = [Class::Yoke, Class::Body, Class::SidePanel].map(|class| (class, order[1]));
        for body in up.into_iter().chain(down).filter_map(|(class, face)| self.find(class, Some(face), hand)) {
            let edges = body.chain_back(Label::Armhole, Some(hand));
            if !edges.is_empty() {
                pieces.push(body);
                armhole.extend(edges);
            }
        }
        armhole.extend(half(Hand::Left));
        self.add(SeamKind::Armhole(hand), cap, armhole, &pieces, EASED_DOUBT);
    }

    fn whole_legs(&mut self) {
        let legs = Hand::BOTH.map(|hand| self.whole_leg(hand));
        for (hand, leg) in Hand::BOTH.into_iter().zip(legs) {
            let Some(leg) = leg else { continue };
            let (a, b) = (leg.chain(Label::Inseam, Some(Hand::Right)), leg.chain_back(Label::Inseam, Some(Hand::Left)));
            self.add(SeamKind::Inseam(hand), a, b, &[leg], PLAIN_DOUBT);
        }
        let [Some(right), Some(left)] = legs else { return };
        // Seen from outside, the front of a right leg lies on the right, that of a left leg on the left.
        for (face, side) in Face::BOTH.into_iter().zip(Hand::BOTH) {
            let a = right.chain(Label::Crotch, Some(side));
            let b = left.chain_back(Label::Crotch, Some(side.other()));
            self.add(SeamKind::Crotch(face), a, b, &[right, left], PLAIN_DOUBT);
        }
    }

    pub fn whole_leg(&self, hand: Hand) -> Option<&'w Worn> {
        self.worn.iter().find(|worn| worn.class == Class::Leg && worn.is_whole && worn.hand == Some(hand))
    }

    fn cuff(&mut self, hand: Hand) {
        let halves = Face::BOTH
            .map(|face| (self.find(Class::Cuff, Some(face), hand), self.find(Class::Sleeve, Some(face), hand)));
        for (face, (cuff, sleeve)) in Face::BOTH.into_iter().zip(halves) {
            let (Some(cuff), Some(sleeve)) = (cuff, sleeve) else { continue };
            let (a, b) = (sleeve.chain(Label::Hem, None), cuff.chain_back(Label::Top, None));
            self.add(SeamKind::CuffHalf(face, hand), a, b, &[cuff, sleeve], GATHERED_DOUBT);
        }
        let sleeve =
            self.worn.iter().find(|worn| worn.class == Class::Sleeve && worn.is_whole && worn.hand == Some(hand));
        let cuff =
            self.worn.iter().find(|worn| worn.class == Class::Cuff && worn.face.is_none() && worn.hand == Some(hand));
        if let (Some(sleeve), Some(cuff)) = (sleeve, cuff) {
            let (a, b) = (sleeve.chain(Label::Hem, None), cuff.chain_back(Label::Top, None));
            self.add(SeamKind::Cuff(hand), a, b, &[cuff, sleeve], GATHERED_DOUBT);
            let (a, b) = (cuff.chain(Label::End, Some(Hand::Right)), cuff.chain_back(Label::End, Some(Hand::Left)));
            self.add(SeamKind::CuffEnds(hand), a, b, &[cuff], PLAIN_DOUBT);
        }
        if let [(Some(front), _), (Some(back), _)] = halves {
            for end in Hand::BOTH {
                let (a, b) = (front.chain(Label::End, Some(end)), back.chain_back(Label::End, Some(end.other())));
                self.add(SeamKind::CuffSide(hand, end), a, b, &[front, back], PLAIN_DOUBT);
            }
        }
    }

    fn centre(&mut self, face: Face) {
        let halves: [Joined<Face>; 4] = [
            (Class::Body, Label::Centre, SeamKind::Centre),
            (Class::Yoke, Label::Centre, SeamKind::YokeCentre),
            (Class::Skirt, Label::Centre, SeamKind::SkirtCentre),
            (Class::Leg, Label::Crotch, SeamKind::Crotch),
        ];
        for (class, label, kind) in halves {
            let is_half = |hand: Hand| self.find(class, Some(face), hand).is_some_and(|worn| worn.hand.is_some());
            // A yoke below the waist is joined together with the piece that carries it.
            let is_low = |worn: &Worn| worn.class == Class::Yoke && worn.has(Label::Waist);
            if !Hand::BOTH.into_iter().all(is_half) || self.find(class, Some(face), Hand::Right).is_some_and(is_low) {
                continue;
            }
            let [right, left] = Hand::BOTH.map(|hand| self.along(class, label, face, hand));
            let a: Chain<'_> = right.iter().flat_map(|(worn, label)| worn.chain(*label, None)).collect();
            let b: Chain<'_> = left.iter().flat_map(|(worn, label)| worn.chain_back(*label, None)).collect();
            let pieces: Vec<&Worn> = right.iter().chain(&left).map(|(worn, _)| *worn).collect();
            let kind = kind(face);
            let choices = ["a seam or a fold", "an opening"];
            let mut asked = || {
                let about = a.iter().chain(&b).map(Along::to_string).collect();
                self.asker.ask_at(about, centre_question(&kind), choices, Some(0))
            };
            let is_open = kind.is_centre() && asked() == Some(1);
            if !is_open {
                self.add(kind, a, b, &pieces, PLAIN_DOUBT);
            }
        }
    }
}
