//! Units and code page of a DXF file.

use super::DxfError;
use super::code_page::CodePage;
use super::guard::{Inventory, Located};
use super::tags::clipped;

/// Unit of length of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimetre (`Units: METRIC`).
    Mm,
    /// Centimetre (`Units: CM`).
    Cm,
    /// Inch (`Units: ENGLISH`).
    In,
    /// Metre (`Units: M`).
    M,
}

impl Unit {
    /// All supported units.
    pub const ALL: [Self; 4] = [Self::Mm, Self::Cm, Self::In, Self::M];

    /// Millimetres in one unit.
    #[must_use]
    pub fn mm_per_unit(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::In => 25.4,
            Self::M => 1000.0,
        }
    }

    /// Symbol, as `--unit` takes it.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::In => "in",
            Self::M => "m",
        }
    }
}

/// Source of the unit of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitSource {
    /// The user.
    Given,
    /// A `Units:` text, `$INSUNITS` or `$MEASUREMENT`.
    File,
    /// No source: millimetres by default.
    Assumed,
}

/// A unit that the file names.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Unit that is named.
    pub unit: Unit,
    /// Name of the text or header variable.
    pub by: &'static str,
    /// Line number of the text or header value, from 1.
    pub line: usize,
}

/// Units that a file names, the one that counts first. A `Units:` text [AAMA-292] precedes `$INSUNITS`, which precedes
/// `$MEASUREMENT`.
///
/// # Errors
/// [`DxfError`] for an unknown unit.
pub fn claims(inventory: &Inventory<'_>, file: &str) -> Result<Vec<Claim>, DxfError> {
    let mut claims = Vec::new();
    for &Located { bytes, line } in &inventory.texts {
        let text = String::from_utf8_lossy(bytes);
        let Some((key, value)) = text.split_once(':') else { continue };
        if key.trim().eq_ignore_ascii_case("units") {
            let unit = match value.trim().to_ascii_uppercase().as_str() {
                "METRIC" | "MM" | "MILLIMETERS" | "MILLIMETRES" => Unit::Mm,
                "ENGLISH" | "IMPERIAL" | "INCH" | "INCHES" | "IN" => Unit::In,
                "CM" | "CENTIMETERS" | "CENTIMETRES" => Unit::Cm,
                "M" | "METERS" | "METRES" => Unit::M,
                _ => {
                    let found = format!("unit `{}`", clipped(value.trim()));
                    let accepted =
                        "METRIC, MM, CM, M, ENGLISH, INCH; or --unit mm, cm, in or m, which goes before the file";
                    return Err(DxfError::new(file, Some(line), found, accepted));
                }
            };
            claims.push(Claim { unit, by: "Units text", line });
        }
    }
    let header = [
        (
            "$INSUNITS",
            &[("1", Unit::In), ("4", Unit::Mm), ("5", Unit::Cm), ("6", Unit::M)][..],
            "0 (none), 1 (inches), 4 (mm), 5 (cm), 6 (m); or --unit mm, cm, in or m, which goes before the file",
        ),
        (
            "$MEASUREMENT",
            &[("0", Unit::In), ("1", Unit::Mm)][..],
            "0 (English), 1 (metric); or --unit mm, cm, in or m, which goes before the file",
        ),
    ];
    for (by, units, accepted) in header {
        let Some(entry) = inventory.header.get(by).filter(|entry| by != "$INSUNITS" || entry.value != "0") else {
            continue;
        };
        match units.iter().find(|(value, _)| *value == entry.value) {
            Some(&(_, unit)) => claims.push(Claim { unit, by, line: entry.line }),
            // Drawing programs write this variable into every header, so a text of the pattern counts more.
            None if !claims.is_empty() => {}
            None => {
                return Err(DxfError::new(file, Some(entry.line), format!("{by} {}", clipped(entry.value)), accepted));
            }
        }
    }
    Ok(claims)
}

/// Warnings for later claims that contradict the first.
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

/// Warning if the file names another unit than the user.
pub fn overruled(claims: &[Claim], given: Unit) -> Option<String> {
    let claim = claims.first().filter(|claim| claim.unit != given)?;
    let Claim { unit, by, line } = claim;
    Some(format!("{by} (line {line}) says {}: --unit {} is taken instead", unit.as_str(), given.as_str()))
}

/// Encoding of the texts: UTF-8 from AutoCAD 2007 on, or if all texts are valid UTF-8, whatever the header says.
/// Otherwise `$DWGCODEPAGE`, or Windows-1252 if the file has none.
///
/// # Errors
/// [`DxfError`] for an unknown code page, if a text is not ASCII.
pub fn code_page(inventory: &Inventory<'_>, file: &str) -> Result<CodePage, DxfError> {
    let version = inventory.header.get("$ACADVER").map_or("", |entry| entry.value);
    let is_ascii = inventory.words().all(<[u8]>::is_ascii);
    // Text in another encoding is hardly ever valid UTF-8.
    let is_utf8 = !is_ascii && inventory.words().all(|bytes| std::str::from_utf8(bytes).is_ok());
    if (version >= "AC1021" && version.starts_with("AC")) || is_utf8 {
        return Ok(CodePage::Web(encoding_rs::UTF_8));
    }
    let Some(entry) = inventory.header.get("$DWGCODEPAGE") else { return Ok(CodePage::Web(encoding_rs::WINDOWS_1252)) };
    match CodePage::named(entry.value) {
        Some(page) => Ok(page),
        None if is_ascii => Ok(CodePage::Web(encoding_rs::WINDOWS_1252)),
        None => {
            let found = format!("$DWGCODEPAGE {}", clipped(entry.value));
            let accepted = "ANSI_1250 to ANSI_1258, ISO 8859, KOI8, 437, 850, 852, 866, 874, 932, 936, 949, 950, UTF-8";
            Err(DxfError::new(file, Some(entry.line), found, accepted))
        }
    }
}
