//! Proposal by evidence: the pieces as they are cut, and the seams that the recogniser finds between them.

use std::collections::BTreeMap;

use super::ask::Asker;
use super::cutting::Cutting;
use super::worn_pieces::{Worn, WornEdge, id_of_kind};
use super::{Class, Face, Hand, Label, ProposedSeam, SeamKind, role_of};
use crate::piece::Piece;
use crate::recogniser::facts::Facts;
use crate::recogniser::network::{Garment, Kind, Likelihoods};
use crate::recogniser::settle::{self, Found, Settled};
use crate::recogniser::{self, Part};
use crate::seams::{DEFAULT_LENGTH_TOLERANCE_MM, Ease, PieceEntry, SeamEntry};
use crate::style::correspond::shares;
use crate::style::named::reference;
use crate::trade::{Named, PartName};
use geom::units::mm;

/// Most questions that are open at the same time: the answer to one settles others.
const MOST_ASKED: usize = 3;
/// Likelihood below which what a stretch is sewn to is asked.
const DOUBTED: f64 = 0.8;
/// Length of a stretch below which it is not asked about, and its kind says little.
const LEAST_ASKED_M: f64 = 30e-3;
/// Cost in nats of a seam between a front of one hand and a back of the other: drawn from inside, a piece is of the other
/// hand.
const CROSSED: f64 = 3.0;
/// Cost in nats of names that mislead: a stranger's words may be of any language.
const MISNAMED: f64 = 1.0;
/// Length beyond which a stretch matters no more.
const LONG_M: f64 = 0.3;
/// Least likelihood of a partner that is offered.
const OFFERED: f64 = 0.02;
const MOST_OFFERED: usize = 4;

pub struct Evident {
    pub worn: Vec<Worn>,
    pub seams: Vec<ProposedSeam>,
    /// Edges that stay free.
    pub open: Vec<String>,
    /// Share of the outlines whose partner, or whose being free, is likelier than [`DOUBTED`].
    pub surety: f64,
    /// Texts of the questions about edges, each with its edge where that is of a piece in a seam.
    pub asked: Vec<(String, Option<String>)>,
}

/// A piece as it is worn.
#[derive(Clone, Copy)]
struct Copy {
    piece: usize,
    is_mirror: bool,
}

/// Takes the pieces that `is_worn` accepts. `None` where nothing is sewn.
pub fn evident(
    pieces: &[Piece],
    named: &[Named],
    is_worn: impl Fn(usize) -> bool,
    asker: &mut Asker<'_>,
) -> Option<Evident> {
    let drawn = recogniser::parts(pieces, named);
    let copies = (0..pieces.len()).filter(|&k| is_worn(k)).map(|piece| Copy { piece, is_mirror: false }).collect();
    let ways = ways(&drawn, copies);
    let weighed = ways.into_iter().map(|(cost, copies, parts)| {
        let garment = Garment::of(&parts);
        let settled = settle::seams(&garment, &Facts::default());
        let evidence = settled.evidence() - cost - CROSSED * crossed(&parts, &garment, &settled.seams) as f64;
        (evidence, copies, parts, garment)
    });
    let best = weighed.reduce(|best, way| if way.0 > best.0 { way } else { best });
    let (_, copies, parts, garment) = best.filter(|(_, _, _, garment)| !garment.stretches.is_empty())?;
    let table = Table { pieces, copies: &copies, parts: &parts, garment: &garment };
    let (settled, asked) = table.settled(asker);
    if settled.seams.is_empty() {
        return None;
    }
    table.ask_left_out(&settled, asker);
    Some(table.sewn(named, &settled, asked))
}

/// Number of seams between a front of one hand and a back of the other.
fn crossed(parts: &[Part], garment: &Garment, seams: &[Found]) -> usize {
    let is_crossed = |seam: &&Found| {
        let [a, b] = [seam.a, seam.b].map(|k| parts[garment.stretches[k].part].said);
        let are_others = |a: Option<Hand>, b: Option<Hand>| a.is_some() && a.map(Hand::other) == b;
        are_others(a.hand, b.hand) && a.face.is_some() && a.face.map(Face::other) == b.face
    };
    seams.iter().filter(is_crossed).count()
}

