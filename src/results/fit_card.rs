//! Fit cards: the size of a garment that a subject wears, with the ease of all sizes at every level.

use rusqlite::Row;
use serde::Serialize;

use fit::target::is_within_reach;
use geom::units::from_mm;
use store::{Result, Store, StudyError};

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelSits {
    pub level: String,
    pub pattern_girth_mm: f64,
    pub body_girth_mm: f64,
    /// Pattern length minus body length.
    pub ease_mm: f64,
    /// Least and greatest; `None` without a target. The greatest is infinite where the garment hangs free.
    pub target_mm: Option<[f64; 2]>,
    /// Departure of the ease from its target: below 0 if too tight. `None` without a target.
    pub off_mm: Option<f64>,
    /// Weight of the departure: double where too tight, a grade step more where the garment cannot be closed.
    pub weight_mm: Option<f64>,
    /// True for a girth smaller than the body in a fabric that does not stretch.
    pub cannot_close: bool,
    /// Angle round the body over which the drape covers the level; beyond it the hem hangs above the level. `None` for
    /// a whole turn, or without a drape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covered_deg: Option<f64>,
}

/// Least departure from a target that counts: a smaller one would be written as 0.
const DEPARTURE_MM: f64 = 0.5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sits {
    Tight,
    AsMeant,
    Loose,
}

impl LevelSits {
    /// `None` without a target, and where the drape does not cover the level all round.
    pub fn sits(&self) -> Option<Sits> {
        self.off_mm.filter(|_| self.covered_deg.is_none()).map(|off| match off {
            off if off <= -DEPARTURE_MM => Sits::Tight,
            off if off >= DEPARTURE_MM => Sits::Loose,
            _ => Sits::AsMeant,
        })
    }

    /// Magnitude; 0 without a target.
    pub fn departure_mm(&self) -> f64 {
        self.off_mm.map_or(0.0, f64::abs)
    }

