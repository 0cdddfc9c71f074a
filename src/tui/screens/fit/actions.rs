//! Choosing a level and a quantity; asking for cross sections.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::fit::quantities::{Quantity, quantities};
use crate::screens::fit::state::{Sections, View};
use crate::screens::movement::{Movement, stepped};
use crate::screens::state::State;
use crate::widgets::text::words;
use results::{CrossSection, GarmentWorn};
use store::JobId;

impl State {
    /// The subject looked at in the grid.
    #[must_use]
    pub fn wearer(&self) -> Option<String> {
        self.grid()?.subjects.get(self.study.place.subject).cloned()
    }

    /// How the garment looked at sits on that subject, once it was read.
    #[must_use]
    pub fn worn(&self) -> Option<&GarmentWorn> {
        let (garment, wearer) = (&self.grid()?.garment, self.wearer()?);
        let worn = self.data.as_ref()?.worn.as_ref()?;
        Some(worn).filter(|worn| worn.card.garment == *garment && worn.card.subject == wearer)
    }

    /// The levels of its card that pass the filter.
    #[must_use]
    pub fn card_levels(&self) -> Vec<&str> {
        let mut levels = self.worn().map_or(vec![], |worn| worn.card.levels());
        levels.retain(|level| self.passes(&words(level)));
        levels
    }

    /// The quantities of its sizes that pass the filter.
    #[must_use]
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut rows = self.worn().map_or(vec![], |worn| quantities(&worn.sizes));
        rows.retain(|row| self.passes(&row.name));
        rows
    }

    /// Whether a name passes the filter.
    pub fn passes(&self, name: &str) -> bool {
        name.to_lowercase().contains(&self.nav.filters[Screen::Fit as usize].to_lowercase())
    }

    /// Its cross sections; `None` while they are being cut.
    #[must_use]
    pub fn sections(&self) -> Option<&Sections> {
        let jobs = jobs_of(self.worn()?);
        self.fit.cut.as_ref().filter(|(of, _)| *of == jobs).map(|(_, sections)| sections)
    }

    fn known_sections(&self) -> &[CrossSection] {
        self.sections().and_then(|sections| sections.as_deref().ok()).unwrap_or_default()
    }

    /// The level looked at: the one chosen, else the one that is worst with the size to wear.
    #[must_use]
    pub fn level(&self) -> Option<&str> {
        let worn = self.worn()?;
        let sections = self.known_sections().iter().map(|section| section.level.as_str());
        let known: Vec<&str> = worn.card.levels().into_iter().chain(sections).collect();
        let chosen = self.fit.level.as_deref().filter(|level| known.iter().any(|one| is_same(one, level)));
        let worst = worn.card.to_wear().and_then(|size| size.worst_level.as_deref());
        chosen.or(worst).or(known.first().copied())
    }

    /// The section at the level looked at; where none was chosen and there is none, the first.
    #[must_use]
    pub fn section(&self) -> Option<&CrossSection> {
        let (level, sections) = (self.level()?, self.known_sections());
        let first = sections.first().filter(|_| self.fit.level.is_none());
        sections.iter().find(|section| is_same(&section.level, level)).or(first)
    }

    /// Goes to the section at the next level, or to the one before.
    pub fn step_level(&mut self, step: isize) {
        let sections = self.known_sections();
        let at = self.section().and_then(|shown| sections.iter().position(|one| one.level == shown.level));
        let next = match at {
            Some(at) => stepped(at, step, sections.len()),
            None => (!sections.is_empty()).then_some(0),
        };
        match next.map(|next| sections[next].level.clone()) {
            Some(level) => self.fit.level = Some(level),
            None => self.say(self.why_no_section()),
        }
    }

    /// Why there is no section at the level looked at.
    #[must_use]
    pub fn why_no_section(&self) -> String {
        match (self.worn(), self.sections()) {
            (None, _) => "reading…".to_owned(),
            (Some(worn), _) if worn.sizes.is_empty() => "sections need a drape: R runs the study".to_owned(),
            (Some(_), None) => "cutting body and cloth…".to_owned(),
            (Some(_), Some(Err(error))) => format!("no section: {error}"),
            (Some(_), Some(Ok(sections))) => {
                let levels: Vec<String> = sections.iter().map(|section| words(&section.level)).collect();
                format!("not cut at this level; v goes to {}", levels.join(", "))
            }
        }
    }

    /// Moves in the part that has the focus.
    pub fn go_in_fit(&mut self, movement: Movement) {
        match (self.fit.view, movement) {
            (View::Card, _) => {
                let levels = self.card_levels();
                let at = self.level().and_then(|level| levels.iter().position(|one| is_same(one, level)));
                let next = movement.from(at.unwrap_or(0), levels.len());
                self.fit.level = levels.get(next).map(|level| (*level).to_owned()).or(self.fit.level.take());
            }
            (View::Section, Movement::By(step) | Movement::Round(step)) => self.step_level(step.signum()),
            (View::Section, _) => {
                let sections = self.known_sections();
                let end = if movement == Movement::First { sections.first() } else { sections.last() };
                self.fit.level = end.map(|section| section.level.clone()).or(self.fit.level.take());
            }
            (View::Sizes, _) => self.fit.row = movement.from(self.fit.row, self.quantities().len()),
        }
    }

    /// Gives the focus to the next part, or to the one before; from what to change, back to the one before that.
    pub fn step_view(&mut self, step: isize) {
        if std::mem::take(&mut self.fit.alter.is_open) {
            return;
        }
        let at = stepped(self.fit.view as usize, step, View::ALL.len());
        self.fit.view = View::ALL[at.unwrap_or(0)];
    }

    /// Has the results that are looked at cut, where that was not asked for yet.
    pub fn ask_for_sections(&mut self) -> Option<Effect> {
        let jobs = self.worn().map(jobs_of).filter(|jobs| !jobs.is_empty() && *jobs != self.fit.asked)?;
        self.fit.asked.clone_from(&jobs);
        Some(Effect::Cut(jobs))
    }

    /// Takes in sections that are still wanted.
    pub fn take_sections(&mut self, jobs: Vec<JobId>, sections: Sections) {
        if jobs == self.fit.asked {
            self.fit.cut = Some((jobs, sections));
        }
    }
}

