//! Laying a template round an outline: which edges are the hem, which the side, and how well the whole fits.

use super::Label;
use super::shape::{Shape, Stretch};
use super::templates::{Part, TEMPLATES, Template};
use geom::V2;

/// Weight of the distance between where a stretch lies and where its part should lie, squared.
const PLACE_WEIGHT: f64 = 1.5;
/// Weight of the turns that a stretch makes at corners inside it, for a right angle.
const TURN_WEIGHT: f64 = 0.3;
/// Weight of the natural logarithm of a stretch's share of the length over its part's.
const SHARE_WEIGHT: f64 = 0.2;
/// Bow at which a curve counts as fully hollow or bulging (a segment of a circle of about 60 degrees).
const FULL_BOW: f64 = 0.09;
/// Weight of bending the wrong way.
const BOW_WEIGHT: f64 = 0.4;
/// What a piece loses that does not stand upright.
pub const TURNED: f64 = 0.12;

/// A labelled stretch of a piece, as drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Labelled {
    /// What it is.
    pub label: Label,
    /// Index of the corner at which it begins.
    pub from: usize,
    /// Number of edges.
    pub span: usize,
    /// Whether it lies on the outer side or the right half as drawn (told of a stretch that the template has twice).
    pub is_right: bool,
}

/// A template laid round a piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// Template that fits best.
    pub template: Template,
    /// Whether the template was mirrored: the wearer's outer side is to the left of the drawing.
    pub is_mirrored: bool,
    /// Quarter turns, counter-clockwise, that set the piece upright.
    pub quarter_turns: usize,
    /// Stretches of the outline, one for each part of the template, counter-clockwise.
    pub parts: Vec<Labelled>,
    /// Goodness of fit, at most 1.
    pub score: f64,
}

/// Least fit of an outline that anything else, its name or other pieces, tells of.
pub const LEAST_FIT: f64 = 0.35;

/// The best way to lay one of some templates round a shape, as pieces are mostly drawn: upright.
#[must_use]
pub fn upright(shape: &Shape, is_one: impl Fn(&Template) -> bool) -> Option<Alignment> {
    let cost = |quarter_turns| if quarter_turns == 0 { 0.0 } else { TURNED };
    align(shape, TEMPLATES.iter().filter(|template| is_one(template)), cost)
}

