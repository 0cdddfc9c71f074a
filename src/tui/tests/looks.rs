//! Snapshots of the screens, at 80 by 24 and at 160 by 50.

use image::{Rgba, RgbaImage};
use insta::assert_snapshot;

use super::{Bench, fixture};
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::widgets::ascii::stand_in;
use crate::widgets::picture::{Images, PictureEncoder};
use crate::widgets::theme::Colours;

/// Compares the screen after some keys with its snapshot, in both sizes.
macro_rules! looks_like {
    ($name:literal, $keys:literal) => {
        for (width, height) in [(80, 24), (160, 50)] {
            let mut bench = Bench::example(width, height);
            assert_snapshot!(format!("{}_{width}x{height}", $name), bench.press($keys).screen());
        }
    };
}

#[test]
fn study() {
    looks_like!("study", "");
}

#[test]
fn subjects() {
    looks_like!("subjects", "2j");
}

#[test]
fn the_form_of_a_subject() {
    looks_like!("subject_form", "2a<F5>eva<Tab><Tab>1650<Tab>70;5<Tab>1500<Tab>700");
}

#[test]
fn styles() {
    looks_like!("styles", "3");
}

#[test]
fn seams() {
    looks_like!("seams", "3<Enter>pyjj");
}

#[test]
fn the_form_of_a_style() {
    looks_like!("style_form", "3i~/patterns/titan.dxf<Tab><Tab><Tab>mile<F5>");
}

#[test]
fn fabrics() {
    looks_like!("fabrics", "9j");
}

#[test]
fn the_form_of_a_fabric() {
    looks_like!("fabric_form", "9ja<F5>poplin<Tab><Tab><C-u>1.2");
}

#[test]
fn jobs() {
    looks_like!("jobs", "4jjjj");
}

#[test]
fn results() {
    looks_like!("results", "5");
}

#[test]
fn maps_say_what_their_colours_mean() {
    let check = |keys: &str, expect: &str, unit: &str| {
        let screen = Bench::example(80, 24).press(keys).screen();
        let legend =
            screen.lines().find(|line| line.contains(expect)).unwrap_or_else(|| panic!("{expect} in {screen}"));
        assert!(legend.contains("███") && legend.contains(unit), "{legend}");
    };
    check("5mm", "stretch −8 ", " 8 %");
    check("5mmm", "tension 0 ", " 100 N/m");
    check("5mmmm", "pressure 0 ", " 2 kPa");
    check("5mmmmm", "gap −100 ", " 100 mm");
}

#[test]
fn help() {
    looks_like!("help", "?job");
    looks_like!("help_of_a_screen", "4?");
}

#[test]
fn jumps() {
    looks_like!("jumps", "3'");
}

#[test]
fn messages_longer_than_the_line_are_wrapped() {
    let mut bench = Bench::example(60, 15);
    bench.send(Message::Failed(format!("{}the end", "a word ".repeat(14))));
    let screen = bench.screen();
    assert!(screen.contains("✗ a word") && bench.status().ends_with("the end"), "{screen}");
    assert!(!bench.press("j").screen().contains("the end"));
}

#[test]
fn explanation() {
    looks_like!("explanation", "5jK");
}

#[test]
fn every_sign_has_a_stand_in_in_ascii() {
    for keys in [
        "",
        "2j",
        "2a",
        "3<Enter>pym",
        "3i",
        "4jjjj",
        "5",
        "c",
        "7",
        "8",
        "9",
        "9j<Tab>",
        "9a",
        "0",
        "0l",
        "0a",
        "0lad",
        "?",
        "1a",
        "5K",
    ] {
        let screen = Bench::example(160, 50).press(keys).screen();
        let odd: String = screen.chars().filter(|sign| !sign.is_ascii() && stand_in(*sign) == '?').collect();
        assert!(odd.is_empty(), "{keys}: {odd}");
    }
}

#[test]
fn first_start() {
    for (width, height) in [(80, 24), (160, 50)] {
        let screen = Bench::new(width, height, fixture::empty()).screen();
        assert_snapshot!(format!("first_start_{width}x{height}"), screen);
    }
}