    pub fn words(&self) -> String {
        let by_mm = self.departure_mm();
        if let Some(covered_deg) = self.covered_deg {
            return format!("covered {covered_deg:.0} of 360 degrees");
        }
        match self.sits() {
            _ if self.cannot_close => format!("smaller than the body by {:.0} mm, cannot be closed", -self.ease_mm),
            None => "as designed".to_owned(),
            Some(Sits::Tight) if self.ease_mm < 0.0 => format!("tight by {by_mm:.0} mm, smaller than the body"),
            Some(Sits::Tight) => format!("tight by {by_mm:.0} mm"),
            Some(Sits::Loose) => format!("loose by {by_mm:.0} mm"),
            Some(Sits::AsMeant) => "as meant".to_owned(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SizeSits {
    pub size: String,
    /// Rank among the sizes: 1 is the size to wear, 2 the next best.
    pub place: Option<i64>,
    /// Level with the greatest departure, counting too tight double; `None` without a target.
    pub worst_level: Option<String>,
    /// Levels from the neck down.
    pub levels: Vec<LevelSits>,
}

impl SizeSits {
    /// Finds the worst of the levels that the drape covers all round. Returns its weighted departure, m; `None` where
    /// none has a target.
    fn judge(&mut self) -> Option<f64> {
        let all = self.levels.iter().filter(|level| level.covered_deg.is_none());
        let weighed = all.filter_map(|level| Some((level, from_mm(level.weight_mm?))));
        let worst = weighed.reduce(|worst, next| if next.1 > worst.1 { next } else { worst });
        self.worst_level = worst.map(|(level, _)| level.level.clone());
        worst.map(|(_, weight_m)| weight_m)
    }

    /// `None` where no level has a target.
    pub fn worst(&self) -> Option<&LevelSits> {
        self.levels.iter().find(|level| self.worst_level.as_ref() == Some(&level.level))
    }

    /// True if the size may be worn: the departure of its worst level, counting too tight double, is at most a grade
    /// step. A size without targets may be worn.
    pub fn is_within_reach(&self) -> bool {
        let weight_m = self.worst().and_then(|level| level.weight_mm).map(from_mm);
        weight_m.is_none_or(is_within_reach)
    }

    /// `wear`, or `nearest` where no size fits; `None` for all but the size to wear.
    pub fn mark(&self) -> Option<&'static str> {
        let mark = if self.is_within_reach() { "wear" } else { "nearest" };
        (self.place == Some(1)).then_some(mark)
    }

    fn lacks_hip(&self) -> bool {
        let has = |level: &str| self.levels.iter().any(|known| known.level == level);
        has("waist") && !["hip", "chest", "bust"].into_iter().any(has)
    }

    pub fn words(&self) -> String {
        let worst = self.worst().filter(|level| level.sits().is_some_and(|sits| sits != Sits::AsMeant));
        let told = worst.map(|level| format!("{} {}", level.level.replace('_', " "), level.words()));
        match (told, self.lacks_hip()) {
            (None, _) if self.levels.is_empty() => NO_GIRTH.to_owned(),
            (told, false) => told.unwrap_or_else(|| "every level as meant".to_owned()),
            (None, true) => "every known level as meant; hip not known".to_owned(),
            (Some(told), true) => format!("{told}; hip not known"),
        }
    }
}

/// Fit of a garment on a subject in all sizes, by ease.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitCard {
    pub garment: String,
    pub subject: String,
    /// Name in the study file; `None` where it names none.
    pub intended: Option<String>,
    pub sizes: Vec<SizeSits>,
}

impl FitCard {
    /// Adds the levels that drapes do not cover all round. If there are any, ranks the sizes again by their other
    /// levels.
    fn take(&mut self, bare: &[Bare]) {
        let own = bare.iter().filter(|bare| bare.garment == self.garment && bare.subject == self.subject);
        let mut is_other = false;
        for Bare { size, level, bare_deg, .. } in own {
            let sizes = self.sizes.iter_mut().filter(|known| known.size == *size);
            for known in sizes.flat_map(|known| &mut known.levels).filter(|known| known.level == *level) {
                known.covered_deg = Some(360.0 - bare_deg);
                is_other = true;
            }
        }
        if !is_other {
            return;
        }
        let mut weights: Vec<(usize, f64)> = Vec::new();
        for (number, size) in self.sizes.iter_mut().enumerate() {
            size.place = None;
            weights.extend(size.judge().map(|weight_m| (number, weight_m)));
        }
        // Sorting is stable: of two equal sizes the smaller stays first.
        weights.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (place, (number, _)) in (1..).zip(weights) {
            self.sizes[number].place = Some(place);
        }
    }

    /// True if no girth of any size is known.
    pub fn is_unknown(&self) -> bool {
        self.sizes.iter().all(|size| size.levels.is_empty())
    }

    /// `None` where no level has a target.
    pub fn to_wear(&self) -> Option<&SizeSits> {
        self.sizes.iter().find(|size| size.place == Some(1))
    }

    /// Size to wear with its two neighbours, or the nearest two at an end of the range; all sizes where none is to
    /// wear.
    pub fn beside(&self) -> &[SizeSits] {
        let last = self.sizes.len().saturating_sub(BESIDE);
        match self.sizes.iter().position(|size| size.place == Some(1)) {
            Some(at) => {
                let first = at.saturating_sub(1).min(last);
                &self.sizes[first..(first + BESIDE).min(self.sizes.len())]
            }
            None => &self.sizes,
        }
    }

    pub fn levels(&self) -> Vec<&str> {
        let levels = self.sizes.iter().flat_map(|size| &size.levels);
        let mut found: Vec<&str> = levels.map(|level| level.level.as_str()).collect();
        found.sort_by_key(|level| (order(level), *level));
        found.dedup();
        found
    }

    pub fn verdict(&self) -> String {
        let told = |size: &SizeSits| match size.is_within_reach() {
            true => format!("wear {}: {}", size.size, size.words()),
            false => format!("{NONE_FITS}; nearest is {}: {}", size.size, size.words()),
        };
        let none = if self.is_unknown() { NO_GIRTH } else { "no level has a target" };
        self.to_wear().map_or_else(|| none.to_owned(), told)
    }

    pub fn reasons(&self) -> String {
        let own = self.to_wear().map(|size| match size.is_within_reach() {
            true => size.words(),
            false => format!("{NONE_FITS}, it is the nearest: {}", size.words()),
        });
        let others = self.beside().iter().filter(|size| size.place != Some(1));
        let others = others.map(|size| format!("{}: {}", size.size, size.words()));
        own.into_iter().chain(others).collect::<Vec<_>>().join("; ")
    }
}

const NO_GIRTH: &str = "not known, no girth of its pattern was found";
const NONE_FITS: &str = "no size fits";

/// Number of sizes side by side on a card.
const BESIDE: usize = 3;

/// Levels from the neck down, arms after the trunk.
const ORDER: [&str; 13] = [
    "neck",
    "across_shoulder",
    "bust",
    "chest",
    "underbust",
    "waist",
    "hip",
    "thigh",
    "knee",
    "calf",
    "upper_arm",
    "forearm",
    "wrist",
];

fn order(level: &str) -> usize {
    ORDER.iter().position(|known| *known == level).unwrap_or(ORDER.len())
}

/// Ease of garments on subjects in all sizes, with the size to wear. `garment` and `subject` select one of each.
pub fn fit_cards(store: &Store, study: &str, garment: Option<&str>, subject: Option<&str>) -> Result<Vec<FitCard>> {
    let cards = read_cards(store, study, garment, subject)?;
    if !cards.is_empty() {
        return Ok(cards);
    }
    // All cards, for the names that there are.
    let mut cards = read_cards(store, study, None, None)?;
    keep(&mut cards, "garment", garment, |card| &card.garment)?;
    keep(&mut cards, "subject", subject, |card| &card.subject)?;
    Ok(cards)
}

/// Cards in the order of the study. A garment whose girths are not known has a card without levels once it has jobs.
fn read_cards(store: &Store, study: &str, garment: Option<&str>, subject: Option<&str>) -> Result<Vec<FitCard>> {
    let sql = "WITH fit AS (
            SELECT * FROM v_fit WHERE study = :study
            AND garment = coalesce(:garment, garment) AND subject = coalesce(:subject, subject)
        ), place AS (
            SELECT * FROM v_size WHERE study = :study
            AND garment = coalesce(:garment, garment) AND subject = coalesce(:subject, subject)
        ), cell AS (
            SELECT garment, size, subject FROM fit
            UNION SELECT garment, size, subject FROM job JOIN study USING (study_id)
            WHERE study.name = :study AND is_current
            AND garment = coalesce(:garment, garment) AND subject = coalesce(:subject, subject)
        )
        SELECT cell.garment, cell.subject, cell.size, place, fit.intended, level, pattern_girth_mm, body_girth_mm,
            ease_mm, least_mm, most_mm, off_mm, worst_level, fit.weight_mm, fit.verdict = 'too_small'
        FROM cell LEFT JOIN fit USING (garment, size, subject) LEFT JOIN place USING (garment, size, subject)
        ORDER BY
            (SELECT position FROM study_axis JOIN study USING (study_id)
                WHERE study.name = :study AND axis = 'garment' AND study_axis.name = cell.garment),
            (SELECT position FROM study_axis JOIN study USING (study_id)
                WHERE study.name = :study AND axis = 'subject' AND study_axis.name = cell.subject),
            (SELECT position FROM study_axis JOIN study USING (study_id)
                WHERE study.name = :study AND axis = 'size' AND study_axis.name = cell.size)";
    let mut statement = store.reader.prepare_cached(sql)?;
    let of = rusqlite::named_params! { ":study": study, ":garment": garment, ":subject": subject };
    let rows = statement.query_map(of, read)?;
    let mut cards: Vec<FitCard> = Vec::new();
    for row in rows {
        let Found { garment, subject, size, place, intended, level, worst_level } = row?;
        if cards.last().is_none_or(|card| card.garment != garment || card.subject != subject) {
            cards.push(FitCard { garment, subject, intended: None, sizes: Vec::new() });
        }
        let Some(card) = cards.last_mut() else { continue };
        card.intended = card.intended.take().or(intended);
        if card.sizes.last().is_none_or(|last| last.size != size) {
            card.sizes.push(SizeSits { size, place, worst_level, levels: Vec::new() });
        }
        if let Some(last) = card.sizes.last_mut() {
            last.levels.extend(level);
            last.levels.sort_by_key(|level| order(&level.level));
        }
    }
    let bare = bare(store, study, garment, subject)?;
    cards.iter_mut().for_each(|card| card.take(&bare));
    Ok(cards)
}

struct Bare {
    garment: String,
    subject: String,
    size: String,
    level: String,
    /// Angle round the body over which there is no cloth.
    bare_deg: f64,
}

/// Greatest bare angle at which a level still counts as covered: one direction of a section may lie between two pieces
/// of cloth.
const LEAST_BARE_DEG: f64 = 15.0;

/// Levels of a study that a drape does not cover all round. A direction of a section is bare if it has no cloth and the
/// hem on that side hangs above the level; where the hem is lower, another limb is in the way. The drape of FEM-GS
/// counts where there is one.
fn bare(store: &Store, study: &str, garment: Option<&str>, subject: Option<&str>) -> Result<Vec<Bare>> {
    let sql = "WITH drape AS (
            SELECT job_id, garment, subject, size, row_number() OVER (
                PARTITION BY garment, subject, size ORDER BY simulator = 'hybrid', repeat
            ) AS rank
            FROM v_metrics WHERE study = ?1 AND garment = coalesce(?3, garment) AND subject = coalesce(?4, subject)
        )
        SELECT garment, subject, size, level, 10.0 * count(*) AS bare_deg
        FROM drape JOIN section USING (job_id) JOIN section_gap USING (job_id, level)
            JOIN balance ON balance.job_id = drape.job_id
                AND quantity = CASE CAST((angle_deg + 45) / 90 AS INTEGER) % 4
                    WHEN 0 THEN 'hem_front' WHEN 1 THEN 'hem_right' WHEN 2 THEN 'hem_back' ELSE 'hem_left' END
        WHERE rank = 1 AND gap_mm IS NULL AND height_mm < value
        GROUP BY garment, subject, size, level HAVING bare_deg > ?2";
    let mut statement = store.reader.prepare_cached(sql)?;
    let rows = statement.query_map((study, LEAST_BARE_DEG, garment, subject), |row| {
        Ok(Bare {
            garment: row.get(0)?,
            subject: row.get(1)?,
            size: row.get(2)?,
            level: row.get(3)?,
            bare_deg: row.get(4)?,
        })
    })?;
    Ok(rows.collect::<rusqlite::Result<_>>()?)
}

