//! Jobs of a study: one specification for every garment, size, subject, simulator and repeat.

use std::collections::BTreeSet;

use crate::fields::{FABRIC_NUMBERS, MEASUREMENTS, millimetres, sex_name};
use crate::file::{GarmentEntry, Person, SizeFile, Study, Subject};
use crate::inputs::Inputs;
use crate::parameters::Parameters;
use crate::schedule::Schedule;
use crate::versions;
use fit::Simulator;
use sim::Fabric;
use store::files::SourceFile;
use store::{JobRow, Result, StudyError};

/// One simulation with everything that it needs.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct JobSpec {
    pub garment: String,
    pub style: String,
    pub size: String,
    pub subject: String,
    pub simulator: Simulator,
    /// Counts from 1.
    pub repeat: u32,
    #[serde(flatten)]
    pub person: Person,
    pub pattern: SourceFile,
    /// Unit of the pattern, where its file names none.
    pub unit: Option<String>,
    /// `None` where the pattern holds its own seams.
    pub seams: Option<SourceFile>,
    pub fabric: Fabric,
    /// Edge length of the finest mesh.
    pub edge_length_m: f64,
    pub parameters: Parameters,
    #[serde(default)]
    pub schedule: Schedule,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outfit: Option<Outfit>,
    /// Job that drapes the garment in the pose in which it is put on, if the body then moves and carries it along.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dressed: Option<Box<JobSpec>>,
    /// All fields above but `schedule`, with the versions of the stages, as named values.
    pub inputs: Inputs,
}

/// Name of the input with the size that is draped.
pub const PATTERN_SIZE: &str = "pattern.size";

/// Name of the input with the pose that a garment was carried from.
pub const CARRIED_FROM: &str = "carried.from";

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Outfit {
    pub name: String,
    /// Index, the inmost 0.
    pub layer: usize,
    /// Every layer as a job of its own, the inmost first.
    pub layers: Vec<JobSpec>,
}

impl Outfit {
    /// Hash of the inputs of all layers, equal for each layer of the outfit.
    pub fn id(&self) -> String {
        let mut all = Inputs::default();
        for (number, layer) in self.layers.iter().enumerate() {
            all.set(format!("layer.{number}"), layer.inputs.hash());
        }
        all.hash()
    }
}

/// Selection of jobs of a study; an empty list takes all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// `fem` and `hybrid`.
    pub simulators: Vec<String>,
    /// Names in upper or lower case.
    pub sizes: Vec<String>,
    pub subjects: Vec<String>,
    pub garments: Vec<String>,
}

impl Selection {
    pub fn takes(&self, cell: Cell, study: &Study) -> bool {
        let (garment, size, subject) = (cell.garment(study), cell.size(study), cell.subject(study));
        self.takes_cell([cell.simulator.as_str(), &size.name, &subject.id, &garment.name])
    }

    pub fn takes_row(&self, job: &JobRow) -> bool {
        self.takes_cell([job.simulator.as_str(), &job.size, &job.subject, &job.garment])
    }