/// Ways to read the drawing, each with its cost: as it is called, with the backs drawn from inside, and by shape alone.
fn ways(drawn: &[Part], copies: Vec<Copy>) -> Vec<(f64, Vec<Copy>, Vec<Part>)> {
    let is_back = |copy: &Copy| drawn[copy.piece].said.face == Some(Face::Back);
    let turn = |copy: &Copy| Copy { is_mirror: copy.is_mirror != is_back(copy), ..*copy };
    let turned: Vec<Copy> = copies.iter().map(turn).collect();
    let parts = |copies: &[Copy]| -> Vec<Part> {
        copies.iter().map(|copy| as_worn(&drawn[copy.piece], copy.is_mirror)).collect()
    };
    let nameless = parts(&copies).into_iter().map(|part| Part { said: Named::default(), ..part }).collect();
    let mut ways = vec![(0.0, copies.clone(), parts(&copies))];
    if copies.iter().any(is_back) {
        ways.push((0.0, turned.clone(), parts(&turned)));
    }
    if drawn.iter().any(|part| !part.said.is_nameless()) {
        ways.push((MISNAMED, copies, nameless));
    }
    ways
}

/// True if every piece is drawn as often as it is worn, as the garments are that the recogniser was fitted to.
pub fn is_drawn_whole(pieces: &[Piece], is_worn: impl Fn(usize) -> bool) -> bool {
    let is_whole = |piece: &Piece| {
        let Cutting { times, on_fold } = Cutting::of(piece);
        times == Some(1) && !on_fold && piece.beside.fold.is_none()
    };
    (0..pieces.len()).filter(|&k| is_worn(k)).all(|k| is_whole(&pieces[k]))
}

fn as_worn(part: &Part, is_mirror: bool) -> Part {
    if is_mirror { part.mirrored() } else { part.clone() }
}

struct Table<'t> {
    pieces: &'t [Piece],
    copies: &'t [Copy],
    parts: &'t [Part],
    garment: &'t Garment,
}

