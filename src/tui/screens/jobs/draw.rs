//! Drawing the queue, and log and curves of the selected job.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use crate::overlays::explanation::Selected;
use crate::screens::jobs::state::{JobOrder, JobsScreen};
use crate::screens::page::Draw;
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::is_narrow;
use crate::widgets::lists::{first_shown, listed, no_rows, pane};
use crate::widgets::text::{self, left, right, sparkline, wrapped};
use crate::widgets::theme::sign;
use store::{JobRow, LogLine, Status};

impl Draw for JobsScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        if is_narrow(area) {
            frame.render_widget(Paragraph::new(self.list(state, area)), area);
            return;
        }
        let [table_area, log_area] = panes(area);
        let shown = self.shown(state).len();
        let all = state.data.as_ref().map_or(0, |data| data.jobs.len());
        let study = state.study().map_or("", |study| &study.name);
        let title =
            if shown == all { format!("{study} · {all} jobs") } else { format!("{study} · {shown} of {all} jobs") };
        let block = pane(state.theme, title, !state.in_second_pane());
        let inner = block.inner(table_area);
        let lines = self.table(state, inner.width, inner.height, !state.in_second_pane());
        frame.render_widget(Paragraph::new(lines).block(block), table_area);
        self.draw_log(frame, log_area, state);
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let jobs = self.shown(state);
        let at = jobs.iter().position(|job| Some(job.id) == state.focus.job).unwrap_or(0);
        if is_narrow(area) {
            return jump::rows(0, area, 0, jobs.len(), at);
        }
        let [table, log] = panes(area);
        let mut targets = jump::rows(0, jump::inside(table), 1, jobs.len(), at);
        targets.push(jump::pane(log, 1));
        targets
    }

    fn explained(&self, state: &State) -> Selected {
        let what = state.job().map_or(String::new(), |job| {
            let ei = job.ei.map_or(String::new(), |ei| format!(", EI {ei:.4}"));
            format!("job {}, {} {} on {}: {}{ei}", job.id, job.garment, job.size, job.subject, text::status(job.status))
        });
        Selected::new(what, &NAMES, &[])
    }
}