    pub fn check(&self, study: &Study) -> Result<()> {
        let sizes = study.worn().flat_map(|garment| &garment.sizes).map(|size| size.name.as_str());
        let axes: [(&'static str, &[String], Vec<&str>); 4] = [
            ("simulator", &self.simulators, study.simulators.iter().map(|simulator| simulator.as_str()).collect()),
            ("size", &self.sizes, sizes.collect()),
            ("subject", &self.subjects, study.subjects.iter().map(|subject| subject.id.as_str()).collect()),
            ("garment", &self.garments, study.worn().map(|garment| garment.name.as_str()).collect()),
        ];
        for (what, wanted, known) in axes {
            let mut seen = BTreeSet::new();
            let known: Vec<&str> = known.into_iter().filter(|name| seen.insert(*name)).collect();
            if let Some(name) = wanted.iter().find(|wanted| !known.iter().any(|k| k.eq_ignore_ascii_case(wanted))) {
                let known = known.into_iter().map(str::to_owned).collect();
                return Err(StudyError::NotFound { what, name: name.clone(), known });
            }
        }
        Ok(())
    }

    fn takes_cell(&self, [simulator, size, subject, garment]: [&str; 4]) -> bool {
        let among = |list: &[String], name: &str| list.is_empty() || list.iter().any(|x| x.eq_ignore_ascii_case(name));
        among(&self.simulators, simulator)
            && among(&self.sizes, size)
            && among(&self.subjects, subject)
            && among(&self.garments, garment)
    }
}

/// Order is that of the file: garments, sizes, subjects, simulators, repeats.
pub fn jobs(study: &Study) -> Vec<JobSpec> {
    cells(study).iter().map(|cell| cell.job(study)).collect()
}

/// Order is that of `jobs`.
pub fn jobs_of(study: &Study, garment: &str, subject: &str) -> Vec<JobSpec> {
    let is_wanted = |cell: &&Cell| cell.garment(study).name == garment && cell.subject(study).id == subject;
    cells(study).iter().filter(is_wanted).map(|cell| cell.job(study)).collect()
}

/// Cell of the grid of a study, as indices into it: a job takes kilobytes, and a study may have a million.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cell {
    garment: u32,
    size: u32,
    subject: u32,
    pub simulator: Simulator,
    /// Counts from 1.
    pub repeat: u32,
}

impl Cell {
    /// Garment of the study that made the cell, or layer of an outfit.
    pub fn garment(self, study: &Study) -> &GarmentEntry {
        let index = self.garment as usize;
        study.garments.get(index).unwrap_or_else(|| &study.layers[index - study.garments.len()])
    }

    pub fn size(self, study: &Study) -> &SizeFile {
        &self.garment(study).sizes[self.size as usize]
    }

    pub fn subject(self, study: &Study) -> &Subject {
        &study.subjects[self.subject as usize]
    }

    pub fn job(self, study: &Study) -> JobSpec {
        job(self.garment(study), self.size as usize, self.subject(study), self.simulator, self.repeat)
    }
}

/// Order is that of the study's jobs.
pub fn cells(study: &Study) -> Vec<Cell> {
    let mut cells = Vec::new();
    let number = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
    for (garment, entry) in study.worn().enumerate() {
        let wearers: BTreeSet<&str> = entry.subjects.iter().map(String::as_str).collect();
        // Layers of an outfit cannot be carried into another pose.
        let is_able = |subject: &Subject| entry.outfit.is_none() || subject.carried_from.is_none();
        let is_worn = |(_, subject): &(usize, &Subject)| wearers.contains(subject.id.as_str()) && is_able(subject);
        let subjects: Vec<(usize, &Subject)> = study.subjects.iter().enumerate().filter(is_worn).collect();
        for size in 0..entry.sizes.len() {
            for (subject, who) in &subjects {
                // Only FEM-GS simulates layers, and the friction by which a body carries a garment.
                let is_plain = entry.outfit.is_none() && who.carried_from.is_none();
                for &simulator in study.simulators.iter().filter(|simulator| is_plain || **simulator == Simulator::Fem)
                {
                    let [garment, size, subject] = [garment, size, *subject].map(number);
                    cells.extend((1..=study.repeats).map(|repeat| Cell { garment, size, subject, simulator, repeat }));
                }
            }
        }
    }
    cells
}