impl Table<'_> {
    /// Number of a stretch of a part along its piece as drawn, from 1.
    fn number(&self, stretch: usize) -> usize {
        let stretch = &self.garment.stretches[stretch];
        let count = self.parts[stretch.part].corners.len();
        1 + if self.copies[stretch.part].is_mirror { (2 * count - 2 - stretch.at) % count } else { stretch.at }
    }

    /// Stretch for a person to find in the picture.
    fn name(&self, stretch: usize) -> String {
        let piece = self.copies[self.garment.stretches[stretch].part].piece;
        format!("edge {} of `{}`", self.number(stretch), reference(self.pieces, piece))
    }

    /// Asks about what is doubtful, and hears the answers. Returns also the stretches asked about, with the texts.
    fn settled(&self, asker: &mut Asker<'_>) -> (Settled, Vec<(String, usize)>) {
        let (mut facts, mut asked, mut told, mut open) = (Facts::default(), Vec::new(), Vec::new(), 0);
        let first = self.garment.likelihoods(&facts);
        loop {
            let settled = settle::seams(self.garment, &facts);
            let doubt = if open < MOST_ASKED { self.doubt(&settled, &asked) } else { None };
            let Some(stretch) = doubt else { return (settled, told) };
            let partner = settled.partner(stretch);
            asked.extend([Some(stretch), partner].into_iter().flatten());
            let text = format!("what is sewn to {}?", self.name(stretch));
            let partners = self.partners(stretch, &first, partner);
            let choice = |partner: &Option<usize>| match partner {
                Some(k) => self.name(*k),
                None => "nothing: it stays open".to_owned(),
            };
            let stands = partners.iter().position(|offered| *offered == partner);
            let is_answered = asker.is_answered(&text);
            let taken = asker.ask_at(Vec::new(), text.clone(), partners.iter().map(choice), stands);
            told.push((text, stretch));
            match taken.filter(|_| is_answered).and_then(|choice| partners.get(choice)) {
                Some(&Some(partner)) => facts.sew(stretch, partner),
                Some(None) => facts.free(stretch),
                None => open += 1,
            }
        }
    }

    fn is_sewn(&self, part: usize, settled: &Settled) -> bool {
        let is_of = |k: usize| self.garment.stretches[k].part == part;
        settled.seams.iter().any(|seam| is_of(seam.a) || is_of(seam.b))
    }

    /// Asks about each piece that is in no seam: nothing is draped before.
    fn ask_left_out(&self, settled: &Settled, asker: &mut Asker<'_>) {
        for (_, copy) in self.copies.iter().enumerate().filter(|&(part, _)| !self.is_sewn(part, settled)) {
            let name = reference(self.pieces, copy.piece);
            let text = format!("piece `{name}`: nothing was found that is sewn to it; what is it?");
            asker.require(&text);
            asker.ask_of([copy.piece], text, ["worn: its seams are to be written into the seam file"], None);
        }
    }

    /// Stretch whose partner matters most and is least sure.
    fn doubt(&self, settled: &Settled, asked: &[usize]) -> Option<usize> {
        let sure = settled.confidences();
        let length = |k: usize| self.garment.stretches[k].length;
        let is_asked = |k: usize| {
            let symmetry = &self.garment.symmetry;
            asked.contains(&k) || symmetry.twin[k].is_some_and(|twin| asked.contains(&twin))
        };
        let doubtful = (0..sure.len()).filter(|&k| sure[k] < DOUBTED && length(k) > LEAST_ASKED_M && !is_asked(k));
        let cost = |k: usize| (1.0 - sure[k]) * length(k).min(LONG_M);
        doubtful.max_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(b.cmp(&a)))
    }

    /// Possible partners of a stretch, and that in effect if it is none of them. `None` stands for staying free. Their
    /// order does not depend on other answers: an answer is kept by the number of its choice.
    fn partners(&self, stretch: usize, first: &Likelihoods, partner: Option<usize>) -> Vec<Option<usize>> {
        let mut others: Vec<usize> = (0..self.garment.stretches.len()).filter(|&k| k != stretch).collect();
        others.sort_by(|&a, &b| first.of(stretch, b).total_cmp(&first.of(stretch, a)));
        let offered = others.into_iter().filter(|&k| first.of(stretch, k) > OFFERED).take(MOST_OFFERED);
        let mut partners: Vec<Option<usize>> = offered.map(Some).chain([None]).collect();
        if !partners.contains(&partner) {
            partners.push(partner);
        }
        partners
    }

    fn sewn(&self, named: &[Named], settled: &Settled, asked: Vec<(String, usize)>) -> Evident {
        let kinds = self.garment.likelihoods(&Facts::default()).kinds;
        let places = places(self.parts, &self.garment.symmetry.twin_part, &kinds);
        let named: Vec<Named> = self.copies.iter().map(|copy| named[copy.piece]).collect();
        let is_bodice = places.iter().any(|place| matches!(place.class, Class::Skirt | Class::Leg | Class::Waistband));
        let labels = self.labels(&places, &settled.seams);
        let mut worn: Vec<Worn> = Vec::new();
        let mut of_part: Vec<Option<usize>> = Vec::new();
        for (part, place) in places.iter().enumerate() {
            if !self.is_sewn(part, settled) {
                of_part.push(None);
                continue;
            }
            let base = id_of_kind(place.class, place.face, place.hand);
            let base = if base.is_empty() { "part".to_owned() } else { base };
            let same = worn.iter().filter(|worn| worn.id == base || is_numbered(&worn.id, &base)).count();
            let id = if same == 0 { base } else { format!("{base}_{}", same + 1) };
            let class = named[part].class.filter(|&class| class != Class::Other).unwrap_or(place.class);
            let role = role_of(Some(class), place.face, place.hand, is_bodice);
            of_part.push(Some(worn.len()));
            worn.push(self.worn(part, id, *place, role, &labels));
        }
        let edge = |k: usize| {
            let worn = of_part[self.garment.stretches[k].part].map(|index| &worn[index])?;
            Some(format!("{}.{}", worn.id, self.edge(labels[k], k)))
        };
        let side = |k: usize| edge(k).expect("a piece in a seam is worn");
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let mut seams: Vec<ProposedSeam> =
            settled.seams.iter().map(|found| self.seam(found, [side(found.a), side(found.b)], &mut names)).collect();
        seams.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        let is_free = |k: &usize| settled.partner(*k).is_none();
        let open = (0..self.garment.stretches.len()).filter(is_free).filter_map(edge).collect();
        let asked = asked.into_iter().map(|(text, stretch)| (text, edge(stretch))).collect();
        Evident { worn, seams, open, surety: self.surety(settled), asked }
    }

    fn surety(&self, settled: &Settled) -> f64 {
        let sure = settled.confidences();
        let lengths = || self.garment.stretches.iter().map(|stretch| stretch.length);
        let known: f64 = lengths().zip(&sure).filter(|(_, sure)| **sure >= DOUBTED).map(|(length, _)| length).sum();
        known / lengths().sum::<f64>()
    }

    fn seam(&self, found: &Found, [a, b]: [String; 2], names: &mut BTreeMap<String, usize>) -> ProposedSeam {
        let [first, second] = [found.a, found.b].map(|k| &self.garment.stretches[k]);
        let (a_mm, b_mm) = (mm(first.length), mm(second.length));
        let id = |edge: &str| edge.split_once('.').map_or_else(String::new, |(id, _)| id.to_owned());
        let mut count = |base: &str| {
            let count = names.entry(base.to_owned()).or_default();
            *count += 1;
            *count
        };
        let kind = if first.part == second.part {
            let piece = id(&a);
            SeamKind::Dart { number: count(&piece), piece }
        } else {
            let base = format!("{}_{}", id(&a), id(&b));
            SeamKind::Between { number: count(&base), pieces: [id(&a), id(&b)] }
        };
        let excess = ((a_mm - b_mm) * 10.0).round() / 10.0;
        let ease_mm = Ease::Same(if excess.abs() > 0.5 * DEFAULT_LENGTH_TOLERANCE_MM { excess } else { 0.0 });
        let entry = SeamEntry { name: kind.to_string(), a: vec![a], b: vec![b], same_direction: false, ease_mm };
        ProposedSeam { entry, kind, a_mm, b_mm, confidence: found.confidence }
    }

    /// Names of edges begin with what they are: so a piece is known to be upright.
    fn edge(&self, label: Option<Label>, stretch: usize) -> String {
        format!("{}_{}", label.map_or("edge", Label::as_str), self.number(stretch))
    }

    fn labels(&self, places: &[Place], found: &[Found]) -> Vec<Option<Label>> {
        let place = |k: usize| places[self.garment.stretches[k].part];
        let mut partners: Vec<Option<Place>> = vec![None; self.garment.stretches.len()];
        for seam in found {
            (partners[seam.a], partners[seam.b]) = (Some(place(seam.b)), Some(place(seam.a)));
        }
        let is_long = |k: usize| self.garment.stretches[k].length > LEAST_ASKED_M;
        let label = |(k, partner): (usize, &Option<Place>)| label(place(k), *partner).filter(|_| is_long(k));
        partners.iter().enumerate().map(label).collect()
    }

    fn worn(&self, part: usize, id: String, place: Place, role: crate::Role, labels: &[Option<Label>]) -> Worn {
        let Copy { piece, is_mirror } = self.copies[part];
        let own: Vec<usize> =
            (0..self.garment.stretches.len()).filter(|&k| self.garment.stretches[k].part == part).collect();
        let edges = own.iter().map(|&k| {
            let stretch = &self.garment.stretches[k];
            WornEdge {
                name: self.edge(labels[k], k),
                label: labels[k],
                hand: None,
                length: stretch.length,
                notches: stretch.notches.clone(),
            }
        });
        let count = own.len();
        let corners = |(name, from): (String, usize)| (name, [from, (from + 1) % count]);
        let outline = self.pieces[piece].seam_outline();
        let drawn = recogniser::corners(&self.pieces[piece]);
        Worn {
            piece,
            id,
            class: place.class,
            face: place.face,
            hand: place.hand,
            is_whole: false,
            is_gore: false,
            darts: Vec::new(),
            entry: PieceEntry {
                block: reference(self.pieces, piece),
                role,
                mirror: is_mirror,
                corners_at: shares(outline, &drawn),
                allowance_mm: BTreeMap::new(),
                edges: own.iter().map(|&k| (self.edge(labels[k], k), self.number(k) - 1)).map(corners).collect(),
            },
            edges: edges.collect(),
            confidence: place.confidence,
        }
    }
}

