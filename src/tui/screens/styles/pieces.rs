//! Drawing the pieces of a size, laid out around the head: edges with numbers, seams with letters. Braille dots and
//! text can be shown by every terminal.

use ratatui::Frame;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::canvas::{Canvas, Line as Stroke};

use crate::messages::seams::SizeLayout;
use crate::screens::state::State;
use crate::screens::styles::state::{EdgeAt, StylesScreen};
use crate::widgets::jump::{self, Goal, Target};
use crate::widgets::lists::pane;
use crate::widgets::text::{shortened, width};
use wardrobe::seams::{DeskEdge, DeskPiece, DeskSeam};

/// Digits that name the answers of a question.
const DIGITS: [&str; 9] = ["1", "2", "3", "4", "5", "6", "7", "8", "9"];
/// Distances at which a label is tried beside its edge, in braille dots; above 0 inside the piece.
const OFFSETS: [f64; 6] = [6.0, 9.0, 3.0, 13.0, -6.0, -9.0];

/// Letter of a seam, in table and drawing.
pub fn letter(seam: usize) -> char {
    let small = || ('a'..='z').nth(seam.saturating_sub(26));
    ('A'..='Z').nth(seam).or_else(small).unwrap_or('+')
}

impl StylesScreen {
    /// Draws the pane with the pieces.
    pub fn draw_piece_pane(&self, frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
        let title = self.size_row(state).map_or("pieces".to_owned(), |row| format!("{} {}", row.style, row.size));
        let room = usize::from(area.width).saturating_sub(26);
        let legend =
            if area.width < 34 { " ● edge ○ sewn ◆ marked " } else { " ● edge  ○ sewn to it  ◆ marked " };
        let block = pane(state.theme, format!("{} · fronts up, right →", shortened(&title, room)), focused)
            .title_bottom(Line::styled(legend, state.theme.legend()));
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let Some(layout) = self.laid_out(state) else { return };
        let Some(view) = View::of(inner, layout) else { return };
        let drawing = Drawing { screen: self, state, layout, view };
        drawing.outlines(frame);
        drawing.selection(frame);
        drawing.labels(frame);
    }
}

/// Places of the edges, for a jump: their midpoints.
pub fn targets(layout: &SizeLayout, area: Rect) -> Vec<Target> {
    let Some(view) = View::of(jump::inside(area), layout) else { return vec![] };
    let place = |(k, (piece, edge)): (usize, EdgeAt)| {
        let [middle, _] = layout.out.desk.pieces[piece].edges[edge].middle();
        Some(Target { at: view.cell(middle)?, size: Size::new(2, 1), goal: Goal::Item(k) })
    };
    layout.edges().into_iter().enumerate().filter_map(place).collect()
}

/// Scale from mm to braille dots, of which a cell has two by four.
struct View {
    area: Rect,
    /// Left and upper end of the pane, mm.
    corner: [f64; 2],
    /// Scale, mm per dot.
    scale: f64,
}

impl View {
    /// View of all pieces in a pane; `None` without pieces or room.
    fn of(area: Rect, layout: &SizeLayout) -> Option<Self> {
        let edges = layout.out.desk.pieces.iter().flat_map(|piece| &piece.edges);
        let points = edges.flat_map(|edge| &edge.line_mm);
        let bounds = points.fold(None, |bounds: Option<[f64; 4]>, [x, y]| {
            let [left, low, right, high] = bounds.unwrap_or([*x, *y, *x, *y]);
            Some([left.min(*x), low.min(*y), right.max(*x), high.max(*y)])
        });
        let [left, low, right, high] = bounds?;
        if area.width < 4 || area.height < 3 {
            return None;
        }
        let dots = [f64::from(area.width) * 2.0, f64::from(area.height) * 4.0];
        // One dot stays free on each side.
        let scale = ((right - left) / (dots[0] - 2.0)).max((high - low) / (dots[1] - 2.0)).max(1e-6);
        let corner = [(left + right - scale * dots[0]) / 2.0, (low + high + scale * dots[1]) / 2.0];
        Some(Self { area, corner, scale })
    }