fn keep(
    cards: &mut Vec<FitCard>,
    what: &'static str,
    name: Option<&str>,
    name_of: fn(&FitCard) -> &String,
) -> Result<()> {
    let Some(name) = name else { return Ok(()) };
    let mut known: Vec<String> = cards.iter().map(|card| name_of(card).clone()).collect();
    known.sort();
    known.dedup();
    if !known.iter().any(|known| known == name) {
        return Err(StudyError::NotFound { what, name: name.to_owned(), known });
    }
    cards.retain(|card| name_of(card) == name);
    Ok(())
}

struct Found {
    garment: String,
    subject: String,
    size: String,
    place: Option<i64>,
    intended: Option<String>,
    /// `None` for a size whose girths are not known.
    level: Option<LevelSits>,
    worst_level: Option<String>,
}

fn read(row: &Row<'_>) -> rusqlite::Result<Found> {
    let level: Option<String> = row.get(5)?;
    Ok(Found {
        garment: row.get(0)?,
        subject: row.get(1)?,
        size: row.get(2)?,
        place: row.get(3)?,
        intended: row.get(4)?,
        level: level.map(|level| sits(row, level)).transpose()?,
        worst_level: row.get(12)?,
    })
}

fn sits(row: &Row<'_>, level: String) -> rusqlite::Result<LevelSits> {
    let target: [Option<f64>; 2] = [row.get(9)?, row.get(10)?];
    Ok(LevelSits {
        level,
        pattern_girth_mm: row.get(6)?,
        body_girth_mm: row.get(7)?,
        ease_mm: row.get(8)?,
        target_mm: target[0].map(|least| [least, target[1].unwrap_or(f64::INFINITY)]),
        off_mm: row.get(11)?,
        weight_mm: row.get(13)?,
        cannot_close: row.get::<_, Option<bool>>(14)?.unwrap_or(false),
        covered_deg: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(size: &str, place: i64, worst: &str, eases_mm: &[(&str, f64, f64)]) -> SizeSits {
        let level = |(level, ease_mm, off_mm): &(&str, f64, f64)| LevelSits {
            level: (*level).to_owned(),
            pattern_girth_mm: 900.0 + ease_mm,
            body_girth_mm: 900.0,
            ease_mm: *ease_mm,
            target_mm: Some([ease_mm - off_mm, ease_mm - off_mm + 50.0]),
            off_mm: Some(*off_mm),
            weight_mm: Some(if *off_mm < 0.0 { -2.0 * off_mm } else { *off_mm }),
            cannot_close: false,
            covered_deg: None,
        };
        let levels = eases_mm.iter().map(level).collect();
        SizeSits { size: size.to_owned(), place: Some(place), worst_level: Some(worst.to_owned()), levels }
    }

    #[test]
    fn a_level_that_is_not_covered_all_round_does_not_decide() {
        let check = |bare: &[(&str, &str, f64)], verdict: &str, hip_of_s: &str| {
            let sizes = vec![
                size("S", 2, "hip", &[("chest", 60.0, 0.0), ("hip", 30.0, -10.0), ("upper_arm", 200.0, 8.0)]),
                size("M", 1, "upper_arm", &[("chest", 118.0, 0.0), ("hip", 90.0, 0.0), ("upper_arm", 219.0, 19.0)]),
            ];
            let mut card = FitCard { garment: "top".into(), subject: "a".into(), intended: None, sizes };
            let bare: Vec<Bare> = bare
                .iter()
                .map(|(size, level, bare_deg)| Bare {
                    garment: "top".into(),
                    subject: "a".into(),
                    size: (*size).to_owned(),
                    level: (*level).to_owned(),
                    bare_deg: *bare_deg,
                })
                .collect();
            card.take(&bare);
            assert_eq!((card.verdict().as_str(), card.sizes[0].levels[1].words().as_str()), (verdict, hip_of_s));
        };
        check(&[], "wear M: upper arm loose by 19 mm", "tight by 10 mm");
        let both = [("S", "hip", 140.0), ("M", "hip", 90.0)];
        check(&both, "wear S: upper arm loose by 8 mm", "covered 220 of 360 degrees");
        check(&both[1..], "wear M: upper arm loose by 19 mm", "tight by 10 mm");
        check(&[("S", "upper_arm", 20.0)], "wear M: upper arm loose by 19 mm", "tight by 10 mm");
    }

    #[test]
    fn a_card_says_what_to_wear_and_what_is_worst() {
        let card = FitCard {
            garment: "tshirt".into(),
            subject: "v".into(),
            intended: Some("regular".into()),
            sizes: vec![
                size("S", 3, "hip", &[("chest", 18.0, -32.0), ("hip", -50.0, -90.0)]),
                size("M", 2, "hip", &[("chest", 78.0, 0.0), ("hip", 10.0, -30.0)]),
                size("L", 1, "chest", &[("chest", 138.0, 18.0), ("hip", 70.0, 0.0)]),
                size("XL", 4, "chest", &[("chest", 198.0, 78.0), ("hip", 130.0, 10.0)]),
                size("XXL", 5, "chest", &[("chest", 258.0, 138.0), ("hip", 190.0, 70.0)]),
            ],
        };
        assert_eq!(card.verdict(), "wear L: chest loose by 18 mm");
        let reasons = "chest loose by 18 mm; M: hip tight by 30 mm; XL: chest loose by 78 mm";
        assert_eq!(card.reasons(), reasons);
        assert_eq!(card.beside().iter().map(|size| size.size.as_str()).collect::<Vec<_>>(), ["M", "L", "XL"]);
        let marks: Vec<Option<&str>> = card.sizes.iter().map(SizeSits::mark).collect();
        assert_eq!(marks, [None, None, Some("wear"), None, None]);
        let at_end = FitCard { sizes: card.sizes[..3].to_vec(), ..card.clone() };
        assert_eq!(at_end.beside().len(), 3, "at an end the next two");
        assert_eq!(card.levels(), ["chest", "hip"]);
        let worst = |at: usize| card.sizes[at].worst().map(|level| (level.level.as_str(), level.words()));
        assert_eq!(worst(0), Some(("hip", "tight by 90 mm, smaller than the body".to_owned())));
        assert_eq!(worst(1), Some(("hip", "tight by 30 mm".to_owned())));
    }

    #[test]
    fn where_no_size_fits_the_nearest_is_told() {
        let check = |off_mm: f64, verdict: &str, mark: &str| {
            let sizes = vec![size("40", 1, "waist", &[("chest", 78.0, 0.0), ("waist", 140.0 + off_mm, off_mm)])];
            let card = FitCard { garment: "top".into(), subject: "a".into(), intended: None, sizes };
            assert_eq!((card.verdict().as_str(), card.sizes[0].mark()), (verdict, Some(mark)));
            assert_eq!(card.reasons().starts_with("no size fits, it is the nearest: "), mark == "nearest");
        };
        check(0.0, "wear 40: every level as meant", "wear");
        check(59.0, "wear 40: waist loose by 59 mm", "wear");
        check(121.0, "no size fits; nearest is 40: waist loose by 121 mm", "nearest");
        check(-29.0, "wear 40: waist tight by 29 mm", "wear");
        check(-31.0, "no size fits; nearest is 40: waist tight by 31 mm", "nearest");
    }
}