fn is_numbered(id: &str, base: &str) -> bool {
    id.strip_prefix(base).and_then(|rest| rest.strip_prefix('_')).is_some_and(|rest| rest.parse::<usize>().is_ok())
}

#[derive(Clone, Copy)]
struct Place {
    class: Class,
    face: Option<Face>,
    hand: Option<Hand>,
    confidence: f64,
}

/// Kind of an edge by what it is sewn to. `None` where that does not tell.
fn label(own: Place, partner: Option<Place>) -> Option<Label> {
    let is_of = |classes: &[Class]| partner.is_some_and(|partner| classes.contains(&partner.class));
    let is_across = partner.is_some_and(|partner| partner.face == own.face && partner.hand != own.hand);
    match own.class {
        Class::Sleeve if is_of(&[Class::Body, Class::Yoke, Class::SidePanel]) => Some(Label::Cap),
        Class::Sleeve if partner.is_none() || is_of(&[Class::Cuff]) => Some(Label::Lower),
        Class::Body if is_of(&[Class::Sleeve]) => Some(Label::Armhole),
        Class::Body if is_of(&[Class::Collar]) => Some(Label::Neck),
        Class::Body if is_of(&[Class::Skirt, Class::Leg, Class::Waistband]) => Some(Label::Hem),
        Class::Body if is_of(&[Class::Body]) && is_across => Some(Label::Centre),
        Class::Skirt | Class::Leg if is_of(&[Class::Waistband, Class::Body]) => Some(Label::Waist),
        Class::Skirt | Class::Leg if partner.is_none() || is_of(&[Class::Cuff]) => Some(Label::Hem),
        Class::Leg if is_of(&[Class::Leg]) && is_across => Some(Label::Crotch),
        Class::Waistband if is_of(&[Class::Skirt, Class::Leg]) => Some(Label::Lower),
        Class::Waistband if is_of(&[Class::Waistband]) => Some(Label::End),
        _ => None,
    }
}

