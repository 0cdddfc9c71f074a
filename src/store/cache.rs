//! Cache of the products of stages, each kept under the hash of its inputs: the latest in memory for one run, all in
//! the database. Where two workers need the same product at once, one makes it and the other waits.

use std::any::Any;
use std::collections::{BTreeMap, VecDeque};
use std::io::{Read, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use rusqlite::{Connection, OptionalExtension, params};

use crate::connection::{self, Access};
use crate::error::{InOrigin, Origin, Result, StudyError};
use crate::rows::StageKind;
use crate::transaction::now_ms;
use geom::DistanceField;

/// A product that can be stored.
pub trait Artefact: Sized + Send + Sync + 'static {
    fn encode(&self) -> Result<Vec<u8>>;
    fn decode(bytes: &[u8]) -> std::result::Result<Self, String>;
}

/// Makes types artefacts that are stored as JSON, which is exact for finite numbers and readable by other programs.
#[macro_export]
macro_rules! json_artefact {
    ($($stored:ty),*) => {$(
        impl $crate::cache::Artefact for $stored {
            fn encode(&self) -> $crate::Result<Vec<u8>> {
                $crate::cache::to_json(self)
            }

            fn decode(bytes: &[u8]) -> std::result::Result<Self, String> {
                $crate::cache::from_json(bytes)
            }
        }
    )*};
}

json_artefact!(sim::Drape);

/// Fails where a number is not finite.
pub fn to_json(artefact: &impl serde::Serialize) -> Result<Vec<u8>> {
    serde_json::to_vec(artefact).origin(Origin::Store)
}

pub fn from_json<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> std::result::Result<T, String> {
    serde_json::from_slice(bytes).map_err(|error| error.to_string())
}

impl Artefact for DistanceField {
    fn encode(&self) -> Result<Vec<u8>> {
        Ok(self.to_bytes())
    }

    fn decode(bytes: &[u8]) -> std::result::Result<Self, String> {
        Self::from_bytes(bytes).map_err(|error| error.to_string())
    }
}

/// One product that a job used.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Used {
    pub stage: StageKind,
    /// Hex hash of the stage's inputs.
    pub hash: String,
    pub was_cached: bool,
}

impl std::fmt::Display for Used {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.stage.as_str(), if self.was_cached { "from the cache" } else { "made" })
    }
}

/// Most memory for the products of one run, bytes before compression: room for bodies and distance fields of a dozen
/// subjects. Without a limit the subjects of a population would take gigabytes.
const KEPT_BYTES: usize = 512 << 20;

type Product = Arc<dyn Any + Send + Sync>;
/// Place of one product. The first worker fills the slot; the others wait for its lock.
type Slot = Arc<Mutex<Option<Product>>>;

/// Products of one run in memory, backed by those of a database.
pub struct Cache {
    path: PathBuf,
    slots: Mutex<BTreeMap<String, Slot>>,
    /// Hashes of filled slots with their sizes, the oldest first.
    filled: Mutex<VecDeque<(String, usize)>>,
}

impl Cache {
    pub fn new(database: PathBuf) -> Self {
        Self { path: database, slots: Mutex::default(), filled: Mutex::default() }
    }

    /// Returns the product of a stage: from memory, from the database, or else from `make`, and then stores it.
    pub fn get<T: Artefact>(
        &self,
        stage: StageKind,
        hash: &str,
        make: impl FnOnce() -> Result<T>,
    ) -> Result<(Arc<T>, Used)> {
        let used = |was_cached| Used { stage, hash: hash.to_owned(), was_cached };
        let slot = lock(&self.slots).entry(hash.to_owned()).or_default().clone();
        let mut slot = lock(&slot);
        if let Some(product) = slot.clone().and_then(|product| product.downcast::<T>().ok()) {
            return Ok((product, used(true)));
        }
        let connection = connection::open(&self.path, Access::Write)?;
        let stored = load(&connection, hash)?.and_then(|bytes| Some((T::decode(&bytes).ok()?, bytes.len())));
        let was_cached = stored.is_some();
        let (product, size) = match stored {
            Some(found) => found,
            None => {
                let product = make()?;
                let bytes = product.encode()?;
                save(&connection, stage, hash, &bytes)?;
                (product, bytes.len())
            }
        };
        let product = Arc::new(product);
        if stage != StageKind::Drape {
            *slot = Some(product.clone());
            self.keep(hash, size, KEPT_BYTES);
        }
        Ok((product, used(was_cached)))
    }

    /// Notes a product that was put into memory, and drops the oldest products while all take more than `most` bytes. A
    /// worker that still uses a dropped product keeps its own reference.
    fn keep(&self, hash: &str, size: usize, most: usize) {
        let mut filled = lock(&self.filled);
        filled.push_back((hash.to_owned(), size));
        let mut all: usize = filled.iter().map(|(_, size)| size).sum();
        while all > most && filled.len() > 1 {
            let Some((oldest, size)) = filled.pop_front() else { break };
            lock(&self.slots).remove(&oldest);
            all -= size;
        }
    }
}

