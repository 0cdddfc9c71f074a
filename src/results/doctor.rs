//! Checks that the machine, the database and the stages work.

use std::path::Path;

use body::{Dimension, Measurements, Sex};
use engine::outcome::machine;
use geom::units::mm;
use spec::{bodies, patterns};
use store::{Result, Store, Value, files, sql};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    pub name: &'static str,
    pub passed: bool,
    pub found: String,
}

/// Checks the machine, the database, and each stage on a small case.
pub fn checks(database: &Path, readonly: bool) -> Vec<Check> {
    let check = |name, found: Result<String>| match found {
        Ok(found) => Check { name, passed: true, found },
        Err(error) => Check { name, passed: false, found: error.to_string() },
    };
    vec![
        check("machine", Ok(machine())),
        check("database", database_check(database, readonly)),
        check("body", body_check()),
        check("pattern", pattern_check()),
    ]
}

/// Runs SQLite's own check.
fn database_check(path: &Path, readonly: bool) -> Result<String> {
    let store = Store::open(path, readonly)?;
    let table = sql::query(&store, "PRAGMA quick_check")?;
    let said: Vec<String> = table.rows.iter().flatten().map(Value::to_string).collect();
    let jobs = sql::query(&store, "SELECT count(*) FROM job")?;
    let count = jobs.rows.iter().flatten().map(Value::to_string).collect::<String>();
    Ok(format!("{}: {}, {count} jobs", path.display(), said.join("; ")))
}

fn body_check() -> Result<String> {
    let known = Measurements::of(Sex::Female, 1.65).with(Dimension::Weight, 60.0).with(Dimension::ChestGirth, 0.9);
    let body = bodies::build_body(&known)?;
    Ok(format!(
        "{} triangles; chest asked 900 mm, measured {:.0} mm",
        body.mesh.triangles.len(),
        body.girths.get(Dimension::ChestGirth).map_or(f64::NAN, mm)
    ))
}

fn pattern_check() -> Result<String> {
    let folder = std::env::temp_dir().join(format!("toile-doctor-{}", std::process::id()));
    let found = files::write_files(&folder, &patterns::drafted(patterns::Model::Tshirt)).and_then(|_| {
        let style = patterns::style(&folder.join("tshirt-m.dxf"), Some(&folder.join("tshirt.seams.toml")), None, None)?;
        let (garment, quality) = patterns::mesh(&style, 0.02)?;
        let edge = mm(quality.mean_edge_m);
        Ok(format!("drafted T-shirt: {} triangles, mean edge {edge:.1} mm", garment.triangles.len()))
    });
    // A folder that this function made; one that cannot be removed does no harm.
    let _ = std::fs::remove_dir_all(&folder);
    found
}