/// By the name, and where it does not tell, by evidence. Mirror images are of two hands.
fn places(parts: &[Part], twins: &[Option<usize>], kinds: &[Kind]) -> Vec<Place> {
    let place = |part: usize| {
        let (said, kind) = (parts[part].said, &kinds[part]);
        let (class, sure) = match said.class {
            Some(Class::Other) if said.part == Some(PartName::Neck) => (Class::Collar, 1.0),
            Some(class) => (class, 1.0),
            None => kind.class(),
        };
        let face = said.face.or_else(|| kind.face().0);
        let hand = said.hand.or_else(|| match twins[part] {
            Some(twin) => {
                let of_twin = parts[twin].said.hand.map(Hand::other);
                let is_right = kind.rightness() - kinds[twin].rightness();
                of_twin.or(match is_right {
                    _ if kind.bothness() + kinds[twin].bothness() > 1.0 => None,
                    r if r > 0.0 || (r == 0.0 && part < twin) => Some(Hand::Right),
                    _ => Some(Hand::Left),
                })
            }
            None if kind.bothness() > 0.5 => None,
            None => Some(if kind.rightness() > 0.0 { Hand::Right } else { Hand::Left }),
        });
        Place { class, face, hand, confidence: sure }
    };
    (0..parts.len()).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propose::{Question, propose, propose_answered};
    use geom::V2;

    /// Drawn once, corners in mm.
    fn piece(name: &str, corners: &[[f64; 2]]) -> Piece {
        let outline: Vec<V2> = corners.iter().map(|&corner| V2::from(corner) / 1000.0).collect();
        let quantity = Some("1".to_owned());
        Piece {
            name: name.to_owned(),
            block: name.to_owned(),
            quantity,
            turn_points: outline.clone(),
            outline,
            ..Piece::default()
        }
    }

    #[test]
    fn a_piece_in_no_seam_is_asked_about_and_nothing_is_draped_before() {
        let panel = [[-280.0, 0.0], [280.0, 0.0], [220.0, 600.0], [-220.0, 600.0]];
        let lone = [[0.0, 0.0], [131.0, 0.0], [157.0, 83.0], [29.0, 71.0]];
        let pieces = [piece("X1", &panel), piece("X2", &panel), piece("X3", &lone)];
        let proposal = propose(&pieces);
        let question = proposal.questions.iter().find(|question| question.text.starts_with("piece `X3`"));
        let question = question.unwrap_or_else(|| panic!("{:?}", proposal.questions));
        assert!(proposal.to_drape().is_err());
        let last = Question::letter(question.choices.len() - 1);
        let answered = propose_answered(&pieces, &[(question.number, last)]).expect("an answer that is offered");
        assert_eq!(answered.seams.len(), 2);
        answered.to_drape().expect("two panels closed at the sides");
    }
}
