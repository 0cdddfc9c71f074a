//! Alignment of a template with an outline: labels its edges (hem, side, ...) and scores the fit.
//!
//! The score is the mean of [`goodness`] over the parts of the template, less a penalty for turning the piece.

use super::shape::{Section, Shape};
use super::templates::{Part, TEMPLATES, Template};
use super::{Class, Label};
use geom::V2;

/// Weight of the squared distance between a section of the outline and its expected position.
const PLACE_WEIGHT: f64 = 1.5;
/// Weight of the turning of a section at corners inside it, per right angle.
const TURN_WEIGHT: f64 = 0.3;
/// Weight of |ln(s / s0)| for a section with the share s of the length and the expected share s0.
const SHARE_WEIGHT: f64 = 0.2;
/// Bow at which a curve counts as fully hollow or bulging: about a circular segment of 60 degrees.
const FULL_BOW: f64 = 0.09;
const BOW_WEIGHT: f64 = 0.4;
/// Penalty on a section of a skirt or leg with a dart that is not its waist.
const ASTRAY: f64 = 0.5;
/// Penalty on the score of a piece that is not upright.
pub const TURNED: f64 = 0.12;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Labelled {
    pub label: Label,
    /// Index of the first corner.
    pub from: usize,
    pub span: usize,
    /// True for the outer side, or the right half as drawn: tells apart two sections with one label.
    pub is_right: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    pub template: Template,
    /// True if the wearer's outer side is on the left of the drawing.
    pub is_mirrored: bool,
    /// Counter-clockwise, to set the piece upright.
    pub quarter_turns: usize,
    /// One for each part of the template, counter-clockwise.
    pub parts: Vec<Labelled>,
    /// At most 1.
    pub score: f64,
}

/// Least score of an outline with other evidence, such as its name or the other pieces.
pub const LEAST_FIT: f64 = 0.35;

/// Best alignment of the templates for which `is_one` is true. The piece may be turned, at a penalty: most are drawn
/// upright. A grain that lies on its side says that the piece does, except for bands, yokes and half sleeves: theirs
/// may run either way.
pub fn upright(shape: &Shape, is_one: impl Fn(&Template) -> bool) -> Option<Alignment> {
    let cost = |template: &Template, quarter_turns: usize| {
        let hangs = match template.class {
            Class::Body | Class::SidePanel | Class::Leg | Class::Skirt => true,
            Class::Sleeve => template.is_whole,
            Class::Yoke | Class::Waistband | Class::Cuff | Class::Collar | Class::Other => false,
        };
        let is_upright = if hangs && shape.lies() { !quarter_turns.is_multiple_of(2) } else { quarter_turns == 0 };
        if is_upright { 0.0 } else { TURNED }
    };
    align(shape, TEMPLATES.iter().filter(|template| is_one(template)), cost)
}

/// `cost` is the penalty of a template for a number of quarter turns.
pub fn align<'t>(
    shape: &Shape,
    templates: impl Iterator<Item = &'t Template>,
    cost: impl Fn(&Template, usize) -> f64,
) -> Option<Alignment> {
    let mut best: Option<Alignment> = None;
    let templates: Vec<&Template> = templates.collect();
    for quarter_turns in 0..4 {
        let (framed, size) = shape.framed(quarter_turns);
        let sections = SectionTable::of(&framed);
        // Half a trunk is never symmetric, from the side to the centre.
        let is_whole = sections.mirror.is_some();
        for template in
            templates.iter().filter(|template| template.is_whole || template.class != Class::Body || !is_whole)
        {
            for is_mirrored in if template.is_whole { &[false][..] } else { &[false, true] } {
                let parts = parts_of(template, *is_mirrored);
                let Some(Cut { goodness, runs }) = sections.best(template.class, &parts, size) else { continue };
                let score = goodness - cost(template, quarter_turns);
                if best.as_ref().is_none_or(|best| score > best.score) {
                    let labelled = (0..parts.len()).map(|k| Labelled {
                        label: parts[k].label,
                        from: runs[k].from,
                        span: runs[k].span,
                        is_right: parts[k].at[0] > 0.5,
                    });
                    best = Some(Alignment {
                        template: **template,
                        is_mirrored: *is_mirrored,
                        quarter_turns,
                        parts: labelled.collect(),
                        score,
                    });
                }
            }
        }
    }
    best
}

