//! Seams stay those of the outlines under any names of the pieces, or a question is asked.

use std::collections::{BTreeMap, BTreeSet};

use super::told::told;
use super::*;
use crate::draft::Model;

/// Words of eight languages: everyday words, words that contain garment terms, and garment terms of another language.
#[rustfmt::skip]
const WORDS: [&str; 216] = [
    // Words that contain garment terms.
    "PALAZZO", "FROCK", "JEANNE", "ROCKY", "SHORTBREAD", "BUNDLE", "SLEEVELESS", "BACKPACK", "FRONTIER", "LEGEND", "SKIRMISH", "HEMLOCK",
    "COLLARBONE", "BANDANA", "MANCHESTER", "DOSSIER", "PANTHER", "PANTRY", "HOSEPIPE", "POCKETBOOK", "HOODLUM", "CUFFLINK", "RIGHTEOUS",
    "LEFTOVER", "STABLE", "TABLET", "LOOPHOLE", "ZIPPY", "FLAPJACK", "STAYCATION", "ROCKET", "SHORTCUT", "BACKGAMMON", "CONFRONT",
    "FEEDBACK", "LEGUME", "JEANETTE", "TROUSSEAU", "YOKEL", "MANGANESE", "VORDERASIEN", "HINTERLAND", "BUNDESTAG", "ROCKKONZERT",
    "HOSENBODEN", "KRAGENBÄR", "ÄRMELKANAL", "MANCHEGO", "DEVANTURE", "JUPITER", "DOSAGE", "VISTAMAR", "FALDERA", "COLLOQUIO", "TASCABILE",
    "MANICARETTO", "KOLEJ", "PASEKA", "ETEKLERİ", "YAKAMOZ", "SOLARIUM", "REKAWEK", "GOLANIA", "前进", "领导", "以后", "袖手旁观", "裤衩子弟",
    // Garment terms of one language that are everyday words of another.
    "ROCK", "BUND", "HOSE", "PASSE", "PALA", "ROBA", "VISTA", "TELA", "DOS", "SOL", "KOL", "RUG", "SAU", "FRAM", "SHORT", "JEAN", "FLY", "TAB",
    "STAY", "LOOP", "HOOD", "CEP", "GOLA", "MANCHE", "MANGA", "AVANT", "LEFT", "BACK", "FRONT", "SLEEVE", "SKIRT", "YOKE", "POCKET", "帽子",
    "裙子", "左右",
    // English.
    "HOUSE", "RIVER", "SUMMER", "WINDOW", "GARDEN", "BREAD", "STONE", "OCEAN", "MOUNTAIN", "WINTER", "APPLE", "CANDLE", "MARKET", "SILVER",
    // German.
    "HAUS", "WOLKE", "SOMMER", "FENSTER", "GARTEN", "BROT", "STEIN", "MEER", "WINTER", "APFEL", "KERZE", "MARKT", "SILBER", "STRASSE",
    // French.
    "MAISON", "RIVIÈRE", "ÉTÉ", "FENÊTRE", "JARDIN", "PAIN", "PIERRE", "MER", "MONTAGNE", "HIVER", "POMME", "BOUGIE", "MARCHÉ", "ARGENT",
    // Italian.
    "CASA", "FIUME", "ESTATE", "FINESTRA", "GIARDINO", "PANE", "PIETRA", "MARE", "MONTAGNA", "INVERNO", "MELA", "CANDELA", "MERCATO", "STELLA",
    // Spanish.
    "CAMINO", "RÍO", "VERANO", "VENTANA", "JARDÍN", "PIEDRA", "MANZANA", "INVIERNO", "VELA", "PLATA", "LUNA", "CIELO", "FLOR", "NIEVE",
    // Turkish.
    "EV", "NEHİR", "YAZ", "PENCERE", "BAHÇE", "EKMEK", "TAŞ", "DENİZ", "DAĞ", "KIŞ", "ELMA", "MUM", "PAZAR", "GÜMÜŞ",
    // Polish.
    "DOM", "RZEKA", "LATO", "OKNO", "OGRÓD", "CHLEB", "KAMIEŃ", "MORZE", "GÓRA", "ZIMA", "JABŁKO", "ŚWIECA", "RYNEK", "SREBRO",
    // Chinese.
    "房屋", "河流", "夏天", "窗户", "花园", "面包", "石头", "海洋", "山", "冬天", "苹果", "蜡烛", "市场", "银",
];

/// An edge as drawn: its piece, true for the mirror image, and its corners in hundredths of the piece.
type Drawn = (usize, bool, [[i64; 2]; 2]);
/// Seams by their drawn edges, independent of all names.
type Sewn = BTreeSet<BTreeSet<Drawn>>;

