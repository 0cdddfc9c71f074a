//! Units and code page of a DXF file.

use super::DxfError;
use super::code_page::CodePage;
use super::guard::{Inventory, Located};
use super::mtext;
use super::tags::clipped;
use crate::trade;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// `Units: METRIC`.
    Mm,
    /// `Units: CM`.
    Cm,
    /// `Units: ENGLISH`.
    In,
    /// `Units: M`.
    M,
}

impl Unit {
    pub const ALL: [Self; 4] = [Self::Mm, Self::Cm, Self::In, Self::M];

    pub fn mm_per_unit(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::In => 25.4,
            Self::M => 1000.0,
        }
    }

    /// Symbol, as `--unit` takes it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::In => "in",
            Self::M => "m",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitSource {
    Given,
    /// A `Units:` text, `$INSUNITS` or `$MEASUREMENT`.
    File,
    /// Millimetres by default.
    Assumed,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    pub unit: Unit,
    pub by: &'static str,
    pub line: usize,
}

/// The one that counts first: a `Units:` text [AAMA-292], then `$INSUNITS`, then `$MEASUREMENT`.
pub fn claims(inventory: &Inventory<'_>, file: &str) -> Result<Vec<Claim>, DxfError> {
    let mut claims = Vec::new();
    let texts = inventory.texts.iter().flat_map(|&Located { bytes, line }| {
        mtext::lines(&String::from_utf8_lossy(bytes)).into_iter().map(move |text| (text, line))
    });
    for (text, line) in texts {
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

pub fn overruled(claims: &[Claim], given: Unit) -> Option<String> {
    let claim = claims.first().filter(|claim| claim.unit != given)?;
    let Claim { unit, by, line } = claim;
    Some(format!("{by} (line {line}) says {}: --unit {} is taken instead", unit.as_str(), given.as_str()))
}

/// The likeliest first: those of CAD programs of Europe, China, Japan, Taiwan, Korea, Russia, Turkey and Greece.
const UNNAMED_PAGES: [&str; 13] =
    ["1252", "936", "932", "950", "949", "1251", "1254", "1250", "1253", "850", "437", "866", "koi8-r"];

#[derive(Clone, Debug, PartialEq)]
pub struct Encoding {
    pub page: CodePage,
    /// `None` where the file says its encoding, or has ASCII alone.
    pub remark: Option<String>,
}

/// UTF-8 from AutoCAD 2007 on, or if all texts are valid UTF-8, whatever the header says; otherwise `$DWGCODEPAGE`.
/// Without one, the page in which most words are words of the trade.
pub fn code_page(inventory: &Inventory<'_>, file: &str) -> Result<Encoding, DxfError> {
    let said = |page| Ok(Encoding { page, remark: None });
    let version = inventory.header.get("$ACADVER").map_or("", |entry| entry.value);
    let is_ascii = inventory.words().all(<[u8]>::is_ascii);
    // Text in another encoding is hardly ever valid UTF-8.
    let is_utf8 = !is_ascii && inventory.words().all(|bytes| std::str::from_utf8(bytes).is_ok());
    if (version >= "AC1021" && version.starts_with("AC")) || is_utf8 {
        return said(CodePage::Web(encoding_rs::UTF_8));
    }
    match inventory.header.get("$DWGCODEPAGE") {
        _ if is_ascii => said(CodePage::Web(encoding_rs::WINDOWS_1252)),
        None => Ok(guessed(inventory, file)),
        Some(entry) => match CodePage::named(entry.value) {
            Some(page) => said(page),
            None => {
                let found = format!("$DWGCODEPAGE {}", clipped(entry.value));
                let accepted =
                    "ANSI_1250 to ANSI_1258, ISO 8859, KOI8, 437, 850, 852, 866, 874, 932, 936, 949, 950, UTF-8";
                Err(DxfError::new(file, Some(entry.line), found, accepted))
            }
        },
    }
}

/// Page in which the words of the trade have most letters beyond ASCII.
fn guessed(inventory: &Inventory<'_>, file: &str) -> Encoding {
    let letters = |page: CodePage| -> usize {
        let texts = inventory.words().filter(|bytes| !bytes.is_ascii()).map(|bytes| page.decoded(bytes));
        let words: Vec<String> = texts.flat_map(|text| trade::words(&text)).collect();
        let of_trade = words.iter().filter(|word| trade::word_of(word).is_some());
        of_trade.flat_map(|word| word.chars()).filter(|sign| !sign.is_ascii()).count()
    };
    let pages = UNNAMED_PAGES.into_iter().filter_map(|name| Some((name, CodePage::named(name)?)));
    let counted = pages.map(|(name, page)| (letters(page), name, page));
    let best = counted.reduce(|best, found| if found.0 > best.0 { found } else { best });
    let (found, name, page) = best.expect("there are pages");
    let how =
        if found > 0 { "the page in which its names are words of the trade" } else { "for want of a better guess" };
    let remark = format!("{file} has letters beyond ASCII and names no code page: they are read in page {name}, {how}");
    Encoding { page, remark: Some(remark) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dxf::guard::take_inventory;
    use crate::dxf::tags::scan;

    #[test]
    fn names_without_a_code_page_are_words_of_the_trade() {
        let check = |page: &str, names: &[&str]| {
            let page = CodePage::named(page).expect("a page");
            let mut file = b"0\nSECTION\n2\nBLOCKS\n".to_vec();
            for name in names {
                file.extend(b"0\nBLOCK\n2\n");
                file.extend(page.encoded(name));
                file.extend(b"\n0\nENDBLK\n");
            }
            file.extend(b"0\nENDSEC\n0\nEOF\n");
            let tags = scan(&file, "x").expect("tags");
            let Encoding { page: found, remark } =
                code_page(&take_inventory(&tags, "x").expect("blocks"), "x").expect("a page");
            let read: Vec<String> = names.iter().map(|name| found.decoded(&page.encoded(name))).collect();
            assert_eq!(read, names, "{page:?}");
            assert!(remark.is_some());
        };
        check("936", &["\u{524d}\u{7247}", "\u{540e}\u{7247}", "\u{8896}\u{5b50}"]);
        check("932", &["\u{524d}\u{8eab}\u{9803}", "\u{5f8c}\u{8eab}\u{9803}", "\u{8896}"]);
        check("950", &["\u{524d}\u{7247}", "\u{5f8c}\u{7247}", "\u{9818}"]);
        check("949", &["\u{c55e}\u{d310}", "\u{c18c}\u{b9e4}"]);
        check(
            "1251",
            &[
                "\u{41f}\u{435}\u{440}\u{435}\u{434}",
                "\u{421}\u{43f}\u{438}\u{43d}\u{43a}\u{430}",
                "\u{420}\u{443}\u{43a}\u{430}\u{432}",
            ],
        );
        check("866", &["\u{41f}\u{435}\u{440}\u{435}\u{434}", "\u{421}\u{43f}\u{438}\u{43d}\u{43a}\u{430}"]);
        check("1254", &["\u{d6}n beden", "sa\u{11f} kol"]);
        check("1252", &["\u{c4}rmel", "R\u{fc}ckenteil"]);
        check("850", &["\u{c4}rmel", "R\u{fc}ckenteil"]);
        check("1252", &["Caf\u{e9}"]);
    }
}
