//! Form for a new study: its name, and the entries of the catalogue that it uses.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use crate::messages::effect::Effect;
use crate::messages::requests::FileTask;
use crate::overlays::form_frame::{Sending, draw_frame, is_done};
use crate::overlays::outcome::Outcome;
use crate::widgets::lists::first_shown;
use crate::widgets::text::{self, left, shortened};
use crate::widgets::theme::Theme;
use crate::widgets::typing::{edit, is_ctrl_c, moved};
use engine::{NewOutfit, NewStudy, PatternSource, Wearable};
use fit::Simulator;

/// Columns for the names of the parts.
const SECTION: usize = 17;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormLine {
    Name,
    Fabric,
    Simulator(usize),
    /// Style of several sizes, by the index of its first: all of them chosen, or not.
    Style(usize),
    Size(usize),
    /// Outfit of another study, by index.
    Outfit(usize),
    /// Outfit of one's own, typed.
    OwnOutfit,
    Subject(usize),
}

impl FormLine {
    pub fn section(self) -> &'static str {
        match self {
            Self::Name => "name",
            Self::Fabric => "fabric",
            Self::Simulator(_) => "simulators",
            Self::Style(_) | Self::Size(_) => "styles and sizes",
            Self::Outfit(_) | Self::OwnOutfit => "outfits",
            Self::Subject(_) => "subjects",
        }
    }
}

/// Filter for the lines of one part.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// Heading of the part whose lines are narrowed.
    section: &'static str,
    /// Text that these lines must contain, in lower case.
    text: String,
    is_typed: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct StudyForm {
    pub name: String,
    pub folder: PathBuf,
    pub fabrics: Vec<String>,
    pub fabric: usize,
    /// Simulators, each chosen or not.
    pub simulators: Vec<(Simulator, bool)>,
    /// Sizes, those of a style together, each chosen or not.
    pub sizes: Vec<(Wearable, bool)>,
    /// Styles whose sizes have a line each.
    pub opened: BTreeSet<String>,
    /// Outfits of other studies whose styles are there, each chosen or not.
    pub outfits: Vec<(NewOutfit, bool)>,
    pub own_outfit: String,
    /// Subjects, each chosen or not.
    pub subjects: Vec<(String, bool)>,
    pub filter: Filter,
    pub at: usize,
    pub sending: Sending,
}

impl StudyForm {
    /// Lines of the form, in order, without those that the filter hides.
    pub fn lines(&self) -> Vec<FormLine> {
        let mut lines = vec![FormLine::Name];
        for k in 0..self.sizes.len() {
            let style = self.of_style(k);
            if style.len() > 1 && style.start == k {
                lines.push(FormLine::Style(k));
            }
            if style.len() == 1 || self.is_open(k) {
                lines.push(FormLine::Size(k));
            }
        }
        lines.extend((0..self.subjects.len()).map(FormLine::Subject));
        if self.has_layers() {
            lines.extend((0..self.outfits.len()).map(FormLine::Outfit));
            lines.push(FormLine::OwnOutfit);
        }
        lines.extend((0..self.simulators.len()).map(FormLine::Simulator));
        lines.push(FormLine::Fabric);
        lines.retain(|line| self.passes(*line));
        lines
    }

    /// Sizes of the same style as a size.
    fn of_style(&self, k: usize) -> Range<usize> {
        let is_other = |(size, _): &&(Wearable, bool)| size.style != self.sizes[k].0.style;
        let before = self.sizes[..k].iter().rev().take_while(|size| !is_other(size)).count();
        let after = self.sizes[k..].iter().take_while(|size| !is_other(size)).count();
        k - before..k + after
    }

    /// True if the sizes of a size's style have a line each: the style is opened, or a filter is about its sizes.
    fn is_open(&self, k: usize) -> bool {
        let style = &self.sizes[k].0.style;
        let is_sought = self.filter.section == FormLine::Size(k).section() && !self.filter.text.is_empty();
        self.opened.contains(style) || is_sought && !style.to_lowercase().contains(&self.filter.text)
    }

