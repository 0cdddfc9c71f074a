//! The structure that manifests cannot enforce: which files of a crate import each other, and who touches the outside.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};
use syn::{Attribute, File, Item, ItemMod, ItemUse, UseTree, Visibility};

/// The crates, each a folder of `src`.
const CRATES: [&str; 16] = [
    "geom", "body", "pattern", "linalg", "sim", "fit", "render", "report", "store", "spec", "wardrobe", "engine",
    "results", "advice", "cli", "tui",
];

/// Parts of one crate that never use each other.
const STRANGERS: [[&str; 2]; 1] = [["sim::fem", "sim::hybrid"]];

/// Parts of the standard library that only the crates from `store` on may use: files and their paths, the clock, threads.
const OUTSIDE: [&str; 6] = ["std::fs", "std::net", "std::path", "std::process", "std::thread", "std::time"];

/// The crates that may touch [`OUTSIDE`].
const TOUCHING: [&str; 8] = ["store", "spec", "wardrobe", "engine", "results", "advice", "cli", "tui"];

/// Public fields in millimetres below `store`, where all else is in SI units: they are written so, in seam files and in what
/// `pattern inspect` and `pattern propose` answer.
const MILLIMETRES: [&str; 18] = [
    "body::model::figured::FigureFound.amount_mm",
    "body::model::figured::FigureFound.sd_mm",
    "pattern::inspect::PieceReport.grain_mm",
    "pattern::inspect::PieceReport.perimeter_mm",
    "pattern::propose::ProposedSeam.a_mm",
    "pattern::propose::ProposedSeam.b_mm",
    "pattern::seams::PieceEntry.allowance_mm",
    "pattern::seams::SeamEntry.ease_mm",
    "pattern::seams::SeamFile.allowance_mm",
    "pattern::seams::SeamFile.length_tolerance_mm",
    "pattern::spec_sheet::compared::SpecLine.deviation_mm",
    "pattern::spec_sheet::compared::SpecLine.flat_mm",
    "pattern::spec_sheet::compared::SpecLine.flat_step_mm",
    "pattern::spec_sheet::compared::SpecLine.minus_mm",
    "pattern::spec_sheet::compared::SpecLine.plus_mm",
    "pattern::spec_sheet::compared::SpecLine.spec_mm",
    "pattern::spec_sheet::compared::SpecLine.step_mm",
    "pattern::spec_sheet::compared::SpecLine.worn_mm",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A module of a crate: one source file, without its tests.
struct Module {
    file: File,
    /// What it names at its top, by where that lies: imports, and re-exports, which others reach through it.
    names: BTreeMap<String, Vec<String>>,
    globs: Vec<Vec<String>>,
    defined: BTreeSet<String>,
}

/// The modules of a crate by their paths, such as `sim::fem::run`.
type Modules = BTreeMap<Vec<String>, Module>;

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| a.path().is_ident("cfg") && a.parse_args::<syn::Ident>().is_ok_and(|i| i == "test"))
}

/// Reads a module and those below it.
fn read(file: &Path, folder: &Path, path: Vec<String>, modules: &mut Modules) {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    for item in &parsed.items {
        if let Item::Mod(ItemMod { attrs, ident, content: None, .. }) = item
            && !is_test(attrs)
        {
            let name = ident.to_string();
            let below = folder.join(&name);
            let flat = folder.join(format!("{name}.rs"));
            let file = if flat.is_file() { flat } else { below.join("mod.rs") };
            read(&file, &below, [path.clone(), vec![name]].concat(), modules);
        }
    }
    let mut module = Module { file: parsed, names: BTreeMap::new(), globs: Vec::new(), defined: BTreeSet::new() };
    for item in module.file.items.clone() {
        match item {
            Item::Use(ItemUse { tree, .. }) => module.import(&tree, &path, &mut Vec::new()),
            Item::Fn(i) => module.define(&i.sig.ident),
            Item::Struct(i) => module.define(&i.ident),
            Item::Enum(i) => module.define(&i.ident),
            Item::Trait(i) => module.define(&i.ident),
            Item::Type(i) => module.define(&i.ident),
            Item::Const(i) => module.define(&i.ident),
            Item::Static(i) => module.define(&i.ident),
            _ => {}
        }
    }
    modules.insert(path, module);
}

