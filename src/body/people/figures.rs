//! Figures that a tailor alters for: signed traits of a body, and their names in the trade.
//!
//! The amount of a trait is a length on the body by which a pattern maker can cut. Usual amounts are those of books on
//! pattern alteration (Liechty, Rasband and Pottberg-Steineckert; Armstrong; Aldrich), less where a taut tape can change
//! by no more on a body that keeps its girths.

use super::dimension::Dimension;
use crate::{BodyError, Measurements, Sex};
use geom::units::from_mm;
use std::collections::BTreeMap;

/// Departure of a body from the standard body of its measurements. Above 0 is the longer or fuller one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Trait {
    /// Crotch length back: taut from the waist level at centre back to the point between the legs above the middle of the
    /// thighs.
    Seat,
    /// Crotch length front: taut from the waist level at centre front to the same point.
    Abdomen,
    /// Length of the back between blades and seat beside that of the side: below 0 in a hollow back. The bend of the
    /// trunk's axis at the waist times the distance from side to back.
    SwayBack,
    /// Taut from the back neck point down the centre back to blade level.
    UpperBack,
    /// Half of the front part of the chest girth, from side to side. Of women.
    Bust,
    /// Fall of the ridge of the shoulder over a mean shoulder, 0.076 of the stature across: from the side neck point to the
    /// shoulder point.
    ShoulderSlope,
    /// Distance by which the shoulder point lies in front of the middle of the neck, between front and back neck point.
    ShoulderForward,
    UpperArm,
    Thigh,
    /// Body rise: upright from the crotch to the waist level.
    Rise,
    /// Height by which the right side of the hip, between hip and waist level, lies above the left side.
    HighHip,
}

pub(crate) const TRAITS: usize = 11;

/// One value for each trait, m.
pub(crate) type ByTrait<T> = [T; TRAITS];

impl Trait {
    pub const ALL: [Self; TRAITS] = {
        use Trait::*;
        [Seat, Abdomen, SwayBack, UpperBack, Bust, ShoulderSlope, ShoulderForward, UpperArm, Thigh, Rise, HighHip]
    };

    /// Name of the figure with more (`amount` of 0 and above) or less of the trait.
    pub fn name(self, amount: f64) -> &'static str {
        let sign = if amount < 0.0 { -1.0 } else { 1.0 };
        let named = NAMED.iter().find(|named| named.of == self && named.sign == sign);
        named.expect("every trait has two names").name
    }
}

/// Traits that are a dimension, and sign of their amount in it. The body rise falls with the height of the crotch.
pub(crate) const DIMENSIONS: [(Trait, Dimension, f64); 3] = [
    (Trait::UpperArm, Dimension::UpperArmGirth, 1.0),
    (Trait::Thigh, Dimension::ThighGirth, 1.0),
    (Trait::Rise, Dimension::Inseam, -1.0),
];

struct Named {
    name: &'static str,
    of: Trait,
    sign: f64,
    /// Slight, medium and strong amounts.
    usual_mm: [f64; 3],
}

const fn named(name: &'static str, of: Trait, sign: f64, usual_mm: [f64; 3]) -> Named {
    Named { name, of, sign, usual_mm }
}

/// Names of the degrees, and the one that is meant where none is said.
const DEGREES: [&str; 3] = ["slight", "medium", "strong"];
const USUAL: usize = 1;

/// Greatest amount of a figure, as a multiple of its strong one. Judgement: what is beyond needs another size.
const MOST: f64 = 1.2;

