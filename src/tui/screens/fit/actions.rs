//! Choosing a level and a quantity; requesting cross sections.

use crate::keys::screen::Screen;
use crate::messages::answered::Answered;
use crate::messages::effect::Effect;
use crate::screens::fit::quantities::{Quantity, quantities};
use crate::screens::fit::state::{FitScreen, Sections, View};
use crate::screens::movement::{Movement, stepped};
use crate::screens::state::State;
use crate::widgets::text::words;
use results::{CrossSection, GarmentWorn};
use store::JobId;

/// Subject of the selected cell of the grid.
pub fn wearer(state: &State) -> Option<&String> {
    state.grid()?.subjects.get(state.place.subject)
}

/// Fit of the shown garment on that subject; `None` until it is read.
pub fn worn(state: &State) -> Option<&GarmentWorn> {
    let (garment, wearer) = (&state.grid()?.garment, wearer(state)?);
    let worn = state.data.as_ref()?.worn.as_ref()?;
    Some(worn).filter(|worn| worn.card.garment == *garment && worn.card.subject == *wearer)
}

/// Levels of the fit card that pass the filter.
pub fn card_levels(state: &State) -> Vec<&str> {
    let Some(card) = worn(state).map(|worn| &worn.card) else { return vec![] };
    let sits = |level: &str| {
        let of_level = card.sizes.iter().flat_map(|size| &size.levels).filter(|sits| sits.level == level);
        of_level.map(|sits| format!("{:+.0} {}", sits.ease_mm, sits.words())).collect::<Vec<_>>().join(" ")
    };
    let mut levels = card.levels();
    levels.retain(|level| passes(state, &format!("{} {}", words(level), sits(level))));
    levels
}

/// Quantities of the sizes that pass the filter.
pub fn quantities_shown(state: &State) -> Vec<Quantity> {
    let mut rows = worn(state).map_or(vec![], |worn| quantities(&worn.sizes));
    let cells = |row: &Quantity| row.cells.iter().flatten().cloned().collect::<Vec<_>>().join(" ");
    rows.retain(|row| passes(state, &format!("{} {}", row.name, cells(row))));
    rows
}

pub fn passes(state: &State, text: &str) -> bool {
    text.to_lowercase().contains(&state.filter_of(Screen::Fit))
}

impl FitScreen {
    /// Returns `None` while the sections are cut.
    pub fn sections(&self, state: &State) -> Option<&Sections> {
        let jobs = jobs_of(worn(state)?);
        self.cut.as_ref().filter(|cut| cut.request == jobs).map(|cut| &cut.outcome)
    }

    fn known_sections(&self, state: &State) -> &[CrossSection] {
        self.sections(state).and_then(|sections| sections.as_deref().ok()).unwrap_or_default()
    }

    /// Level that is shown: the chosen one, else the worst level of the size to wear.
    pub fn level<'a>(&'a self, state: &'a State) -> Option<&'a str> {
        let worn = worn(state)?;
        let sections = self.known_sections(state).iter().map(|section| section.level.as_str());
        let known: Vec<&str> = worn.card.levels().into_iter().chain(sections).collect();
        let chosen = self.level.as_deref().filter(|level| known.iter().any(|known| is_same(known, level)));
        let worst = worn.card.to_wear().and_then(|size| size.worst_level.as_deref());
        chosen.or(worst).or(known.first().copied())
    }

    pub fn level_in(&self, state: &State, levels: &[&str]) -> Option<usize> {
        self.level(state).and_then(|level| levels.iter().position(|other| is_same(other, level)))
    }

    /// Section at the shown level; the first section where no level was chosen and the shown one has none.
    pub fn section(&self, state: &State) -> Option<&CrossSection> {
        let (level, sections) = (self.level(state)?, self.known_sections(state));
        let first = sections.first().filter(|_| self.level.is_none());
        sections.iter().find(|section| is_same(&section.level, level)).or(first)
    }

    pub fn step_level(&mut self, state: &mut State, step: isize) {
        let sections = self.known_sections(state);
        let shown = self.section(state);
        let at = shown.and_then(|shown| sections.iter().position(|section| section.level == shown.level));
        let next = match at {
            Some(at) => stepped(at, step, sections.len()),
            None => (!sections.is_empty()).then_some(0),
        };
        match next.map(|next| sections[next].level.clone()) {
            Some(level) => self.level = Some(level),
            None => state.say(self.why_no_section(state)),
        }
    }

