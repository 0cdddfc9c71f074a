//! The real program in a folder of its own.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::time::Duration;

use serde_json::Value;

/// Longest time a command may take.
const PATIENCE: Duration = Duration::from_secs(300);

/// A folder with a database that goes when this does.
pub struct Place {
    folder: tempfile::TempDir,
}

/// What a command said.
pub struct Said {
    /// Exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Said {
    fn from(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }

    /// Checks the exit code.
    #[track_caller]
    pub fn ends_with(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "out: {}\nerr: {}", self.out, self.err);
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {}", self.out))
    }
}

impl Place {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("within the folder")).expect("writable");
        std::fs::write(path, bytes).expect("writable");
    }

    /// The program with its arguments separated by spaces, ready to start.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
        command.args(arguments.split_whitespace()).current_dir(self.folder.path());
        command.env("TOILE_DB", self.path("toile.sqlite")).env_remove("NO_COLOR");
        command
    }

    /// Runs the program with its arguments separated by spaces.
    #[track_caller]
    pub fn toile(&self, arguments: &str) -> Said {
        let mut command = assert_cmd::Command::from_std(self.command(arguments));
        Said::from(&command.timeout(PATIENCE).output().expect("it starts"))
    }

    /// The answer to a question in SQL, as CSV without its head.
    #[track_caller]
    pub fn sql(&self, query: &str) -> Vec<String> {
        let mut command = assert_cmd::Command::from_std(self.command("sql --format csv -f -"));
        let said = Said::from(&command.timeout(PATIENCE).write_stdin(query).output().expect("it starts"));
        said.ends_with(0).out.lines().skip(1).map(str::to_owned).collect()
    }

    /// The one number or text that answers a question in SQL.
    #[track_caller]
    pub fn one(&self, query: &str) -> String {
        let rows = self.sql(query);
        assert_eq!(rows.len(), 1, "{query}: {rows:?}");
        rows[0].clone()
    }

    /// The study file.
    pub fn study_file(&self) -> String {
        std::fs::read_to_string(self.path("study.toml")).expect("it is written")
    }

    /// Writes the drafted T-shirt below `patterns/`.
    pub fn draft(&self) {
        self.toile("pattern draft -o patterns").ends_with(0);
    }

    /// Writes the drafted T-shirt and a coarse study of it: each garment is a size M in a poplin of its own.
    pub fn study(&self, garments: &[Tee]) {
        self.draft();
        self.write("study.toml", study(garments));
    }

    /// As `study`, by Hybrid-GS, with more lines at the head and at the end of the study file.
    pub fn hybrid_study(&self, head: &str, garments: &[Tee], end: &str) {
        self.draft();
        self.write("study.toml", format!("simulators = [\"hybrid\"]\n{head}\n{}{end}", study(garments)));
    }

    /// A place with the study of two T-shirts that [`draped`] has run.
    pub fn draped() -> Self {
        draped().copy()
    }
}

/// A place as commands left it. They run once for all tests, and each test has a copy of its own.
pub struct Kept {
    files: Vec<(String, Vec<u8>)>,
    /// What the last command said.
    pub said: Said,
}

impl Kept {
    pub fn of(place: &Place, said: Said) -> Self {
        let read = |name: String| {
            let bytes = std::fs::read(place.path(&name)).expect("readable");
            (name, bytes)
        };
        Self { files: files(place.folder.path()).into_iter().map(read).collect(), said }
    }

    pub fn copy(&self) -> Place {
        let place = Place::new();
        self.files.iter().for_each(|(name, bytes)| place.write(name, bytes));
        place
    }
}

/// All files below a folder by their paths from there.
pub fn files(folder: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            found.extend(files(&entry.path()).into_iter().map(|file| format!("{name}/{file}")));
        } else {
            found.insert(name);
        }
    }
    found
}

/// The T-shirts that [`draped`] has.
pub const DRAPED: [Tee; 2] = [("light", 0.1, &["m"]), ("heavy", 0.2, &["l"])];

/// A study of two T-shirts, draped by FEM-GS with one worker, and its report.
pub fn draped() -> &'static Kept {
    static KEPT: OnceLock<Kept> = OnceLock::new();
    KEPT.get_or_init(|| {
        let place = Place::new();
        place.study(&DRAPED);
        let said = place.toile("run . --workers 1").ends_with(0);
        Kept::of(&place, said)
    })
}

/// A T-shirt of the study: its name, the density of its cloth in kg/m2, and its sizes.
pub type Tee<'a> = (&'a str, f64, &'a [&'a str]);

/// A study file that drapes coarse T-shirts on one man.
fn study(garments: &[Tee]) -> String {
    let mut text = r#"
name = "coarse"
edge_length_mm = 60

[[subject]]
id = "ii"
sex = "male"
stature_mm = 1690
chest_girth_mm = 863
waist_girth_mm = 782
hip_girth_mm = 914
"#
    .to_owned();
    for (name, density, sizes) in garments {
        let sizes =
            sizes.iter().map(|size| format!(r#"{{ name = "{size}", pattern = "patterns/tshirt-{size}.dxf" }}"#));
        let sizes = sizes.collect::<Vec<_>>().join(", ");
        text += &format!(
            r#"
[[garment]]
name = "{name}"
seams = "patterns/tshirt.seams.toml"
fabric = "poplin_{name}"
sizes = [{sizes}]

[[fabric]]
name = "poplin_{name}"
density_kg_m2 = {density}
thickness_mm = 0.2
membrane_warp_n_m = 3000
membrane_weft_n_m = 2000
shear_n_m = 90
bending_warp_nm = 5e-6
bending_weft_nm = 4e-6
friction_body = 0.3
friction_self = 0.5
"#
        );
    }
    text
}

/// A text file of the project's sample data, if that is here; says so if not.
pub fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(name);
    if !path.exists() {
        eprintln!("skipped: {name} of the sample data is not here");
        return None;
    }
    Some(path)
}