const NAMED: [Named; 2 * TRAITS] = {
    use Trait::*;
    [
        named("flat_seat", Seat, -1.0, [8.0, 15.0, 25.0]),
        named("prominent_seat", Seat, 1.0, [8.0, 15.0, 25.0]),
        named("hollow_abdomen", Abdomen, -1.0, [2.0, 4.0, 6.0]),
        named("prominent_abdomen", Abdomen, 1.0, [8.0, 14.0, 20.0]),
        named("sway_back", SwayBack, -1.0, [5.0, 12.0, 20.0]),
        named("straight_back", SwayBack, 1.0, [4.0, 8.0, 12.0]),
        named("round_back", UpperBack, 1.0, [5.0, 10.0, 16.0]),
        named("erect_back", UpperBack, -1.0, [3.0, 5.0, 7.0]),
        named("full_bust", Bust, 1.0, [4.0, 8.0, 12.0]),
        named("small_bust", Bust, -1.0, [3.0, 5.0, 7.0]),
        named("sloping_shoulders", ShoulderSlope, 1.0, [5.0, 10.0, 15.0]),
        named("square_shoulders", ShoulderSlope, -1.0, [5.0, 10.0, 15.0]),
        named("forward_shoulders", ShoulderForward, 1.0, [5.0, 8.0, 12.0]),
        named("backward_shoulders", ShoulderForward, -1.0, [4.0, 7.0, 10.0]),
        named("large_upper_arm", UpperArm, 1.0, [10.0, 25.0, 40.0]),
        named("thin_upper_arm", UpperArm, -1.0, [10.0, 20.0, 30.0]),
        named("full_thigh", Thigh, 1.0, [10.0, 20.0, 30.0]),
        named("thin_thigh", Thigh, -1.0, [10.0, 20.0, 30.0]),
        named("long_rise", Rise, 1.0, [5.0, 12.0, 25.0]),
        named("short_rise", Rise, -1.0, [5.0, 12.0, 25.0]),
        named("high_hip", HighHip, 1.0, [5.0, 10.0, 15.0]),
        named("high_left_hip", HighHip, -1.0, [5.0, 10.0, 15.0]),
    ]
};

/// Amounts of the traits of a person, mm. A trait that is not there is that of the standard body.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Figures(BTreeMap<Trait, f64>);

impl Figures {
    /// Reads figures as `flat_seat`, `flat_seat=strong` or `flat_seat=18` (mm).
    ///
    /// # Examples
    /// ```
    /// use body::{Figures, Trait};
    ///
    /// let figures = Figures::read(["flat_seat=18", "round_back"])?;
    /// assert_eq!(figures.amount_mm(Trait::Seat), -18.0);
    /// assert_eq!(figures.amount_mm(Trait::UpperBack), 10.0);
    /// # Ok::<(), body::BodyError>(())
    /// ```
    pub fn read<'a>(texts: impl IntoIterator<Item = &'a str>) -> Result<Self, BodyError> {
        let mut figures = Self::default();
        for text in texts {
            let (name, degree) =
                text.split_once('=').map_or((text, None), |(name, degree)| (name, Some(degree.trim())));
            let named = named_figure(name.trim(), text)?;
            let amount = named.sign * named.amount(degree, text)?;
            if figures.0.insert(named.of, amount).is_some() {
                let problem = "another figure gives the same part of the body".to_owned();
                return Err(refused(text, problem, "one of them".to_owned()));
            }
        }
        Ok(figures)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Amount with its sign. 0 for the standard body.
    pub fn amount_mm(&self, of: Trait) -> f64 {
        self.0.get(&of).copied().unwrap_or(0.0)
    }

    /// Amount of a trait, m.
    pub(crate) fn amount(&self, of: Trait) -> f64 {
        from_mm(self.amount_mm(of))
    }

    /// Traits with their amounts, mm.
    pub fn iter(&self) -> impl Iterator<Item = (Trait, f64)> + '_ {
        self.0.iter().map(|(of, amount)| (*of, *amount))
    }

    /// Fails for a figure that a given measurement decides, or that the sex does not have.
    pub fn check(&self, known: &Measurements) -> Result<(), BodyError> {
        for (of, amount) in self.iter() {
            let refused = |problem, accepted: &str| Err(refused(of.name(amount), problem, accepted.to_owned()));
            let given = DIMENSIONS.iter().find(|(other, dimension, _)| *other == of && known.get(*dimension).is_some());
            if let Some((_, dimension, _)) = given {
                return refused(format!("`{}` is given, and says it already", dimension.key()), "one of the two");
            }
            if of == Trait::Bust && known.sex == Sex::Male {
                return refused("the body is a man's".to_owned(), "it for women");
            }
        }
        Ok(())
    }
}

