//! Automatic preposition (4.2): every piece before, behind or about the limb it is worn on.
//!
//! Pieces of one side of the trunk or of a leg are laid out flat as they are sewn ([`sheet`]), then bent as one; sleeves
//! go about the arms; circle skirts, gores and what is sewn to itself go round the trunk ([`ring`], [`round`]); a piece of no
//! such role follows what it is sewn to ([`follow`]).

mod arm;
mod ellipse;
mod follow;
mod form;
mod leg;
mod limb;
mod ring;
mod round;
mod sheet;
mod trunk;

use std::f64::consts::TAU;

use crate::body::Body;
use crate::geom::{V2, V3};
use crate::pattern::{Garment, Role};
use crate::sim::SimError;

use super::params::Params;
use arm::Sleeve;
use form::Form;
use leg::Leg;
use limb::Limb;
use ring::{Flat, Ring};
use sheet::{Joins, Part, Sheet};
use trunk::Bent;

/// Turn of a ring from which on it goes round as one, rad: as two sheets it comes to rest as a tent, not in folds.
const WIDE_RAD: f64 = 0.35 * TAU;
/// Longest inner edge of a wide ring that hangs from the neck, as a cape does, m.
const NECK_M: f64 = 0.55;

/// World positions of all garment vertices before sewing, m.
///
/// # Errors
/// [`SimError::CannotPlace`] for a piece without a role that is sewn to no piece with one.
pub fn place(body: &Body, garment: &Garment, params: &Params) -> Result<Vec<V3>, SimError> {
    let mut placing = Placing {
        form: Form::of(body),
        joins: Joins::of(garment),
        positions: vec![V3::zeros(); garment.rest.len()],
        limb: vec![None; garment.pieces.len()],
    };
    let wide = placing.wide_rings();
    placing.trunk(&wide, params);
    placing.legs();
    placing.arms();
    placing.rings(wide);
    placing.followers()?;
    Ok(placing.positions)
}

/// A garment half placed.
struct Placing<'a> {
    form: Form<'a>,
    joins: Joins<'a>,
    positions: Vec<V3>,
    /// Limb of each piece placed so far.
    limb: Vec<Option<Limb>>,
}

/// Pieces that go round the trunk, laid out flat.
struct Round {
    pieces: Vec<usize>,
    flat: Flat,
}