    /// Cell of a point; `None` outside the pane.
    fn cell(&self, [x, y]: [f64; 2]) -> Option<Position> {
        let column = ((x - self.corner[0]) / self.scale / 2.0).floor();
        let row = ((self.corner[1] - y) / self.scale / 4.0).floor();
        let is_inside =
            column >= 0.0 && row >= 0.0 && column < f64::from(self.area.width) && row < f64::from(self.area.height);
        is_inside.then(|| Position::new(self.area.x + column as u16, self.area.y + row as u16))
    }
}

struct Drawing<'a> {
    screen: &'a StylesScreen,
    state: &'a State,
    layout: &'a SizeLayout,
    view: View,
}

impl Drawing<'_> {
    /// Colour of an edge, which is that of its seam.
    fn colour(&self, edge: EdgeAt) -> Color {
        self.layout.seam_at(edge).map_or(Color::Reset, |seam| self.state.theme.lettered(seam))
    }

    /// All edges with their indices.
    fn edges(&self) -> impl Iterator<Item = (EdgeAt, &DeskPiece, &DeskEdge)> {
        let pieces = self.layout.out.desk.pieces.iter().enumerate();
        pieces.flat_map(|(k, piece)| piece.edges.iter().enumerate().map(move |(n, edge)| ((k, n), piece, edge)))
    }

    fn outlines(&self, frame: &mut Frame<'_>) {
        let View { area, corner, scale } = &self.view;
        // The canvas puts its bounds on the middles of the outermost dots.
        let (dx, dy) = (f64::from(area.width) * 2.0 - 1.0, f64::from(area.height) * 4.0 - 1.0);
        let (x, y) = (corner[0] + scale / 2.0, corner[1] - scale / 2.0);
        let canvas = Canvas::default()
            .marker(Marker::Braille)
            .x_bounds([x, x + dx * scale])
            .y_bounds([y - dy * scale, y])
            .paint(|context| {
                for (at, _, edge) in self.edges() {
                    let colour = self.colour(at);
                    for pair in edge.line_mm.windows(2) {
                        let [[x1, y1], [x2, y2]] = [pair[0], pair[1]];
                        context.draw(&Stroke { x1, y1, x2, y2, color: colour });
                    }
                }
            });
        frame.render_widget(canvas, *area);
    }

    /// Draws the selected edge, those that a question is about, and the partner with glyphs that need no colour; possible
    /// partners by the digits of their answers.
    fn selection(&self, frame: &mut Frame<'_>) {
        let chosen = self.screen.edge;
        let asked = self.screen.asked(self.state);
        let offered = |at: EdgeAt| {
            let choices = &asked.as_ref()?.choices;
            choices.iter().position(|choice| choice.edges.contains(&at)).filter(|place| *place < DIGITS.len())
        };
        let pointed = self.screen.pointed(self.state);
        let seam = self.layout.seam_at(chosen).map(|k| &self.layout.out.desk.seams[k]);
        let others = seam.map_or(&[][..], |seam| if seam.a.contains(&chosen) { &seam.b } else { &seam.a });
        for (at, _, edge) in self.edges() {
            let glyph = match at {
                at if at == chosen => "●",
                at if self.screen.marks.contains(&at) => "◆",
                at if others.contains(&at) => "○",
                at if pointed.contains(&at) => "●",
                at => match offered(at) {
                    Some(place) => DIGITS[place],
                    None => continue,
                },
            };
            let style = Style::new().fg(self.colour(at)).add_modifier(Modifier::BOLD);
            for cell in walked(edge, self.view.scale * 1.5).into_iter().filter_map(|place| self.view.cell(place)) {
                frame.buffer_mut()[cell].set_symbol(glyph).set_style(style);
            }
        }
        for (at, is_forwards) in seam.map_or(vec![], sides) {
            let edge = &self.layout.out.desk.pieces[at.0].edges[at.1];
            let [place, inwards] = edge.middle();
            // Direction along the edge: a quarter turn back from the inward normal.
            let along = [inwards[1], -inwards[0]].map(|x| if is_forwards { x } else { -x });
            if let Some(cell) = self.view.cell(place) {
                let style = Style::new().fg(self.colour(at)).add_modifier(Modifier::BOLD | Modifier::REVERSED);
                frame.buffer_mut()[cell].set_symbol(arrow(along)).set_style(style);
            }
        }
    }

    /// Draws numbers of edges with letters of seams, and names of pieces, where they fit: first those of the selection,
    /// then long edges before short ones.
    fn labels(&self, frame: &mut Frame<'_>) {
        let screen = self.screen;
        let pointed = screen.pointed(self.state);
        let mut edges: Vec<_> = self.edges().collect();
        let rank = |at: EdgeAt| match at {
            at if at == screen.edge => 0,
            at if screen.marks.contains(&at) || pointed.contains(&at) => 1,
            _ => 2,
        };
        edges.sort_by(|(a, _, one), (b, _, two)| {
            rank(*a).cmp(&rank(*b)).then(two.length_mm.total_cmp(&one.length_mm)).then(a.cmp(b))
        });
        let mut taken: Vec<Rect> = vec![];
        for (at, _, edge) in edges {
            let seam = self.layout.seam_at(at);
            let label = format!("{}{}", edge.number, seam.map_or(String::new(), |seam| letter(seam).to_string()));
            let style = match rank(at) {
                0 => Style::new().add_modifier(Modifier::REVERSED | Modifier::BOLD),
                _ => Style::new().fg(self.colour(at)).add_modifier(Modifier::BOLD),
            };
            let [middle, inwards] = edge.middle();
            let places = OFFSETS.map(|dots| [0, 1].map(|k| middle[k] + inwards[k] * dots * self.view.scale));
            self.put(frame, &mut taken, &label, style, &places);
        }
        for piece in &self.layout.out.desk.pieces {
            let places = [0.0, 7.0, -7.0, 14.0, -14.0].map(|dots| {
                let [x, y] = centre(piece);
                [x, y + dots * self.view.scale]
            });
            self.put(frame, &mut taken, &piece.id, self.state.theme.dim(), &places);
        }
    }

    /// Writes a label at the first of `places` where it touches no other label.
    fn put(&self, frame: &mut Frame<'_>, taken: &mut Vec<Rect>, label: &str, style: Style, places: &[[f64; 2]]) {
        let columns = width(label) as u16;
        for cell in places.iter().filter_map(|place| self.view.cell(*place)) {
            let last = self.view.area.right().saturating_sub(columns).max(self.view.area.x);
            let x = cell.x.saturating_sub(columns / 2).clamp(self.view.area.x, last);
            let room = Rect::new(x, cell.y, columns, 1).intersection(self.view.area);
            let apart = Rect::new(x.saturating_sub(1), cell.y, columns + 2, 1);
            if room.width == columns && !taken.iter().any(|other| other.intersects(apart)) {
                frame.buffer_mut().set_string(x, cell.y, label, Style::reset().patch(style));
                taken.push(room);
                return;
            }
        }
    }
}

