//! Features of pieces that go round a limb: sleeves, fronts and backs of legs, skirts in one piece.

use super::line::{between, joined, nth, run};
use super::{Face, Found, Mapper, OnTube, face, is_leg};
use crate::hybrid::outline::{self, Chain, Partner};
use body::RING;
use geom::V3;
use pattern::Role;

geom::constants! {
    "hybrid.features.limb",
    /// Line of an arm that runs along its top and underside.
    pub(super) const TOP_OF_ARM: i32 = 16;
    const UNDER_ARM: i32 = 4;
    const CENTRE_BACK: i32 = 18;
    const LEAST_SLEEVE_M: f64 = 0.02;
}

impl Mapper<'_> {
    /// Maps a sleeve in one piece: its opening goes round the arm at the length of the underarm seam.
    pub(super) fn sleeve(&mut self, piece: usize, chains: &[Chain], side: usize) -> Found {
        let [rising, falling] = self.lengthwise(piece, chains)?;
        let opening = joined(run(falling, rising, chains));
        let cap = joined(run(rising, falling, chains));
        let underarm = self.underarm(&cap).ok_or("its underarm is not sewn to the trunk")?;
        let height = |v: &usize| self.place(*v).map_or(f64::MIN, |p| p.z);
        let top = cap.iter().copied().filter(|&v| self.place(v).is_some_and(|p| p != underarm));
        let top = top.max_by(|a, b| height(a).total_cmp(&height(b))).ok_or("its cap is not sewn to a shoulder")?;
        let arm = self.form.arms[side].clone();
        let mesh = &self.form.mesh;
        let root = arm.at(mesh, UNDER_ARM, 0.0);
        let left = chains[rising].length_m(self.garment) - (root - underarm).norm();
        let below = arm.further(mesh, UNDER_ARM, 0.0, left.max(LEAST_SLEEVE_M));
        // The opening over the top of the arm lies below the shoulder by the sleeve's height there.
        let start = arm.at(mesh, TOP_OF_ARM, 0.0);
        let shoulder = self.place(top).map_or(0.0, |p| (p - start).norm());
        let height = self.v(top) - self.v(nth(self.garment, &opening, 0.5 * outline::length_m(self.garment, &opening)));
        let above = arm.further(mesh, TOP_OF_ARM, 0.0, shoulder + height.max(LEAST_SLEEVE_M));
        // On the right, +u is the front: the opening runs from below over the back, the top and the front.
        let turn = if side == 0 { -24.0 } else { 24.0 };
        self.round(&arm, &opening, &|share| OnTube {
            line: f64::from(UNDER_ARM) + turn * share,
            along: below + (above - below) * 0.5 * (1.0 - (share * std::f64::consts::TAU).cos()),
        });
        Ok(())
    }

    fn lengthwise(&self, piece: usize, chains: &[Chain]) -> Result<[usize; 2], &'static str> {
        let [a, b] = own_seam(piece, chains)?;
        let up = |i: usize| chains[i].chord(self.garment).y > 0.0;
        match (up(a), up(b)) {
            (true, false) => Ok([a, b]),
            (false, true) => Ok([b, a]),
            _ => Err("its seam does not run along both sides of it"),
        }
    }

    /// Point at which a sleeve's underarm seam meets the trunk: at a side seam, or else interpolated between the
    /// nearest placed points of the cap by arc length.
    fn underarm(&mut self, cap: &[usize]) -> Option<V3> {
        let (first, last) = (*cap.first()?, *cap.last()?);
        if let Some(place) = self.place(first) {
            return Some(place);
        }
        let placed = |&i: &usize| self.place(cap[i]).is_some();
        let (after, before) = ((0..cap.len()).find(placed)?, (0..cap.len()).rev().find(placed)?);
        let [near, far] =
            [outline::length_m(self.garment, &cap[..=after]), outline::length_m(self.garment, &cap[before..])];
        let place = self.place(cap[after])?.lerp(&self.place(cap[before])?, near / (near + far));
        self.set(first, place);
        self.set(last, place);
        Some(place)
    }

    /// Maps a piece that goes all round the trunk, sewn to itself: its seam runs down the centre back from the waist.
    pub(super) fn wrap(&mut self, piece: usize, chains: &[Chain]) -> Found {
        let [a, b] = own_seam(piece, chains)?;
        let lines = [joined(run(a, b, chains)), joined(run(b, a, chains))];
        if lines.iter().any(|line| line.len() < 2) {
            return Err("it has no hem or no waist line");
        }
        // Whether it is drawn as a ring or as a trapeze, the waist is the shorter of the two lines.
        let length = |line: &Vec<usize>| outline::length_m(self.garment, line);
        let [one, other] = &lines;
        let (top, bottom) = if length(one) < length(other) { (one, other) } else { (other, one) };
        let (trunk, mesh) = (self.form.trunk.clone(), &self.form.mesh);
        let above = trunk.at_height(mesh, CENTRE_BACK, self.body.levels.waist_m);
        let below = trunk.further(mesh, CENTRE_BACK, above, chains[a].length_m(self.garment));
        // Lines run from the right over the front to the left, as a hem seen from outside does.
        let [before, after] = [CENTRE_BACK - RING as i32, CENTRE_BACK].map(f64::from);
        let on = |along: f64| [before, after].map(|line| OnTube { line, along });
        let [first, last] = on(above);
        self.round(&trunk, top, &between([last, first]));
        self.round(&trunk, bottom, &between(on(below)));
        Ok(())
    }

    /// Maps a leg in one piece: its inseam runs down the inside, its waist from centre front to centre back.
    pub(super) fn whole_leg(&mut self, piece: usize, chains: &[Chain], side: usize) -> Found {
        let [rising, falling] = self.lengthwise(piece, chains)?;
        let other =
            |c: &Chain| matches!(c.partner, Partner::Piece(p) if p != piece && is_leg(self.garment.pieces[p].role));
        let crotches: Vec<usize> = (0..chains.len()).filter(|&i| other(&chains[i])).collect();
        let after = crotches.iter().copied().find(|&i| i == (rising + 1) % chains.len());
        let before = crotches.iter().copied().find(|&i| (i + 1) % chains.len() == falling);
        let (Some(after), Some(before)) = (after, before) else {
            return Err("it has no crotch seam before and behind");
        };
        let (hem, waist) = (joined(run(falling, rising, chains)), joined(run(after, before, chains)));
        if hem.len() < 2 || waist.len() < 2 {
            return Err("it has no hem or no waist line");
        }
        let mesh = &self.form.mesh;
        let (trunk, tube) = (self.form.trunk.clone(), self.form.legs[side].clone());
        let fork = self.fork_place();
        // Counter-clockwise the right leg has its front first, the left one its back; either passes the outside.
        let (first, last, inner) = if side == 0 { (6.0, -6.0, 12) } else { (18.0, 6.0, 0) };
        let forks = [chains[rising].last(), chains[falling].first()];
        let ends = [(first, waist[0], forks[0]), (last, waist[waist.len() - 1], forks[1])].map(|(line, end, own)| {
            let z = self.place(end).map_or(fork.z + self.v(end) - self.v(own), |p| p.z);
            OnTube { line, along: trunk.at_height(mesh, (line as i32).rem_euclid(RING as i32), z) }
        });
        let reach = (fork - tube.at(mesh, inner, 0.0)).norm();
        let along = tube.further(mesh, inner, 0.0, chains[rising].length_m(self.garment) - reach);
        forks.into_iter().for_each(|own| self.set(own, fork));
        self.round(&trunk, &waist, &between(ends));
        let start = f64::from(inner);
        let hem_ends = [OnTube { line: start, along }, OnTube { line: start + RING as f64, along }];
        self.round(&tube, &hem, &between(hem_ends));
        Ok(())
    }

    fn fork_place(&self) -> V3 {
        let mesh = &self.form.mesh;
        let sides = [self.form.legs[0].at(mesh, 12, 0.0), self.form.legs[1].at(mesh, 0, 0.0)];
        sides[0].lerp(&sides[1], 0.5)
    }

    pub(super) fn leg(&mut self, piece: usize, chains: &[Chain], side: usize) -> Found {
        let own = face(self.garment.pieces[piece].role);
        let role_of = |chain: &Chain| match chain.partner {
            Partner::Piece(p) => Some(self.garment.pieces[p].role),
            Partner::Free => None,
        };
        let is_own_leg = |role: Role| {
            let right = matches!(role, Role::LegFrontRight | Role::LegBackRight);
            is_leg(role) && right == (side == 0)
        };
        // Seen from outside, the front's +u is the wearer's left: the right leg's inseam.
        let inseam_rises = (own == Face::Front) == (side == 0);
        let up = |chain: &Chain| chain.chord(self.garment).y > 0.0;
        let find = |wanted: &dyn Fn(&Chain) -> bool| chains.iter().position(wanted);
        let own_leg = |c: &Chain| role_of(c).is_some_and(is_own_leg);
        let inseam = find(&|c| own_leg(c) && up(c) == inseam_rises).ok_or("it has no inseam")?;
        let outseam = find(&|c| own_leg(c) && up(c) != inseam_rises).ok_or("it has no outseam")?;
        let crotch =
            find(&|c| role_of(c).is_some_and(|r| is_leg(r) && !is_own_leg(r))).ok_or("it has no crotch seam")?;
        let (hem, waist) = if inseam_rises {
            (joined(run(outseam, inseam, chains)), joined(run(crotch, outseam, chains)))
        } else {
            (joined(run(inseam, outseam, chains)), joined(run(outseam, crotch, chains)))
        };
        if hem.len() < 2 || waist.len() < 2 {
            return Err("it has no hem or no waist line");
        }
        let fork = if inseam_rises { chains[inseam].last() } else { chains[inseam].first() };
        let (centre, outer) =
            if inseam_rises { (waist[0], waist[waist.len() - 1]) } else { (waist[waist.len() - 1], waist[0]) };
        let mesh = &self.form.mesh;
        let tube = self.form.legs[side].clone();
        let inner_line = if side == 0 { 12 } else { 0 };
        let fork_place = self.fork_place();
        // The waist lies above the fork by the rise of the pattern.
        let rise = self.v(centre) - self.v(fork);
        let trunk = self.form.trunk.clone();
        let (line_c, line_o) = match (own, side) {
            (Face::Front, 0) => (6.0, 0.0),
            (Face::Front, _) => (6.0, 12.0),
            (_, 0) => (18.0, 24.0),
            (_, _) => (18.0, 12.0),
        };
        let z = self.place(centre).map_or(fork_place.z + rise, |p| p.z);
        let z_outer = self.place(outer).map_or(z + self.v(outer) - self.v(centre), |p| p.z);
        let on = |line: f64, z: f64| OnTube { line, along: trunk.at_height(mesh, line as i32, z) };
        let (at_centre, at_outer) = (on(line_c, z), on(line_o, z_outer));
        let reach = (fork_place - tube.at(mesh, inner_line, 0.0)).norm();
        let along = tube.further(mesh, inner_line, 0.0, chains[inseam].length_m(self.garment) - reach);
        self.set(fork, fork_place);
        let waist_ends = if inseam_rises { [at_centre, at_outer] } else { [at_outer, at_centre] };
        self.round(&trunk, &waist, &between(waist_ends));
        // Lines 0 to 12 run over the front, 12 to 24 over the back; the hem runs counter-clockwise with them.
        let start = if own == Face::Front { 0.0 } else { 12.0 };
        let hem_ends = [OnTube { line: start, along }, OnTube { line: start + 12.0, along }];
        self.round(&tube, &hem, &between(hem_ends));
        Ok(())
    }
}

fn own_seam(piece: usize, chains: &[Chain]) -> Result<[usize; 2], &'static str> {
    let is_own = |c: &Chain| c.partner == Partner::Piece(piece);
    let own: Vec<usize> = (0..chains.len()).filter(|&i| is_own(&chains[i])).collect();
    <[usize; 2]>::try_from(own).map_err(|_| "what goes round an arm or the trunk must have one seam with itself")
}
