//! Pictures with options: several results and views on one sheet, close-ups, turntables, in any cloth.

use image::RgbaImage;

use crate::picture::{self, Cloth, Dressed, Map};
use geom::TriMesh;
use render::{self, Camera, Cell, Frame, Rgb, Scene, View};
use sim::Stage;
use store::{InOrigin, JobId, Origin, Result, Store, StudyError, read};

/// Time of one turn.
const TURN_MS: u32 = 6000;
/// Angle, enlargement and height of a close-up, as in [`Zoom`].
const CLOSE_UP: (f64, Zoom) = (24.0, Zoom { zoom_pct: 280, rise_pct: 40 });

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zoom {
    /// Enlargement of the garment; at 100 it fills the picture.
    pub zoom_pct: u32,
    /// Height of the picture's middle above the garment's, in parts of half the garment's height.
    pub rise_pct: i32,
}

impl Zoom {
    pub(super) fn of(self, mut frame: Frame) -> Frame {
        frame.centre.z += f64::from(self.rise_pct) / 100.0 * frame.height_m / 2.0;
        frame.height_m *= 100.0 / f64::from(self.zoom_pct.max(1));
        frame
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shot {
    View(View),
    CloseUp,
    /// Angle about the vertical from the front towards the subject's right, degrees.
    Turned(f64),
}

impl Shot {
    fn name(self) -> String {
        match self {
            Self::View(view) => view.as_str().to_owned(),
            Self::CloseUp => "close-up".to_owned(),
            Self::Turned(degrees) => format!("{degrees}°"),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Order {
    /// Shots; each makes a picture.
    pub shots: Vec<Shot>,
    /// Stages of the simulation; each makes a picture.
    pub stages: Vec<Stage>,
    pub map: Map,
    /// Cloths on [`Map::Plain`].
    pub cloths: Vec<Cloth>,
    /// `None` shows a dress form.
    pub skin: Option<Rgb>,
    /// `None` shows body and garment as a whole.
    pub zoom: Option<Zoom>,
    /// Pixels of each shot, across and down.
    pub size: (u32, u32),
}

impl Order {
    /// `whole` encloses bodies and garments, `garments` only the garments.
    fn camera(&self, shot: Shot, whole: Frame, garments: Frame) -> Camera {
        let frame = self.zoom.map_or(whole, |zoom| zoom.of(garments));
        match shot {
            Shot::View(view) => Camera::new(view, frame),
            Shot::Turned(azimuth_deg) => Camera { azimuth_deg, ..Camera::new(View::Front, frame) },
            Shot::CloseUp => {
                let (azimuth_deg, zoom) = CLOSE_UP;
                Camera { azimuth_deg, ..Camera::new(View::Front, self.zoom.unwrap_or(zoom).of(garments)) }
            }
        }
    }

    fn draw(&self, scene: &Scene, camera: &Camera) -> Result<RgbaImage> {
        let mut picture = render::render(scene, camera, self.size.0, self.size.1).origin(Origin::Render)?;
        if let Some(scale) = self.map.scale() {
            render::draw_legend(&mut picture, &scale).origin(Origin::Render)?;
        }
        Ok(picture)
    }

    /// Frames around bodies and garments, and around only the garments.
    fn frames(&self, dressed: &[Dressed]) -> [Frame; 2] {
        let cloth = || dressed.iter().map(|worn| &worn.cloth);
        let all: Vec<&TriMesh> = dressed.iter().map(|worn| &worn.body).chain(cloth()).collect();
        let aspect = picture::aspect(self.size.0, self.size.1);
        [Frame::enclosing(all, aspect), Frame::enclosing(cloth(), aspect)]
    }
}

/// PNG file: a single shot of a single result by itself, several on a sheet at one scale.
pub fn pictures(store: &Store, ids: &[JobId], order: &Order) -> Result<Vec<u8>> {
    let worn = ids.iter().flat_map(|id| order.stages.iter().map(move |stage| (*id, *stage)));
    let worn: Vec<(JobId, Stage)> = worn.collect();
    let dressed = worn.iter().map(|(id, stage)| dressed_at(store, *id, *stage)).collect::<Result<Vec<_>>>()?;
    let [whole, garments] = order.frames(&dressed);
    let mut cells = Vec::new();
    for ((id, stage), worn) in worn.iter().zip(&dressed) {
        let scene = worn.scene_in(order.map, &order.cloths, order.skin)?;
        let job = read::job(store, *id)?;
        let before = if *stage == Stage::Drape { String::new() } else { format!(" {}", stage.as_str()) };
        for shot in &order.shots {
            let picture = order.draw(&scene, &order.camera(*shot, whole, garments))?;
            let simulator = job.simulator.as_str();
            let label = format!("{} {}, {}, {simulator}{before}, {}", job.garment, job.size, job.subject, shot.name());
            cells.push(Cell { picture, label });
        }
    }
    let columns = match (order.shots.len(), order.stages.len()) {
        (1, 1) => ids.len().min(4),
        (1, stages) => stages,
        (shots, _) => shots,
    };
    let picture = match cells.as_slice() {
        [cell] => render::png(&cell.picture),
        _ => render::contact_sheet("", &cells, columns).and_then(|sheet| render::png(&sheet)),
    };
    picture.origin(Origin::Render)
}

fn dressed_at(store: &Store, id: JobId, stage: Stage) -> Result<Dressed> {
    let worn = picture::dressed(store, id)?;
    let known = worn.earlier.iter().map(|staged| staged.stage).chain([worn.stage]);
    let known: Vec<String> = known.map(|stage| stage.as_str().to_owned()).collect();
    let name = format!("{} of job {id}", stage.as_str());
    worn.at(stage).ok_or(StudyError::NotFound { what: "stage", name, known })
}

/// Animated PNG file of one turn about the vertical, repeated endlessly.
pub fn turntable(store: &Store, id: JobId, order: &Order, pictures: u32) -> Result<Vec<u8>> {
    let dressed = [picture::dressed(store, id)?];
    let [whole, garments] = order.frames(&dressed);
    let scene = dressed[0].scene_in(order.map, &order.cloths, order.skin)?;
    let turned = (0..pictures).map(|k| {
        let shot = Shot::Turned(360.0 * f64::from(k) / f64::from(pictures));
        order.draw(&scene, &order.camera(shot, whole, garments))
    });
    let frames = turned.collect::<Result<Vec<_>>>()?;
    render::animated_png(&frames, TURN_MS / pictures.max(1)).origin(Origin::Render)
}