    /// Sizes that a line of a style stands for: those that pass the filter.
    fn meant(&self, k: usize) -> impl Iterator<Item = usize> + '_ {
        self.of_style(k).filter(|k| self.passes(FormLine::Size(*k)))
    }

    /// Numbers of chosen and of all sizes that a line of a style stands for.
    fn chosen_of(&self, k: usize) -> [usize; 2] {
        [self.meant(k).filter(|k| self.sizes[*k].1).count(), self.meant(k).count()]
    }

    /// Gives the sizes of a line's style a line each, or folds them into one.
    fn fold(&mut self, line: FormLine, is_opened: bool) {
        let (FormLine::Style(k) | FormLine::Size(k)) = line else { return };
        let (style, first) = (self.sizes[k].0.style.clone(), self.of_style(k).start);
        if is_opened {
            self.opened.insert(style);
        } else {
            self.opened.remove(&style);
            self.at = self.lines().iter().position(|line| *line == FormLine::Style(first)).unwrap_or(self.at);
        }
    }

    /// True if an outfit is possible: one is known, or sizes of two styles are chosen.
    fn has_layers(&self) -> bool {
        let mut chosen = self.sizes.iter().filter(|(_, is_chosen)| *is_chosen).map(|(size, _)| &size.style);
        let first = chosen.next();
        !self.outfits.is_empty() || chosen.any(|style| Some(style) != first)
    }

    fn passes(&self, line: FormLine) -> bool {
        let words = match line {
            FormLine::Size(k) => format!("{} {}", self.sizes[k].0.style, self.sizes[k].0.size),
            FormLine::Style(k) => return self.meant(k).next().is_some(),
            FormLine::Subject(k) => self.subjects[k].0.clone(),
            FormLine::Outfit(k) => outfit_words(&self.outfits[k].0),
            FormLine::Simulator(k) => text::sim(self.simulators[k].0).to_owned(),
            FormLine::Name | FormLine::Fabric | FormLine::OwnOutfit => return true,
        };
        line.section() != self.filter.section || words.to_lowercase().contains(&self.filter.text)
    }

    pub fn line(&self) -> FormLine {
        self.lines().get(self.at).copied().unwrap_or(FormLine::Name)
    }

    /// Numbers of chosen subjects, sizes and simulators.
    pub fn jobs(&self) -> [usize; 3] {
        let sizes = self.sizes.iter().filter(|(_, is_chosen)| *is_chosen).count();
        let subjects = self.subjects.iter().filter(|(_, is_chosen)| *is_chosen).count();
        let simulators = self.simulators.iter().filter(|(_, is_chosen)| *is_chosen).count();
        [subjects, sizes, simulators]
    }

    /// True for a chosen line; `None` for lines that are filled in instead.
    pub fn choice(&self, line: FormLine) -> Option<bool> {
        match line {
            FormLine::Name | FormLine::Fabric | FormLine::OwnOutfit => None,
            FormLine::Simulator(k) => Some(self.simulators[k].1),
            FormLine::Style(k) => {
                let [chosen, all] = self.chosen_of(k);
                Some(chosen == all)
            }
            FormLine::Size(k) => Some(self.sizes[k].1),
            FormLine::Outfit(k) => Some(self.outfits[k].1),
            FormLine::Subject(k) => Some(self.subjects[k].1),
        }
    }

    fn choose(&mut self, line: FormLine, is_chosen: bool) {
        match line {
            FormLine::Name | FormLine::Fabric | FormLine::OwnOutfit => {}
            FormLine::Simulator(k) => self.simulators[k].1 = is_chosen,
            FormLine::Style(k) => {
                let meant: Vec<usize> = self.meant(k).collect();
                meant.into_iter().for_each(|k| self.sizes[k].1 = is_chosen);
            }
            FormLine::Size(k) => self.sizes[k].1 = is_chosen,
            FormLine::Outfit(k) => {
                self.outfits[k].1 = is_chosen;
                if is_chosen {
                    self.choose_layers(k);
                }
            }
            FormLine::Subject(k) => self.subjects[k].1 = is_chosen,
        }
    }

    /// Chooses all sizes of those styles of an outfit of which none is chosen.
    fn choose_layers(&mut self, k: usize) {
        for layer in &self.outfits[k].0.layers {
            if !self.sizes.iter().any(|(size, is_chosen)| *is_chosen && size.style == *layer) {
                let own = self.sizes.iter_mut().filter(|(size, _)| size.style == *layer);
                own.for_each(|(_, is_chosen)| *is_chosen = true);
            }
        }
    }

    /// Chosen outfits and the typed one.
    pub fn worn_over(&self) -> Result<Vec<NewOutfit>, String> {
        let mut all: Vec<NewOutfit> = chosen(&self.outfits);
        if !self.own_outfit.trim().is_empty() {
            all.push(self.own_outfit.trim().parse()?);
        }
        Ok(all)
    }

    /// Number of simulations of layers of outfits, which only FEM-GS drapes.
    pub fn layer_jobs(&self) -> Result<usize, String> {
        let sizes = chosen(&self.sizes);
        let sizes: Vec<(&str, &str)> = sizes.iter().map(|size| (size.style.as_str(), size.size.as_str())).collect();
        let layers = |outfit: &NewOutfit| Ok(outfit.layers.len() * outfit.sizes(&sizes)?.len());
        let layers: usize = self.worn_over()?.iter().map(layers).sum::<Result<_, String>>()?;
        let is_fem = self.simulators.contains(&(Simulator::Fem, true));
        Ok(if is_fem { layers * self.jobs()[0] } else { 0 })
    }

    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if is_ctrl_c(event) || event.code == KeyCode::Esc && !self.leave() {
            return Outcome::Closed;
        }
        if self.sending.is_busy || event.code == KeyCode::Esc {
            return Outcome::Open;
        }
        self.sending.problem = None;
        if self.filter.is_typed {
            self.narrow(event);
            return Outcome::Open;
        }
        let (line, lines) = (self.line(), self.lines().len());
        // In a line that is typed, letters do not move, and Ctrl-U empties it.
        let is_typed = matches!(line, FormLine::Name | FormLine::OwnOutfit);
        let empties = is_typed && event.code == KeyCode::Char('u');
        if let Some(next) = moved(self.at, lines, event, !is_typed).filter(|_| !empties) {
            self.at = next;
            return Outcome::Open;
        }
        match event.code {
            _ if is_done(event, line == FormLine::Fabric) => return self.save(),
            KeyCode::Enter | KeyCode::Tab => self.go_to_section(1),
            KeyCode::BackTab => self.go_to_section(-1),
            _ if is_typed => {
                edit(if line == FormLine::Name { &mut self.name } else { &mut self.own_outfit }, event);
            }
            KeyCode::Char('/') => {
                self.filter = Filter { section: line.section(), text: String::new(), is_typed: true };
            }
            KeyCode::Right | KeyCode::Char('l') if matches!(line, FormLine::Style(_) | FormLine::Size(_)) => {
                self.fold(line, true);
            }
            KeyCode::Left | KeyCode::Char('h') if matches!(line, FormLine::Style(_) | FormLine::Size(_)) => {
                self.fold(line, false);
            }
            KeyCode::Left | KeyCode::Char('h') if line == FormLine::Fabric => self.next_fabric(-1),
            KeyCode::Right | KeyCode::Char(' ' | 'l') if line == FormLine::Fabric => self.next_fabric(1),
            KeyCode::Char(' ' | 'x') => {
                if let Some(is_chosen) = self.choice(line) {
                    self.choose(line, !is_chosen);
                }
            }
            KeyCode::Char('a' | '*') => self.choose_section(line),
            _ => {}
        }
        Outcome::Open
    }

    /// Leaves the filter or the present part. Returns false where there is none to leave.
    fn leave(&mut self) -> bool {
        if self.sending.is_busy {
            return false;
        }
        let line = self.line();
        if !self.filter.section.is_empty() {
            let Filter { section, .. } = std::mem::take(&mut self.filter);
            let is_meant =
                |other: &FormLine| if line.section() == section { *other == line } else { other.section() == section };
            self.at = self.lines().iter().position(is_meant).unwrap_or(0);
            return true;
        }
        self.at = 0;
        line != FormLine::Name
    }

    /// Edits the filter, and selects the first line of the part that passes.
    fn narrow(&mut self, event: &KeyEvent) {
        if event.code == KeyCode::Enter {
            self.filter.is_typed = false;
        } else if edit(&mut self.filter.text, event) {
            self.filter.text = self.filter.text.to_lowercase();
        }
        if self.filter.section == FormLine::Fabric.section() && !self.is_sought(self.fabric) {
            self.next_fabric(1);
        }
        let lines = self.lines();
        if lines.get(self.at).is_none_or(|line| line.section() != self.filter.section) {
            let first = lines.iter().position(|line| line.section() == self.filter.section);
            self.at = first.unwrap_or(self.at.min(lines.len() - 1));
        }
    }

    fn keys(&self) -> &'static str {
        match self.line() {
            _ if self.filter.is_typed => " type what the lines contain  ↵ keep  Esc all again ",
            FormLine::Name => " ↵ next part  F5 make it  Esc cancel ",
            FormLine::Fabric => " h l choose  / filter  ↵ make it  Esc back ",
            FormLine::OwnOutfit => " NAME=STYLE,STYLE, the inner first; empty = none  ↵ next part  F5 make it ",
            FormLine::Style(_) => " j k  Space all sizes  l each size  / filter  ↵ next part  F5 make it  Esc back ",
            _ if !self.filter.section.is_empty() => {
                " j k  Space choose  a all of these  ↵ next part  F5 make it  Esc all again "
            }
            _ => " j k  Space choose  a all  / filter  ↵ next part  F5 make it  Esc back ",
        }
    }

    fn go_to_section(&mut self, step: isize) {
        let lines = self.lines();
        let starts: Vec<usize> =
            (0..lines.len()).filter(|k| *k == 0 || lines[*k].section() != lines[*k - 1].section()).collect();
        let at = starts.iter().rposition(|start| *start <= self.at).unwrap_or(0);
        self.at = starts[(at as isize + step).rem_euclid(starts.len() as isize) as usize];
    }

    fn next_fabric(&mut self, step: isize) {
        let len = self.fabrics.len();
        let next = |k: usize| (self.fabric as isize + step * k as isize).rem_euclid(len.max(1) as isize) as usize;
        self.fabric = (1..=len).map(next).find(|k| self.is_sought(*k)).unwrap_or(self.fabric);
    }

    /// True if a fabric passes the filter.
    fn is_sought(&self, k: usize) -> bool {
        let is_filtered = self.filter.section == FormLine::Fabric.section();
        !is_filtered || self.fabrics.get(k).is_some_and(|name| name.to_lowercase().contains(&self.filter.text))
    }

    /// Chooses all lines of a line's part, or none where all are chosen.
    fn choose_section(&mut self, line: FormLine) {
        let lines: Vec<FormLine> = self.lines().into_iter().filter(|other| other.section() == line.section()).collect();
        let all = lines.iter().all(|other| self.choice(*other) != Some(false));
        for other in lines {
            self.choose(other, !all);
        }
    }

    /// Sends the form, or moves to a part that is missing.
    fn save(&mut self) -> Outcome {
        let [subjects, sizes, simulators] = self.jobs();
        let missing = [
            (self.name.trim().is_empty(), "name", "a study needs a name"),
            (sizes == 0, "styles and sizes", "choose a size of a style with Space; a chooses all"),
            (subjects == 0, "subjects", "choose a subject with Space; a chooses all"),
            (simulators == 0, "simulators", "choose a simulator with Space"),
            (self.fabrics.is_empty(), "fabric", "the catalogue has no fabric: screen 9 imports some"),
        ];
        if let Some((_, section, problem)) = missing.into_iter().find(|(is_missing, ..)| *is_missing) {
            self.filter = Filter::default();
            self.at = self.lines().iter().position(|line| line.section() == section).unwrap_or(0);
            self.sending.problem = Some(problem.to_owned());
            return Outcome::Open;
        }
        let outfits = match self.layer_jobs().and_then(|_| self.worn_over()) {
            Ok(outfits) => outfits,
            Err(problem) => {
                self.filter = Filter::default();
                self.at = self.lines().iter().position(|line| *line == FormLine::OwnOutfit).unwrap_or(0);
                self.sending.problem = Some(problem);
                return Outcome::Open;
            }
        };
        let new = NewStudy {
            name: self.name.trim().to_owned(),
            folder: self.folder.clone(),
            subjects: chosen(&self.subjects),
            sizes: chosen(&self.sizes),
            fabric: self.fabrics[self.fabric].clone(),
            simulators: chosen(&self.simulators),
            fit: None,
            outfits,
        };
        self.sending.start();
        Outcome::Sent(vec![Effect::Files(FileTask::CreateStudy(new))])
    }
}

