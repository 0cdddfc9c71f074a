//! Recognition of pieces: first by the name, then by the outline, then by the other pieces.

use super::align::{Alignment, LEAST_FIT, Labelled, upright};
use super::ask::Asker;
use super::cutting::is_half;
use super::details::{details, is_strip};
use super::faces::{doubt_faces, tell_faces, tell_skirt_faces, tell_yoke_faces};
use super::gore::{self, Cut};
use super::panels::{self, Panel};
use super::raglan;
use super::recognised::{Recognised, is_whole_leg};
use super::shape::Shape;
use super::templates::Template;
use super::{Class, Face, Label, PartName, circle_skirt};
use crate::piece::Piece;
use crate::style::named::reference;
use crate::trade::Named;

/// Least score of an outline without other evidence.
pub const LEAST_UNNAMED_FIT: f64 = 0.6;
/// Kinds with templates. Of equal scores the first kind counts.
const CLASSES: [Class; 8] = [
    Class::Body,
    Class::SidePanel,
    Class::Leg,
    Class::Sleeve,
    Class::Skirt,
    Class::Yoke,
    Class::Waistband,
    Class::Cuff,
];

/// Greatest relative length difference between the two inseams of a leg in one piece.
const SAME_INSEAM: f64 = 0.03;
/// Least advantage in score of another kind at which a name is doubted.
pub const CONTRADICTED: f64 = 0.25;
/// Factor on the confidence if the outline contradicts the name, or another kind fits nearly as well.
const DOUBTED: f64 = 0.5;
const CLEAR_MARGIN: f64 = 0.15;

#[derive(Clone, Copy)]
struct Around {
    /// True if there is a sleeve, collar or hood: nameless pieces are then no legs.
    has_sleeve: bool,
    /// True if a name says yoke: a front or back may then have no shoulders.
    has_yoke: bool,
    /// True if there is a trunk: a yoke then lies over the shoulders.
    has_trunk: bool,
    is_raglan: bool,
    /// True if no leg is called front or back.
    has_lone_leg: bool,
    nameless: &'static [Class],
}

/// Assumptions under which all pieces of a file are read.
#[derive(Clone, Copy)]
pub struct Reading {
    /// Possible kinds. Of equal scores the first kind counts.
    pub nameless: &'static [Class],
    pub is_raglan: bool,
}

impl Reading {
    /// Possible readings of some pieces, the likeliest first. Nameless rectangles may be bands, skirts or other pieces,
    /// so they are tried as such only after sleeves.
    pub fn ways(pieces: &[Piece], named: &[Named]) -> Vec<Self> {
        let kinds: [&[Class]; 2] =
            [&[Class::Body, Class::Leg, Class::Sleeve], &[Class::Body, Class::Leg, Class::Skirt]];
        let details = details(pieces, named);
        let has_nameless = (0..pieces.len()).any(|k| named[k].is_nameless() && !details[k]);
        let kinds = if has_nameless { &kinds[..] } else { &kinds[..1] };
        let raglan = raglan::ways(pieces, named).iter();
        raglan.flat_map(|&is_raglan| kinds.iter().map(move |&nameless| Self { nameless, is_raglan })).collect()
    }
}

/// Facts about a piece that are known before its outline is read.
#[derive(Clone, Copy)]
struct Among {
    gore: Option<Cut>,
    panel: Option<Panel>,
    /// Kind of a front and a back whose names do not give the kind.
    pair: Option<Class>,
}

#[derive(Clone, Copy)]
struct Subject<'p> {
    index: usize,
    name: &'p str,
    piece: &'p Piece,
    named: Named,
}

