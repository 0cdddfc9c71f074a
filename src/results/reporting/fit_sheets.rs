//! Fit sheets for the fit report: the fit of a garment on a subject in its sizes.

use crate::assessment::{GarmentWorn, SizeWorn};
use crate::cross_section::{self, CutAt};
use crate::fit_card::{FitCard, LevelSits, Sits, SizeSits};
use crate::reporting::callouts;
use crate::reporting::spec_tables::specification;
use crate::reporting::{Part, Tell};
use fit::target::band_words;
use geom::units::signed_tenths;
use pattern::pom::Point;
use render::Frame;
use report::data::{Fact, FitCell, FitComment, FitRow, FitSheet, FitSize, FitTable, FitVerdict};
use store::comments::{self, Comment, Remark, State};
use store::{Result, Store};

pub(super) fn sheets(
    store: &Store,
    study: &str,
    worn: &[GarmentWorn],
    frame: Frame,
    tell: Tell<'_>,
) -> Result<Vec<FitSheet>> {
    let comments = comments::comments(store, study)?;
    let own = |worn: &GarmentWorn| -> Vec<&Comment> {
        let card = &worn.card;
        comments.iter().filter(|one| one.garment == card.garment && one.subject == card.subject).collect()
    };
    let sheet = |(done, of): (usize, &GarmentWorn)| {
        tell(Part { name: "fit sheets", step: [done + 1, worn.len()] });
        sheet(store, of, &own(of), frame)
    };
    worn.iter().enumerate().map(sheet).collect()
}

fn sheet(store: &Store, worn: &GarmentWorn, comments: &[&Comment], frame: Frame) -> Result<FitSheet> {
    let card = &worn.card;
    let beside = card.beside();
    let drape_of = |name: &str| worn.sizes.iter().find(|size| size.size == name);
    let drapes: Vec<Option<&SizeWorn>> = beside.iter().map(|size| drape_of(&size.size)).collect();
    let jobs: Vec<_> = worn.sizes.iter().map(|size| size.job).collect();
    let wear = card.to_wear().map(|size| size.size.as_str());
    let charts = cross_section::drawn(store, &jobs, &CutAt::Levels, wear)?;
    let size = |size: &SizeSits| FitSize {
        size: size.size.clone(),
        is_to_wear: size.place == Some(1),
        fits: size.is_within_reach(),
        words: size.words(),
    };
    let names: Vec<String> = beside.iter().map(|size| size.size.clone()).collect();
    let mut tables = vec![ease(card, beside, &names)];
    if drapes.iter().any(Option::is_some) {
        tables.push(hang(&drapes, &names));
        tables.push(points(&drapes, &names));
        tables.push(specification(store, &jobs, &names)?);
    }
    let open: Vec<&Comment> = comments.iter().copied().filter(|one| one.status == State::Open).collect();
    let last = open.iter().max_by_key(|one| one.round);
    let called = last.and_then(|last| drape_of(&last.size));
    let remarks: Vec<&Remark> = open.iter().map(|one| &one.remark).collect();
    let spots = called.map_or(Ok(Vec::new()), |drape| callouts::spots(store, drape.job, frame, &remarks))?;
    let spot_of = |comment: &Comment| {
        let number = open.iter().position(|one| one.number == comment.number)?;
        spots.get(number).copied().flatten()
    };
    Ok(FitSheet {
        garment: card.garment.clone(),
        subject: card.subject.clone(),
        intended: card.intended.clone().unwrap_or_default(),
        verdict: card.verdict(),
        drape: wear.and_then(drape_of).map_or_else(String::new, told),
        sizes: beside.iter().map(size).collect(),
        simulator: worn.simulator,
        tables: tables.into_iter().filter(|table| !table.rows.is_empty()).collect(),
        sections: charts.into_iter().map(|(_, chart)| chart).collect(),
        comments: comments.iter().map(|comment| told_comment(comment, spot_of(comment))).collect(),
        called: called.map_or_else(String::new, |drape| drape.size.clone()),
        round: round(comments),
    })
}