/// A panic of another thread that held the lock leaves at most an empty slot behind.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Stored bytes of a hash; `None` where there are none, or where they are damaged.
pub(crate) fn load(connection: &Connection, hash: &str) -> Result<Option<Vec<u8>>> {
    let sql = "SELECT bytes FROM artefact WHERE hash = ?";
    let packed: Option<Vec<u8>> = connection.prepare_cached(sql)?.query_row([hash], |row| row.get(0)).optional()?;
    Ok(packed.and_then(|packed| {
        let mut bytes = Vec::new();
        ZlibDecoder::new(packed.as_slice()).read_to_end(&mut bytes).ok().map(|_| bytes)
    }))
}

/// Compresses the bytes: most of a distance field is far from the body and constant. Replaces bytes under this hash
/// that the program can no longer read.
fn save(connection: &Connection, stage: StageKind, hash: &str, bytes: &[u8]) -> Result<()> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
    packer.write_all(bytes).origin(Origin::Store)?;
    let packed = packer.finish().origin(Origin::Store)?;
    let sql = "INSERT OR REPLACE INTO artefact (hash, kind, bytes, created_at) VALUES (?, ?, ?, ?)";
    connection.execute(sql, params![hash, stage.as_str(), packed, now_ms()])?;
    Ok(())
}

pub fn stored<T: Artefact>(connection: &Connection, hash: &str) -> Result<T> {
    let fail = |message: &str| StudyError::Artefact { hash: hash.to_owned(), message: message.to_owned() };
    let bytes = load(connection, hash)?.ok_or_else(|| fail("it is not in the database"))?;
    T::decode(&bytes).map_err(|message| fail(&message))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    impl Artefact for String {
        fn encode(&self) -> Result<Vec<u8>> {
            Ok(self.clone().into_bytes())
        }

        fn decode(bytes: &[u8]) -> std::result::Result<Self, String> {
            Self::from_utf8(bytes.to_vec()).map_err(|error| error.to_string())
        }
    }

    fn get(cache: &Cache, stage: StageKind, made: &str) -> (String, bool) {
        let (product, used) = cache.get(stage, "hash", || Ok(made.to_owned())).expect("the database works");
        ((*product).clone(), used.was_cached)
    }

    fn new_cache(path: &Path) -> Cache {
        connection::open(path, Access::Create).expect("a new database");
        Cache::new(path.to_owned())
    }

    #[test]
    fn a_deleted_database_is_told_and_not_made_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        let cache = new_cache(&path);
        get(&cache, StageKind::Body, "first");
        std::fs::remove_file(&path).expect("there");
        let error = cache.get(StageKind::Mesh, "other", || Ok(String::new())).expect_err("it is gone");
        assert!(error.to_string().contains("toile.sqlite: cannot open") && !path.exists(), "{error}");
    }

    #[test]
    fn a_product_is_made_once_and_outlives_the_run() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        for stage in [StageKind::Body, StageKind::Drape] {
            let cache = new_cache(&path.with_extension(stage.as_str()));
            assert_eq!(get(&cache, stage, "first"), ("first".to_owned(), false));
            assert_eq!(get(&cache, stage, "second"), ("first".to_owned(), true));
            let later = Cache::new(path.with_extension(stage.as_str()));
            assert_eq!(get(&later, stage, "third"), ("first".to_owned(), true));
        }
    }

    #[test]
    fn what_cannot_be_read_is_made_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        let connection = connection::open(&path, Access::Create).expect("a new database");
        save(&connection, StageKind::Body, "hash", &[0xff]).expect("writable");
        assert_eq!(get(&Cache::new(path.clone()), StageKind::Body, "again"), ("again".to_owned(), false));
        assert_eq!(get(&Cache::new(path), StageKind::Body, "more"), ("again".to_owned(), true));
    }

    #[test]
    fn the_oldest_products_leave_memory_but_not_the_database() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = new_cache(&folder.path().join("toile.sqlite"));
        let get = |hash: &str| {
            let make = || Ok(hash.repeat(100));
            let (product, used) = cache.get(StageKind::Body, hash, make).expect("the database works");
            assert_eq!(*product, hash.repeat(100));
            used.was_cached
        };
        assert_eq!(["a", "b", "c"].map(get), [false; 3]);
        cache.keep("d", 100, 250);
        let kept: Vec<String> = lock(&cache.filled).iter().map(|(hash, _)| hash.clone()).collect();
        assert_eq!(kept, ["c", "d"]);
        assert_eq!(lock(&cache.slots).keys().collect::<Vec<_>>(), ["c"]);
        assert_eq!(["a", "b", "c"].map(get), [true; 3]);
    }

    #[test]
    fn workers_that_need_the_same_wait_for_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = new_cache(&folder.path().join("toile.sqlite"));
        let made = std::sync::atomic::AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let make = || {
                        std::thread::sleep(std::time::Duration::from_millis(20));
                        made.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                        Ok("body".to_owned())
                    };
                    cache.get(StageKind::Body, "hash", make).expect("the database works");
                });
            }
        });
        assert_eq!(made.into_inner(), 1);
    }
}