/// Asks about each piece that it leaves out, except details.
pub fn recognise(
    pieces: &[Piece],
    named: &[Named],
    Reading { nameless, is_raglan }: Reading,
    asker: &mut Asker<'_>,
) -> Vec<Recognised> {
    let mut found: Vec<Recognised> = Vec::new();
    let is_called = |named: &Named, class: Class| named.class == Some(class);
    let [has_sleeve, has_yoke] =
        [Class::Sleeve, Class::Yoke].map(|class| named.iter().any(|named| is_called(named, class)));
    let is_collar = |named: &Named| is_called(named, Class::Other) && named.part == Some(PartName::Neck);
    let has_sleeve = has_sleeve || named.iter().any(is_collar);
    let (gores, panels) = (gore::gores(pieces, named), panels::panels(pieces, named));
    let pair = class_of_pair(pieces, named, has_sleeve, is_raglan);
    let is_leg_face = |named: &Named| is_called(named, Class::Leg) && named.face.is_some();
    let has_lone_leg = !named.iter().any(is_leg_face);
    let details = details(pieces, named);
    for are_yokes in [false, true] {
        let has_trunk = found.iter().any(|candidate| candidate.class == Class::Body);
        let around = Around { has_sleeve, has_yoke, has_trunk, is_raglan, has_lone_leg, nameless };
        for (index, piece) in pieces.iter().enumerate() {
            let named = named[index];
            if is_called(&named, Class::Yoke) == are_yokes && !details[index] {
                let pair = pair.filter(|_| is_nameless_face(named));
                let among = Among { gore: gores[index], panel: panels[index], pair };
                let name = &reference(pieces, index);
                let subject = Subject { index, name, piece, named };
                found.extend(match recognise_one(subject, around, among, asker) {
                    Ok(recognised) => Some(recognised),
                    Err(doubt) => ask_kind(subject, &doubt, around, among, asker),
                });
            }
        }
    }
    found.sort_by_key(|candidate| candidate.piece);
    reread_lone_legs(pieces, &mut found, asker);
    let around = Around { has_sleeve, has_yoke, has_trunk: false, is_raglan, has_lone_leg, nameless };
    for index in take_lone_sleeves(named, &mut found) {
        let name = &reference(pieces, index);
        let subject = Subject { index, name, piece: &pieces[index], named: Named { class: None, ..named[index] } };
        let among = Among { gore: None, panel: None, pair: None };
        found.extend(ask_kind(
            subject,
            "what it looks like goes with a trunk, and there is none",
            around,
            among,
            asker,
        ));
    }
    for class in [Class::Body, Class::Leg] {
        tell_faces(class, &mut found);
    }
    for class in [Class::Body, Class::Leg] {
        doubt_faces(class, pieces, named, &mut found, asker);
    }
    tell_yoke_faces(&mut found);
    tell_skirt_faces(pieces, named, &mut found, asker);
    let skirts = found.iter().filter(|candidate| candidate.class == Class::Skirt).count();
    for candidate in &mut found {
        // A single skirt piece may go all round, as gores do.
        if candidate.class == Class::Skirt && (skirts == 1 || candidate.gore.is_some()) {
            continue;
        }
        let is_faced = matches!(candidate.class, Class::Body | Class::Leg | Class::Skirt)
            && !candidate.alignment.template.is_limb();
        if is_faced && candidate.face.is_none() {
            let text = format!("is piece `{}` a front or a back?", reference(pieces, candidate.piece));
            let choice = asker.ask_of([candidate.piece], text, ["a front", "a back"], None);
            candidate.face = choice.map(|choice| Face::BOTH[choice]);
        }
    }
    found
}

fn is_nameless_face(named: Named) -> bool {
    named.class.is_none() && named.face.is_some()
}