fn told_comment(comment: &Comment, spot: Option<[f64; 2]>) -> FitComment {
    let remark = &comment.remark;
    let state = match (comment.status, comment.met_in) {
        (State::Met, Some(round)) => format!("met in round {round}"),
        (state, _) => state.as_str().to_owned(),
    };
    FitComment {
        number: comment.number,
        side: remark.side.as_str(),
        place: remark.place.clone(),
        spot,
        said: remark.said.clone(),
        severity: remark.severity.as_str(),
        cause: remark.cause.clone(),
        action: remark.action.clone(),
        owner: comment.owner.clone(),
        state: format!("round {}, {state}", comment.round),
    }
}

/// Last round that asked or met anything, with its sign-off.
fn round(comments: &[&Comment]) -> String {
    let last = comments.iter().map(|one| one.round.max(one.met_in.unwrap_or(0))).max();
    let Some(last) = last else { return String::new() };
    let open = comments.iter().filter(|one| one.status == State::Open).count();
    let signed = comments.iter().find(|one| one.round == last).and_then(|one| one.signed_by.as_ref());
    let signed = signed.map_or_else(|| "not signed".to_owned(), |by| format!("signed by {by}"));
    format!("Round {last}, {signed}; {open} open of {}.", comments.len())
}

fn told(size: &SizeWorn) -> String {
    let hem = size.hem_words().map(|words| format!("Hem {words}."));
    let most = size.pressure.first().map(|most| {
        let region = most.region.replace('_', " ");
        format!("Presses most at the {region}, {:.2} kPa.", most.most_kpa)
    });
    hem.into_iter().chain(most).collect::<Vec<_>>().join(" ")
}

/// Points of measure that any drape has, with definitions.
pub(super) fn definitions(worn: &[GarmentWorn]) -> Vec<Fact> {
    let has = |point: &Point| {
        let mut points = worn.iter().flat_map(|worn| &worn.sizes).flat_map(|size| &size.points);
        points.any(|measured| measured.point == point.as_str())
    };
    let fact = |point: Point| Fact { name: point.as_str().replace('_', " "), value: point.definition().to_owned() };
    Point::ALL.into_iter().filter(has).map(fact).collect()
}

fn plain(text: impl Into<String>) -> FitCell {
    FitCell { text: text.into(), ..FitCell::default() }
}

/// Whole number with U+2212 as its minus sign; never a negative zero.
fn whole(value: f64) -> String {
    format!("{:.0}", value.round() + 0.0).replace('-', "\u{2212}")
}

fn signed(value: f64) -> String {
    if value < -0.5 { format!("\u{2212}{:.0}", -value) } else { format!("+{:.0}", value.abs()) }
}

fn ease(card: &FitCard, sizes: &[SizeSits], names: &[String]) -> FitTable {
    let row = |level: &str| {
        let level_of = |size: &SizeSits| size.levels.iter().find(|known| known.level == level).cloned();
        let all: Vec<Option<LevelSits>> = sizes.iter().map(level_of).collect();
        let known = all.iter().flatten().next();
        let target = known.and_then(|level| level.target_mm);
        let body = known.map_or(String::new(), |level| format!("{:.0}", level.body_girth_mm));
        let target = target.map_or(String::new(), band_words);
        let cell = |level: &Option<LevelSits>| {
            level.as_ref().map_or_else(FitCell::default, |level| FitCell {
                text: signed(level.ease_mm),
                note: level.words(),
                verdict: level.sits().map(|sits| match sits {
                    Sits::Tight => FitVerdict::Tight,
                    Sits::Loose => FitVerdict::Loose,
                    Sits::AsMeant => FitVerdict::AsMeant,
                }),
            })
        };
        let cells = [plain(body), plain(target)].into_iter().chain(all.iter().map(cell)).collect();
        FitRow { name: level.replace('_', " "), cells }
    };
    FitTable {
        caption: "Ease: garment less body, mm".to_owned(),
        columns: ["body", "target"].map(str::to_owned).into_iter().chain(names.iter().cloned()).collect(),
        rows: card.levels().into_iter().map(row).collect(),
    }
}