fn sewn_edges(proposal: &Proposal) -> Sewn {
    let drawn = |edge: &String| {
        let (id, edge) = edge.split_once('.').expect("PIECE.EDGE");
        let worn = proposal.worn.iter().find(|worn| worn.id == id).expect("a piece");
        let place = |corner: usize| worn.entry.corners_at[corner].map(|share| (share * 100.0).round() as i64);
        (worn.piece, worn.entry.mirror, worn.entry.edges[edge].map(place))
    };
    proposal.seams.iter().map(|seam| seam.entry.a.iter().chain(&seam.entry.b).map(drawn).collect()).collect()
}

fn renamed(pieces: &[Piece], name: impl Fn(usize, &str) -> String) -> Vec<Piece> {
    let call = |(k, piece): (usize, &Piece)| {
        let name = name(k, &piece.name);
        Piece { block: name.clone(), name, ..piece.clone() }
    };
    pieces.iter().enumerate().map(call).collect()
}

/// Proposals by the texts of the pieces, independent of their names.
struct Proposer {
    known: BTreeMap<String, Proposal>,
}

impl Proposer {
    fn of(&mut self, pieces: &[Piece]) -> &Proposal {
        self.known.entry(format!("{:?}", told(pieces))).or_insert_with(|| propose(pieces))
    }
}

/// Renames the pieces in all ways, and compares each proposal with that for their own names.
fn check(model: Model) {
    let drafts = model.drafts();
    let pieces = &drafts[drafts.len() / 2].pieces;
    let own = propose(pieces);
    let (edges, asked) = (sewn_edges(&own), own.questions.len());
    let mut proposer = Proposer { known: BTreeMap::new() };
    let mut faults = Vec::new();
    for (w, word) in WORDS.iter().enumerate() {
        let styled = renamed(pieces, |_, name| format!("{word} {name}"));
        let found = proposer.of(&styled);
        let ids = |proposal: &Proposal| proposal.seams.iter().map(|seam| seam.entry.clone()).collect::<Vec<_>>();
        if ids(found) != ids(&own) || found.questions.len() > asked {
            faults.push(format!("{word} FRONT: {:?}", found.questions));
        }
        let numbered = renamed(pieces, |k, _| format!("{word} {}", k + 1));
        let alone = renamed(pieces, |k, _| WORDS[(w + 31 * k) % WORDS.len()].to_owned());
        for called in [numbered, alone] {
            let found = proposer.of(&called);
            if sewn_edges(found) != edges && found.questions.len() <= asked {
                let names: Vec<&str> = called.iter().map(|piece| piece.name.as_str()).collect();
                let seams: Vec<&str> = found.seams.iter().map(|seam| seam.entry.name.as_str()).collect();
                faults.push(format!("{names:?}: {seams:?}, {:?}", found.notes));
            }
        }
    }
    assert!(faults.is_empty(), "{model:?}: {} of {}:\n{}", faults.len(), 3 * WORDS.len(), faults.join("\n"));
}

#[test]
fn a_tshirt_is_sewn_as_it_is_or_asked_about_whatever_it_is_called() {
    check(Model::Tshirt);
}

#[test]
fn trousers_are_sewn_as_they_are_or_asked_about_whatever_they_are_called() {
    check(Model::Trousers);
}

#[test]
fn a_tee_top_is_sewn_as_it_is_or_asked_about_whatever_it_is_called() {
    check(Model::Teetop);
}

#[test]
fn a_dress_is_sewn_as_it_is_or_asked_about_whatever_it_is_called() {
    check(Model::Dress);
}

#[test]
fn a_name_that_the_outline_contradicts_is_asked_about_and_one_that_it_bears_out_makes_surer() {
    let drafts = Model::Tshirt.drafts();
    let pieces = &drafts[0].pieces;
    let call = |names: [&str; 3]| renamed(pieces, |k, _| names[k].to_owned());
    let sure = |names: [&str; 3]| propose(&call(names)).pieces.iter().map(|piece| piece.confidence).sum::<f64>();
    assert!(sure(["FRONT", "BACK", "SLEEVE"]) > sure(["1", "2", "3"]));
    let check = |names: [&str; 3], asked: &str, choices: [&str; 2]| {
        let called = call(names);
        let found = propose(&called);
        let question = found.questions.iter().find(|question| question.text.contains(asked));
        let question = question.unwrap_or_else(|| panic!("{names:?}: {:?}", found.questions));
        let [says, looks] = choices;
        assert_eq!(question.choices, [says, looks, "none of these: left out"]);
        assert_eq!(question.taken, Some(1));
        assert_eq!(sewn_edges(&found), sewn_edges(&propose(pieces)), "{names:?}");
        let answered = propose_answered(&called, &[(question.number, 'a')]).expect("a choice");
        assert_ne!(sewn_edges(&answered), sewn_edges(&found), "{names:?}");
    };
    check(["FRONT", "BACK", "JEAN"], "`JEAN`: its name says a leg", ["a leg", "a sleeve"]);
    check(["FRONT", "BACK", "POCKET"], "`POCKET`: its name says a part", ["a part", "a sleeve"]);
    check(["SLEEVE", "BACK", "ARM"], "`SLEEVE`: its name says a sleeve", ["a sleeve", "a trunk"]);
}