/// The best way to lay one of the templates round a shape; `cost` is what each number of quarter turns loses.
#[must_use]
pub fn align<'t>(
    shape: &Shape,
    templates: impl Iterator<Item = &'t Template>,
    cost: impl Fn(usize) -> f64,
) -> Option<Alignment> {
    let mut best: Option<Alignment> = None;
    let templates: Vec<&Template> = templates.collect();
    for quarter_turns in 0..4 {
        let (framed, size) = shape.framed(quarter_turns);
        let stretches = Stretches::of(&framed);
        for template in &templates {
            for is_mirrored in if template.is_whole { &[false][..] } else { &[false, true] } {
                let parts = parts_of(template, *is_mirrored);
                let Some((score, cuts)) = stretches.best(&parts, size) else { continue };
                let score = score - cost(quarter_turns);
                if best.as_ref().is_none_or(|best| score > best.score) {
                    let labelled = (0..parts.len()).map(|k| Labelled {
                        label: parts[k].label,
                        from: cuts[k].0,
                        span: cuts[k].1,
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

/// The parts of a template, mirrored left to right where asked, counter-clockwise again.
pub fn parts_of(template: &Template, is_mirrored: bool) -> Vec<Part> {
    let mut parts = template.parts.to_vec();
    if is_mirrored {
        parts.reverse();
        for part in &mut parts {
            // Seen in a mirror and walked the other way round: u turns twice, v once.
            part.direction_deg = -part.direction_deg;
            part.at[0] = 1.0 - part.at[0];
        }
    }
    parts
}

/// All stretches of a framed shape that do not begin or end inside a dart.
struct Stretches {
    edges: usize,
    /// By first edge, then span less one; `None` where a dart would be cut.
    table: Vec<Vec<Option<Stretch>>>,
    total: f64,
    /// Of an outline that is its own mirror image, left to right: the sum, modulo the number of corners, of a corner and its image.
    mirror: Option<usize>,
}

impl Stretches {
    fn of(shape: &Shape) -> Self {
        let n = shape.len();
        let is_cut = |corner: usize| shape.is_in_dart(corner % n);
        let row = |from: usize| {
            let stretch = |span: usize| (!is_cut(from) && !is_cut(from + span)).then(|| shape.stretch(from, span));
            (1..n).map(stretch).collect()
        };
        let total = (0..n).filter(|&edge| !shape.is_leg(edge)).map(|edge| shape.length(edge)).sum();
        Self { edges: n, table: (0..n).map(row).collect(), total, mirror: shape.mirror() }
    }

    /// The mean goodness of the best cut of the outline into the parts, with `(first corner, span)` of each. Where outline and template are
    /// both their own mirror images the cut is as well: else half of a neckline that rises in the middle was taken for a shoulder.
    fn best(&self, parts: &[Part], size: V2) -> Option<Cut> {
        let n = self.edges;
        if n < parts.len() {
            return None;
        }
        let value =
            |stretch: &Option<Stretch>, part: &Part| stretch.map(|stretch| goodness(&stretch, part, size, self.total));
        let of_part = |part: &Part| -> Values {
            self.table.iter().map(|row| row.iter().map(|stretch| value(stretch, part)).collect()).collect()
        };
        let values: Vec<Values> = parts.iter().map(of_part).collect();
        let mirror = self.mirror.filter(|_| is_symmetric(parts));
        let symmetric = mirror.and_then(|mirror| greatest((0..n).map(|start| symmetric_from(start, mirror, &values))));
        let (sum, cuts) = symmetric.or_else(|| greatest((0..n).map(|start| Reached::new(start, &values).cut(n))))?;
        Some((sum / parts.len() as f64, cuts))
    }
}

/// The sum of its goodnesses, and `(first corner, span)` of each part.
type Cut = (f64, Vec<(usize, usize)>);

/// The first of the best cuts.
fn greatest(cuts: impl Iterator<Item = Option<Cut>>) -> Option<Cut> {
    cuts.flatten().reduce(|best, cut| if cut.0 > best.0 { cut } else { best })
}

/// Whether parts are their own mirror image: the first and the one half way round lie on the axis, the others right and left of it.
fn is_symmetric(parts: &[Part]) -> bool {
    let n = parts.len();
    n.is_multiple_of(2) && (1..n).all(|k| parts[k].label == parts[n - k].label && parts[k].at[1] == parts[n - k].at[1])
}

/// The best cut that begins at a corner and is its own mirror image; `mirror` is the sum of a corner and its image.
fn symmetric_from(start: usize, mirror: usize, values: &[Values]) -> Option<Cut> {
    let (n, half) = (values.first()?.len(), values.len() / 2);
    // From a corner to its image.
    let across = |from: usize| (mirror + 2 * n - 2 * from) % n;
    let axis = |part: usize, from: usize| {
        let span = across(from);
        (span > 0).then(|| values[part][from][span - 1].map(|value| (value, (from, span))))?
    };
    let (first, hem) = axis(0, start)?;
    let right = Reached::new((start + hem.1) % n, &values[1..half]);
    let ends = (1..n).map(|used| {
        let (sum, side) = right.cut(used)?;
        let (top, upper) = axis(half, (start + hem.1 + used) % n)?;
        let image = |&(from, span): &(usize, usize)| ((mirror + 2 * n - from - span) % n, span);
        let left = side.iter().rev().map(image);
        let cuts: Vec<_> = [hem].into_iter().chain(side.iter().copied()).chain([upper]).chain(left).collect();
        (cuts.iter().map(|(_, span)| span).sum::<usize>() == n).then_some((first + 2.0 * sum + top, cuts))
    });
    greatest(ends)
}

/// Goodness of every stretch for one part: by first edge, then span less one.
type Values = Vec<Vec<Option<f64>>>;

/// Dynamic programme over the edges passed since a corner.
struct Reached {
    /// Index of the corner at which the first part begins.
    start: usize,
    /// Number of edges.
    edges: usize,
    /// Best sum of all parts with so many edges used.
    sums: Vec<Option<f64>>,
    /// For each part the span that it has in the best sum up to it, by edges used.
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

    /// The best cut of the `used` edges from the corner on.
    fn cut(&self, mut used: usize) -> Option<Cut> {
        let sum = (*self.sums.get(used)?)?;
        let mut cuts = Vec::new();
        for chosen in self.spans.iter().rev() {
            let span = chosen[used];
            used -= span;
            cuts.push(((self.start + used) % self.edges, span));
        }
        cuts.reverse();
        Some((sum, cuts))
    }
}

/// How well a stretch does for a part, at most 1.
fn goodness(stretch: &Stretch, part: &Part, size: V2, total: f64) -> f64 {
    let direction = part.direction_deg.to_radians();
    let along = stretch.chord.try_normalize(1e-9).map_or(-1.0, |c| c.dot(&V2::new(direction.cos(), direction.sin())));
    let expect = V2::new(part.at[0] * size.x, part.at[1] * size.y);
    let away = (stretch.middle - expect).norm_squared();
    let share = (stretch.length / total / part.share).max(1e-3).ln().abs().min(4.0);
    let bow = (stretch.bow / FULL_BOW).clamp(-1.0, 1.0);
    let wrong_bow = if part.bow == 0.0 { 0.3 * bow.abs() } else { 0.5 * (1.0 - bow * part.bow) };
    along
        - PLACE_WEIGHT * away
        - TURN_WEIGHT * stretch.turn / std::f64::consts::FRAC_PI_2
        - SHARE_WEIGHT * share
        - BOW_WEIGHT * wrong_bow
}