/// Kind of a front and a back whose names do not give it: the kind that fits both best, because they belong to one
/// garment. `None` without exactly such two pieces. Of a garment with a waistband there may be more, of which the largest
/// tell.
fn class_of_pair(pieces: &[Piece], named: &[Named], has_sleeve: bool, is_raglan: bool) -> Option<Class> {
    // What has a waistband, and neither sleeve nor collar, hangs from the waist. Called a skirt, something else may be
    // above it.
    let is_called =
        |classes: &[Class]| named.iter().any(|named| named.class.is_some_and(|class| classes.contains(&class)));
    let hangs = !has_sleeve && is_called(&[Class::Waistband]) && !is_called(&[Class::Skirt, Class::Leg]);
    let details = details(pieces, named);
    let faced: Vec<usize> = (0..pieces.len()).filter(|&k| is_nameless_face(named[k]) && !details[k]).collect();
    let largest = |face: Face| {
        let of_face = faced.iter().copied().filter(|&k| named[k].face == Some(face));
        of_face.max_by(|a, b| pieces[*a].area_m2().total_cmp(&pieces[*b].area_m2()))
    };
    let [first, second] = [largest(Face::Front)?, largest(Face::Back)?];
    if faced.len() > 2 && !hangs {
        return None;
    }
    let [first, second] = [&pieces[first], &pieces[second]];
    let fit = |piece: &Piece, class: Class| {
        let is_one = |template: &Template| {
            let is_trunk =
                !template.is_panel() && template.is_raglan() == is_raglan && (is_raglan || template.has_shoulder());
            template.class == class && (class != Class::Body || is_trunk)
        };
        Some(upright(&Shape::of(piece)?, is_one)?.score)
    };
    // A sleeve is worn with a trunk.
    let kinds: &[Class] = match (has_sleeve, hangs) {
        (true, _) => &[Class::Body],
        (_, true) => &[Class::Leg, Class::Skirt],
        _ => &[Class::Body, Class::Leg, Class::Skirt],
    };
    let sums = kinds.iter().filter_map(|&class| Some((fit(first, class)? + fit(second, class)?, class)));
    let (sum, class) = sums.reduce(|best, found| if found.0 > best.0 { found } else { best })?;
    (sum >= 2.0 * LEAST_FIT).then_some(class)
}

const KINDS: [(Class, Option<Face>); 10] = [
    (Class::Body, Some(Face::Front)),
    (Class::Body, Some(Face::Back)),
    (Class::Sleeve, None),
    (Class::Leg, Some(Face::Front)),
    (Class::Leg, Some(Face::Back)),
    (Class::Skirt, Some(Face::Front)),
    (Class::Skirt, Some(Face::Back)),
    (Class::Waistband, None),
    (Class::Cuff, None),
    (Class::SidePanel, None),
];
const OFFERED: usize = 3;

/// Asks for the kind of a piece that neither name nor outline shows. Without an answer the piece is left out.
fn ask_kind(
    subject: Subject<'_>,
    doubt: &str,
    around: Around,
    among: Among,
    asker: &mut Asker<'_>,
) -> Option<Recognised> {
    let as_kind = |(class, face): (Class, Option<Face>)| {
        let named = Named { class: Some(class), face, ..subject.named };
        let read = recognise_one(Subject { named, ..subject }, around, among, &mut asker.aside()).ok()?;
        let face = face.map_or_else(String::new, |face| format!("{face} of the "));
        Some((format!("{face}{}", class.as_str()), read))
    };
    let mut kinds: Vec<(String, Recognised)> = KINDS.into_iter().filter_map(as_kind).collect();
    kinds.sort_by(|a, b| b.1.alignment.score.total_cmp(&a.1.alignment.score));
    kinds.truncate(OFFERED);
    let name = subject.name;
    if kinds.is_empty() {
        asker.tell(format!("piece `{name}`: {doubt}; it is in no proposed seam"));
        return None;
    }
    let text = format!("piece `{name}`: {doubt}; what is it?");
    let nothing = "nothing that is draped".to_owned();
    let choices = std::iter::once(nothing).chain(kinds.iter().map(|(kind, _)| kind.clone()));
    let choice = if is_strip(subject.piece) {
        asker.ask(text, choices, Some(0))
    } else {
        asker.ask_first(text, choices, Some(0))
    };
    let choice = choice?.checked_sub(1)?;
    Some(kinds.swap_remove(choice).1)
}

