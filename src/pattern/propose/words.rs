//! Words of the trade in the languages of its files: English, German, French, Spanish, Italian, Dutch, Portuguese, Polish, Russian, Ukrainian,
//! Turkish, Chinese, Japanese, Korean, Vietnamese, Swedish, Danish, Romanian, Czech, Greek, Hindi.

use super::{Class, Face, Hand};

/// Parts of words that name a kind of piece; the first that is found counts, so small parts stand before what they are
/// sewn to (`front pocket bag` is a pocket, `sleeve cuff` a cuff).
#[rustfmt::skip]
pub const CLASSES: [(Class, &[&str]); 7] = [
    (Class::Other, &[
        "pocket", "tasche", "poche", "bolsillo", "tasca", "bolso", "kiesze", "карман", "кишен", "facing", "beleg",
        "parementure", "vista", "belegsel", "подборт", "підборт", "interface", "interfacing", "lining", "futter",
        "placket", "fly", "collar", "kragen", "collo", "cuello", "kraag", "colarinho", "gola", "воротник", "комір",
        "комир", "hood", "kapuze", "capuche", "капюшон", "neckband", "binding", "gusset", "loop", "interlin",
        "einlage", "entoilage", "entretela", "flap", "patka", "клапан", "welt", "paspel", "passepoil", "stay", "tab",
        "zip", "zipper", "reißverschluss", "reissverschluss", "fermeture", "cremallera", "cerniera", "ritssluiting",
        "молни", "блискавк", "yaka", "cep", "astar", "tela", "领", "領", "袋", "里布", "衬", "襯", "衿", "襟", "カラー", "ポケット",
        "裏", "芯", "칼라", "깃", "주머니", "포켓", "안감", "심지", "túi", "lót", "krage", "ficka", "foder", "mellanlägg", "krave",
        "lomme", "indlæg", "guler", "buzunar", "căptușeală", "captuseala", "límec", "limec", "kapsa", "kapes",
        "podšívka", "podsivka", "výztuh", "γιακ", "τσέπ", "τσεπ", "φόδρ", "φοδρ", "कॉलर", "जेब", "अस्तर", "门襟", "門襟",
        "帽", "kapşon", "フード", "후드", "mũ", "luva",
    ]),
    (Class::Yoke, &[
        "yoke", "passe", "sattel", "empiec", "canesú", "canesu", "sprone", "schouderstuk", "pala", "karczek",
        "кокетк", "roba", "育克", "过肩", "過肩", "ヨーク", "요크", "bærestyk", "platcă", "platca", "sedlo", "νωμίτ",
    ]),
    (Class::Waistband, &[
        "waistband", "bund", "ceinture", "cinturilla", "pretina", "cintura", "tailleband", "pasek", "пояс", "wb",
        "kemer", "腰头", "腰頭", "腰", "ベルト", "허리", "cạp", "linning", "betelie", "pásek", "ζών", "ζων", "कमर",
    ]),
    (Class::Cuff, &[
        "cuff", "manschette", "poignet", "puño", "polsino", "manchet", "punho", "mankiet", "манжет", "manşet",
        "manset", "袖口", "克夫", "カフス", "커프스", "소매단", "manșet", "manžet", "manzet", "μανσέτ", "μανσετ",
    ]),
    (Class::Sleeve, &[
        "sleeve", "ärmel", "aermel", "manche", "manga", "manica", "mouw", "rękaw", "rekaw", "рукав", "kol", "袖", "そで",
        "スリーブ", "소매", "tay", "ärm", "ærme", "mânec", "manec", "rukáv", "rukav", "μανίκ", "μανικ", "आस्तीन", "बाजू",
    ]),
    (Class::Leg, &[
        "trouser", "pant", "hose", "pantalon", "pantalón", "pantaloni", "broek", "spodni", "брюк", "штан", "leg", "legging",
        "jean", "short", "pantolon", "裤", "褲", "パンツ", "ズボン", "바지", "quần", "byxa", "byxben", "buks", "kalhot",
        "παντελ", "पतलून", "पैंट",
    ]),
    (Class::Skirt, &[
        "skirt", "rock", "jupe", "falda", "gonna", "saia", "spódnic", "spodnic", "юбк", "спідниц", "etek", "裙",
        "スカート", "치마", "스커트", "váy", "kjol", "nederdel", "skørt", "fustă", "fusta", "sukně", "sukne", "φούστ", "φουστ",
        "स्कर्ट",
    ]),
];

/// Parts of words that say front or back.
#[rustfmt::skip]
pub const FACES: [(Face, &[&str]); 2] = [
    (Face::Front, &[
        "front", "vorder", "vorne", "devant", "avant", "delantero", "delanter", "davanti", "voorpand", "voor",
        "frente", "przód", "przod", "перед", "пілочк", "полочк", "пилочк", "ftorso", "ön", "前", "まえ", "フロント", "앞",
        "trước", "fram", "framsty", "forstyk", "față", "fata", "předn", "predn", "μπροστ", "आगे", "सामने",
    ]),
    (Face::Back, &[
        "back", "rücken", "ruecken", "hinter", "dos", "derrière", "espalda", "trasero", "dietro", "achterpand",
        "achter", "rug", "costas", "tył", "tyl", "зад", "спинк", "btorso", "arka", "后", "後", "うしろ", "バック", "뒤", "뒷",
        "sau", "bakstyc", "bagstyk", "spate", "zadní", "zadni", "πίσω", "πισω", "πλάτη", "πλατη", "पीछे", "पिछ",
    ]),
];

/// Words that say left or right.
#[rustfmt::skip]
pub const HANDS: [(Hand, &[&str]); 2] = [
    (Hand::Right, &[
        "right", "rechts", "droite", "derecha", "destra", "prawy", "правый", "права", "r", "sağ", "右", "오른", "phải",
        "höger", "højre", "dreapta", "pravá", "prava", "pravý", "δεξι", "दाय",
    ]),
    (Hand::Left, &[
        "left", "links", "gauche", "izquierda", "sinistra", "lewy", "левый", "ліва", "l", "sol", "左", "왼", "trái",
        "vänster", "venstre", "stânga", "stanga", "levá", "leva", "levý", "αριστερ", "बाय",
    ]),
];
