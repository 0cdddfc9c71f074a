//! Outfits of new studies: which styles are worn over each other, in which sizes.

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

use spec::file::LAYERS;

/// Written `NAME=STYLE,STYLE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NewOutfit {
    pub name: String,
    /// Styles, the inner first.
    pub layers: Vec<String>,
}

impl FromStr for NewOutfit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let told = || format!("found `{text}`; accepted: NAME=STYLE,STYLE, the inner style first");
        let (name, layers) = text.split_once('=').ok_or_else(told)?;
        let layers: Vec<String> = layers.split(',').map(|layer| layer.trim().to_owned()).collect();
        if name.trim().is_empty() || layers.iter().any(String::is_empty) {
            return Err(told());
        }
        Ok(Self { name: name.trim().to_owned(), layers })
    }
}

impl fmt::Display for NewOutfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.layers.join(","))
    }
}

impl NewOutfit {
    /// Sizes that are worn together, each with one size of every layer: all that the sizes of the layers share, else the
    /// only one of each. `chosen` has styles with their sizes.
    pub fn sizes<'a>(&self, chosen: &[(&'a str, &'a str)]) -> Result<Vec<Vec<&'a str>>, String> {
        let distinct: BTreeSet<&String> = self.layers.iter().collect();
        if distinct.len() < self.layers.len() || !LAYERS.contains(&self.layers.len()) {
            let (least, most) = (LAYERS.start(), LAYERS.end());
            return Err(format!("outfit {self}: accepted: {least} to {most} different styles"));
        }
        let of = |style: &String| -> Vec<&'a str> {
            chosen.iter().filter(|(of, _)| of == style).map(|(_, size)| *size).collect()
        };
        let all: Vec<Vec<&str>> = self.layers.iter().map(of).collect();
        if let Some((style, _)) = self.layers.iter().zip(&all).find(|(_, sizes)| sizes.is_empty()) {
            return Err(format!("outfit {self}: no size of {style} is chosen"));
        }
        let is_shared = |size: &&&str| all.iter().all(|sizes| sizes.contains(size));
        let shared: Vec<Vec<&str>> = all[0].iter().filter(is_shared).map(|size| vec![*size; all.len()]).collect();
        match all.iter().map(|sizes| sizes.first().filter(|_| sizes.len() == 1).copied()).collect() {
            _ if !shared.is_empty() => Ok(shared),
            Some(only) => Ok(vec![only]),
            None => Err(format!("outfit {self}: its styles share no chosen size; accepted: one size of each")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outfits_are_read_and_their_sizes_found() {
        let chosen = [("tee", "S"), ("tee", "M"), ("skirt", "M"), ("skirt", "L"), ("coat", "48"), ("hat", "one")];
        let check = |text: &str, expect: &str| {
            let told = text.parse::<NewOutfit>().and_then(|outfit| {
                assert_eq!(outfit.to_string(), text.replace(' ', ""));
                Ok(outfit.sizes(&chosen)?.iter().map(|sizes| sizes.join("+")).collect::<Vec<_>>().join(" "))
            });
            let told = told.unwrap_or_else(|problem| problem);
            assert!(told.ends_with(expect), "{text}: {told}");
        };
        check("look=tee,skirt", "M+M");
        check("look=coat, hat", "48+one");
        check("look=tee,coat", "share no chosen size; accepted: one size of each");
        check("look=tee,socks", "no size of socks is chosen");
        check("look=tee", "accepted: 2 to 5 different styles");
        check("look=tee,tee", "accepted: 2 to 5 different styles");
        check("tee,skirt", "accepted: NAME=STYLE,STYLE, the inner style first");
        check("=tee,skirt", "accepted: NAME=STYLE,STYLE, the inner style first");
        check("look=tee,", "accepted: NAME=STYLE,STYLE, the inner style first");
    }
}
