//! Readings of a drape: balance, gaps, pressure, positions of seams.

use std::collections::BTreeMap;

use body::Body;
use engine::Level;
use engine::assessment::{Quantity, hang, quantities};
use fit::on_body::{self, DIRECTIONS, Section};
use geom::units::mm;
use geom::{Surface, V3};
use pattern::pom::Point;
use pattern::style::PathPart;
use pattern::{Garment, MaterialLine, Style};
use sim::Fabric;
use sim::sewn::Sewn;
use store::{InOrigin, Origin, Result};

/// Number of directions to either side of front, back, right or left that belong to it: a quarter of all directions.
const QUARTER: usize = DIRECTIONS / 8;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    pub value: f64,
    /// `mm`, `deg` or `kPa`.
    pub unit: &'static str,
}

pub type Readings = BTreeMap<String, Reading>;

/// A style on a body, with the lines of the style on its mesh.
pub struct Place<'a> {
    body: &'a Body,
    surface: Surface,
    garment: &'a Garment,
    fabric: &'a Fabric,
    /// Lines of the shoulder, from the neck outwards. Likewise the inseam from the fork down, and the centre front and
    /// back from the neck down.
    shoulder: Vec<MaterialLine>,
    inseam: Vec<MaterialLine>,
    necks: [Vec<MaterialLine>; 2],
    style: &'a Style,
}

impl<'a> Place<'a> {
    pub fn new(body: &'a Body, style: &'a Style, garment: &'a Garment, fabric: &'a Fabric) -> Result<Self> {
        let surface = Surface::new(&body.mesh).origin(Origin::Measure)?;
        let points = style.points_of_measure();
        let named = [Point::Shoulder, Point::Inseam, Point::CentreFrontLength, Point::CentreBackLength];
        let path = |point: Point| points.iter().find(|found| found.point == point).map(|found| found.path.as_slice());
        let paths: Vec<&[PathPart]> = named.into_iter().map(|point| path(point).unwrap_or_default()).collect();
        let mut laid = style.laid(garment, &paths).into_iter().map(Option::unwrap_or_default);
        let mut next = || laid.next().unwrap_or_default();
        let (shoulder, inseam, necks) = (next(), next(), [next(), next()]);
        Ok(Self { body, surface, garment, fabric, shoulder, inseam, necks, style })
    }

    /// Reads a drape whose vertices are at `positions`. `drawn` is its flat mesh, which may differ slightly from the
    /// mesh with the lines.
    pub fn readings(&self, drawn: &Garment, positions: &[V3]) -> Result<Readings> {
        let sewn = Sewn::new(drawn, self.fabric, positions).origin(Origin::Measure)?;
        let mut found = Readings::new();
        let balance = quantities(&hang(self.style, self.garment, positions)).into_iter();
        found.extend(balance.map(|Quantity { name, value, unit }| (name, Reading { value, unit })));
        let mut add = |name: String, value_m: Option<f64>| {
            found.extend(value_m.map(|m| (name, Reading { value: mm(m), unit: "mm" })));
        };
        for site in on_body::sites(self.body) {
            let Some(section) = Section::cut(site, &self.body.mesh, &sewn.mesh) else { continue };
            let Level { level, gaps_m, .. } = Level::of(&section);
            add(format!("gap_{level}"), mean(gaps_m.iter()));
            for (number, side) in ["front", "right", "back", "left"].into_iter().enumerate() {
                let first = DIRECTIONS + number * DIRECTIONS / 4 - QUARTER;
                let towards = (first..=first + 2 * QUARTER).map(|k| &gaps_m[k % DIRECTIONS]);
                add(format!("gap_{level}_{side}"), mean(towards));
            }
        }
        let ends = |lines: &[MaterialLine]| {
            let points = || lines.iter().flat_map(|line| &line.points);
            Some([points().next()?.at(positions), points().next_back()?.at(positions)])
        };
        let gap_at = |p: V3| self.surface.signed_distance(&p);
        add("off_neck_side".to_owned(), ends(&self.shoulder).map(|[neck, _]| gap_at(neck)));
        add("off_shoulder_point".to_owned(), ends(&self.shoulder).map(|[_, tip]| gap_at(tip)));
        add("fork_below_crotch".to_owned(), ends(&self.inseam).map(|[fork, _]| self.body.levels.crotch_m - fork.z));
        for (side, lines) in ["neck_front", "neck_back"].into_iter().zip(&self.necks) {
            add(side.to_owned(), ends(lines).map(|[neck, _]| neck.z).filter(|_| !self.shoulder.is_empty()));
        }
        for pressed in on_body::pressed(self.body, &sewn.mesh, &sewn.welded_pressures_kpa()) {
            let most = Reading { value: pressed.most_kpa, unit: "kPa" };
            found.insert(format!("pressure_{}", pressed.region.as_str()), most);
        }
        Ok(found)
    }
}

/// `None` without a known gap.
fn mean<'g>(gaps_m: impl Iterator<Item = &'g Option<f64>>) -> Option<f64> {
    let known: Vec<f64> = gaps_m.flatten().copied().collect();
    (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
}