/// Counter-clockwise, mirrored left to right if `is_mirrored`.
pub fn parts_of(template: &Template, is_mirrored: bool) -> Vec<Part> {
    let mut parts = template.parts.to_vec();
    if is_mirrored {
        parts.reverse();
        for part in &mut parts {
            // Mirroring reverses u, and walking the mirror image counter-clockwise reverses both: so only v changes its
            // sign.
            part.direction_deg = -part.direction_deg;
            part.at[0] = 1.0 - part.at[0];
        }
    }
    parts
}

/// All sections of a shape that neither begin nor end inside a dart.
struct SectionTable {
    edges: usize,
    /// By first edge, then span minus one. `None` for one that would cut a dart.
    table: Vec<Vec<Option<Section>>>,
    total: f64,
    /// Mirror symmetry as `Shape::mirror` gives it.
    mirror: Option<usize>,
}

impl SectionTable {
    fn of(shape: &Shape) -> Self {
        let n = shape.len();
        let is_cut = |corner: usize| shape.is_in_dart(corner % n);
        let row = |from: usize| {
            let section = |span: usize| (!is_cut(from) && !is_cut(from + span)).then(|| shape.section(from, span));
            (1..n).map(section).collect()
        };
        let total = (0..n).filter(|&edge| !shape.is_leg(edge)).map(|edge| shape.length(edge)).sum();
        Self { edges: n, table: (0..n).map(row).collect(), total, mirror: shape.mirror() }
    }

    /// Best partition of the outline into the parts, with its mean goodness. `None` if there are more parts than edges.
    /// The partition is symmetric if outline and template are: otherwise half of a neckline that rises in the middle
    /// would pass for a shoulder.
    fn best(&self, class: Class, parts: &[Part], size: V2) -> Option<Cut> {
        let n = self.edges;
        if n < parts.len() {
            return None;
        }
        // What hangs from the waist is shaped there.
        let hangs = matches!(class, Class::Skirt | Class::Leg);
        let value = |section: &Option<Section>, part: &Part| {
            let section = section.as_ref()?;
            let is_astray = hangs && section.has_dart && part.label != Label::Waist;
            Some(goodness(section, part, size, self.total) - if is_astray { ASTRAY } else { 0.0 })
        };
        let of_part = |part: &Part| -> Values {
            self.table.iter().map(|row| row.iter().map(|section| value(section, part)).collect()).collect()
        };
        let values: Vec<Values> = parts.iter().map(of_part).collect();
        let mirror = self.mirror.filter(|_| is_symmetric(parts));
        let symmetric = mirror.and_then(|mirror| greatest((0..n).map(|start| symmetric_from(start, mirror, &values))));
        let cut = symmetric.or_else(|| greatest((0..n).map(|start| Reached::new(start, &values).cut(n))))?;
        Some(Cut { goodness: cut.goodness / parts.len() as f64, ..cut })
    }
}

struct Cut {
    /// Sum or mean of the goodness of the parts.
    goodness: f64,
    runs: Vec<Run>,
}

#[derive(Clone, Copy)]
struct Run {
    from: usize,
    span: usize,
}

/// First of equals.
fn greatest(cuts: impl Iterator<Item = Option<Cut>>) -> Option<Cut> {
    cuts.flatten().reduce(|best, cut| if cut.goodness > best.goodness { cut } else { best })
}

/// First part and the one half-way round lie on the axis, the others are pairs.
fn is_symmetric(parts: &[Part]) -> bool {
    let n = parts.len();
    n.is_multiple_of(2) && (1..n).all(|k| parts[k].label == parts[n - k].label && parts[k].at[1] == parts[n - k].at[1])
}