/// The figures as they are read: `flat_seat=18 round_back=10`.
impl std::fmt::Display for Figures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (number, (of, amount)) in self.iter().enumerate() {
            write!(f, "{}{}={}", if number > 0 { " " } else { "" }, of.name(amount), amount.abs())?;
        }
        Ok(())
    }
}

impl Named {
    /// Amount of a degree by name or in mm, mm.
    fn amount(&self, degree: Option<&str>, text: &str) -> Result<f64, BodyError> {
        let Some(degree) = degree else { return Ok(self.usual_mm[USUAL]) };
        if let Some(place) = DEGREES.iter().position(|name| *name == degree) {
            return Ok(self.usual_mm[place]);
        }
        let most = (self.usual_mm[2] * MOST).round();
        let number = degree.strip_suffix("mm").unwrap_or(degree).trim().parse::<f64>().ok();
        number.filter(|amount| *amount > 0.0 && *amount <= most).ok_or_else(|| {
            refused(
                text,
                format!("`{degree}` is no degree"),
                format!("{}, or above 0 to {most} mm", DEGREES.join(", ")),
            )
        })
    }
}

fn named_figure(name: &str, text: &str) -> Result<&'static Named, BodyError> {
    let same = |named: &&Named| named.name == name || named.name.replace('_', "-") == name;
    NAMED.iter().find(same).ok_or_else(|| {
        let known: Vec<&str> = NAMED.iter().map(|named| named.name).collect();
        refused(text, format!("no figure is called `{name}`"), known.join(", "))
    })
}

fn refused(figure: &str, problem: String, accepted: String) -> BodyError {
    BodyError::Figure { figure: figure.to_owned(), problem, accepted }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read_by_name_degree_and_length() {
        let check = |texts: &[&str], expect: &[(Trait, f64)]| {
            let read = Figures::read(texts.iter().copied()).expect("figures");
            assert_eq!(read.iter().collect::<Vec<_>>(), expect, "{texts:?}");
            let again = read.to_string();
            assert_eq!(Figures::read(again.split(' ').filter(|text| !text.is_empty())).expect("its own text"), read);
        };
        check(&[], &[]);
        check(&["flat_seat"], &[(Trait::Seat, -15.0)]);
        check(&["flat-seat=strong", " round_back = 12 mm"], &[(Trait::Seat, -25.0), (Trait::UpperBack, 12.0)]);
        check(&["high_hip=slight", "sway_back=7.5"], &[(Trait::SwayBack, -7.5), (Trait::HighHip, 5.0)]);
    }

    #[test]
    fn what_is_no_figure_is_refused_with_what_is_accepted() {
        let check = |texts: &[&str], words: &[&str]| {
            let error = Figures::read(texts.iter().copied()).expect_err("no such figure").to_string();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        };
        check(&["flat_saet"], &["flat_saet", "flat_seat", "high_left_hip"]);
        check(&["flat_seat=huge"], &["huge", "slight, medium, strong", "30 mm"]);
        check(&["flat_seat=31"], &["31", "30 mm"]);
        check(&["flat_seat=-5"], &["-5"]);
        check(&["flat_seat=NaN"], &["NaN"]);
        check(&["flat_seat", "prominent_seat=3"], &["prominent_seat=3", "same part"]);
    }

    #[test]
    fn every_name_has_growing_degrees_and_its_own_sign() {
        for named in &NAMED {
            assert!(named.usual_mm.windows(2).all(|pair| pair[0] < pair[1]), "{}", named.name);
            assert_eq!(named.of.name(named.sign), named.name);
        }
    }
}