/// The error says why the kind is unknown.
fn recognise_one(
    subject: Subject<'_>,
    around: Around,
    Among { gore, panel, pair }: Among,
    asker: &mut Asker<'_>,
) -> Result<Recognised, String> {
    let Subject { index, name, piece, named } = subject;
    let ask = str::to_owned;
    let shape = Shape::of(piece).ok_or_else(|| ask("its corners cannot be told"))?;
    let is_candidate = |class: Class| match (named.class, named.face) {
        _ if gore.is_some() => class == Class::Skirt,
        _ if panel.is_some() => panel.is_some_and(|panel| class == panel.class),
        (Some(named), _) => class == named,
        _ if pair.is_some() => pair == Some(class),
        (None, _) if around.has_sleeve && class == Class::Leg => false,
        (None, _) if around.has_sleeve && around.has_yoke && class == Class::Skirt => false,
        (None, Some(_)) => matches!(class, Class::Body | Class::Leg | Class::Skirt),
        (None, None) => around.nameless.contains(&class),
    };
    let is_half = is_half(piece, &shape);
    // A sleeve called front or back is half a sleeve.
    let is_half_sleeve = named.face.is_some();
    let as_class = |class: Class| {
        let of_class = |template: &Template| {
            let fits = match class {
                Class::Sleeve if is_half_sleeve => !template.is_whole,
                Class::Sleeve => template.is_whole && template.is_raglan() == around.is_raglan,
                Class::Skirt if gore.is_some() => template.is_whole,
                Class::Leg => !template.is_whole,
                Class::Yoke => template.has_shoulder() == around.has_trunk,
                _ if panel.is_some() || template.is_panel() => panel.is_some_and(|panel| panel.fits(template)),
                Class::Body | Class::Skirt if is_half && template.is_whole => false,
                Class::Body if around.is_raglan || template.is_raglan() => around.is_raglan == template.is_raglan(),
                Class::Body => template.has_shoulder() || around.has_yoke,
                _ => true,
            };
            template.class == class && fits
        };
        upright(&shape, of_class)
    };
    if let Some(sector) = circle_skirt::read(&shape).filter(|_| named.class == Some(Class::Skirt) || gore.is_some()) {
        return Ok(Recognised {
            piece: index,
            class: Class::Skirt,
            face: named.face,
            hand: named.hand,
            shape,
            alignment: sector,
            confidence: circle_skirt::CONFIDENCE,
            rival: None,
            is_pair: false,
            gore,
            part: named.part,
        });
    }
    // A leg in one piece is called neither front nor back.
    let may_be_whole_leg = named.class == Some(Class::Leg) && named.face.is_none() && around.has_lone_leg;
    let mut readings: Vec<Alignment> = match whole_leg(&shape).filter(|_| may_be_whole_leg) {
        Some(whole) => vec![whole],
        None => CLASSES.into_iter().filter(|&class| is_candidate(class)).filter_map(as_class).collect(),
    };
    readings.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut readings = readings.into_iter();
    let alignment = readings.next().ok_or_else(|| ask("it has too few corners for what it is called"))?;
    let rival = readings.next().filter(|rival| rival.score >= LEAST_FIT);
    let is_named = named.class.is_some() || named.face.is_some() || gore.is_some();
    let least = if is_named { LEAST_FIT } else { LEAST_UNNAMED_FIT };
    if alignment.score < least {
        return Err(ask("neither its name nor its outline tells what it is"));
    }
    let fit = ((alignment.score - LEAST_FIT) / (0.85 - LEAST_FIT)).clamp(0.0, 1.0);
    let mut confidence = if is_named { 0.6 + 0.4 * fit } else { 0.3 + 0.5 * fit };
    if let Some(rival) = &rival {
        let margin = ((alignment.score - rival.score) / CLEAR_MARGIN).min(1.0);
        confidence *= DOUBTED + (1.0 - DOUBTED) * margin;
    }
    // Bands and skirts are rectangles, so only kinds with a characteristic shape can contradict a name.
    let shaped = [Class::Body, Class::Leg, Class::Sleeve];
    if named.class.is_some_and(|class| shaped.contains(&class)) {
        let others = shaped.into_iter().filter(|&class| Some(class) != named.class).filter_map(as_class);
        if let Some(other) = others.max_by(|a, b| a.score.total_cmp(&b.score))
            && other.score > alignment.score + CONTRADICTED
        {
            let (says, looks) = (alignment.template.class.as_str(), other.template.class.as_str());
            let text = format!("piece `{name}`: its name says a {says}, its outline a {looks}; which is it?");
            if asker.ask_of([index], text, [says, looks].map(|class| format!("a {class}")), Some(0)) == Some(1) {
                let named = Named { class: Some(other.template.class), ..named };
                return recognise_one(Subject { named, ..subject }, around, Among { gore, panel, pair }, asker);
            }
            confidence *= DOUBTED;
        }
    }
    let (shape, alignment) = match alignment.template {
        Template { class: Class::SidePanel, is_whole: true, .. } => halved_armhole(shape, alignment),
        _ => (shape, alignment),
    };
    Ok(Recognised {
        piece: index,
        class: alignment.template.class,
        face: named.face,
        hand: named.hand,
        shape,
        alignment,
        confidence,
        rival,
        is_pair: false,
        gore,
        part: named.part,
    })
}