impl Module {
    fn define(&mut self, name: &syn::Ident) {
        self.defined.insert(name.to_string());
    }

    fn import(&mut self, tree: &UseTree, here: &[String], before: &mut Vec<String>) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.import(&path.tree, here, before);
                before.pop();
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(tree, here, before)),
            UseTree::Name(name) => self.name(&name.ident, name.ident.to_string(), here, before),
            UseTree::Rename(rename) => self.name(&rename.ident, rename.rename.to_string(), here, before),
            UseTree::Glob(_) => self.globs.push(absolute(before, here)),
        }
    }

    fn name(&mut self, ident: &syn::Ident, alias: String, here: &[String], before: &[String]) {
        let is_self = ident == "self";
        let path = if is_self { before.to_vec() } else { [before, &[ident.to_string()]].concat() };
        let alias = if is_self { path.last().cloned().unwrap_or_default() } else { alias };
        self.names.insert(alias, absolute(&path, here));
    }
}

/// A path from the crate's name on; as it stands where it begins otherwise.
fn absolute(path: &[String], here: &[String]) -> Vec<String> {
    let mut base = here.to_vec();
    let mut rest = path;
    match path.first().map(String::as_str) {
        Some("crate") => (base, rest) = (here[..1].to_vec(), &path[1..]),
        Some("self") => rest = &path[1..],
        Some("super") => {
            while rest.first().is_some_and(|part| part == "super") {
                base.pop();
                rest = &rest[1..];
            }
        }
        _ => return path.to_vec(),
    }
    [base, rest.to_vec()].concat()
}

/// The module that defines what a path means as it is written in a module, if it is of this crate: through imports and
/// re-exports to the file itself.
fn defining(modules: &Modules, here: &[String], path: &[String], depth: usize) -> Option<Vec<String>> {
    if depth == 0 {
        return None;
    }
    let start = absolute(path, here);
    if start[0] != here[0] {
        // A name of this module: an import, a child, or its own.
        let (first, rest) = (&start[0], &start[1..]);
        if let Some(target) = modules[here].names.get(first) {
            return defining(modules, here, &[target.clone(), rest.to_vec()].concat(), depth - 1);
        }
        let child = [here, &start[..1]].concat();
        return modules.contains_key(&child).then(|| within(modules, &child, rest, depth)).flatten();
    }
    within(modules, &start[..1], &start[1..], depth)
}

/// As [`defining`], from a module downwards.
fn within(modules: &Modules, module: &[String], rest: &[String], depth: usize) -> Option<Vec<String>> {
    let (first, below) = (rest.first()?, &rest[1..]);
    let child = [module, &rest[..1]].concat();
    if modules.contains_key(&child) && !below.is_empty() {
        return within(modules, &child, below, depth);
    }
    let front = modules.get(module)?;
    if front.defined.contains(first) {
        return Some(module.to_vec());
    }
    if let Some(target) = front.names.get(first) {
        return defining(modules, module, &[target.clone(), below.to_vec()].concat(), depth - 1);
    }
    let through = |glob: &Vec<String>| defining(modules, module, &[glob.clone(), rest.to_vec()].concat(), depth - 1);
    front.globs.iter().find_map(through)
}

/// What a module uses: every path in it but those of its re-exports and tests.
struct Uses {
    paths: BTreeSet<Vec<String>>,
}

impl<'a> Visit<'a> for Uses {
    fn visit_item_mod(&mut self, module: &'a ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        if matches!(item.vis, Visibility::Inherited) {
            leaves(&item.tree, &mut Vec::new(), &mut self.paths);
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        self.paths.insert(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }
}

fn leaves(tree: &UseTree, before: &mut Vec<String>, found: &mut BTreeSet<Vec<String>>) {
    match tree {
        UseTree::Path(path) => {
            before.push(path.ident.to_string());
            leaves(&path.tree, before, found);
            before.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, before, found)),
        UseTree::Name(name) if name.ident != "self" => {
            found.insert([before.as_slice(), &[name.ident.to_string()]].concat());
        }
        UseTree::Rename(rename) => {
            found.insert([before.as_slice(), &[rename.ident.to_string()]].concat());
        }
        UseTree::Name(_) | UseTree::Glob(_) => {
            found.insert(before.clone());
        }
    }
}

