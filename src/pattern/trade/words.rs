//! Garment terms in the languages of pattern files: English, German, French, Spanish, Italian, Dutch, Portuguese,
//! Polish, Russian, Ukrainian, Turkish, Chinese, Japanese, Korean, Vietnamese, Swedish, Danish, Romanian, Czech, Greek,
//! Hindi.
//!
//! A word that ends in `-` is a stem: inflecting languages append an ending of up to three letters.

use super::{Class, Face, Hand, PartName};

/// First kind that is found counts, so small parts precede the pieces that they are sewn to: `front pocket bag` is a
/// pocket, `sleeve cuff` a cuff.
#[rustfmt::skip]
pub const CLASSES: [(Class, &[&str]); 7] = [
    (Class::Other, &[
        "pocket", "pocketing", "facing", "interface", "interfacing", "lining", "interlining", "placket", "fly", "collar", "hood",
        "neckband", "binding", "gusset", "loop", "flap", "welt", "stay", "tab", "zip", "zipper",
        "tasche", "taschen", "beleg", "belege", "futter", "kragen", "kapuze", "kapuzen", "einlage", "einlagen", "patte", "patten",
        "paspel", "paspeln", "reißverschluss", "reissverschluss",
        "poche", "parementure", "passepoil", "entoilage", "capuche", "fermeture",
        "bolsillo", "vista", "entretela", "cuello", "cremallera", "tasca", "collo", "cerniera", "bolso", "colarinho", "gola",
        "kieszeń", "kieszen-", "kieszon-", "karman-", "patka", "карман-", "кишен-", "подборт-", "підборт-", "воротник-", "комір-", "комир-",
        "капюшон-", "клапан-", "молни-", "блискавк-",
        "yaka", "yakası", "cep", "cebi", "astar", "astarı", "tela", "kapşon",
        "kraag", "belegsel", "ritssluiting", "krage", "ficka", "fickor", "foder", "mellanlägg", "krave", "lomme", "indlæg",
        "guler", "buzunar", "buzunare", "căptușeală", "captuseala", "límec", "limec", "kapsa", "kapes", "kapsy", "podšívka", "podsivka",
        "výztuh-", "luva", "γιακ-", "τσέπ-", "τσεπ-", "φόδρ-", "φοδρ-", "कॉलर", "जेब", "अस्तर", "túi", "lót", "mũ",
        "领", "領", "袋", "里布", "里料", "衬", "襯", "衿", "襟", "门襟", "門襟", "帽", "カラー", "ポケット", "フード", "裏", "芯",
        "칼라", "깃", "주머니", "포켓", "안감", "심지", "후드",
    ]),
    (Class::Yoke, &[
        "yoke", "passe", "passen", "sattel", "empiècement", "empiecement", "canesú", "canesu", "sprone", "schouderstuk", "pala", "karczek",
        "karczk-", "кокетк-", "roba", "育克", "过肩", "過肩", "ヨーク", "요크", "bærestykke", "platcă", "platca", "sedlo", "νωμίτ-",
    ]),
    (Class::Waistband, &[
        "waistband", "bund", "ceinture", "cinturilla", "pretina", "cintura", "tailleband", "pasek", "пояс-", "wb",
        "kemer", "kemeri", "腰头", "腰頭", "腰", "ベルト", "허리", "cạp", "linning", "betelie", "pásek", "ζών-", "ζων-", "कमर",
    ]),
    (Class::Cuff, &[
        "cuff", "manschette", "manschetten", "poignet", "puño", "polsino", "polsini", "manchet", "manchetten", "punho", "mankiet-", "манжет-",
        "manşet", "manset", "manşeti", "manschett", "袖口", "克夫", "カフス", "커프스", "소매단", "manșet-", "manžet-", "manzet-", "μανσέτ-",
        "μανσετ-",
    ]),
    (Class::Sleeve, &[
        "sleeve", "ärmel", "aermel", "manche", "manga", "manica", "maniche", "mouw", "mouwen", "rękaw-", "rekaw-", "рукав-", "kol", "kolu",
        "袖", "そで", "スリーブ", "소매", "tay", "ärm", "ærme", "mânec-", "manec-", "rukáv-", "rukav-", "μανίκ-", "μανικ-", "आस्तीन", "बाजू",
    ]),
    (Class::Leg, &[
        "trouser", "pant", "hose", "hosen", "pantalon", "pantalón", "pantalones", "pantaloni", "broek", "spodni-", "брюк-", "брюч-", "штан-", "leg",
        "legging", "jean", "short", "pantolon", "裤", "褲", "パンツ", "ズボン", "바지", "quần", "byxa", "byxben", "byxor", "buks", "bukser",
        "kalhot-", "παντελ-", "पतलून", "पैंट",
    ]),
    (Class::Skirt, &[
        "skirt", "rock", "jupe", "falda", "gonna", "saia", "spódnic-", "spodnic-", "юбк-", "юбоч-", "спідниц-", "etek", "eteği", "裙",
        "スカート", "치마", "스커트", "váy", "kjol", "nederdel", "skørt", "fustă", "fusta", "sukně", "sukne", "φούστ-", "φουστ-",
        "स्कर्ट",
    ]),
];

