//! Measurement files of other programs: SeamlyMe and Valentina (XML), GarmentCode (YAML or JSON).
//!
//! Only measurements defined as here are taken. A value of zero means that it was not measured.

use super::dimension::{Dimension, Measurements};
use crate::{BodyError, Sex};

/// Names of the dimensions in other programs. Of several names for a dimension, the first one in the file counts.
const NAMES: [(Dimension, &[&str]); 18] = [
    (Dimension::Stature, &["height"]),
    (Dimension::Weight, &["weight"]),
    (Dimension::ChestGirth, &["bust_circ", "bust"]),
    (Dimension::WaistGirth, &["waist_circ", "waist"]),
    (Dimension::HipGirth, &["hip_circ", "hips"]),
    (Dimension::NeckGirth, &["neck_circ"]),
    (Dimension::AcrossShoulder, &["shoulder_tip_to_shoulder_tip_b", "shoulder_w"]),
    (Dimension::UnderbustGirth, &["lowbust_circ", "underbust"]),
    (Dimension::ThighGirth, &["leg_thigh_upper_circ", "leg_circ"]),
    (Dimension::KneeGirth, &["leg_knee_circ"]),
    (Dimension::CalfGirth, &["leg_calf_circ"]),
    (Dimension::AnkleGirth, &["leg_ankle_circ"]),
    (Dimension::UpperArmGirth, &["arm_upper_circ"]),
    (Dimension::ForearmGirth, &["arm_lower_circ"]),
    (Dimension::WristGirth, &["arm_wrist_circ", "wrist"]),
    (Dimension::Inseam, &["leg_crotch_to_floor"]),
    (Dimension::ArmLength, &["arm_shoulder_tip_to_wrist_bent", "arm_shoulder_tip_to_wrist", "arm_length"]),
    (Dimension::FootLength, &["foot_length"]),
];

/// Uses `sex` if the file does not say it.
pub fn read_foreign(bytes: &[u8], sex: Option<Sex>) -> Result<Measurements, BodyError> {
    let text = std::str::from_utf8(bytes).map_err(|error| refused(error.to_string(), "a text file in UTF-8"))?;
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let told = if text.starts_with('<') { of_xml(text)? } else { of_garmentcode(text)? };
    let value =
        |name: &str| told.values.iter().find(|(key, value)| key == name && *value > 0.0).map(|(_, value)| *value);
    let value_of = |dimension: Dimension| {
        let (_, names) = NAMES.iter().find(|(named, _)| *named == dimension)?;
        let unit = if dimension == Dimension::Weight { 1.0 } else { told.metres };
        names.iter().find_map(|name| value(name)).map(|value| value * unit)
    };
    let stature = value_of(Dimension::Stature).ok_or_else(|| refused("no height".to_owned(), "`height` above 0"))?;
    let [least, most] = Dimension::Stature.range();
    if !(least..=most).contains(&stature) {
        let [given, unit] = [stature / told.metres, told.metres * 1e3];
        let found = format!("`height` {given}, in units of {unit} mm as such files have");
        return Err(refused(found, &format!("{} to {} mm", least * 1e3, most * 1e3)));
    }
    let sex = sex.or(told.sex).ok_or_else(|| refused("no sex".to_owned(), "--sex m or --sex f"))?;
    let others = NAMES.iter().filter_map(|&(dimension, _)| Some((dimension, value_of(dimension)?)));
    Ok(others.fold(Measurements::of(sex, stature), |all, (dimension, value)| all.with(dimension, value)))
}

struct Told {
    sex: Option<Sex>,
    /// Unit of length of the file, m.
    metres: f64,
    values: Vec<(String, f64)>,
}

fn refused(found: String, accepted: &str) -> BodyError {
    BodyError::Measurements { found, accepted: accepted.to_owned() }
}

/// SeamlyMe (`.smis`) and Valentina (`.vit`), and the base size of their tables of sizes (`.smms`, `.vst`).
fn of_xml(text: &str) -> Result<Told, BodyError> {
    let accepted = "a file of SeamlyMe (.smis) or Valentina (.vit)";
    let document = roxmltree::Document::parse(text).map_err(|error| refused(error.to_string(), accepted))?;
    let text_of = |name: &str| {
        let node = document.descendants().find(|node| node.has_tag_name(name));
        node.and_then(|node| node.text()).map_or("", str::trim)
    };
    let metres = match text_of("unit") {
        "mm" => 1e-3,
        "cm" => 1e-2,
        "inch" => 25.4e-3,
        unit => return Err(refused(format!("unit `{unit}`"), "cm, mm or inch in <unit>")),
    };
    let sex = sex_of(text_of("gender"));
    let measures = document.descendants().filter(|node| node.has_tag_name("m"));
    // A value may be a formula of other measurements. It is then not measured.
    let value = |node: roxmltree::Node<'_, '_>| {
        let value = node.attribute("value").or_else(|| node.attribute("base"))?;
        Some((node.attribute("name")?.to_owned(), number(value)?))
    };
    Ok(Told { sex, metres, values: measures.filter_map(value).collect() })
}