/// The selected level or quantity, and what is shown of all.
pub fn explained(state: &State) -> Selected {
    const NAMES: [&str; 11] = [
        "ease",
        "target",
        "body",
        "wear",
        "level",
        "mean gap",
        "hem",
        "side seam lean",
        "greatest pressure",
        "folds",
        "drag lines",
    ];
    let quantities = state.quantities();
    let quantity = quantities.get(state.fit.row).filter(|_| state.fit.view == View::Sizes);
    let (what, name) = match (quantity, state.level()) {
        (Some(quantity), _) => {
            let cells: Vec<&str> = quantity.cells.iter().flatten().map(String::as_str).collect();
            (format!("{}: {}", quantity.name, cells.join("; ")), quantity.name.clone())
        }
        (None, level) => {
            let level = words(level.unwrap_or_default());
            (level.clone(), level)
        }
    };
    Selected::new(what, &[&name], &NAMES)
}

/// The results of the sizes that have one.
fn jobs_of(worn: &GarmentWorn) -> Vec<JobId> {
    worn.sizes.iter().map(|size| size.job).collect()
}

/// Whether two levels are one: the bust is the chest of women's garments.
#[must_use]
pub fn is_same(level: &str, other: &str) -> bool {
    let plain = |level| if level == "bust" { "chest" } else { level };
    plain(level) == plain(other)
}

/// The fit card, tab-separated.
#[must_use]
pub fn card_table(state: &State) -> Option<String> {
    let card = &state.worn().filter(|worn| !worn.card.sizes.is_empty())?.card;
    let names: Vec<String> =
        card.sizes.iter().map(|size| format!("{}_ease_mm\t{}_off_mm", size.size, size.size)).collect();
    let mut table = format!("level\tbody_mm\tleast_mm\tmost_mm\t{}\n", names.join("\t"));
    for level in card.levels() {
        let of_sizes: Vec<_> =
            card.sizes.iter().map(|size| size.levels.iter().find(|one| one.level == level)).collect();
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.1}"));
        let Some(known) = of_sizes.iter().flatten().next() else { continue };
        let eases = of_sizes
            .iter()
            .map(|one| format!("{}\t{}", number(one.map(|one| one.ease_mm)), number(one.and_then(|one| one.off_mm))));
        let [least, most] = [0, 1].map(|k| number(known.target_mm.map(|target| target[k])));
        let eases = eases.collect::<Vec<_>>().join("\t");
        table += &format!("{level}\t{:.1}\t{least}\t{most}\t{eases}\n", known.body_girth_mm);
    }
    Some(table)
}

/// The sizes side by side, tab-separated.
#[must_use]
pub fn size_table(state: &State) -> Option<String> {
    let sizes = &state.worn().filter(|worn| !worn.sizes.is_empty())?.sizes;
    let names: Vec<&str> = sizes.iter().map(|size| size.size.as_str()).collect();
    let mut table = format!("quantity\t{}\n", names.join("\t"));
    for row in state.quantities() {
        let cells: Vec<String> = row.cells.into_iter().map(Option::unwrap_or_default).collect();
        table += &format!("{}\t{}\n", row.name, cells.join("\t"));
    }
    Some(table)
}