/// Best symmetric partition that begins at a corner. `mirror` is the sum of the indices of a corner and its image.
fn symmetric_from(start: usize, mirror: usize, values: &[Values]) -> Option<Cut> {
    let (n, half) = (values.first()?.len(), values.len() / 2);
    // Number of edges from a corner to its image.
    let across = |from: usize| (mirror + 2 * n - 2 * from) % n;
    let axis = |part: usize, from: usize| {
        let span = across(from);
        (span > 0).then(|| values[part][from][span - 1].map(|value| (value, Run { from, span })))?
    };
    let (first, hem) = axis(0, start)?;
    let right = Reached::new((start + hem.span) % n, &values[1..half]);
    let ends = (1..n).map(|used| {
        let side = right.cut(used)?;
        let (top, upper) = axis(half, (start + hem.span + used) % n)?;
        let image = |&Run { from, span }: &Run| Run { from: (mirror + 2 * n - from - span) % n, span };
        let left = side.runs.iter().rev().map(image);
        let runs: Vec<Run> = [hem].into_iter().chain(side.runs.iter().copied()).chain([upper]).chain(left).collect();
        let goodness = first + 2.0 * side.goodness + top;
        (runs.iter().map(|run| run.span).sum::<usize>() == n).then_some(Cut { goodness, runs })
    });
    greatest(ends)
}

/// Goodness of each section for one part, by first edge, then span minus one.
type Values = Vec<Vec<Option<f64>>>;

/// State of the dynamic programming over the number of edges used since a corner.
struct Reached {
    start: usize,
    edges: usize,
    /// Best sum of all parts so far, by the number of edges used.
    sums: Vec<Option<f64>>,
    /// For each part, its span in the best sum, by the number of edges used.
    spans: Vec<Vec<usize>>,
}

impl Reached {
    fn new(start: usize, values: &[Values]) -> Self {
        let n = values.first().map_or(0, Vec::len);
        let mut sums = vec![None; n + 1];
        sums[0] = Some(0.0);
        let mut spans = Vec::new();
        for values in values {
            let mut next: Vec<Option<f64>> = vec![None; n + 1];
            let mut chosen = vec![0; n + 1];
            for used in 0..n {
                let Some(sum) = sums[used] else { continue };
                for span in 1..=(n - used).min(n - 1) {
                    let Some(value) = values[(start + used) % n][span - 1] else { continue };
                    let value = sum + value;
                    if next[used + span].is_none_or(|found| value > found) {
                        next[used + span] = Some(value);
                        chosen[used + span] = span;
                    }
                }
            }
            sums = next;
            spans.push(chosen);
        }
        Self { start, edges: n, sums, spans }
    }

    fn cut(&self, mut used: usize) -> Option<Cut> {
        let sum = (*self.sums.get(used)?)?;
        let mut runs = Vec::new();
        for chosen in self.spans.iter().rev() {
            let span = chosen[used];
            used -= span;
            runs.push(Run { from: (self.start + used) % self.edges, span });
        }
        runs.reverse();
        Some(Cut { goodness: sum, runs })
    }
}

/// Goodness of a section for a part, at most 1: cosine of the angle between both directions, less weighted penalties
/// for place, turning, length and bow.
fn goodness(section: &Section, part: &Part, size: V2, total: f64) -> f64 {
    let direction = part.direction_deg.to_radians();
    let along = section.chord.try_normalize(1e-9).map_or(-1.0, |c| c.dot(&V2::new(direction.cos(), direction.sin())));
    let expect = V2::new(part.at[0] * size.x, part.at[1] * size.y);
    let away = (section.middle - expect).norm_squared();
    let share = (section.length / total / part.share).max(1e-3).ln().abs().min(4.0);
    let bow = (section.bow / FULL_BOW).clamp(-1.0, 1.0);
    let wrong_bow = if part.bow == 0.0 { 0.3 * bow.abs() } else { 0.5 * (1.0 - bow * part.bow) };
    along
        - PLACE_WEIGHT * away
        - TURN_WEIGHT * section.turn / std::f64::consts::FRAC_PI_2
        - SHARE_WEIGHT * share
        - BOW_WEIGHT * wrong_bow
}
