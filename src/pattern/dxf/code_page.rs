//! Code pages of texts, by all the names that programs use for them.

use encoding_rs::Encoding;
use oem_cp::code_table::{DECODING_TABLE_CP_MAP, ENCODING_TABLE_CP_MAP};
use oem_cp::encode_string_lossy;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CodePage {
    /// WHATWG encoding, which includes those of Windows and ISO 8859.
    Web(&'static Encoding),
    /// OEM (DOS) code page, by its number.
    Dos(u16),
}

const PREFIXES: [&str; 8] = ["ANSI", "WINDOWS", "WIN", "CP", "DOS", "OEM", "IBM", "MS"];

impl CodePage {
    /// Takes `ANSI_1252`, `iso8859-1`, `8859_1`, `dos850`, `gb2312`, `utf8`, ...
    pub fn named(name: &str) -> Option<Self> {
        let web = |label: &str| Encoding::for_label(label.as_bytes()).map(Self::Web);
        let plain: String = name.to_ascii_uppercase().chars().filter(char::is_ascii_alphanumeric).collect();
        let latin = plain.strip_prefix("ISO").unwrap_or(&plain).strip_prefix("8859");
        if let Some(part) = latin {
            return web(&format!("iso-8859-{part}"));
        }
        match plain.as_str() {
            "ASCII" | "USASCII" => return web("windows-1252"),
            "UTF8" | "65001" => return web("utf-8"),
            "MACINTOSH" | "MACROMAN" | "MAC" => return web("macintosh"),
            _ => {}
        }
        let number = PREFIXES.iter().find_map(|prefix| plain.strip_prefix(prefix)).unwrap_or(&plain);
        match number.parse::<u16>() {
            Ok(932) => web("shift_jis"),
            Ok(936) => web("gbk"),
            Ok(949 | 1361) => web("euc-kr"),
            Ok(950) => web("big5"),
            Ok(866) => web("ibm866"),
            Ok(874) => web("windows-874"),
            Ok(20866) => web("koi8-r"),
            Ok(number @ 1250..=1258) => web(&format!("windows-{number}")),
            Ok(number) => DECODING_TABLE_CP_MAP.contains_key(&number).then_some(Self::Dos(number)),
            Err(_) => web(name.trim()).or_else(|| web(&plain)),
        }
    }

    pub fn decoded(self, bytes: &[u8]) -> String {
        match self {
            Self::Web(encoding) => encoding.decode_without_bom_handling(bytes).0.into_owned(),
            Self::Dos(number) => match DECODING_TABLE_CP_MAP.get(&number) {
                Some(table) => table.decode_string_lossy(bytes),
                None => String::from_utf8_lossy(bytes).into_owned(),
            },
        }
    }

    pub fn encoded(self, text: &str) -> Vec<u8> {
        match self {
            Self::Web(encoding) => encoding.encode(text).0.into_owned(),
            Self::Dos(number) => match ENCODING_TABLE_CP_MAP.get(&number) {
                Some(table) => encode_string_lossy(text, table),
                None => text.as_bytes().to_vec(),
            },
        }
    }

    pub fn is_utf8(self) -> bool {
        self == Self::Web(encoding_rs::UTF_8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_page_goes_by_many_names() {
        let check = |name: &str, bytes: &[u8], text: &str| {
            let page = CodePage::named(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!(page.decoded(bytes), text, "{name}");
            assert_eq!(page.encoded(text), bytes, "{name}");
        };
        for name in ["ANSI_1252", "windows-1252", "CP1252", "8859_1", "iso8859-1", "ISO_8859-1", "ASCII"] {
            check(name, b"\xC4rmel", "\u{c4}rmel");
        }
        for name in ["dos850", "850", "CP850", "OEM850", "ibm850"] {
            check(name, b"\x8Ermel", "\u{c4}rmel");
        }
        for name in ["gb2312", "GBK", "ANSI_936"] {
            check(name, b"\xC7\xB0", "\u{524d}");
        }
        check("KOI8-R", b"\xD0", "\u{43f}");
        check("iso8859-5", b"\xBF", "\u{41f}");
        check("dos932", b"\x91O", "\u{524d}");
        check("utf8", "\u{c4}".as_bytes(), "\u{c4}");
        for name in ["", "ANSI_1", "none", "dos99999"] {
            assert_eq!(CodePage::named(name), None, "{name}");
        }
    }
}