fn hang(sizes: &[Option<&SizeWorn>], names: &[String]) -> FitTable {
    let mut rows = Vec::new();
    let mut add = |name: &str, of: &dyn Fn(&SizeWorn) -> Option<(String, String)>| {
        let cell = |size: &Option<&SizeWorn>| {
            let told = size.and_then(of);
            told.map_or_else(FitCell::default, |(text, note)| FitCell { text, note, verdict: None })
        };
        let cells: Vec<FitCell> = sizes.iter().map(cell).collect();
        if cells.iter().any(|cell| !cell.text.is_empty()) {
            rows.push(FitRow { name: name.to_owned(), cells });
        }
    };
    let height =
        |quantity: &'static str| move |size: &SizeWorn| size.balance_of(quantity).map(|mm| (whole(mm), String::new()));
    add("hem above the floor, in front, mm", &height("hem_front"));
    add("hem above the floor, behind, mm", &height("hem_back"));
    add("hem, front over back, mm", &|size| {
        let (off, words) = size.hem_tilt()?;
        Some((signed(off), words.to_owned()))
    });
    add("hem, right over left, mm", &|size| Some((signed(size.balance_of("hem_right_over_left")?), String::new())));
    add("waist edge, front over back, mm", &|size| {
        Some((signed(size.balance_of("waist_front_over_back")?), String::new()))
    });
    add("side seam lean, right and left, degrees", &|size| {
        let [right, left] = ["side_seam_lean_right", "side_seam_lean_left"].map(|quantity| size.balance_of(quantity));
        let words = if right? + left? > 0.0 { "forwards going down" } else { "backwards going down" };
        Some((format!("{:.1}, {:.1}", right?.abs(), left?.abs()), words.to_owned()))
    });
    add("greatest pressure, kPa", &|size| {
        let most = size.pressure.first()?;
        let (region, mmhg) = (most.region.replace('_', " "), most.most_mmhg);
        Some((
            format!("{:.2}", most.most_kpa),
            format!("{region}, {mmhg:.1} mmHg; mean there {:.2} kPa", most.mean_kpa),
        ))
    });
    add("folds and drag lines", &|size| {
        let longest = size.folds.first();
        let words = longest.map(|fold| format!("the longest {:.0} mm, {}", fold.length_mm, fold.words()));
        Some((size.folds.len().to_string(), words.unwrap_or_default()))
    });
    for opening in names_among(sizes, |size| size.drawn.iter().map(|drawn| drawn.opening.as_str()).collect()) {
        add(&format!("drawn by the movement: {opening}, mm"), &|size| {
            let drawn = size.drawn.iter().find(|drawn| drawn.opening == opening)?;
            Some((signed(drawn.drawn_mm), format!("{} at most", signed(drawn.drawn_most_mm))))
        });
    }
    for level in names_among(sizes, |size| size.gaps.iter().map(|gap| gap.level.as_str()).collect()) {
        add(&format!("mean gap at the {}, mm", level.replace('_', " ")), &|size| {
            let gap = size.gaps.iter().find(|gap| gap.level == level)?;
            let words = gap.least_gap_mm.zip(gap.greatest_gap_mm);
            let words =
                words.map_or(String::new(), |(least, greatest)| format!("{} to {}", whole(least), whole(greatest)));
            Some((whole(gap.mean_gap_mm?), words))
        });
    }
    FitTable { caption: "How it hangs and what it presses".to_owned(), columns: names.to_vec(), rows }
}

/// Each name once, in order of appearance.
fn names_among<'a>(sizes: &[Option<&'a SizeWorn>], of: impl Fn(&'a SizeWorn) -> Vec<&'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for name in sizes.iter().flatten().flat_map(|size| of(size)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn points(sizes: &[Option<&SizeWorn>], names: &[String]) -> FitTable {
    let row = |point: Point| {
        let name = point.as_str();
        let cell = |size: &Option<&SizeWorn>| {
            let found = size.and_then(|size| size.points.iter().find(|measured| measured.point == name));
            found.map_or_else(FitCell::default, |measured| {
                let worn = measured.draped_mm.map(|mm| format!("worn {mm:.1}"));
                let step = measured.step_mm.map(|mm| format!("step {}", signed_tenths(mm)).replace('-', "\u{2212}"));
                let note = worn.into_iter().chain(step).collect::<Vec<_>>().join(", ");
                FitCell { text: format!("{:.1}", measured.flat_mm), note, verdict: None }
            })
        };
        FitRow { name: name.replace('_', " "), cells: sizes.iter().map(cell).collect() }
    };
    let rows = Point::ALL.into_iter().map(row).filter(|row| row.cells.iter().any(|cell| !cell.text.is_empty()));
    FitTable { caption: "Points of measure, flat, mm".to_owned(), columns: names.to_vec(), rows: rows.collect() }
}
