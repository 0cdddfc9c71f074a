//! Automatic preposition (4.2): every piece before, behind or about the limb it is worn on.
//!
//! Pieces of one side of the trunk or of a leg are laid out flat as they are sewn ([`sheet`]), then bent as one; sleeves
//! go about the arms; circle skirts, their tiers, gores and what is sewn to itself go round the trunk ([`tiers`], [`ring`],
//! [`round`]); a piece of no such role follows what it is sewn to ([`follow`]).

mod arm;
mod ellipse;
mod follow;
mod form;
mod leg;
mod limb;
mod ring;
mod round;
mod sheet;
mod tiers;
mod trunk;

use crate::body::Body;
use crate::geom::{V2, V3};
use crate::pattern::{Garment, Role};
use crate::sim::SimError;

use super::params::Params;
use arm::Sleeve;
use form::Form;
use leg::Leg;
use limb::Limb;
use sheet::{Joins, Part, Sheet};
use tiers::Round;
use trunk::Bent;

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

impl Placing<'_> {
    fn put(&mut self, sheet: &Sheet, limb: &Limb, at: impl Fn(V2) -> V3) {
        let places: Vec<(usize, V3)> = sheet.points(self.joins.garment).map(|(v, p)| (v, at(p))).collect();
        self.assign(&sheet.pieces(), limb, places);
    }

    /// Gives the vertices of some pieces about a limb their places.
    fn assign(&mut self, pieces: &[usize], limb: &Limb, places: impl IntoIterator<Item = (usize, V3)>) {
        for (v, place) in places {
            self.positions[v] = place;
        }
        for &piece in pieces {
            self.limb[piece] = Some(limb.clone());
        }
    }

    /// Pieces that have a place.
    fn placed(&self) -> Vec<usize> {
        (0..self.limb.len()).filter(|&p| self.limb[p].is_some()).collect()
    }

    fn about_trunk(&self) -> Limb {
        Limb::straight(self.form.trunk_axis())
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
            let limb = Limb::straight(self.form.leg_axis(hand));
            let sheets: Vec<_> = leg.places().map(|(sheet, places)| (sheet.pieces(), places)).collect();
            for (pieces, places) in sheets {
                self.assign(&pieces, &limb, places);
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

    /// Places what is left, each piece by those it is sewn to, the longest seams first; halves that flare go together.
    fn followers(&mut self) -> Result<(), SimError> {
        let halves = self.flared_halves();
        while let Some(open) = self.limb.iter().position(Option::is_none) {
            let (piece, pairs) = self.next_follower().ok_or_else(|| self.cannot_place(open))?;
            let about = self.limb_of_partners(piece);
            if let Some(ring) = halves.iter().find(|ring| ring.pieces.contains(&piece)) {
                self.roll_about(ring, &about);
                continue;
            }
            let places = follow::place(&self.form, &self.joins, piece, &pairs, &self.positions, &about);
            let vertices = self.joins.garment.pieces[piece].vertices.clone();
            self.assign(&[piece], &about, vertices.zip(places));
        }
        Ok(())
    }

    /// The piece without a place that is sewn most to those with one, and where it is.
    fn next_follower(&self) -> Option<(usize, Vec<[usize; 2]>)> {
        let placed = self.placed();
        let loose = (0..self.limb.len()).rev().filter(|&p| self.limb[p].is_none());
        let seams = loose.map(|p| (p, self.joins.to_any(p, &placed)));
        seams.max_by_key(|(_, pairs)| pairs.len()).filter(|(_, pairs)| !pairs.is_empty())
    }

    /// The limb about which a piece goes: that of those it is sewn to.
    fn limb_of_partners(&self, piece: usize) -> Limb {
        let partners = self.placed().into_iter().filter(|&p| !self.joins.between(piece, p).is_empty());
        let mut limbs = partners.filter_map(|p| self.limb[p].as_ref());
        // What joins several limbs goes about the trunk, and so does half a waistband on one leg.
        let is_waist = self.joins.garment.pieces[piece].role == Role::Waistband;
        let first = limbs.next().filter(|_| !is_waist);
        let only = first.filter(|first| limbs.all(|limb| limb == *first));
        only.cloned().unwrap_or_else(|| self.about_trunk())
    }

    fn cannot_place(&self, piece: usize) -> SimError {
        let piece = &self.joins.garment.pieces[piece];
        let accepted = "pieces of the trunk and the legs by role, sleeves that are sewn to an armhole, pieces that go round the \
            trunk one after the other, any other piece that is sewn to one of these; this one is sewn to none";
        SimError::CannotPlace { piece: piece.id.clone(), role: piece.role, accepted }
    }
}

/// Front and back of the trunk but for some pieces, each laid out as one sheet.
fn trunk_sheets(joins: &Joins, without: &[usize]) -> [Sheet; 2] {
    let [in_front, behind] = [&trunk::FRONTS, &trunk::BACKS].map(|roles| {
        let pieces = joins.worn_as(roles).into_iter();
        pieces.filter(|&piece| !without.contains(&piece) && !follow::is_in_a_slit(joins, piece)).collect::<Vec<_>>()
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

    /// A panel of straight edges, or of those that say otherwise, cm.
    fn panel(corners: &[[f64; 2]], [x, z]: [f64; 2], curved: &[(usize, Value)]) -> Value {
        let edge = |k: usize| {
            let mut edge = json!({ "endpoints": [k, (k + 1) % corners.len()] });
            if let Some((_, curvature)) = curved.iter().find(|(at, _)| *at == k) {
                edge["curvature"] = curvature.clone();
            }
            edge
        };
        let edges: Vec<Value> = (0..corners.len()).map(edge).collect();
        json!({ "translation": [x, 0, z], "rotation": [0, 0, 0], "vertices": corners, "edges": edges })
    }

    fn stitch(one: (&str, usize), other: (&str, usize)) -> Value {
        let side = |(panel, edge): (&str, usize)| json!({ "panel": panel, "edge": edge });
        json!([side(one), side(other)])
    }

    /// A mesh of panels and stitches; `role` says what each piece is.
    fn sewn(panels: &Value, stitches: &[Value], role: impl Fn(&str) -> Role) -> Garment {
        let document = json!({
            "pattern": { "panels": panels, "stitches": stitches },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "garment").expect("a specification");
        let mut garment = read.style().mesh(0.04).expect("a mesh");
        for piece in &mut garment.pieces {
            piece.role = role(&piece.id);
        }
        garment
    }

    /// A front and a back of some roles with six gores of another below, three sewn to each.
    fn gored_dress([front, back, gores]: [Role; 3]) -> Garment {
        let top = [[-24.0, 0.0], [-8.0, 0.0], [8.0, 0.0], [24.0, 0.0], [24.0, 40.0], [-24.0, 40.0]];
        let gore = [[-16.0, -50.0], [16.0, -50.0], [8.0, 0.0], [-8.0, 0.0]];
        // Behind, the same as seen from outside.
        let mirrored = |corners: &[[f64; 2]]| -> Vec<[f64; 2]> { corners.iter().map(|[x, y]| [-x, *y]).collect() };
        let mut panels =
            json!({ "front": panel(&top, [0.0, 20.0], &[]), "back": panel(&mirrored(&top), [0.0, -20.0], &[]) });
        let mut stitches = vec![stitch(("front", 3), ("back", 5)), stitch(("front", 5), ("back", 3))];
        for k in 0..6 {
            let (name, place) = (format!("panel_{k}"), 16.0 * (k % 3) as f64 - 16.0);
            let side = if k < 3 { "front" } else { "back" };
            panels[&name] =
                if k < 3 { panel(&gore, [place, 20.0], &[]) } else { panel(&mirrored(&gore), [-place, -20.0], &[]) };
            stitches.push(stitch((&name, 2), (side, k % 3)));
            stitches.push(stitch((&name, 1), (&format!("panel_{}", (k + 1) % 6), 3)));
        }
        sewn(&panels, &stitches, |id| match id {
            "front" => front,
            "back" => back,
            _ => gores,
        })
    }

    #[test]
    fn gores_go_round_as_one() {
        let check = |roles: [Role; 3]| {
            let garment = gored_dress(roles);
            let x = place(&body(), &garment, &Params::default()).expect("it goes round");
            let gap = |seam: &SeamMesh| gaps(seam, &x).into_iter().fold(0.0, f64::max);
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

    /// Front or back of a skirt, by name.
    fn skirt_role(id: &str) -> Role {
        if id.starts_with("back") { Role::SkirtBack } else { Role::SkirtFront }
    }

    /// A skirt of half circles: tiers each of a front and a back of some inner radius, cm, 30 cm long.
    fn tiered(radii: &[f64]) -> Garment {
        let (mut panels, mut stitches) = (json!({}), Vec::new());
        let arc = |radius: f64, sweep: u8| json!({ "type": "circle", "params": [radius, 0, sweep] });
        for (tier, &inner) in radii.iter().enumerate() {
            let outer = inner + 30.0;
            let corners = [[-outer, 0.0], [outer, 0.0], [inner, 0.0], [-inner, 0.0]];
            let [front, back] = ["front", "back"].map(|side| format!("{side}_{tier}"));
            for side in [&front, &back] {
                panels[side] = panel(&corners, [0.0, 0.0], &[(0, arc(outer, 1)), (2, arc(inner, 0))]);
            }
            if tier + 1 < radii.len() {
                stitches.push(stitch((&front, 0), (&format!("front_{}", tier + 1), 2)));
                stitches.push(stitch((&back, 0), (&format!("back_{}", tier + 1), 2)));
            }
            stitches.push(stitch((&front, 1), (&back, 3)));
            stitches.push(stitch((&front, 3), (&back, 1)));
        }
        sewn(&panels, &stitches, skirt_role)
    }

    /// Distances of the sides of a seam, m.
    fn gaps(seam: &SeamMesh, x: &[V3]) -> Vec<f64> {
        seam.pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).collect()
    }

    #[test]
    fn a_flounce_of_half_circles_goes_round_as_one() {
        let straight = [[-28.0, 0.0], [28.0, 0.0], [28.0, 40.0], [-28.0, 40.0]];
        let (inner, outer) = (36.0, 60.0);
        let half = [[-outer, 0.0], [outer, 0.0], [inner, 0.0], [-inner, 0.0]];
        let arc = |radius: f64, sweep: u8| json!({ "type": "circle", "params": [radius, 0, sweep] });
        let half = panel(&half, [0.0, 0.0], &[(0, arc(outer, 1)), (2, arc(inner, 0))]);
        let panels = json!({
            "front": panel(&straight, [0.0, 20.0], &[]),
            "back": panel(&straight, [0.0, -20.0], &[]),
            "flounce_a": half.clone(),
            "flounce_b": half,
        });
        let stitches = [
            stitch(("front", 1), ("back", 3)),
            stitch(("front", 3), ("back", 1)),
            stitch(("front", 0), ("flounce_a", 2)),
            stitch(("back", 0), ("flounce_b", 2)),
            stitch(("flounce_a", 1), ("flounce_b", 3)),
            stitch(("flounce_a", 3), ("flounce_b", 1)),
        ];
        let role = |id: &str| if id.starts_with("flounce") { Role::Other } else { skirt_role(id) };
        let garment = sewn(&panels, &stitches, role);
        let body = body();
        let x = place(&body, &garment, &Params::default()).expect("it goes round");
        let surface = Surface::new(&body.mesh).expect("a closed body");
        let of_flounce = |v: usize| {
            let piece = garment.pieces.iter().find(|piece| piece.vertices.contains(&v)).expect("a piece's");
            piece.role == Role::Other
        };
        assert!((0..x.len()).all(|v| !of_flounce(v) || surface.signed_distance(&x[v]) > 0.0), "inside the body");
        for seam in garment.seams.iter().filter(|seam| seam.pairs[0].iter().any(|&v| of_flounce(v))) {
            let gaps = gaps(seam, &x);
            let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
            // Of its sides one begins open.
            assert!(mean < 0.15, "{}: {mean} m open", seam.name);
        }
    }

    #[test]
    fn a_godet_is_folded_outwards_from_its_slit() {
        let slit = [[-30.0, 0.0], [-1.0, 0.0], [0.0, 30.0], [1.0, 0.0], [30.0, 0.0], [25.0, 60.0], [-25.0, 60.0]];
        let whole = [[-30.0, 0.0], [30.0, 0.0], [25.0, 60.0], [-25.0, 60.0]];
        let half_width = 12.0;
        let godet = [[-half_width, 0.0], [half_width, 0.0], [0.0, 30.0]];
        let panels = json!({
            "front": panel(&slit, [0.0, 20.0], &[]),
            "back": panel(&whole, [0.0, -20.0], &[]),
            "front_godet": panel(&godet, [0.0, 40.0], &[])
        });
        let stitches = [
            stitch(("front", 4), ("back", 3)),
            stitch(("front", 6), ("back", 1)),
            stitch(("front_godet", 1), ("front", 2)),
            stitch(("front_godet", 2), ("front", 1)),
        ];
        let garment = sewn(&panels, &stitches, skirt_role);
        let piece = |name: &str| garment.pieces.iter().position(|piece| piece.id == name).expect("a piece");
        let joins = Joins::of(&garment);
        let in_slits: Vec<bool> =
            ["front", "back", "front_godet"].map(|name| follow::is_in_a_slit(&joins, piece(name))).to_vec();
        assert_eq!(in_slits, [false, false, true]);
        let body = body();
        let x = place(&body, &garment, &Params::default()).expect("a skirt");
        let is_godet = |v: usize| joins.piece_of[v] == piece("front_godet");
        let sides: Vec<[usize; 2]> = garment.seams.iter().flat_map(|seam| seam.pairs.clone()).collect();
        let own = sides.iter().filter(|pair| pair.iter().any(|&v| is_godet(v)));
        let widest = own.map(|[a, b]| (x[*a] - x[*b]).norm()).fold(0.0, f64::max);
        assert!(widest < 0.05, "its seams begin {widest} m open");
        let axis = Form::of(&body).trunk_axis();
        let hem = garment.pieces[piece("front_godet")].vertices.clone().filter(|&v| garment.rest[v].y < 1e-6);
        let [near, far] = ring::bounds(hem.map(|v| axis.coordinates(&x[v]).1));
        assert!(far - near > 0.9e-2 * half_width, "its hem lies from {near} to {far} m");
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
                let gaps = gaps(seam, &x);
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