#[rustfmt::skip]
pub const FACES: [(Face, &[&str]); 2] = [
    (Face::Front, &[
        "front", "vorder", "vordere", "vorderer", "vorderes", "vorderen", "vorne", "devant", "avant", "delantero", "delantera", "delanter",
        "davanti", "voorpand", "voor", "frente", "przód", "przod", "przodu", "перед", "переда", "передн-", "пілочк-", "полочк-", "пилочк-",
        "ftorso", "ön", "前", "まえ", "フロント", "앞", "trước", "fram", "framstycke", "forstykke", "față", "fata", "předn-", "predn-",
        "μπροστ-", "μπροστινό", "आगे", "सामने",
    ]),
    (Face::Back, &[
        "back", "rücken", "ruecken", "hinter", "hintere", "hinterer", "hinteres", "hinteren", "hinten", "dos", "derrière", "derriere", "espalda",
        "trasero", "trasera", "dietro", "achterpand", "achter", "rug", "costas", "tył", "tyl", "tyłu", "зад", "зада", "задн-", "спинк-",
        "btorso", "arka", "后", "後", "うしろ", "バック", "뒤", "뒷", "sau", "bakstycke", "bagstykke", "spate", "zadn-", "πίσω", "πισω", "πλάτη",
        "πλάτης", "πλατη", "पीछे", "पिछ-",
    ]),
];

#[rustfmt::skip]
pub const HANDS: [(Hand, &[&str]); 2] = [
    (Hand::Right, &[
        "right", "rechts", "droite", "droit", "derecha", "derecho", "destra", "destro", "prawy", "prawa", "prawe", "правый", "правая", "правое",
        "права", "r", "sağ", "右", "오른", "오른쪽", "phải", "höger", "højre", "dreapta", "pravá", "prava", "pravý", "δεξι-", "δεξί", "दाय-",
    ]),
    (Hand::Left, &[
        "left", "links", "gauche", "izquierda", "izquierdo", "sinistra", "sinistro", "lewy", "lewa", "lewe", "левый", "левая", "левое", "ліва",
        "l", "sol", "左", "왼", "왼쪽", "trái", "vänster", "venstre", "stânga", "stanga", "levá", "leva", "levý", "αριστερ-", "बाय-",
    ]),
];

#[rustfmt::skip]
pub const PARTS: [(PartName, &[&str]); 5] = [
    (PartName::Under, &["under", "lower", "unter", "dessous", "inferior", "onder", "spodni", "нижн-"]),
    (PartName::Gore, &["gore", "bahn", "bahnen", "nesga", "клин-"]),
    (PartName::Neck, &[
        "collar", "neckband", "hood", "kragen", "kapuze", "kapuzen", "capuche", "cuello", "collo", "colarinho", "gola", "воротник-", "комір-",
        "комир-", "капюшон-", "yaka", "yakası", "kapşon", "kraag", "krage", "krave", "guler", "límec", "limec", "γιακ-", "कॉलर", "领", "領", "帽",
        "カラー", "フード", "칼라", "깃", "후드",
    ]),
    (PartName::Side, &[
        "side", "seite", "seiten", "côté", "cote", "lado", "costado", "lateral", "laterale", "fianco", "fianchetto", "zij", "sida", "boczek", "boczk-",
        "боков-", "бочок", "бочк-", "бічн-", "yan", "侧", "側", "脇", "サイド", "옆", "bočn-", "bocn-", "πλαϊν-",
    ]),
    (PartName::Panel, &["panel", "paneel"]),
];

/// Words that form compounds with the others and say nothing about seams.
#[rustfmt::skip]
pub const PLAIN: &[&str] = &[
    "centre", "center", "middle", "upper", "top", "inner", "outer", "inside", "outside", "inset", "insert", "part", "piece",
    "body", "bodice", "torso", "trunk", "bag", "guard", "dart", "princess", "raglan", "band", "belt", "hem", "neck", "arm", "armhole", "waist",
    "hip", "bust", "chest", "shoulder", "knee", "seat", "crotch", "main", "self", "shell", "full", "half", "long", "stand", "bottom",
    "extension", "shield", "tape", "strap", "rib", "trim", "block", "button", "buttonhole", "underlap", "overlap", "curved", "straight", "round", "square", "pointed",
    "edge", "pad", "piping", "elastic", "vent", "pleat", "ruffle", "frill", "godet",
    "blatt", "rumpf", "taille", "hals", "ausschnitt", "schulter", "brust", "hüft", "knie", "knopf", "falte", "falten", "keil", "riegel", "gürtel",
    "teil", "teile", "stück", "stueck", "mitte", "ober", "innen", "aussen", "außen", "beutel", "leiste", "leisten", "steg",
    "blende", "schlitz", "naht", "saum", "abnäher", "besatz", "bein", "lang", "kurz", "halb", "streifen", "verlängerung",
    "pand", "deel", "stuk", "midden", "boven", "stycke", "stykke", "del", 
    "片", "身", "頃", "幅", "中", "大", "小", "上", "下", "内", "內", "外", "面", "底", "子", "布", "头", "頭", "口", "缝", "線", "位", "贴",
    "貼", "条", "條", "带", "帶", "长", "長", "短", "半", "拼", "接", "里", "土", "男", "女", "装", "裝", "衣", "衫", "服", "ろ", "見", "返", "し",
    "身頃", "판", "몸판", "길", "쪽",
];