impl JobsScreen {
    fn table(&self, state: &State, width: u16, height: u16, focused: bool) -> Vec<Line<'static>> {
        let jobs = self.shown(state);
        let columns = Columns::new(&jobs, usize::from(width));
        let room = usize::from(height).saturating_sub(1);
        let at = jobs.iter().position(|job| Some(job.id) == state.focus.job);
        let selection = at.map(|_| state.theme.selection(focused));
        let mut lines = vec![self.header(state, &columns)];
        lines.extend(listed(&jobs, at.unwrap_or(0), room, selection, |job| line(state, job, &columns)));
        if jobs.is_empty() {
            lines.push(no_rows(state.filter(), "no job matches the filter", "no jobs yet: R runs the study"));
        }
        lines
    }

    fn header(&self, state: &State, columns: &Columns) -> Line<'static> {
        let order = self.order;
        let name = |title: &str, by: JobOrder| {
            let rises = (by == JobOrder::Number || by == JobOrder::Status) != order.reversed;
            let mark = match (order.by == by, rises) {
                (false, _) => "",
                (true, true) => "▲",
                (true, false) => "▼",
            };
            format!("{title}{mark}")
        };
        let text = format!(
            "{} {} {} {} {} {}{}{}{}{}  {}",
            right(&name("ID", JobOrder::Number), columns.id),
            left(&name("S", JobOrder::Status), 2),
            left("style", columns.garment),
            left("size", columns.size),
            left("subj", columns.subject),
            left("sim", 4),
            left("progress", columns.bar + PROGRESS),
            right("ETA", 6),
            right(&name("took", JobOrder::Time), 7),
            right(&name("EI", JobOrder::Ei), 8),
            text::shortened("why", columns.why)
        );
        Line::styled(text, state.theme.dim())
    }

    fn draw_log(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let title = match state.job() {
            Some(job) => format!("log of job {} ({})", job.id, text::zone(state.offset_ms())),
            None => "log".into(),
        };
        let block = pane(state.theme, title, state.in_second_pane());
        let inner = block.inner(area);
        let width = usize::from(inner.width);
        let mut lines = self.curves(state, width);
        let room = usize::from(inner.height).saturating_sub(lines.len());
        lines.extend(self.log_lines(state, width, room));
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    /// Curves over the steps: residual, on a logarithmic scale, and E(chi).
    fn curves(&self, state: &State, width: usize) -> Vec<Line<'static>> {
        let steps = self.steps(state);
        let Some(last) = steps.last() else { return vec![] };
        let room = width.saturating_sub(23);
        let residuals: Vec<f64> = steps.iter().map(|step| step.residual.max(1e-300).log10()).collect();
        let chi: Vec<f64> = steps.iter().map(|step| step.e_chi).collect();
        let curve = |name: &str, value: String, values: &[f64]| {
            let label = Span::raw(format!("{}{} ", left(name, 13), right(&value, 8)));
            Line::from(vec![label, Span::styled(sparkline(values, room), state.theme.busy())])
        };
        vec![
            curve("log residual", format!("{:.1e}", last.residual), &residuals),
            curve("E(chi)", format!("{:.4}", last.e_chi), &chi),
        ]
    }

    /// Lines of the log that are scrolled to, below the whole error of a failed job.
    fn log_lines(&self, state: &State, width: usize, room: usize) -> Vec<Line<'static>> {
        let Some(detail) = state.detail() else { return vec![] };
        let error = state.job().and_then(|job| job.error.as_deref()).unwrap_or_default();
        let mut lines: Vec<Line<'_>> = wrapped(error, width)
            .into_iter()
            .map(|line| Line::styled(line, state.theme.bad()))
            .take(room.saturating_sub(1))
            .collect();
        let log: Vec<&LogLine> = detail.log.iter().filter(|line| line.text != error).collect();
        let end = log.len().saturating_sub(self.log_up);
        let shown = &log[end.saturating_sub(room - lines.len())..end];
        lines.extend(shown.iter().map(|line| log_line(state, line, width)));
        if detail.log.is_empty() && lines.is_empty() {
            lines.push(Line::styled("nothing logged yet", state.theme.dim()));
        }
        lines
    }

    /// List of the jobs in few columns, where the table does not fit.
    fn list(&self, state: &State, area: Rect) -> Vec<Line<'static>> {
        let jobs = self.shown(state);
        let at = jobs.iter().position(|job| Some(job.id) == state.focus.job).unwrap_or(0);
        let height = usize::from(area.height);
        let first = first_shown(at, jobs.len(), height);
        let id = longest_id(&jobs);
        let line = |(k, job): (usize, &&JobRow)| {
            let share = job.progress.as_ref().map(|progress| format!("{:.0}%", progress.fraction * 100.0));
            let number = share.or(job.ei.map(|ei| format!("{ei:.4}"))).unwrap_or_default();
            let cell = format!("{} {} {} {}", job.garment, job.size, job.subject, text::sim(job.simulator));
            let sign = sign(job.status, job.inside().is_some());
            let text = format!("{} {} {} {cell}", right(&job.id.to_string(), id), left(&sign, 2), left(&number, 6));
            let own = state.theme.result(job.status, job.inside().is_some());
            let style = if k == at { state.theme.selected() } else { own };
            Line::styled(text::shortened(&text, usize::from(area.width)), style)
        };
        jobs.iter().enumerate().skip(first).take(height).map(line).collect()
    }
}

fn panes(area: Rect) -> [Rect; 2] {
    let log_height = (area.height / 3).clamp(7, 16);
    Layout::vertical([Constraint::Fill(1), Constraint::Length(log_height)]).areas(area)
}

/// Names of the quantities on the screen, as in the glossary.
const NAMES: [&str; 13] =
    ["status", "EI", "progress", "ETA", "took", "why", "ID", "style", "size", "subj", "sim", "log residual", "E(chi)"];

