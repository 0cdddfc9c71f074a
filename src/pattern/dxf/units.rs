//! Units and code page of a DXF file.

use encoding_rs::Encoding;

use super::DxfError;
use super::guard::Inventory;
use super::tags::clipped;

/// Unit of length of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimetre (`Units: METRIC`).
    Mm,
    /// Centimetre.
    Cm,
    /// Inch (`Units: ENGLISH`).
    In,
}

impl Unit {
    /// Millimetres in one unit.
    #[must_use]
    pub fn mm_per_unit(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::In => 25.4,
        }
    }

    /// Short name.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::In => "in",
        }
    }
}

/// Where the unit of a file comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitSource {
    /// Said by the user.
    Given,
    /// A `Units:` text, `$INSUNITS` or `$MEASUREMENT`.
    File,
    /// Nowhere; millimetres are assumed.
    Assumed,
}

/// A unit that the file names.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Unit.
    pub unit: Unit,
    /// What names it.
    pub by: &'static str,
    /// Line.
    pub line: usize,
}

/// The units that a file names; the first counts: a `Units:` text [AAMA-292] goes before `$INSUNITS`, and that before
/// `$MEASUREMENT`.
///
/// # Errors
/// [`DxfError`] for a unit that is not known.
pub fn claims(inventory: &Inventory<'_>, file: &str) -> Result<Vec<Claim>, DxfError> {
    let mut claims = Vec::new();
    for &(bytes, line) in &inventory.texts {
        let text = String::from_utf8_lossy(bytes);
        let Some((key, value)) = text.split_once(':') else { continue };
        if key.trim().eq_ignore_ascii_case("units") {
            let unit = match value.trim().to_ascii_uppercase().as_str() {
                "METRIC" | "MM" | "MILLIMETERS" | "MILLIMETRES" => Unit::Mm,
                "ENGLISH" | "IMPERIAL" | "INCH" | "INCHES" | "IN" => Unit::In,
                "CM" | "CENTIMETERS" | "CENTIMETRES" => Unit::Cm,
                _ => {
                    let found = format!("unit `{}`", clipped(value.trim()));
                    return Err(DxfError::new(file, Some(line), found, "METRIC, MM, CM, ENGLISH, INCH"));
                }
            };
            claims.push(Claim { unit, by: "Units text", line });
        }
    }
    let header = [
        ("$INSUNITS", &[("1", Unit::In), ("4", Unit::Mm), ("5", Unit::Cm)][..], "0 (none), 1 (inches), 4 (mm), 5 (cm)"),
        ("$MEASUREMENT", &[("0", Unit::In), ("1", Unit::Mm)][..], "0 (English), 1 (metric)"),
    ];
    for (by, units, accepted) in header {
        let Some(entry) = inventory.header.get(by).filter(|entry| by != "$INSUNITS" || entry.value != "0") else {
            continue;
        };
        match units.iter().find(|(value, _)| *value == entry.value) {
            Some(&(_, unit)) => claims.push(Claim { unit, by, line: entry.line }),
            None => {
                return Err(DxfError::new(file, Some(entry.line), format!("{by} {}", clipped(entry.value)), accepted));
            }
        }
    }
    Ok(claims)
}

/// Warnings where later claims contradict the first.
pub fn contradictions(claims: &[Claim]) -> Vec<String> {
    let Some(first) = claims.first() else { return Vec::new() };
    let warning = |claim: &Claim| {
        format!(
            "{} (line {}) says {}, {} (line {}) says {}: {} is taken",
            first.by,
            first.line,
            first.unit.as_str(),
            claim.by,
            claim.line,
            claim.unit.as_str(),
            first.unit.as_str()
        )
    };
    claims.iter().filter(|claim| claim.unit != first.unit).map(warning).collect()
}

/// Encoding of the texts: UTF-8 from AutoCAD 2007 on, else `$DWGCODEPAGE`, else Windows-1252.
///
/// # Errors
/// [`DxfError`] for a code page that is not known.
pub fn encoding_of(inventory: &Inventory<'_>, file: &str) -> Result<&'static Encoding, DxfError> {
    if inventory
        .header
        .get("$ACADVER")
        .is_some_and(|version| version.value >= "AC1021" && version.value.starts_with("AC"))
    {
        return Ok(encoding_rs::UTF_8);
    }
    let Some(entry) = inventory.header.get("$DWGCODEPAGE") else { return Ok(encoding_rs::WINDOWS_1252) };
    let name = entry.value.to_ascii_uppercase();
    let number = name.trim_start_matches("ANSI_").trim_start_matches("CP");
    let label = match number {
        "932" => "shift_jis".to_owned(),
        "936" => "gbk".to_owned(),
        "949" | "1361" => "euc-kr".to_owned(),
        "950" => "big5".to_owned(),
        "874" => "windows-874".to_owned(),
        "866" => "ibm866".to_owned(),
        "ASCII" | "US-ASCII" => "windows-1252".to_owned(),
        "UTF-8" | "UTF8" | "65001" => "utf-8".to_owned(),
        _ => format!("windows-{number}"),
    };
    Encoding::for_label(label.as_bytes()).ok_or_else(|| {
        let found = format!("$DWGCODEPAGE {}", clipped(entry.value));
        DxfError::new(file, Some(entry.line), found, "ANSI_1250 to ANSI_1258, 866, 874, 932, 936, 949, 950, UTF-8")
    })
}
