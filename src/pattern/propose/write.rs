//! Text of a proposal as a seam file that a person can read and edit.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::worn_pieces::Worn;
use super::{Proposal, ProposedSeam};
use crate::seams::{DEFAULT_LENGTH_TOLERANCE_MM, Ease, SeamFile};
use geom::units::mm;

/// Length ratio of both sides from which a comment calls a seam eased or gathered.
const EASED_RATIO: f64 = 1.01;

impl Proposal {
    pub fn seam_file(&self, name: &str) -> SeamFile {
        SeamFile {
            name: name.to_owned(),
            size: self.size.clone(),
            length_tolerance_mm: DEFAULT_LENGTH_TOLERANCE_MM,
            allowance_mm: mm(self.allowance_m),
            shrinkage_warp_pct: 0.0,
            shrinkage_weft_pct: 0.0,
            open: self.open.clone(),
            piece: self.worn.iter().map(|worn| (worn.id.clone(), worn.entry.clone())).collect(),
            seam: self.seams.iter().map(|seam| seam.entry.clone()).collect(),
            measurement: Vec::new(),
            reinforce: Vec::new(),
            fit: BTreeMap::new(),
        }
    }

    /// Gives confidences and questions to the user as comments.
    pub fn toml(&self, name: &str) -> String {
        let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
        let list = |names: &[String]| names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        let mut text = String::from("# Proposed from names, outlines and lengths: read it before you sew from it.\n");
        for question in &self.questions {
            let mark = if question.is_answered { "ANSWERED" } else { "ASK" };
            let _ = writeln!(text, "# {mark}: {}", question.to_string().replace(['\n', '\r'], " "));
        }
        let _ = writeln!(text, "name = {}", quoted(name));
        if let Some(size) = &self.size {
            let _ = writeln!(text, "size = {}", quoted(size));
        }
        let _ = writeln!(text, "length_tolerance_mm = {DEFAULT_LENGTH_TOLERANCE_MM:.1}");
        if self.allowance_m != 0.0 {
            let _ = writeln!(text, "allowance_mm = {:?}", mm(self.allowance_m));
        }
        if !self.open.is_empty() {
            let _ = writeln!(text, "open = [{}]", list(&self.open));
        }
        for Worn { id, entry, confidence, .. } in &self.worn {
            let _ = writeln!(text, "\n[piece.{id}]  # confidence {confidence:.2}\nblock = {}", quoted(&entry.block));
            let _ = writeln!(text, "role = {}", quoted(entry.role.as_str()));
            if entry.mirror {
                text.push_str("mirror = true\n");
            }
            let corners: Vec<String> = entry.corners_at.iter().map(|[x, y]| format!("[{x}, {y}]")).collect();
            let _ = writeln!(text, "corners_at = [{}]", corners.join(", "));
            let _ = writeln!(text, "[piece.{id}.edges]");
            let mut edges: Vec<_> = entry.edges.iter().collect();
            edges.sort_by_key(|(_, corners)| corners[0]);
            for (name, [from, to]) in edges {
                let _ = writeln!(text, "{name} = [{from}, {to}]");
            }
        }
        for seam in &self.seams {
            let entry = &seam.entry;
            let _ = writeln!(text, "\n[[seam]]  # {}", remark(seam));
            let _ =
                writeln!(text, "name = {}\na = [{}]\nb = [{}]", quoted(&entry.name), list(&entry.a), list(&entry.b));
            if !entry.ease_mm.is_none() {
                let _ = writeln!(text, "ease_mm = {}", ease(&entry.ease_mm));
            }
        }
        text
    }
}

fn ease(ease: &Ease) -> String {
    match ease {
        Ease::Same(ease) => format!("{ease:.1}"),
        Ease::BySize(eases) => {
            let key = |size: &String| toml::Value::String(size.clone());
            let each: Vec<String> = eases.iter().map(|(size, ease)| format!("{} = {ease:.1}", key(size))).collect();
            format!("{{ {} }}", each.join(", "))
        }
    }
}

fn remark(seam: &ProposedSeam) -> String {
    let ratio = seam.ratio();
    let ease = if ratio.max(1.0 / ratio) > EASED_RATIO { format!(", ratio {ratio:.3}") } else { String::new() };
    format!("confidence {:.2}, {:.1} to {:.1} mm{ease}", seam.confidence, seam.a_mm, seam.b_mm)
}
