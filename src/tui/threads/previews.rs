//! The thread that sews a garment coarsely while its seams are edited. The body used last is kept ready.

use std::cell::Cell;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use crate::messages::message::Message;
use crate::messages::seams::{PreviewRequest, Previewed};
use results::preview::{Mannequin, Preview, mannequin};
use store::{Origin, Store, StudyError, SubjectId};
use wardrobe::catalogue;
use wardrobe::seams::Workpiece;

/// Latest preview with the number of its request, for the thread of pictures.
pub type Slot = Arc<Mutex<Option<(u64, Preview)>>>;

/// Answers requests, skipping all but the latest, until nobody requests or listens any more. A newer request stops the
/// work on an older one.
pub fn serve(
    database: &Path,
    readonly: bool,
    wanted: &Receiver<PreviewRequest>,
    slot: &Slot,
    sender: &Sender<Message>,
) {
    let store = catalogue::open(database, readonly).map_err(|error| error.to_string());
    let mut room = Room { store, ready: None };
    let newer = Cell::new(None);
    while let Some(request) = newer.take().or_else(|| wanted.recv().ok()) {
        let started = Instant::now();
        let is_stale = || {
            let last = wanted.try_iter().last();
            let is_stale = last.is_some();
            if is_stale {
                newer.set(last);
            }
            is_stale
        };
        let outcome = match room.dress(&request, &is_stale) {
            Err(StudyError::Interrupted) => continue,
            Err(error) => Err(error.to_string()),
            Ok(Dressed { subject, fabric, preview }) => {
                let (hung, remarks) = (preview.hung, preview.remarks.clone());
                *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some((request.number, preview));
                let took_ms = u64::try_from(started.elapsed().as_millis()).unwrap_or(u64::MAX);
                Ok(Previewed { subject, fabric, hung, remarks, took_ms })
            }
        };
        if sender.send(Message::Previewed(Box::new(request), outcome)).is_err() {
            return;
        }
    }
}

struct Dressed {
    subject: String,
    fabric: String,
    preview: Preview,
}

struct Room {
    store: Result<Store, String>,
    ready: Option<(SubjectId, Mannequin)>,
}

impl Room {
    fn dress(&mut self, request: &PreviewRequest, is_stale: &dyn Fn() -> bool) -> Result<Dressed, StudyError> {
        let store = self.store.as_ref().map_err(|error| StudyError::refused(Origin::Store, error.clone()))?;
        if self.ready.as_ref().is_none_or(|(subject, _)| *subject != request.subject) {
            self.ready = Some((request.subject, mannequin(store, request.subject)?));
        }
        let Some((_, mannequin)) = &self.ready else { return Err(StudyError::Interrupted) };
        let stored = catalogue::workpiece(store, request.size.key)?;
        let piece = Workpiece { seams: request.size.seams.clone().or(stored.seams.clone()), ..stored };
        let cloth = catalogue::cloth(store, request.fabric.as_deref())?;
        let preview = mannequin.dressed_in(&piece, &cloth, request.care, is_stale)?;
        Ok(Dressed { subject: mannequin.name.clone(), fabric: cloth.name, preview })
    }
}