fn job(garment: &GarmentEntry, size: usize, subject: &Subject, simulator: Simulator, repeat: u32) -> JobSpec {
    let SizeFile { name, pattern } = &garment.sizes[size];
    let outfit = garment.outfit.as_ref().map(|worn| Outfit {
        name: worn.name.clone(),
        layer: worn.layer,
        layers: worn.layers.iter().map(|layer| job(layer, size, subject, simulator, repeat)).collect(),
    });
    let spec = JobSpec {
        garment: garment.name.clone(),
        style: garment.style.clone(),
        size: name.clone(),
        subject: subject.id.clone(),
        simulator,
        repeat,
        person: subject.person.clone(),
        pattern: pattern.clone(),
        unit: garment.unit.clone(),
        seams: garment.seams.clone(),
        fabric: garment.fabric.clone(),
        edge_length_m: garment.edge_length_m,
        parameters: garment.parameters.clone(),
        schedule: garment.schedule.clone(),
        outfit,
        dressed: subject.dressed().map(|before| Box::new(job(garment, size, &before, simulator, repeat))),
        inputs: Inputs::default(),
    };
    spec.with_inputs()
}

impl JobSpec {
    /// Returns the job with its inputs as named values, for this program's versions of the stages. All fields are
    /// listed, so that a new field does not compile until somebody decides whether it is an input.
    pub fn with_inputs(self) -> Self {
        let Self {
            // Results do not depend on names in the study.
            garment: _,
            style: _,
            size,
            subject,
            simulator,
            repeat,
            person,
            pattern,
            unit,
            seams,
            fabric,
            edge_length_m,
            parameters,
            // Results do not depend on order and limits.
            schedule: _,
            outfit,
            dressed,
            // Written by this function.
            inputs: _,
        } = &self;
        let mut inputs = Inputs::default();
        inputs.set("sim.name", simulator.as_str());
        inputs.set("sim.repeat", repeat);
        inputs.set("mesh.edge_length_mm", millimetres(*edge_length_m));
        parameters.add_inputs(*simulator, &mut inputs);
        if let Some(seams) = seams {
            inputs.set(format!("seams.{}", seams.name), seams.hash());
        }
        inputs.set(format!("pattern.{}", pattern.name), pattern.hash());
        // A file may hold several sizes, so its hash does not tell them apart.
        inputs.set(PATTERN_SIZE, size);
        if let Some(unit) = unit {
            inputs.set("pattern.unit", unit);
        }
        subject_inputs(&mut inputs, subject, person);
        fabric_inputs(&mut inputs, fabric);
        if let Some(outfit) = outfit {
            let Outfit { name, layer, layers: _ } = outfit;
            inputs.set("outfit.name", name);
            inputs.set("outfit.layer", layer + 1);
            inputs.set("outfit.id", outfit.id());
        }
        if let Some(before) = dressed {
            inputs.set(CARRIED_FROM, before.person.pose.unwrap_or_default());
        }
        for (name, version) in versions::versions(*simulator) {
            inputs.set(name, version);
        }
        Self { inputs, ..self }
    }
}

pub fn subject_inputs(inputs: &mut Inputs, id: &str, Person { measurements: m, scan, pose, figures }: &Person) {
    inputs.set(format!("subject.{id}.sex"), sex_name(m));
    for field in MEASUREMENTS.iter() {
        if let Some(value) = field.get(m) {
            inputs.set(format!("subject.{id}.{}", field.key), value);
        }
    }
    if let Some(scan) = scan {
        inputs.set(format!("subject.{id}.scan"), scan.file.hash());
        inputs.set(format!("subject.{id}.scan_version"), versions::SCAN_VERSION);
        if let Some(unit) = scan.unit {
            inputs.set(format!("subject.{id}.scan_unit"), unit.name());
        }
    }
    if let Some(pose) = pose {
        inputs.set(format!("subject.{id}.pose"), pose);
    }
    if !figures.is_empty() {
        inputs.set(format!("subject.{id}.figure"), figures);
    }
}

/// Results do not depend on the `source` of a fabric.
pub fn fabric_inputs(inputs: &mut Inputs, fabric: &Fabric) {
    for field in FABRIC_NUMBERS.iter() {
        if let Some(number) = field.get(fabric) {
            inputs.set(format!("fabric.{}.{}", fabric.name, field.key), number);
        }
    }
}