    pub fn why_no_section(&self, state: &State) -> String {
        match (worn(state), self.sections(state)) {
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

    pub fn go_in_view(&mut self, state: &mut State, movement: Movement) {
        match (self.view, movement) {
            (View::Card, _) => {
                let levels = card_levels(state);
                let next = movement.from(self.level_in(state, &levels).unwrap_or(0), levels.len());
                self.level = levels.get(next).map(|level| (*level).to_owned()).or(self.level.take());
            }
            (View::Section, Movement::By(step) | Movement::Round(step)) => self.step_level(state, step.signum()),
            (View::Section, _) => {
                let sections = self.known_sections(state);
                let end = if movement == Movement::First { sections.first() } else { sections.last() };
                self.level = end.map(|section| section.level.clone()).or(self.level.take());
            }
            (View::Comments, _) => self.comments.go(state, movement),
            (View::Sizes, _) => self.row = movement.from(self.row, quantities_shown(state).len()),
        }
    }

    /// Moves the focus; from the alteration, moves back to the part under it.
    pub fn step_view(&mut self, step: isize) {
        if std::mem::take(&mut self.alter.is_open) {
            return;
        }
        let at = stepped(self.view as usize, step, View::ALL.len());
        self.view = View::ALL[at.unwrap_or(0)];
    }

    /// Requests sections of the shown results, unless they were requested before.
    pub fn ask_for_sections(&mut self, state: &State) -> Option<Effect> {
        let jobs = worn(state).map(jobs_of).filter(|jobs| !jobs.is_empty() && *jobs != self.asked)?;
        self.asked.clone_from(&jobs);
        Some(Effect::Cut(jobs))
    }

    /// Stores sections that are still wanted.
    pub fn take_sections(&mut self, jobs: Vec<JobId>, sections: Sections) {
        if jobs == self.asked {
            self.cut = Some(Answered { request: jobs, outcome: sections });
        }
    }
}

fn jobs_of(worn: &GarmentWorn) -> Vec<JobId> {
    worn.sizes.iter().map(|size| size.job).collect()
}

/// True if two names mean the same level: the bust is the chest of women's garments.
pub fn is_same(level: &str, other: &str) -> bool {
    let plain = |level| if level == "bust" { "chest" } else { level };
    plain(level) == plain(other)
}

/// Fit card as text, separated by tabs.
pub fn card_table(state: &State) -> Option<String> {
    let card = &worn(state).filter(|worn| !worn.card.sizes.is_empty())?.card;
    let names: Vec<String> =
        card.sizes.iter().map(|size| format!("{}_ease_mm\t{}_off_mm", size.size, size.size)).collect();
    let mut table = format!("level\tbody_mm\tleast_mm\tmost_mm\t{}\n", names.join("\t"));
    for level in card.levels() {
        let of_sizes: Vec<_> =
            card.sizes.iter().map(|size| size.levels.iter().find(|sits| sits.level == level)).collect();
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.1}"));
        let Some(known) = of_sizes.iter().flatten().next() else { continue };
        let eases = of_sizes.iter().map(|sits| {
            format!("{}\t{}", number(sits.map(|sits| sits.ease_mm)), number(sits.and_then(|sits| sits.off_mm)))
        });
        let [least, most] =
            [0, 1].map(|k| number(known.target_mm.map(|target| target[k]).filter(|end| end.is_finite())));
        let eases = eases.collect::<Vec<_>>().join("\t");
        table += &format!("{level}\t{:.1}\t{least}\t{most}\t{eases}\n", known.body_girth_mm);
    }
    Some(table)
}

/// Sizes side by side as text, separated by tabs.
pub fn size_table(state: &State) -> Option<String> {
    let sizes = &worn(state).filter(|worn| !worn.sizes.is_empty())?.sizes;
    let names: Vec<&str> = sizes.iter().map(|size| size.size.as_str()).collect();
    let mut table = format!("quantity\t{}\n", names.join("\t"));
    for row in quantities_shown(state) {
        let cells: Vec<String> = row.cells.into_iter().map(Option::unwrap_or_default).collect();
        table += &format!("{}\t{}\n", row.name, cells.join("\t"));
    }
    Some(table)
}