#[test]
fn small_terminals_show_lists_and_none_is_refused() {
    let check = |width: u16, height: u16, keys: &str, row: &str| {
        let screen = Bench::example(width, height).press(keys).screen();
        assert!(screen.contains(row), "{width}x{height} {keys}: {row} in\n{screen}");
    };
    check(40, 10, "", " 1 Study 2 3 4 5 6 7 8 9 0  men-tops ✗1");
    check(40, 10, "", "S    i         FEM ✓ 0.0117  T~ +43");
    check(40, 10, "", " ↵ open  p pause  ? help  : command");
    check(40, 10, "4", "1 ✓  0.0117 tshirt S i FEM");
    check(40, 10, "4", "2 ✓! 0.0059 tshirt S i HYB");
    check(40, 10, "4", "7 ▶  58%    tshirt M i FEM");
    check(40, 10, "2", "subject▲    s  stature    kg chest waist");
    check(40, 10, "2", "male-ii     m     1690  53.0");
    check(40, 10, "9", "fabric▲                g/m²    mm   warp");
    check(40, 10, "9", "jersey            s     104");
    check(40, 10, "3", "  style          size   rev  pattern");
    check(40, 10, "3", "• tshirt         S      1/1");
    check(40, 10, "3<Enter>", "   edges                 a mm  ease sure");
    check(40, 10, "3<Enter>", "A  front.7=back.4       156.7");
    check(40, 10, "0", "▼ wear M: hip tight by 10 mm");
    check(40, 10, "0<Tab><Tab>", "+ 2 more    ▸M wear");
    check(40, 10, "0mj", "3 critical gapes when…     open");
    check(40, 10, "0a-G", "↑ 15 more lines: k");
    check(60, 15, "3<Tab>", "fronts up, right →");
    // The section stands beside.
    check(120, 30, "0", "869 mm above the floor");
    check(120, 30, "0a-", "869 mm above the floor");
    check(120, 30, "0m", "869 mm above the floor");
    for (width, height) in [(1, 1), (3, 2), (12, 4), (59, 15), (60, 16), (119, 20), (250, 90), (80, 3)] {
        for keys in [
            "1",
            "2",
            "2a<Enter>",
            "2i",
            "2d",
            "9",
            "9<Tab>G",
            "9a",
            "0",
            "0<Tab>vv",
            "0<Tab><Tab>G",
            "0aG",
            "0adj",
            "3",
            "3<Enter>zl<Tab>",
            "3i",
            "4",
            "5",
            "?",
            "<Esc>:x",
            "<Esc>4jx",
            "<Esc>5<Tab><Enter>",
        ] {
            let mut bench = Bench::example(width, height);
            assert!(!bench.press(keys).screen().is_empty(), "{width}x{height} {keys}");
        }
    }
}

#[test]
fn without_colours_glyphs_tell_everything_and_the_shirt_is_seen() {
    let mut bench = Bench::example(80, 24);
    bench.app.state.theme.colours = Colours::None;
    bench.press("5");
    let request =
        bench.effects.iter().find_map(|e| if let Effect::Draw(requests) = e { Some(requests[0]) } else { None });
    let request = request.expect("the picture was asked for");
    let encoder = PictureEncoder::new(Images::Auto, Colours::None, &|_| None).expect("pictures are on");
    let (width, height) = encoder.pixels(&request);
    let picture = RgbaImage::from_fn(width, height, |x, y| {
        let (x, y) = (f64::from(x) / f64::from(width), f64::from(y) / f64::from(height));
        let is_trunk = (0.3..0.7).contains(&x) && (0.2..0.8).contains(&y);
        let is_sleeves = (0.05..0.95).contains(&x) && (0.2..0.4).contains(&y);
        if is_trunk || is_sleeves { Rgba([60, 150, 110, 255]) } else { Rgba([250, 250, 250, 0]) }
    });
    bench.send(Message::Picture(request, encoder.draw(&picture, &request)));
    assert_snapshot!("results_letters_80x24", bench.screen());
}