/// Number with a decimal point or a decimal comma.
fn number(text: &str) -> Option<f64> {
    text.trim().replace(',', ".").parse().ok()
}

fn sex_of(word: &str) -> Option<Sex> {
    match word.trim().trim_matches(['"', '\'']).to_lowercase().as_str() {
        "male" | "m" => Some(Sex::Male),
        "female" | "f" => Some(Sex::Female),
        _ => None,
    }
}

/// Body of GarmentCode: names and numbers in centimetres, as YAML or JSON.
fn of_garmentcode(text: &str) -> Result<Told, BodyError> {
    let accepted = "measurements of SeamlyMe (.smis), Valentina (.vit) or GarmentCode (.yaml, .json)";
    let sex;
    let values: Vec<(String, f64)> = if text.starts_with('{') {
        let json: serde_json::Value =
            serde_json::from_str(text).map_err(|error| refused(error.to_string(), accepted))?;
        let body = json.get("body").unwrap_or(&json).as_object();
        sex = body.and_then(|body| body.get("sex")?.as_str()).and_then(sex_of);
        let numbers = body.into_iter().flatten().filter_map(|(name, value)| Some((name.clone(), value.as_f64()?)));
        numbers.collect()
    } else {
        let pair = |line: &'_ str| {
            let (name, value) = line.split_once(':')?;
            Some((name.trim().to_owned(), value.split('#').next().unwrap_or_default().trim().to_owned()))
        };
        let pairs: Vec<(String, String)> = text.lines().filter_map(pair).collect();
        sex = pairs.iter().find(|(name, _)| name == "sex").and_then(|(_, value)| sex_of(value));
        pairs.into_iter().filter_map(|(name, value)| Some((name, number(&value)?))).collect()
    };
    if values.is_empty() {
        return Err(refused("no measurements".to_owned(), accepted));
    }
    Ok(Told { sex, metres: 1e-2, values })
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIT: &str = "<?xml version='1.0'?>\n<vit><unit>inch</unit><personal><gender>female</gender></personal>
        <body-measurements><m name=\"height\" value=\"66\"/><m name=\"bust_circ\" value=\"36.5\"/>
        <m name=\"hip_circ\" value=\"0\"/><m name=\"waist_circ\" value=\"bust_circ - 9\"/>
        <m name=\"arm_shoulder_tip_to_wrist\" value=\"23\"/></body-measurements></vit>";

    #[test]
    fn measurements_of_other_programs_are_read() {
        let check = |text: &str, sex: Option<Sex>, expect: &[(Dimension, f64)], of: Sex| {
            let read = read_foreign(text.as_bytes(), sex).expect("it reads");
            let known: Vec<(Dimension, i64)> = read.known().map(|(d, m)| (d, (m * 1e4).round() as i64)).collect();
            let expect: Vec<(Dimension, i64)> = expect.iter().map(|(d, mm)| (*d, (mm * 10.0).round() as i64)).collect();
            assert_eq!((known, read.sex), (expect, of));
        };
        use Dimension::{ArmLength, ChestGirth, HipGirth, Stature, WaistGirth};
        let of_vit = [(Stature, 1676.4), (ChestGirth, 927.1), (ArmLength, 584.2)];
        check(VIT, None, &of_vit, Sex::Female);
        check(VIT, Some(Sex::Male), &of_vit, Sex::Male);
        let yaml = "body:\n  height: 171.99  # of the mean\n  bust: 99.8\n  waist: 84.3\n  hips: 103.5\n  arm_pose_angle: 45\n";
        let vst = VIT.replace("value=\"36.5\"", "base=\"36,5\" size_increase=\"1\"").replace("vit>", "vst>");
        check(&vst, None, &of_vit, Sex::Female);
        let body = [(Stature, 1719.9), (ChestGirth, 998.0), (WaistGirth, 843.0), (HipGirth, 1035.0)];
        check(yaml, Some(Sex::Female), &body, Sex::Female);
        check(&yaml.replace("  bust:", "  sex: male\n  bust:"), None, &body, Sex::Male);
        let json =
            "{\"body\": {\"height\": 171.99, \"bust\": 99.8, \"waist\": 84.3, \"hips\": 103.5, \"_note\": \"x\"}}";
        check(json, Some(Sex::Female), &body, Sex::Female);
    }

    #[test]
    fn what_is_missing_is_said() {
        let check = |text: &str, expect: &str| {
            let told = read_foreign(text.as_bytes(), None).expect_err(expect).to_string();
            assert!(told.contains(expect), "{told}");
        };
        check("body:\n  height: 170\n", "--sex");
        check("body:\n  waist: 80\n", "no height");
        check("height: 1650\n", "found `height` 1650, in units of 10 mm as such files have; accepted: 1300 to 2200 mm");
        check("hello", "SeamlyMe (.smis)");
        check("<vit><unit>ell</unit></vit>", "unit `ell`");
        check("<vit><unit>", "accepted: a file of SeamlyMe");
        check("{\"body\": ", "GarmentCode");
    }
}
