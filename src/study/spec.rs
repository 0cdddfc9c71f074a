//! From a study to its jobs: one specification for every garment, size, subject, simulator and repeat.

use super::file::{GarmentEntry, SizeFile, SourceFile, Study, Subject};
use super::inputs::Inputs;
use super::pipeline;
use crate::body::Measurements;
use crate::fit::Simulator;
use crate::sim::Fabric;
use crate::units::mm;

/// One simulation with everything it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct JobSpec {
    /// Garment.
    pub garment: String,
    /// Size.
    pub size: String,
    /// Subject.
    pub subject: String,
    /// Simulator.
    pub simulator: Simulator,
    /// Which repeat, from 1.
    pub repeat: u32,
    /// What is known of the subject's body.
    pub measurements: Measurements,
    /// Pattern of the size.
    pub pattern: SourceFile,
    /// Unit of the pattern where its file names none.
    pub unit: Option<String>,
    /// Seam file.
    pub seams: SourceFile,
    /// Cloth.
    pub fabric: Fabric,
    /// Edge length of the finest mesh, m.
    pub edge_length_m: f64,
    /// All of the above, and the versions of the stages, as named values.
    pub inputs: Inputs,
}

/// Which part of a study to run; empty lists take all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Simulators.
    pub simulators: Vec<String>,
    /// Sizes; case does not matter.
    pub sizes: Vec<String>,
    /// Subjects.
    pub subjects: Vec<String>,
    /// Garments.
    pub garments: Vec<String>,
}

impl Selection {
    /// Whether a job is selected.
    #[must_use]
    pub fn takes(&self, spec: &JobSpec) -> bool {
        let among = |list: &[String], name: &str| list.is_empty() || list.iter().any(|x| x.eq_ignore_ascii_case(name));
        among(&self.simulators, spec.simulator.as_str())
            && among(&self.sizes, &spec.size)
            && among(&self.subjects, &spec.subject)
            && among(&self.garments, &spec.garment)
    }
}

/// All jobs of a study, in the order of its file: garments, sizes, subjects, simulators, repeats.
#[must_use]
pub fn jobs(study: &Study) -> Vec<JobSpec> {
    let mut jobs = Vec::new();
    for garment in &study.garments {
        for size in &garment.sizes {
            for subject in &study.subjects {
                for &simulator in &study.simulators {
                    jobs.extend((1..=study.repeats).map(|n| job(study, garment, size, subject, simulator, n)));
                }
            }
        }
    }
    jobs
}

fn job(
    study: &Study,
    garment: &GarmentEntry,
    size: &SizeFile,
    subject: &Subject,
    simulator: Simulator,
    repeat: u32,
) -> JobSpec {
    let mut inputs = Inputs::default();
    inputs.set("sim.name", simulator.as_str());
    inputs.set("sim.repeat", repeat);
    inputs.set("mesh.edge_length_mm", millimetres(study.edge_length_m));
    inputs.set(format!("seams.{}", garment.seams.name), garment.seams.hash());
    inputs.set(format!("pattern.{}", size.pattern.name), size.pattern.hash());
    if let Some(unit) = &garment.unit {
        inputs.set("pattern.unit", unit);
    }
    subject_inputs(&mut inputs, &subject.id, &subject.measurements);
    fabric_inputs(&mut inputs, &garment.fabric);
    for (name, version) in pipeline::versions(simulator) {
        inputs.set(name, version);
    }
    JobSpec {
        garment: garment.name.clone(),
        size: size.name.clone(),
        subject: subject.id.clone(),
        simulator,
        repeat,
        measurements: subject.measurements.clone(),
        pattern: size.pattern.clone(),
        unit: garment.unit.clone(),
        seams: garment.seams.clone(),
        fabric: garment.fabric.clone(),
        edge_length_m: study.edge_length_m,
        inputs,
    }
}

/// A subject's measurements as inputs; absent ones are left out.
pub(super) fn subject_inputs(inputs: &mut Inputs, id: &str, m: &Measurements) {
    inputs.set(format!("subject.{id}.sex"), sex_name(m));
    let lengths = [
        ("stature_mm", Some(m.stature_m)),
        ("chest_girth_mm", m.chest_girth_m),
        ("waist_girth_mm", m.waist_girth_m),
        ("hip_girth_mm", m.hip_girth_m),
        ("neck_girth_mm", m.neck_girth_m),
        ("across_shoulder_mm", m.across_shoulder_m),
    ];
    for (name, length) in lengths {
        if let Some(length) = length {
            inputs.set(format!("subject.{id}.{name}"), millimetres(length));
        }
    }
    if let Some(weight) = m.weight_kg {
        inputs.set(format!("subject.{id}.weight_kg"), weight);
    }
}

/// A fabric's numbers as inputs; where they are from does not matter to a result.
pub(super) fn fabric_inputs(inputs: &mut Inputs, fabric: &Fabric) {
    let numbers = [
        ("density_kg_m2", fabric.density_kg_m2),
        ("membrane_warp_n_m", fabric.membrane_warp_n_m),
        ("membrane_weft_n_m", fabric.membrane_weft_n_m),
        ("membrane_coupling_n_m", fabric.membrane_coupling_n_m),
        ("shear_n_m", fabric.shear_n_m),
        ("bending_warp_nm", fabric.bending_warp_nm),
        ("bending_weft_nm", fabric.bending_weft_nm),
        ("friction_body", fabric.friction_body),
        ("friction_self", fabric.friction_self),
    ];
    for (name, number) in numbers {
        inputs.set(format!("fabric.{}.{name}", fabric.name), number);
    }
    if let Some(stretched) = fabric.stretched {
        let numbers = [
            ("stretch", stretched.stretch),
            ("stretched_warp_n_m", stretched.membrane_warp_n_m),
            ("stretched_weft_n_m", stretched.membrane_weft_n_m),
        ];
        for (name, number) in numbers {
            inputs.set(format!("fabric.{}.{name}", fabric.name), number);
        }
    }
    inputs.set(format!("fabric.{}.thickness_mm", fabric.name), millimetres(fabric.thickness_m));
}

/// Name of a subject's sex in SQL and study files.
pub(super) fn sex_name(m: &Measurements) -> &'static str {
    match m.sex {
        crate::body::Sex::Male => "male",
        crate::body::Sex::Female => "female",
    }
}

/// A length as written in millimetres, to a nanometre: metres and back do not change it.
pub(super) fn millimetres(length_m: f64) -> f64 {
    (mm(length_m) * 1e6).round() / 1e6
}