impl Placing<'_> {
    fn put(&mut self, sheet: &Sheet, limb: &Limb, at: impl Fn(V2) -> V3) {
        for (v, p) in sheet.points(self.joins.garment) {
            self.positions[v] = at(p);
        }
        for piece in sheet.pieces() {
            self.limb[piece] = Some(limb.clone());
        }
    }

    fn about_trunk(&self) -> Limb {
        Limb::straight(self.form.trunk_axis())
    }

    /// A ring laid out flat, the middle of its fronts at the front.
    fn laid_out(&self, ring: &Ring) -> Round {
        Round { pieces: ring.pieces(), flat: ring.flat(&self.joins, &self.joins.worn_as(&trunk::FRONTS)) }
    }

    /// Rings of fronts and backs that would lie badly as two sheets.
    fn wide_rings(&self) -> Vec<Round> {
        let joins = &self.joins;
        let skirts = Ring::of_several(joins, &joins.worn_as(&[Role::SkirtFront, Role::SkirtBack]));
        let others = Ring::of_several(joins, &joins.worn_as(&trunk::TOPS));
        let skirts = skirts.iter().map(|ring| self.laid_out(ring));
        let (mut skirts, mut narrow): (Vec<Round>, Vec<Round>) =
            skirts.partition(|ring| ring.pieces.len() > 2 || ring.flat.turn_rad() > WIDE_RAD);
        // A narrow tier that hangs from a wide one goes round with it.
        let above = joins.worn_as(&[&trunk::TOPS[..], &[Role::Waistband]].concat());
        let hangs = |ring: &Round, wide: &[Round]| {
            let is_sewn = |pieces: &[usize]| ring.pieces.iter().any(|&p| !joins.to_any(p, pieces).is_empty());
            wide.iter().any(|other| is_sewn(&other.pieces)) && !is_sewn(&above)
        };
        while let Some(next) = narrow.iter().position(|ring| hangs(ring, &skirts)) {
            skirts.push(narrow.remove(next));
        }
        let sides = [trunk::FRONTS, trunk::BACKS].map(|roles| joins.worn_as(&roles));
        let is_of_one_side =
            |ring: &Round| sides.iter().any(|side| ring.pieces.iter().all(|piece| side.contains(piece)));
        // What is narrower at its upper edge hangs from the neck.
        let is_skirt =
            |ring: &Round| (ring.flat.turn_rad() > WIDE_RAD || is_of_one_side(ring)) && ring.flat.inner_m() > NECK_M;
        skirts.into_iter().chain(others.iter().map(|ring| self.laid_out(ring)).filter(is_skirt)).collect()
    }

    fn trunk(&mut self, wide: &[Round], params: &Params) {
        let sheets = trunk_sheets(&self.joins, &wide.iter().flat_map(|ring| ring.pieces.clone()).collect::<Vec<_>>());
        for (k, side) in [1.0, -1.0].into_iter().enumerate() {
            if sheets[k].parts.is_empty() {
                continue;
            }
            let is_alone = sheets[1 - k].parts.is_empty();
            let bent = Bent::new(&self.form, &self.joins, &sheets[k], side, is_alone, params);
            self.put(&sheets[k], &self.about_trunk(), |p| bent.at(p));
        }
    }

    fn legs(&mut self) {
        for hand in [1.0, -1.0] {
            let others = self.joins.worn_as(&leg::roles(-hand));
            let sheet = |(role, side)| {
                let parts = self.joins.worn_as(&[role]).into_iter().map(|p| Part::new(p, self.joins.up(p, V2::y())));
                (Sheet::beside(Sheet::lay(&self.joins, parts.collect()), self.joins.garment), side)
            };
            let sheets = leg::roles(hand).into_iter().zip([1.0, -1.0]).map(sheet);
            let sheets = sheets.filter(|(sheet, _)| !sheet.parts.is_empty());
            let leg = Leg::new(&self.form, &self.joins, hand, sheets, &others);
            for (sheet, places) in leg.places() {
                for (v, place) in places {
                    self.positions[v] = place;
                }
                for piece in sheet.pieces() {
                    self.limb[piece] = Some(Limb::straight(self.form.leg_axis(hand)));
                }
            }
        }
    }

    fn arms(&mut self) {
        for hand in [1.0, -1.0] {
            let sleeve = Sleeve::new(&self.form, &self.joins, hand);
            for (sheet, middle) in &sleeve.parts {
                self.put(sheet, &sleeve.limb, |p| sleeve.at(p, *middle));
            }
        }
    }

    /// Wide rings go round the trunk below what they are sewn to, and so do gores; where no piece has a place then, the largest of
    /// all rings does.
    fn rings(&mut self, wide: Vec<Round>) {
        let others = self.joins.worn_as(&[Role::Other]);
        let several = Ring::of_several(&self.joins, &others);
        let (gores, mut rest): (Vec<Round>, Vec<Round>) =
            several.iter().map(|ring| self.laid_out(ring)).partition(|ring| self.are_gores(ring));
        self.tiers(wide.into_iter().chain(gores).collect());
        if self.limb.iter().all(Option::is_none) {
            rest.extend(Ring::of_one(&self.joins, &others).iter().map(|ring| self.laid_out(ring)));
            let size =
                |ring: &&Round| ring.pieces.iter().map(|&p| self.joins.garment.pieces[p].vertices.len()).sum::<usize>();
            if let Some(ring) = rest.iter().max_by_key(size) {
                self.roll(ring, &[]);
            }
        }
    }

    /// Rolls rings from the top down: what is sewn most to what has a place comes next, of what is sewn to nothing the narrowest.
    fn tiers(&mut self, mut rings: Vec<Round>) {
        let mut rolled = Vec::new();
        while let Some(ring) = (0..rings.len()).min_by(|&a, &b| {
            let rank = |k: usize| (std::cmp::Reverse(self.held(&rings[k]).len()), rings[k].flat.inner_m());
            let (a, b) = (rank(a), rank(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        }) {
            let ring = rings.remove(ring);
            self.roll(&ring, &rolled);
            rolled.extend(ring.pieces);
        }
    }

    /// Vertices with a place to which a ring is sewn.
    fn held(&self, ring: &Round) -> Vec<usize> {
        let placed: Vec<usize> = (0..self.limb.len()).filter(|&p| self.limb[p].is_some()).collect();
        ring.pieces.iter().flat_map(|&p| self.joins.to_any(p, &placed)).map(|[_, v]| v).collect()
    }

    /// Whether a ring of pieces without a role can be the gores of a skirt: more than two, as wide as a trunk, and on no limb.
    fn are_gores(&self, ring: &Round) -> bool {
        let partners = (0..self.limb.len()).filter(|&p| !self.joins.to_any(p, &ring.pieces).is_empty());
        let is_on_limb = partners.filter_map(|p| self.limb[p].as_ref()).any(|limb| *limb != self.about_trunk());
        ring.pieces.len() > 2 && ring.flat.inner_m() > NECK_M && !is_on_limb
    }

    /// Rolls a ring about the trunk below what it is sewn to, and within it where that is one of `rolled`.
    fn roll(&mut self, ring: &Round, rolled: &[usize]) {
        let mean = |values: Vec<f64>| (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64);
        let held = self.held(ring);
        let top = mean(held.iter().map(|&v| self.positions[v].z).collect()).unwrap_or(self.form.body.levels.waist_m);
        let axis = self.form.trunk_axis();
        let hems = held.iter().filter(|&&v| rolled.contains(&self.joins.piece_of[v]));
        let radius = mean(hems.map(|&v| axis.coordinates(&self.positions[v]).1).collect());
        for (v, place) in round::place(&self.form, &ring.flat, top, radius) {
            self.positions[v] = place;
        }
        for &piece in &ring.pieces {
            self.limb[piece] = Some(self.about_trunk());
        }
    }

    /// Places what is left, each piece by those it is sewn to, the longest seams first.
    fn followers(&mut self) -> Result<(), SimError> {
        while let Some(open) = self.limb.iter().position(Option::is_none) {
            let (joins, limb) = (&self.joins, &self.limb);
            let placed: Vec<usize> = (0..limb.len()).filter(|&p| limb[p].is_some()).collect();
            let loose = (0..limb.len()).rev().filter(|&p| limb[p].is_none());
            let seams = loose.map(|p| (p, joins.to_any(p, &placed)));
            let longest = seams.max_by_key(|(_, pairs)| pairs.len()).filter(|(_, pairs)| !pairs.is_empty());
            let Some((piece, pairs)) = longest else {
                let piece = &joins.garment.pieces[open];
                let accepted = "pieces of the trunk and the legs by role, sleeves that are sewn to an armhole, pieces that go round the \
                    trunk one after the other, any other piece that is sewn to one of these; this one is sewn to none";
                return Err(SimError::CannotPlace { piece: piece.id.clone(), role: piece.role, accepted });
            };
            let mut limbs =
                placed.iter().filter(|&&p| !joins.between(piece, p).is_empty()).filter_map(|&p| limb[p].as_ref());
            // What joins several limbs goes about the trunk, and so does half a waistband on one leg.
            let is_waist = joins.garment.pieces[piece].role == Role::Waistband;
            let first = limbs.next().filter(|_| !is_waist);
            let only = first.filter(|first| limbs.all(|limb| limb == *first));
            let about = only.cloned().unwrap_or_else(|| self.about_trunk());
            let places = follow::place(&self.form, joins, piece, &pairs, &self.positions, &about);
            self.positions[joins.garment.pieces[piece].vertices.clone()].copy_from_slice(&places);
            self.limb[piece] = Some(about);
        }
        Ok(())
    }
}

/// Front and back of the trunk but for some pieces, each laid out as one sheet.
fn trunk_sheets(joins: &Joins, without: &[usize]) -> [Sheet; 2] {
    let [in_front, behind] = [&trunk::FRONTS, &trunk::BACKS].map(|roles| {
        let pieces = joins.worn_as(roles).into_iter();
        pieces.filter(|piece| !without.contains(piece)).collect::<Vec<_>>()
    });
    let lay = |own: &[usize], other: &[usize]| {
        // A band between two pieces of this side lies with them.
        let bands = joins.worn_as(&[Role::Waistband, Role::Other]).into_iter();
        let is_between = |&band: &usize| {
            let count = own.iter().filter(|&&p| !joins.between(band, p).is_empty()).count();
            let is_waist = joins.garment.pieces[band].role == Role::Waistband;
            count > usize::from(!is_waist) && joins.to_any(band, other).is_empty()
        };
        let pieces = own.iter().copied().chain(bands.filter(is_between));
        Sheet::lay(joins, pieces.map(|p| Part::new(p, joins.up(p, V2::y()))).collect())
    };
    let [fronts, backs] = [lay(&in_front, &behind), lay(&behind, &in_front)];
    // Where one side is in several parts, as open fronts are, its parts lie as their seams to the other side say.
    let garment = joins.garment;
    if fronts.len() >= backs.len() {
        let back = Sheet::beside(backs, garment);
        [Sheet::beside(ordered(joins, fronts, &back), garment), back]
    } else {
        let front = Sheet::beside(fronts, garment);
        let backs = ordered(joins, backs, &front);
        [front, Sheet::beside(backs, garment)]
    }
}

/// Sheets from left to right as seen from outside, by where they are sewn to the other side.
fn ordered(joins: &Joins, sheets: Vec<Sheet>, other: &Sheet) -> Vec<Sheet> {
    let there = other.pieces();
    let place = |sheet: &Sheet| {
        let pairs = sheet.parts.iter().flat_map(|part| joins.to_any(part.piece, &there));
        let opposite = |[_, b]: [usize; 2]| {
            let part = other.parts.iter().find(|part| part.piece == joins.piece_of[b]);
            part.map(|part| part.at(joins.garment.rest[b]).x)
        };
        let places: Vec<f64> = pairs.filter_map(opposite).collect();
        places.iter().sum::<f64>() / places.len().max(1) as f64
    };
    let mut placed: Vec<(f64, Sheet)> = sheets.into_iter().map(|sheet| (place(&sheet), sheet)).collect();
    // What is right on one side is left on the other.
    placed.sort_by(|a, b| b.0.total_cmp(&a.0));
    placed.into_iter().map(|(_, sheet)| sheet).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::body::{self, Measurements, Sex};
    use crate::geom::Surface;
    use crate::pattern::draft::Model;
    use crate::pattern::garment::SeamMesh;
    use crate::pattern::{Style, garmentcode};

    fn body() -> Body {
        body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body")
    }

    fn garment(model: Model) -> Garment {
        let style = Style::read(&model.drafts()[0].pieces, model.seams(), "seams").expect("a style");
        style.mesh(0.04).expect("a mesh")
    }

    #[test]
    fn drafted_garments_start_outside_the_body_with_near_seams() {
        let body = body();
        let surface = Surface::new(&body.mesh).expect("a closed body");
        // Greatest share of vertices inside, and greatest mean gap of the seams.
        let check = |model: Model, inside: f64, gap_m: f64| {
            let garment = garment(model);
            let x = place(&body, &garment, &Params::default()).expect("all roles are known");
            let count = x.iter().filter(|p| surface.signed_distance(p) < 0.0).count();
            assert!((count as f64) <= inside * x.len() as f64, "{}: {count} of {} inside", garment.name, x.len());
            let pairs: Vec<_> = garment.seams.iter().flat_map(|seam| &seam.pairs).collect();
            let mean = pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).sum::<f64>() / pairs.len() as f64;
            assert!(mean < gap_m, "{}: mean gap {mean} m", garment.name);
        };
        check(Model::Tshirt, 0.03, 0.2);
        check(Model::Teetop, 0.03, 0.2);
        check(Model::Dress, 0.03, 0.2);
        check(Model::Trousers, 0.05, 0.1);
    }

    #[test]
    fn an_angle_of_nothing_leaves_the_trunk_flat() {
        let (body, garment) = (body(), garment(Model::Tshirt));
        let params = Params { bend_angle_rad: Some(0.0), ..Params::default() };
        let x = place(&body, &garment, &params).expect("all roles are known");
        for piece in garment.pieces.iter().filter(|piece| [Role::Front, Role::Back].contains(&piece.role)) {
            let depths = || piece.vertices.clone().map(|v| x[v].y);
            let [near, far] = [depths().fold(f64::MAX, f64::min), depths().fold(f64::MIN, f64::max)];
            assert!(far - near < 0.01, "{} lies between {near} and {far} m", piece.id);
        }
    }

    #[test]
    fn legs_start_on_their_own_side() {
        let garment = garment(Model::Trousers);
        let x = place(&body(), &garment, &Params::default()).expect("all roles are known");
        for piece in &garment.pieces {
            let side = if piece.id.ends_with("right") { 1.0 } else { -1.0 };
            assert!(piece.vertices.clone().all(|v| x[v].x * side > 0.0), "{}", piece.id);
        }
    }

    /// A front and a back of some roles with six gores of another below, three sewn to each.
    fn gored_dress([front, back, gores]: [Role; 3]) -> Garment {
        let panel = |corners: &[[f64; 2]], x: f64, z: f64| {
            let edges: Vec<Value> =
                (0..corners.len()).map(|k| json!({ "endpoints": [k, (k + 1) % corners.len()] })).collect();
            json!({ "translation": [x, 0, z], "rotation": [0, 0, 0], "vertices": corners, "edges": edges })
        };
        let top = [[-24.0, 0.0], [-8.0, 0.0], [8.0, 0.0], [24.0, 0.0], [24.0, 40.0], [-24.0, 40.0]];
        let gore = [[-16.0, -50.0], [16.0, -50.0], [8.0, 0.0], [-8.0, 0.0]];
        // Behind, the same as seen from outside.
        let mirrored = |corners: &[[f64; 2]]| -> Vec<[f64; 2]> { corners.iter().map(|[x, y]| [-x, *y]).collect() };
        let mut panels = json!({ "front": panel(&top, 0.0, 20.0), "back": panel(&mirrored(&top), 0.0, -20.0) });
        let mut stitches = vec![
            json!([{ "panel": "front", "edge": 3 }, { "panel": "back", "edge": 5 }]),
            json!([{ "panel": "front", "edge": 5 }, { "panel": "back", "edge": 3 }]),
        ];
        for k in 0..6 {
            let (name, place) = (format!("panel_{k}"), 16.0 * (k % 3) as f64 - 16.0);
            let side = if k < 3 { "front" } else { "back" };
            panels[&name] = if k < 3 { panel(&gore, place, 20.0) } else { panel(&mirrored(&gore), -place, -20.0) };
            stitches.push(json!([{ "panel": name, "edge": 2 }, { "panel": side, "edge": k % 3 }]));
            let next = format!("panel_{}", (k + 1) % 6);
            stitches.push(json!([{ "panel": name, "edge": 1 }, { "panel": next, "edge": 3 }]));
        }
        let document = json!({
            "pattern": { "panels": panels, "stitches": stitches },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "dress").expect("a specification");
        let mut garment = read.style().mesh(0.04).expect("a mesh");
        for piece in &mut garment.pieces {
            piece.role = match piece.id.as_str() {
                "front" => front,
                "back" => back,
                _ => gores,
            };
        }
        garment
    }

    #[test]
    fn gores_go_round_as_one() {
        let check = |roles: [Role; 3]| {
            let garment = gored_dress(roles);
            let x = place(&body(), &garment, &Params::default()).expect("it goes round");
            let gap = |seam: &SeamMesh| seam.pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).fold(0.0, f64::max);
            let piece = |v: usize| garment.pieces.iter().find(|piece| piece.vertices.contains(&v)).expect("a piece's");
            let is_gore = |v: &usize| piece(*v).role == roles[2];
            let between = garment.seams.iter().filter(|seam| seam.pairs[0].iter().all(is_gore));
            let open = between.filter(|seam| gap(seam) > 0.01).count();
            assert_eq!(open, 1, "{roles:?}: all seams of the gores begin closed, but for one");
            let above = (0..x.len()).filter(|v| !is_gore(v)).map(|v| x[v].z).fold(f64::MAX, f64::min);
            let below = (0..x.len()).filter(is_gore).map(|v| x[v].z).fold(f64::MIN, f64::max);
            assert!(
                (above - below).abs() < 0.02,
                "{roles:?}: the gores begin at {below} m, what is above ends at {above}"
            );
        };
        check([Role::BodiceFront, Role::BodiceBack, Role::Other]);
        check([Role::Waistband, Role::Waistband, Role::BodiceFront]);
    }

    /// A skirt of half circles: tiers each of a front and a back of some inner radius, cm, 30 cm long.
    fn tiered(radii: &[f64]) -> Garment {
        let (mut panels, mut stitches) = (json!({}), Vec::new());
        let arc = |radius: f64, sweep: u8| json!({ "type": "circle", "params": [radius, 0, sweep] });
        for (tier, &inner) in radii.iter().enumerate() {
            let outer = inner + 30.0;
            let edges = json!([
                { "endpoints": [0, 1], "curvature": arc(outer, 1) },
                { "endpoints": [1, 2] },
                { "endpoints": [2, 3], "curvature": arc(inner, 0) },
                { "endpoints": [3, 0] }
            ]);
            let vertices = [[-outer, 0.0], [outer, 0.0], [inner, 0.0], [-inner, 0.0]];
            let [front, back] = ["front", "back"].map(|side| format!("{side}_{tier}"));
            for (name, below) in [(&front, format!("front_{}", tier + 1)), (&back, format!("back_{}", tier + 1))] {
                panels[name] =
                    json!({ "translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": vertices, "edges": edges });
                if tier + 1 < radii.len() {
                    stitches.push(json!([{ "panel": name, "edge": 0 }, { "panel": below, "edge": 2 }]));
                }
            }
            stitches.push(json!([{ "panel": front, "edge": 1 }, { "panel": back, "edge": 3 }]));
            stitches.push(json!([{ "panel": front, "edge": 3 }, { "panel": back, "edge": 1 }]));
        }
        let document = json!({
            "pattern": { "panels": panels, "stitches": stitches },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "tiers").expect("a specification");
        let mut garment = read.style().mesh(0.04).expect("a mesh");
        for piece in &mut garment.pieces {
            piece.role = if piece.id.starts_with("front") { Role::SkirtFront } else { Role::SkirtBack };
        }
        garment
    }

    #[test]
    fn tiers_of_circles_hang_within_each_other() {
        let body = body();
        let surface = Surface::new(&body.mesh).expect("a closed body");
        let check = |radii: &[f64]| {
            let garment = tiered(radii);
            let x = place(&body, &garment, &Params::default()).expect("it goes round");
            assert!(x.iter().all(|p| surface.signed_distance(p) > 0.0), "{radii:?}: inside the body");
            let tier = |v: usize| {
                let piece = garment.pieces.iter().find(|piece| piece.vertices.contains(&v)).expect("a piece's");
                piece.id.rsplit('_').next().map(str::to_owned)
            };
            for seam in &garment.seams {
                let gaps: Vec<f64> = seam.pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).collect();
                let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
                let [a, b] = seam.pairs[0];
                let is_between = tier(a) != tier(b);
                // Of the sides of a tier one begins open.
                assert!(mean < if is_between { 0.05 } else { 0.3 }, "{radii:?}, {}: {mean} m open", seam.name);
            }
        };
        check(&[15.0, 45.0]);
        check(&[15.0, 55.0, 100.0]);
    }

    #[test]
    fn a_piece_without_a_role_follows_its_seams() {
        let body = body();
        let mut garment = garment(Model::Teetop);
        let known = place(&body, &garment, &Params::default()).expect("all roles are known");
        let sleeve = garment.pieces.iter().position(|piece| piece.id == "sleeve_right").expect("it has sleeves");
        garment.pieces[sleeve].role = Role::Other;
        let followed = place(&body, &garment, &Params::default()).expect("it is sewn to known ones");
        let vertices = garment.pieces[sleeve].vertices.clone();
        let mean = |x: &[V3]| x[vertices.clone()].iter().sum::<V3>() / vertices.len() as f64;
        assert!((mean(&known) - mean(&followed)).norm() < 0.25, "{} {}", mean(&known), mean(&followed));
        garment.seams.retain(|seam| !seam.pairs.iter().flatten().any(|v| vertices.contains(v)));
        let error = place(&body, &garment, &Params::default()).expect_err("nothing holds it").to_string();
        assert!(error.contains("sleeve_right") && error.contains("cannot place role"), "{error}");
    }
}