fn uses(module: &Module) -> BTreeSet<Vec<String>> {
    let mut uses = Uses { paths: BTreeSet::new() };
    uses.visit_file(&module.file);
    uses.paths
}

fn modules_of(name: &str) -> Modules {
    let folder = root().join("src").join(name);
    let mut modules = Modules::new();
    read(&folder.join("lib.rs"), &folder, vec![name.to_owned()], &mut modules);
    modules
}

/// Which modules each module imports from. The fronts of the folders that it lies in are left out: they hold the words that
/// all files of a folder speak.
fn imports(modules: &Modules) -> BTreeMap<String, BTreeSet<String>> {
    let of = |(path, module): (&Vec<String>, &Module)| {
        let used = uses(module).into_iter().filter(|used| !used.is_empty());
        let from = used.filter_map(|used| defining(modules, path, &used, 8)).filter(|from| !path.starts_with(from));
        (path.join("::"), from.map(|from| from.join("::")).collect())
    };
    modules.iter().map(of).collect()
}

/// Modules that reach each other, in groups.
fn loops(imports: &BTreeMap<String, BTreeSet<String>>) -> BTreeSet<BTreeSet<String>> {
    let reached = |from: &String| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(at) = open.pop() {
            open.extend(imports[at].iter().filter(|next| seen.insert((*next).clone())));
        }
        seen
    };
    let all: BTreeMap<&String, BTreeSet<String>> = imports.keys().map(|from| (from, reached(from))).collect();
    all.iter()
        .map(|(from, to)| to.iter().filter(|other| all[other].contains(*from)).cloned().collect())
        .filter(|group: &BTreeSet<String>| group.len() > 1)
        .collect()
}

#[test]
fn files_import_each_other_in_no_loop() {
    let found: Vec<BTreeSet<String>> = CRATES.iter().flat_map(|name| loops(&imports(&modules_of(name)))).collect();
    let told: Vec<String> = found.iter().map(|group| format!("{} files: {group:?}", group.len())).collect();
    assert!(told.is_empty(), "{}", told.join("\n"));
}

#[test]
fn strangers_never_meet() {
    for name in CRATES {
        for (module, used) in imports(&modules_of(name)) {
            for [a, b] in STRANGERS.iter().flat_map(|[a, b]| [[a, b], [b, a]]) {
                let met = used.iter().find(|used| module.starts_with(*a) && used.starts_with(*b));
                assert!(met.is_none(), "{module} uses {met:?}");
            }
        }
    }
}

#[test]
fn only_the_store_and_what_uses_it_touch_the_outside() {
    for name in CRATES.iter().filter(|name| !TOUCHING.contains(name)) {
        for (path, module) in modules_of(name) {
            for used in uses(&module) {
                let used = used.join("::");
                let touched = OUTSIDE.iter().find(|outside| used.starts_with(**outside));
                assert!(touched.is_none(), "{} uses {used}", path.join("::"));
            }
        }
    }
}

/// All that stands at the top of a crate's files, with where it stands.
fn items(name: &str) -> Vec<(String, Item)> {
    let modules = modules_of(name).into_iter();
    modules.flat_map(|(path, module)| module.file.items.into_iter().map(move |item| (path.join("::"), item))).collect()
}

#[test]
fn fields_are_in_si_units() {
    let mut found = BTreeSet::new();
    for (module, item) in CRATES.iter().filter(|name| !TOUCHING.contains(name)).flat_map(|name| items(name)) {
        let Item::Struct(item) = item else { continue };
        let public = item.fields.iter().filter(|field| matches!(field.vis, Visibility::Public(_)));
        let names = public.filter_map(|field| field.ident.as_ref()).filter(|name| name.to_string().ends_with("_mm"));
        found.extend(names.map(|name| format!("{module}::{}.{name}", item.ident)));
    }
    assert_eq!(found, MILLIMETRES.map(str::to_owned).into());
}

/// Numbers that decide no result: what an index or a layout is called.
const NAMED_NUMBERS: [&str; 2] = ["linalg::cholesky::SIZE", "sim::walls::MEDIAN"];