/// Columns for reasons that names do not take: "process 12345 on a machine ended before the job did" begins in them.
const WHY: usize = 24;

/// Width of phase and percentage, in characters.
const PROGRESS: usize = 10;

struct Columns {
    id: usize,
    garment: usize,
    size: usize,
    subject: usize,
    bar: usize,
    why: usize,
}

impl Columns {
    /// Columns for number, status, simulator, progress, two times, EI, and gaps.
    const FIXED: usize = 1 + 2 + 4 + PROGRESS + 6 + 7 + 8 + 2 + 4;

    fn new(jobs: &[&JobRow], width: usize) -> Self {
        let longest = |field: fn(&JobRow) -> &str, least, most: usize| {
            jobs.iter().map(|job| text::width(field(job))).max().unwrap_or(0).clamp(least, most)
        };
        let bar = if width >= 120 { 14 } else { 0 };
        let id = longest_id(jobs);
        // Names take what the reasons can spare.
        let names = width.saturating_sub(Self::FIXED + id + 3 + bar + WHY);
        let garment = longest(|job| &job.garment, 5, (names / 2).max(9));
        let size = longest(|job| &job.size, 4, (names / 6).max(6));
        let subject = longest(|job| &job.subject, 4, names.saturating_sub(garment + size).max(7));
        let used = Self::FIXED + id + garment + size + subject + bar;
        Self { id, garment, size, subject, bar, why: width.saturating_sub(used) }
    }
}

fn longest_id(jobs: &[&JobRow]) -> usize {
    jobs.iter().map(|job| job.id.0).max().unwrap_or(0).to_string().len().max(4)
}

fn line(state: &State, job: &JobRow, columns: &Columns) -> Line<'static> {
    let now = state.data.as_ref().map_or(0, |data| data.now_ms);
    let is_paused = state.study().is_some_and(|study| study.paused);
    let elapsed = job.started_at_ms.filter(|_| job.status == Status::Running).map(|start| now - start);
    let progress = job.progress.as_ref().map_or(String::new(), |progress| {
        let share = text::progress(progress);
        let bar = text::progress_bar(progress.fraction, columns.bar.saturating_sub(1));
        if columns.bar > 0 { format!("{bar} {share}") } else { share }
    });
    let time = |ms: Option<i64>| ms.map_or("—".to_owned(), text::duration);
    let is_inside = job.inside().is_some();
    let status = state.theme.result(job.status, is_inside);
    let why = text::why(job, is_paused);
    Line::from(vec![
        Span::raw(format!("{}{}", right(&job.id.to_string(), columns.id), left(state.mark_of(Some(job.id)), 1))),
        Span::styled(left(&sign(job.status, is_inside), 2), status),
        Span::raw(format!(
            " {} {} {} {}",
            left(&job.garment, columns.garment),
            left(&job.size, columns.size),
            left(&job.subject, columns.subject),
            left(text::sim(job.simulator), 4)
        )),
        Span::styled(left(&progress, columns.bar + PROGRESS), status),
        Span::raw(format!(
            "{}{}{}  ",
            right(&time(job.eta_ms(now)), 6),
            right(&time(job.wall_ms.or(elapsed)), 7),
            right(&job.ei.map_or("—".to_owned(), text::ei), 8)
        )),
        Span::styled(text::shortened(&why, columns.why), status),
    ])
}

fn log_line(state: &State, line: &LogLine, width: usize) -> Line<'static> {
    let seconds = (line.at_ms + state.offset_ms()).div_euclid(1000).rem_euclid(86_400);
    let (style, mark) = match line.level.as_str() {
        "error" => (state.theme.bad(), "✗"),
        "warn" => (state.theme.warn(), "!"),
        _ => (ratatui::style::Style::new(), " "),
    };
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let text = format!("{hours:02}:{minutes:02}:{:02} {mark} {}", seconds % 60, line.text);
    Line::styled(text::shortened(&text, width), style)
}
