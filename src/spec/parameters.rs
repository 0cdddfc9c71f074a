//! Parameters of the simulators by name, as a study file sets or sweeps them: `fem.offset_mu`, `fem.bend_angle_deg`,
//! `hybrid.relax.momentum`. Names follow the fields of the simulators' `Params`, with lengths in mm and angles in
//! degrees.

use std::collections::BTreeMap;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::inputs::Inputs;
use fit::Simulator;
use sim::{fem, hybrid};
use store::{InOrigin, Origin, Result, nearest};

pub const SIMULATORS: [Simulator; 2] = [Simulator::Fem, Simulator::Hybrid];

/// Values that differ from the defaults, by name, each in the unit that ends its name.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Parameters(BTreeMap<String, Value>);

impl Parameters {
    pub fn set(&mut self, name: &str, value: Value) -> std::result::Result<(), String> {
        let known = defaults();
        let Some(default) = known.get(name) else {
            let hint = match nearest(name, known.keys().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are: {}", known.keys().cloned().collect::<Vec<_>>().join(", ")),
            };
            return Err(format!("no parameter `{name}`; {hint}"));
        };
        let accepted = accepted(default);
        if !accepted.takes(&value) {
            return Err(format!("`{name}` is {value}; accepted: {}", accepted.words()));
        }
        let alone = Self(BTreeMap::from([(name.to_owned(), value.clone())]));
        // A word is tried in the simulator's own type, which alone knows the accepted words.
        if let (Accepted::Word, Err(error)) = (accepted, alone.fem().map(drop).and(alone.hybrid().map(drop))) {
            return Err(format!("`{name}` is {value}: {error}"));
        }
        self.0.extend(alone.0);
        Ok(())
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// Adds the values for one simulator to the inputs of a job, which does not depend on those for the other.
    pub(crate) fn add_inputs(&self, simulator: Simulator, inputs: &mut Inputs) {
        let prefix = format!("{}.", simulator.as_str());
        for (name, value) in self.iter().filter(|(name, _)| name.starts_with(&prefix)) {
            inputs.set(format!("sim.{name}"), value);
        }
    }

    pub fn of_inputs(inputs: &Inputs) -> std::result::Result<Self, String> {
        let mut parameters = Self::default();
        for (name, text) in inputs.iter() {
            let Some(name) = name.strip_prefix("sim.").filter(|name| name.contains('.')) else { continue };
            parameters.set(name, serde_json::from_str(text).unwrap_or_else(|_| text.into()))?;
        }
        Ok(parameters)
    }

    pub fn fem(&self) -> Result<fem::Params> {
        self.over(Simulator::Fem, &fem::Params::default())
    }

    pub fn hybrid(&self) -> Result<hybrid::Params> {
        self.over(Simulator::Hybrid, &hybrid::Params::default())
    }

    /// Replaces the default parameters that have a value here.
    fn over<T: Serialize + DeserializeOwned + Clone>(&self, simulator: Simulator, default: &T) -> Result<T> {
        if self.0.is_empty() {
            return Ok(default.clone());
        }
        let mut tree = serde_json::to_value(default).origin(Origin::Sim)?;
        fill(&mut tree, simulator.as_str(), &self.0);
        serde_json::from_value(tree).origin(Origin::Sim)
    }
}

fn fill(tree: &mut Value, prefix: &str, given: &BTreeMap<String, Value>) {
    for (key, value) in tree.as_object_mut().into_iter().flatten() {
        let (name, unit) = edge_name(key);
        let name = format!("{prefix}.{name}");
        if value.is_object() {
            fill(value, &name, given);
        } else if let Some(number) = given.get(&name) {
            *value = match (unit, number.as_f64()) {
                (Unit::Millimetre, Some(length)) => geom::units::from_mm(length).into(),
                (Unit::Degree, Some(angle)) => angle.to_radians().into(),
                _ => number.clone(),
            };
        }
    }
}

enum Accepted {
    Number,
    Count,
    Switch,
    Counts,
    Word,
}

impl Accepted {
    fn takes(&self, value: &Value) -> bool {
        match self {
            Self::Number => value.as_f64().is_some_and(|number| number.is_finite() && number >= 0.0),
            Self::Count => value.as_u64().is_some_and(|number| u32::try_from(number).is_ok()),
            Self::Switch => value.is_boolean(),
            Self::Counts => value.as_array().is_some_and(|all| all.iter().all(|item| Self::Count.takes(item))),
            Self::Word => value.is_string(),
        }
    }

    fn words(&self) -> &'static str {
        match self {
            Self::Number => "a number, not negative",
            Self::Count => "a whole number, not negative",
            Self::Switch => "true or false",
            Self::Counts => "a list of whole numbers",
            Self::Word => "text in quotes",
        }
    }
}

fn accepted(default: &Value) -> Accepted {
    match default {
        Value::Bool(_) => Accepted::Switch,
        Value::Array(_) => Accepted::Counts,
        Value::String(_) => Accepted::Word,
        Value::Number(number) if number.is_u64() => Accepted::Count,
        // The default null lets the simulator choose a number itself.
        _ => Accepted::Number,
    }
}

/// All parameters by their names, with their default values in SI units.
fn defaults() -> BTreeMap<String, Value> {
    let mut found = BTreeMap::new();
    // Serialising plain numbers and switches does not fail.
    flatten("fem", serde_json::to_value(fem::Params::default()).unwrap_or_default(), &mut found);
    flatten("hybrid", serde_json::to_value(hybrid::Params::default()).unwrap_or_default(), &mut found);
    found
}