/// An outfit with its layers, the inmost first.
fn outfit_words(outfit: &NewOutfit) -> String {
    format!("{}: {}", outfit.name, outfit.layers.join(" under "))
}

/// Remark on a size that is no one's pattern file.
fn origin(wearable: &Wearable) -> &'static str {
    if matches!(wearable.source, PatternSource::Drafted(_)) { "  drafted by the program" } else { "" }
}

fn chosen<T: Clone>(all: &[(T, bool)]) -> Vec<T> {
    all.iter().filter(|(_, is_chosen)| *is_chosen).map(|(one, _)| one.clone()).collect()
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, form: &StudyForm, theme: Theme) {
    let width = area.width.min(90);
    let columns = usize::from(width.saturating_sub(2));
    let [subjects, sizes, simulators] = form.jobs();
    let counted = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let layers = form.layer_jobs().unwrap_or(0);
    let worn_over = if layers > 0 { format!(" + {layers} of outfits") } else { String::new() };
    let count = format!(
        " {} × {} × {}{worn_over} = {}",
        counted(subjects, "subject"),
        counted(sizes, "size"),
        counted(simulators, "simulator"),
        counted(subjects * sizes * simulators + layers, "simulation")
    );
    let folder = format!(" into {}", form.folder.join(form.name.trim()).display());
    let mut below = vec![
        Line::styled(shortened(&count, columns), theme.bold()),
        Line::styled(shortened(&folder, columns), theme.dim()),
    ];
    if !form.filter.section.is_empty() {
        let cursor = if form.filter.is_typed { "▏" } else { "" };
        let shown = form.lines().iter().filter(|line| line.section() == form.filter.section).count();
        let shown = match form.filter.section {
            section if section == FormLine::Fabric.section() => {
                (0..form.fabrics.len()).filter(|k| form.is_sought(*k)).count()
            }
            _ => shown,
        };
        let text = format!(" {}: {shown} that contain /{}{cursor}", form.filter.section, form.filter.text);
        below.push(Line::styled(shortened(&text, columns), theme.warn()));
    }
    below.extend(form.sending.lines("writing and checking…", columns, theme));
    let lines = form.lines();
    let room = usize::from(area.height.saturating_sub(2)).saturating_sub(below.len());
    // A line that tells what does not fit takes the room of one.
    let room = if lines.len() > room { room.saturating_sub(1) } else { room };
    let first = first_shown(form.at, lines.len(), room);
    let hidden = [(first, "▲", "above"), (lines.len().saturating_sub(first + room), "▼", "below")];
    let hidden = hidden.into_iter().filter(|(count, ..)| *count > 0);
    let hidden: Vec<String> = hidden.map(|(count, sign, where_)| format!("{sign} {count} more {where_}")).collect();
    if !hidden.is_empty() {
        below.insert(0, Line::styled(format!("  {}", hidden.join("  ")), theme.warn()));
    }
    let mut shown: Vec<Line<'_>> =
        (first..lines.len()).take(room).map(|k| line(form, k, k == first, columns, theme)).collect();
    shown.extend(below);
    draw_frame(frame, area, width, "new study".to_owned(), form.keys(), shown, theme);
}

