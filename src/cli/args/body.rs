//! Arguments of `toile body`.

use super::measured::MeasuredValues;
use spec::bodies;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

/// Sex of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Sex {
    /// A male body.
    M,
    /// A female body.
    F,
}

/// Unit of a body mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MeshUnit {
    /// Coordinates in millimetres.
    Mm,
    /// Coordinates in centimetres.
    Cm,
    /// Coordinates in metres.
    M,
    /// Coordinates in decimetres.
    Dm,
    /// Coordinates in inches.
    In,
}

/// A body of a file.
#[derive(Debug, Args)]
pub struct BodyFile {
    /// Body: a mesh or scan (OBJ, PLY, STL, GLB), or measurements (TOML as of a [[subject]], .smis, .vit, GarmentCode .yaml).
    #[arg(long, value_name = "FILE")]
    pub body: PathBuf,
    /// Unit of the mesh; by default told from its height.
    #[arg(long, value_enum)]
    pub body_unit: Option<MeshUnit>,
    /// Sex of the body; by default told from its girths.
    #[arg(long, value_enum)]
    pub sex: Option<Sex>,
}

impl From<MeshUnit> for bodies::LengthUnit {
    fn from(unit: MeshUnit) -> Self {
        match unit {
            MeshUnit::Mm => Self::Millimetre,
            MeshUnit::Cm => Self::Centimetre,
            MeshUnit::M => Self::Metre,
            MeshUnit::Dm => Self::Decimetre,
            MeshUnit::In => Self::Inch,
        }
    }
}

/// Commands on bodies.
#[derive(Debug, Subcommand)]
pub enum Body {
    /// Measure any upright body mesh (OBJ, PLY, STL, GLB).
    Measure {
        /// Mesh file: OBJ, PLY, STL or GLB.
        file: PathBuf,
        /// Unit of the file; by default told from its height.
        #[arg(long, value_enum)]
        unit: Option<MeshUnit>,
        /// Sex, where known: places the waist.
        #[arg(long, value_enum)]
        sex: Option<Sex>,
    },
    /// Build a body from measurements, from a front and a side picture, from a scan, or from a subject of the catalogue.
    Build(Box<BodyBuild>),
    /// Put a body into another pose: arms raised, lowered or reaching forward, legs spread or in a step.
    Pose {
        /// Scan or mesh (OBJ, PLY, STL, GLB), also body.obj of `body build`.
        file: PathBuf,
        /// Angle of the upper arms from the vertical, degrees.
        #[arg(long, value_name = "N", required_unless_present_any = ["leg_deg", "forward_deg", "step_deg"])]
        arm_deg: Option<f64>,
        /// Angle of the thighs from the vertical, degrees.
        #[arg(long, value_name = "N")]
        leg_deg: Option<f64>,
        /// Angle by which the arms then swing forward, degrees.
        #[arg(long, value_name = "N")]
        forward_deg: Option<f64>,
        /// Angle by which the right leg swings forward and the left one back, degrees.
        #[arg(long, value_name = "N")]
        step_deg: Option<f64>,
        /// Unit of the file; by default told from its height.
        #[arg(long, value_enum)]
        unit: Option<MeshUnit>,
        /// Sex, where known: places the waist.
        #[arg(long, value_enum)]
        sex: Option<Sex>,
        /// Folder to write the posed body to: the files of `body build`.
        #[arg(long, short, value_name = "DIR")]
        output: PathBuf,
    },
    /// How well the bodies of a folder are measured from meshes, scans, silhouettes and photographs.
    Evaluate {
        /// Folder with manifest.csv, measurements.csv, and where there are any scans.csv and images.csv.
        folder: PathBuf,
    },
}

/// Arguments of `body build`.
#[derive(Debug, Args)]
pub struct BodyBuild {
    /// Subject of the catalogue to start from.
    #[arg(long, value_name = "NAME")]
    pub subject: Option<String>,
    /// Sex of the body.
    #[arg(long, value_enum, required_unless_present_any = ["subject", "measurements", "scan"])]
    pub sex: Option<Sex>,
    /// Measurements: TOML as of a study's [[subject]], SeamlyMe (.smis), Valentina (.vit) or GarmentCode (.yaml, .json).
    #[arg(long, value_name = "FILE", conflicts_with = "subject")]
    pub measurements: Option<PathBuf>,
    #[command(flatten)]
    pub measured: MeasuredValues,
    /// Figure beside the standard body: flat_seat, flat_seat=strong, flat_seat=18 (mm). May be given several times.
    #[arg(long, value_name = "NAME[=DEGREE]", conflicts_with = "scan")]
    pub figure: Vec<String>,
    /// Front picture (PNG or JPEG): a photograph against a plain background, or a mask.
    #[arg(long, value_name = "IMAGE", requires = "side", conflicts_with_all = ["subject", "measurements"])]
    pub front: Option<PathBuf>,
    /// Side picture, the subject facing its right.
    #[arg(long, value_name = "IMAGE", requires = "front")]
    pub side: Option<PathBuf>,
    /// Scan (OBJ, PLY, STL, GLB): cleaned, it becomes the body itself.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["subject", "measurements", "front"])]
    pub scan: Option<PathBuf>,
    /// Unit of the scan; by default told from its height.
    #[arg(long, value_enum, requires = "scan")]
    pub unit: Option<MeshUnit>,
    /// Distance of the camera from the subject.
    #[arg(long, value_name = "N", requires = "front", requires = "lens")]
    pub camera_distance_mm: Option<f64>,
    /// Focal length in pixels of the pictures.
    #[arg(long, value_name = "N", group = "lens", requires = "camera_distance_mm")]
    pub focal_px: Option<f64>,
    /// Vertical field of view of the pictures.
    #[arg(long, value_name = "N", group = "lens", requires = "camera_distance_mm")]
    pub fov_deg: Option<f64>,
    /// Folder to write body.obj, body.png, measurements.json, control.obj and control.json to.
    #[arg(long, short, value_name = "DIR")]
    pub output: PathBuf,
}