/// Hash of the default parameters and constants of a simulator, by name and value, hex. It changes with a number, but
/// not when a type is renamed.
pub(crate) fn default_hash(simulator: Simulator) -> String {
    deciding(simulator).into_iter().collect::<Inputs>().hash()
}

/// Default parameters and constants that decide the results of a simulator, by name.
fn deciding(simulator: Simulator) -> BTreeMap<String, String> {
    let own = format!("{}.", simulator.as_str());
    let parameters = defaults().into_iter().filter(|(name, _)| name.starts_with(&own));
    let others = SIMULATORS.iter().filter(|other| **other != simulator).map(|other| other.as_str());
    let foreign: Vec<&str> = others.chain(["laboratory"]).collect();
    let is_own = |name: &str| !foreign.iter().any(|room| name.split('.').next() == Some(room));
    let constants = sim::constants().into_iter().filter(|constant| is_own(constant.name));
    let constants = constants.map(|constant| (format!("constant.{}", constant.name), (constant.value)()));
    parameters.map(|(name, value)| (name, value.to_string())).chain(constants).collect()
}

fn flatten(prefix: &str, tree: Value, found: &mut BTreeMap<String, Value>) {
    match tree {
        Value::Object(fields) => {
            for (key, value) in fields {
                flatten(&format!("{prefix}.{}", edge_name(&key).0), value, found);
            }
        }
        leaf => {
            found.insert(prefix.to_owned(), leaf);
        }
    }
}

/// Unit of a value in study files, where it is not the SI unit of the program.
enum Unit {
    Same,
    Millimetre,
    Degree,
}

/// Name and unit of a parameter in study files.
fn edge_name(key: &str) -> (String, Unit) {
    match (key.strip_suffix("_rad"), key.strip_suffix("_m")) {
        (Some(stem), _) => (format!("{stem}_deg"), Unit::Degree),
        (None, Some(stem)) if !stem.ends_with("_n") => (format!("{stem}_mm"), Unit::Millimetre),
        _ => (key.to_owned(), Unit::Same),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(pairs: &[(&str, Value)]) -> Parameters {
        let mut parameters = Parameters::default();
        for (name, value) in pairs {
            parameters.set(name, value.clone()).expect("accepted");
        }
        parameters
    }

    #[test]
    fn values_reach_the_simulators_in_their_units() {
        let parameters = given(&[
            ("fem.offset_mu", 0.4.into()),
            ("fem.bend_angle_deg", 120.into()),
            ("fem.weld_gap_mm", 3.into()),
            ("fem.contact.offset_mm", 1.5.into()),
            ("fem.max_iterations", 7.into()),
            ("hybrid.uncontrolled", vec![1, 2].into()),
        ]);
        let fem = parameters.fem().expect("they fit");
        assert_eq!(fem.bend.offset_mu, Some(0.4));
        assert_eq!(fem.bend.bend_angle_rad, Some(120f64.to_radians()));
        assert_eq!((fem.sewing.weld_gap_m, fem.contact.offset_m, fem.max_iterations), (3e-3, 1.5e-3, 7));
        assert_eq!(fem.sewing.seam_stiffness_n_m, fem::Params::default().sewing.seam_stiffness_n_m);
        assert_eq!(parameters.hybrid().expect("they fit").uncontrolled, [1, 2]);
        let pyramid = given(&[("hybrid.popup", "pyramid".into())]).hybrid().expect("it fits");
        assert_ne!(pyramid.popup, hybrid::Params::default().popup);
        assert_eq!(Parameters::default().fem().expect("none"), fem::Params::default());
        let mut inputs = Inputs::default();
        parameters.add_inputs(Simulator::Hybrid, &mut inputs);
        assert_eq!(inputs.iter().collect::<Vec<_>>(), [("sim.hybrid.uncontrolled", "[1,2]")]);
        assert_eq!(Parameters::of_inputs(&inputs).expect("ours").hybrid().expect("fits").uncontrolled, [1, 2]);
    }

    #[test]
    fn wrong_names_and_values_are_told() {
        let check = |name: &str, value: Value, says: &str| {
            let told = Parameters::default().set(name, value).expect_err("wrong");
            assert!(told.contains(says), "{told}");
        };
        check("fem.ofset_mu", 1.into(), "did you mean `fem.offset_mu`?");
        check("fem.offset_mu", "x".into(), "`fem.offset_mu` is \"x\"; accepted: a number, not negative");
        check("fem.offset_mu", (-1).into(), "not negative");
        check("fem.max_iterations", 1.5.into(), "a whole number");
        check("hybrid.uncontrolled", 1.into(), "a list of whole numbers");
        check("hybrid.popup", 1.into(), "text in quotes");
        check("hybrid.popup", "pyramids".into(), "expected `rigid` or `pyramid`");
    }

    #[test]
    fn default_parameters_are_keyed_by_names_and_values() {
        let [fem, hybrid] = SIMULATORS.map(default_hash);
        assert_ne!(fem, hybrid);
        let check = |name: &str, value: &str| {
            let mut changed = deciding(Simulator::Fem);
            assert!(changed.insert(name.to_owned(), value.to_owned()).is_some(), "no {name}");
            assert_ne!(changed.into_iter().collect::<Inputs>().hash(), fem, "{name}");
        };
        check("fem.tolerance", "0.02");
        check("constant.fem.dress.TORN", "1.3");
        check("constant.linalg.linear.FACTOR_COST", "13");
        let foreign = |name: &&String| name.contains("hybrid.") || name.contains("laboratory.");
        assert_eq!(deciding(Simulator::Fem).keys().find(foreign), None);
    }
}