#[test]
fn constants_of_the_simulators_are_inputs_of_their_results() {
    let mut plain = Vec::new();
    let mut written = BTreeSet::new();
    for (module, item) in ["linalg", "sim"].into_iter().flat_map(items) {
        match item {
            Item::Const(item) if is_number(&item.ty) => plain.push(format!("{module}::{}", item.ident)),
            Item::Macro(item) if item.mac.path.segments.last().is_some_and(|last| last.ident == "constants") => {
                written.extend(listed(item.mac.tokens));
            }
            _ => {}
        }
    }
    plain.retain(|name| !NAMED_NUMBERS.contains(&name.as_str()) && !name.contains("::testing::"));
    assert!(plain.is_empty(), "not in `geom::constants!`: {plain:?}");
    let known: BTreeSet<String> = sim::constants().iter().map(|constant| constant.name.to_owned()).collect();
    assert_eq!(known, written, "`sim::constants` lists each file's");
}

/// Numbers of geometry and arithmetic that may stand in an expression: parts and multiples, the lines of a limb (12 on each face), degrees
/// of series, percent, millimetres.
const PLAIN: [f64; 15] = [0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 18.0, 24.0, 100.0, 1e3, 1e-3];

/// A number up to which one guards a division or a normal, and decides nothing.
const GUARD: f64 = 1e-6;

/// Where other numbers stand that decide no result: shares of progress, a turn of axes, what a message says.
const TOLD: [&str; 3] = ["sim::fem::run", "sim::hybrid", "sim::contact::rub"];

/// Numbers written in the functions of a file, but for its tests and the default parameters, which are inputs by themselves.
#[derive(Default)]
struct Written(Vec<String>);

impl<'a> Visit<'a> for Written {
    fn visit_item_mod(&mut self, module: &'a ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_impl(&mut self, item: &'a syn::ItemImpl) {
        let is_default = item.trait_.as_ref().is_some_and(|(_, path, _)| path.is_ident("Default"));
        if !is_default {
            visit::visit_item_impl(self, item);
        }
    }

    fn visit_lit_float(&mut self, number: &'a syn::LitFloat) {
        let value: f64 = number.base10_parse().expect("a number");
        if !PLAIN.contains(&value) && value > GUARD {
            self.0.push(number.to_string());
        }
    }
}

#[test]
fn no_number_of_the_simulators_is_written_in_place() {
    let mut told = Vec::new();
    for (path, module) in ["linalg", "sim"].into_iter().flat_map(modules_of) {
        let path = path.join("::");
        if TOLD.contains(&path.as_str()) || path.contains("::testing") || path.starts_with("sim::laboratory") {
            continue;
        }
        let mut written = Written::default();
        written.visit_file(&module.file);
        told.extend(written.0.into_iter().map(|number| format!("{path}: {number}")));
    }
    assert!(told.is_empty(), "not in `geom::constants!`, so no input of results: {told:#?}");
}

/// Whether a constant's type is made of numbers.
fn is_number(of: &syn::Type) -> bool {
    match of {
        syn::Type::Path(path) => path.path.segments.last().is_some_and(|last| {
            ["f64", "f32", "usize", "u64", "u32", "i32", "Range"].iter().any(|name| last.ident == name)
        }),
        syn::Type::Array(array) => is_number(&array.elem),
        syn::Type::Tuple(tuple) => tuple.elems.iter().any(is_number),
        _ => false,
    }
}

/// The constants in the words of a `geom::constants!`, by room and name.
fn listed(tokens: impl IntoIterator<Item = impl ToString>) -> Vec<String> {
    let words: Vec<String> = tokens.into_iter().map(|token| token.to_string()).collect();
    let room = words[0].trim_matches('"');
    words.windows(2).filter(|two| two[0] == "const").map(|two| format!("{room}.{}", two[1])).collect()
}

#[test]
fn every_crate_is_known() {
    let folders = fs::read_dir(root().join("src")).expect("src is there").map(|entry| entry.expect("readable").path());
    let found: BTreeSet<String> = folders
        .filter(|path: &PathBuf| path.is_dir())
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    assert_eq!(found, CRATES.iter().map(|name| (*name).to_owned()).collect());
}