fn line(form: &StudyForm, k: usize, is_first_shown: bool, columns: usize, theme: Theme) -> Line<'static> {
    let lines = form.lines();
    let line = lines[k];
    let is_focused = k == form.at && !form.sending.is_busy;
    let begins = k == 0 || is_first_shown || lines[k - 1].section() != line.section();
    let section = if begins { line.section() } else { "" };
    let mark = match form.choice(line) {
        _ if matches!(line, FormLine::Style(k) if (1..form.chosen_of(k)[1]).contains(&form.chosen_of(k)[0])) => "[-] ",
        Some(true) => "[x] ",
        Some(false) => "[ ] ",
        None => "",
    };
    let value = match line {
        FormLine::Name => format!("{}{}", form.name, if is_focused { "▏" } else { "" }),
        FormLine::Fabric => match form.fabrics.get(form.fabric) {
            Some(name) => format!("◂ {name} ▸  {} of {}", form.fabric + 1, form.fabrics.len()),
            None => "none".to_owned(),
        },
        FormLine::Simulator(k) => text::sim(form.simulators[k].0).to_owned(),
        FormLine::Style(k) => {
            let [chosen, all] = form.chosen_of(k);
            let sizes = if all == 1 { "size" } else { "sizes" };
            let sign = if form.is_open(k) { "▼" } else { "▸" };
            format!("{}  {chosen} of {all} {sizes} {sign}{}", form.sizes[k].0.style, origin(&form.sizes[k].0))
        }
        FormLine::Size(k) => {
            let wearable = &form.sizes[k].0;
            let indent = if form.of_style(k).len() > 1 { "  " } else { "" };
            format!("{indent}{} {}{}", wearable.style, wearable.size, origin(wearable))
        }
        FormLine::Outfit(k) => outfit_words(&form.outfits[k].0),
        FormLine::OwnOutfit if is_focused => format!("{}▏", form.own_outfit),
        FormLine::OwnOutfit if form.own_outfit.is_empty() => "one of your own".to_owned(),
        FormLine::OwnOutfit => form.own_outfit.clone(),
        FormLine::Subject(k) => form.subjects[k].0.clone(),
    };
    let text = shortened(&format!("{mark}{value}"), columns.saturating_sub(SECTION + 2));
    let style = if is_focused { theme.selected() } else { ratatui::style::Style::new() };
    let pointer = if is_focused { "▸ " } else { "  " };
    Line::from(vec![
        Span::styled(format!("{pointer}{}", left(section, SECTION)), theme.dim()),
        Span::styled(text, style),
    ])
}