/// Edges of a seam, each with true if the seam runs along it in its drawn direction: both sides then run together.
fn sides(seam: &DeskSeam) -> Vec<(EdgeAt, bool)> {
    let forwards = seam.a.iter().map(|edge| (*edge, true));
    forwards.chain(seam.b.iter().map(|edge| (*edge, seam.same_direction))).collect()
}

/// Arrow nearest to a direction; `y` points up.
fn arrow([x, y]: [f64; 2]) -> &'static str {
    match (x.abs() > y.abs(), x > 0.0, y > 0.0) {
        (true, true, _) => "→",
        (true, false, _) => "←",
        (false, _, true) => "↑",
        (false, _, false) => "↓",
    }
}

/// Points along an edge, at most `apart_mm` apart.
fn walked(edge: &DeskEdge, apart_mm: f64) -> Vec<[f64; 2]> {
    let mut places = vec![];
    for pair in edge.line_mm.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let steps = ((b[0] - a[0]).hypot(b[1] - a[1]) / apart_mm).ceil().clamp(1.0, 1e4) as usize;
        let point_at = |share: f64| [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
        places.extend((0..=steps).map(|k| point_at(k as f64 / steps as f64)));
    }
    places
}

/// Centre of a piece's bounding box.
fn centre(piece: &DeskPiece) -> [f64; 2] {
    let points = || piece.edges.iter().flat_map(|edge| &edge.line_mm);
    [0, 1].map(|k| {
        let low = points().map(|point| point[k]).fold(f64::INFINITY, f64::min);
        let high = points().map(|point| point[k]).fold(f64::NEG_INFINITY, f64::max);
        (low + high) / 2.0
    })
}