/// Divides the armhole of a panel between front and back in the middle, where the seam of the sleeve meets it.
fn halved_armhole(shape: Shape, mut alignment: Alignment) -> (Shape, Alignment) {
    let Some(at) = alignment.parts.iter().position(|part| part.label == Label::Armhole) else {
        return (shape, alignment);
    };
    let Labelled { from, span, .. } = alignment.parts[at];
    let Some((shape, corner)) = shape.with_middle(from, span) else { return (shape, alignment) };
    let n = shape.len();
    for part in alignment.parts.iter_mut().filter(|part| part.from >= corner) {
        part.from += 1;
    }
    let from = alignment.parts[at].from;
    let first = (corner + n - from) % n;
    let half = |from: usize, span: usize, is_right: bool| Labelled { label: Label::Armhole, from, span, is_right };
    alignment.parts.splice(at..=at, [half(from, first, true), half(corner, span + 1 - first, false)]);
    (shape, alignment)
}

/// Takes a leg whose two inseam edges are equally long. `None` for another outline.
fn whole_leg(shape: &Shape) -> Option<Alignment> {
    let whole = upright(shape, |template| template.class == Class::Leg && template.is_limb())?;
    let inseams = whole.parts.iter().filter(|part| part.label == Label::Inseam);
    let lengths: Vec<f64> = inseams.map(|part| shape.sewn_length(part.from, part.span)).collect();
    let [right_m, left_m] = lengths[..] else { return None };
    (whole.score >= LEAST_FIT && (right_m - left_m).abs() < SAME_INSEAM * right_m.max(left_m)).then_some(whole)
}

/// Takes a piece that looks like half a leg for its second-best kind, if there is no other half.
fn reread_lone_legs(pieces: &[Piece], found: &mut [Recognised], asker: &mut Asker<'_>) {
    let has_leg = |face: Face| {
        found.iter().any(|candidate| candidate.class == Class::Leg && candidate.face != Some(face.other()))
    };
    if found.iter().any(is_whole_leg) {
        return;
    }
    if Face::BOTH.into_iter().all(has_leg) {
        return;
    }
    for candidate in found.iter_mut().filter(|candidate| candidate.class == Class::Leg) {
        let Some(rival) = candidate.rival.take() else { continue };
        let text = format!(
            "piece `{}`: its outline looks like a leg, but no other piece is its other half; what is it?",
            pieces[candidate.piece].name
        );
        let choices = [rival.template.class, Class::Leg].map(|class| format!("a {}", class.as_str()));
        if asker.ask_of([candidate.piece], text, choices, Some(0)) == Some(1) {
            continue;
        }
        candidate.class = rival.template.class;
        let fit = ((rival.score - LEAST_FIT) / (0.85 - LEAST_FIT)).clamp(0.0, 1.0);
        candidate.confidence = DOUBTED * (0.3 + 0.5 * fit);
        candidate.alignment = rival;
    }
}

/// Takes out side panels, and what only looks like a sleeve, if nothing has an armhole. Returns their indices.
fn take_lone_sleeves(named: &[Named], found: &mut Vec<Recognised>) -> Vec<usize> {
    if found.iter().any(|candidate| candidate.class == Class::Body) {
        return Vec::new();
    }
    let is_lone = |candidate: &Recognised| match candidate.class {
        Class::Sleeve => named[candidate.piece].class != Some(Class::Sleeve),
        class => class == Class::SidePanel,
    };
    let lone = found.iter().filter(|candidate| is_lone(candidate)).map(|candidate| candidate.piece).collect();
    found.retain(|candidate| !is_lone(candidate));
    lone
}
