//! Drawing the pieces of a size, laid out around the head: edges with numbers, seams with letters. Braille dots and
//! text can be shown by every terminal.

use ratatui::Frame;
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::canvas::{Canvas, Line as Stroke};

use crate::messages::seams::SizeLayout;
use crate::screens::state::State;
use crate::screens::styles::labels::{EdgeDots, places};
use crate::screens::styles::state::{EdgeAt, StylesScreen, short_name};
use crate::screens::styles::view::{View, walked};
use crate::widgets::jump::{self, Goal, Target};
use crate::widgets::lists::pane;
use crate::widgets::text::{shortened, width};
use wardrobe::seams::{DeskEdge, DeskPiece, DeskSeam};

const DIGITS: [&str; 9] = ["1", "2", "3", "4", "5", "6", "7", "8", "9"];

impl StylesScreen {
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

struct Drawing<'a> {
    screen: &'a StylesScreen,
    state: &'a State,
    layout: &'a SizeLayout,
    view: View,
}

impl Drawing<'_> {
    /// Colour of the edge's seam.
    fn colour(&self, edge: EdgeAt) -> Color {
        self.layout.seam_at(edge).map_or(Color::Reset, |seam| self.state.theme.lettered(seam))
    }

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

    /// Draws the selected edge, or those that a question is about, and the partner with glyphs that need no colour;
    /// possible partners by the digits of their answers.
    fn selection(&self, frame: &mut Frame<'_>) {
        let asked = self.screen.asked(self.state);
        let offered = |at: EdgeAt| {
            let choices = &asked.as_ref()?.choices;
            choices.iter().position(|choice| choice.edges.contains(&at)).filter(|place| *place < DIGITS.len())
        };
        let pointed = self.screen.pointed(self.state);
        // A question marks what it is about, and nothing else.
        let may_mark = |edge: &EdgeAt| asked.is_none() || pointed.contains(edge);
        let chosen = Some(self.screen.edge).filter(may_mark);
        let seam = chosen.and_then(|chosen| self.layout.seam_at(chosen)).map(|k| &self.layout.out.desk.seams[k]);
        let is_a = seam.zip(chosen).is_some_and(|(seam, chosen)| seam.a.contains(&chosen));
        let others = seam.map_or(&[][..], |seam| if is_a { &seam.b } else { &seam.a });
        for (at, _, edge) in self.edges() {
            let glyph = match at {
                at if Some(at) == chosen => "●",
                at if self.screen.marks.contains(&at) => "◆",
                at if others.contains(&at) && may_mark(&at) => "○",
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
        let sides = seam.map_or(vec![], sides);
        for (at, is_forwards) in sides.into_iter().filter(|(at, _)| may_mark(at)) {
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
        let dots = EdgeDots::of(&self.layout.out.desk.pieces, &self.view);
        let mut taken: Vec<Rect> = vec![];
        for (at, _, edge) in edges {
            let label = self.layout.label(at);
            let style = match rank(at) {
                0 => Style::new().add_modifier(Modifier::REVERSED | Modifier::BOLD),
                _ => Style::new().fg(self.colour(at)).add_modifier(Modifier::BOLD),
            };
            let is_beside = |cells| dots.is_beside(at, cells, &self.view);
            self.put(frame, &mut taken, (&label, style), &places(edge, &self.view), is_beside);
        }
        for (k, piece) in self.layout.out.desk.pieces.iter().enumerate() {
            let places = [0.0, 7.0, -7.0, 14.0, -14.0].map(|dots| {
                let [x, y] = centre(piece);
                [x, y + dots * self.view.scale]
            });
            // Long names of small pieces are shortened as in the table.
            let names = [piece.id.clone(), short_name(&piece.id, 3), short_name(&piece.id, 1)];
            for name in &names {
                let is_of = |cells| dots.is_of(k, cells, &self.view);
                if self.put(frame, &mut taken, (name, self.state.theme.dim()), &places, is_of) {
                    break;
                }
            }
        }
    }

    /// Writes a label at the first of `places` that suits it, and where it touches no other label. Returns false where
    /// none does.
    fn put(
        &self,
        frame: &mut Frame<'_>,
        taken: &mut Vec<Rect>,
        (label, style): (&str, Style),
        places: &[[f64; 2]],
        suits: impl Fn(Rect) -> bool,
    ) -> bool {
        let columns = width(label) as u16;
        for cell in places.iter().filter_map(|place| self.view.cell(*place)) {
            let last = self.view.area.right().saturating_sub(columns).max(self.view.area.x);
            let x = cell.x.saturating_sub(columns / 2).clamp(self.view.area.x, last);
            let room = Rect::new(x, cell.y, columns, 1).intersection(self.view.area);
            let apart = Rect::new(x.saturating_sub(1), cell.y, columns + 2, 1);
            if room.width == columns && !taken.iter().any(|other| other.intersects(apart)) && suits(room) {
                frame.buffer_mut().set_string(x, cell.y, label, Style::reset().patch(style));
                taken.push(room);
                return true;
            }
        }
        false
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

/// Centre of a piece's bounding box.
pub fn centre(piece: &DeskPiece) -> [f64; 2] {
    let points = || piece.edges.iter().flat_map(|edge| &edge.line_mm);
    [0, 1].map(|k| {
        let low = points().map(|point| point[k]).fold(f64::INFINITY, f64::min);
        let high = points().map(|point| point[k]).fold(f64::NEG_INFINITY, f64::max);
        (low + high) / 2.0
    })
}
