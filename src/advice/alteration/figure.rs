//! Alterations for the figure of a subject: the handle that the trade uses for each trait, and its amount.
//!
//! A pattern is taken as drafted for the standard figure of its size. So a trait asks for as much as the body departs
//! from the standard body of its own measurements.

use serde::Serialize;

use crate::alteration::Wish;
use body::{Body, FigureFound, Trait};
use geom::units::from_mm;
use pattern::pom::Point;
use pattern::{Handle, Style};
use spec::file::Person;
use store::{InOrigin, Origin, Result};

/// Movement of a handle by which the change of its point of measure is found.
const STEP_M: f64 = 0.002;
const DRAWN_MM: f64 = 0.5;

struct Remedy {
    of: Trait,
    /// Handles of garments that cover the part of the body.
    covers: &'static [Handle],
    /// Handles for the trait, the first that a style has, each with the point of measure that changes by the amount of
    /// the trait; without one the handle moves by that amount.
    handles: &'static [(Handle, Option<Point>)],
}

/// Sources: [Liechty10, Armstrong10].
const REMEDIES: [Remedy; 9] = {
    use Handle::*;
    use Trait as Of;
    const SEAT: &[Handle] = &[Fork, Hip];
    const SHOULDER: &[Handle] = &[ShoulderLength];
    const TRUNK: &[Handle] = &[Fork, Hip, ShoulderLength];
    [
        remedy(Of::Seat, SEAT, &[(Seat, Some(Point::BackRise)), (BackRise, None)]),
        remedy(Of::Abdomen, TRUNK, &[(Abdomen, Some(Point::FrontRise)), (FrontRise, None), (FrontLength, None)]),
        remedy(Of::SwayBack, TRUNK, &[(SwayBack, None), (BackRise, None), (BackLength, None)]),
        remedy(Of::UpperBack, SHOULDER, &[(UpperBack, None)]),
        remedy(Of::Bust, SHOULDER, &[(Bust, None)]),
        remedy(Of::ShoulderSlope, SHOULDER, &[(ShoulderSlope, None)]),
        remedy(Of::ShoulderForward, SHOULDER, &[(ForwardShoulder, None)]),
        remedy(Of::Rise, &[Fork], &[(Rise, None)]),
        remedy(Of::HighHip, SEAT, &[]),
    ]
};

const fn remedy(of: Trait, covers: &'static [Handle], handles: &'static [(Handle, Option<Point>)]) -> Remedy {
    Remedy { of, covers, handles }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ForFigure {
    /// Such as `flat_seat`.
    pub figure: &'static str,
    pub amount_mm: f64,
    /// `None` where the style has none, or the amount is beyond what is cut.
    pub handle: Option<&'static str>,
    /// Amount of the handle.
    pub by_mm: f64,
}

/// A figure, and the move of a handle for it, m; without one where there is none.
pub type Asked = (ForFigure, Option<(Handle, f64)>);

/// Finds the traits of a person that no girth tells, and the handles of a style for them: figures that are said of the
/// person, and others that are clear on the body.
pub fn of(style: &Style, person: &Person, body: &Body, wish: &Wish) -> Result<Vec<Asked>> {
    let known = style.handles();
    let said = person.figures.iter().map(|(of, amount_mm)| FigureFound { of, amount_mm, sd_mm: 0.0 });
    let mut found: Vec<FigureFound> = said.collect();
    for seen in body::figures(body).origin(Origin::Body)? {
        if !found.iter().any(|said| said.of == seen.of) {
            found.push(seen);
        }
    }
    let clear = found.iter().filter(|found| found.is_clear());
    let is_covered = |remedy: &&Remedy| remedy.covers.iter().any(|handle| known.contains(handle));
    let asked = clear.filter_map(|found| {
        REMEDIES.iter().find(|remedy| remedy.of == found.of).filter(is_covered).map(|remedy| (found, remedy))
    });
    let altered = |(found, remedy): (&FigureFound, &Remedy)| {
        let own = remedy.handles.iter().find(|(handle, _)| known.contains(handle) && !wish.without.contains(handle));
        let by_mm = own.map_or(0.0, |(handle, point)| found.amount_mm / ratio(style, *handle, *point));
        let most_mm = own.map_or(0.0, |(handle, _)| wish.limit_mm.unwrap_or_else(|| handle.most_mm()));
        let by_mm = (by_mm.clamp(-most_mm, most_mm) / DRAWN_MM).round() * DRAWN_MM;
        let told = ForFigure {
            figure: found.name(),
            amount_mm: found.amount_mm,
            handle: own.map(|(handle, _)| handle.as_str()),
            by_mm,
        };
        (told, own.filter(|_| by_mm != 0.0).map(|(handle, _)| (*handle, from_mm(by_mm))))
    };
    Ok(asked.map(altered).collect())
}

/// Change of a point of measure by a handle, m/m; 1 without a point, or where it cannot be measured.
fn ratio(style: &Style, handle: Handle, point: Option<Point>) -> f64 {
    let length_m = |style: &Style| {
        style.points_of_measure().iter().find(|found| Some(found.point) == point).map(|found| found.length_m)
    };
    let moved = style.moved(&[(handle, STEP_M)]).ok();
    let change =
        moved.as_ref().and_then(length_m).zip(length_m(style)).map(|(after, before)| (after - before) / STEP_M);
    change.filter(|by| *by > 0.1).unwrap_or(1.0)
}
