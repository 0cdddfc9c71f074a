-- The store: catalogue with revisions, jobs with their named inputs, results, artefacts.
-- Lengths are millimetres, times milliseconds (of the clock: UTC since 1970), hashes BLAKE3 in hex.

-- The catalogue. An edit adds a revision; what a result came from stays.
CREATE TABLE subject (
    subject_id INTEGER PRIMARY KEY,
    name TEXT NOT NULL,
    revision INTEGER NOT NULL,
    hash TEXT NOT NULL,
    sex TEXT NOT NULL CHECK (sex IN ('male', 'female')),
    stature_mm REAL NOT NULL,
    weight_kg REAL,
    chest_girth_mm REAL,
    waist_girth_mm REAL,
    hip_girth_mm REAL,
    neck_girth_mm REAL,
    across_shoulder_mm REAL,
    created_at INTEGER NOT NULL,
    UNIQUE (name, revision),
    UNIQUE (name, hash)
) STRICT;

CREATE TABLE style (
    style_id INTEGER PRIMARY KEY,
    name TEXT NOT NULL,
    revision INTEGER NOT NULL,
    hash TEXT NOT NULL,
    seam_file TEXT NOT NULL,
    seams TEXT NOT NULL,
    created_at INTEGER NOT NULL,
    UNIQUE (name, revision),
    UNIQUE (name, hash)
) STRICT;

CREATE TABLE size (
    size_id INTEGER PRIMARY KEY,
    style TEXT NOT NULL,
    name TEXT NOT NULL,
    revision INTEGER NOT NULL,
    hash TEXT NOT NULL,
    pattern_file TEXT NOT NULL,
    unit TEXT,
    pattern BLOB NOT NULL,
    created_at INTEGER NOT NULL,
    UNIQUE (style, name, revision),
    UNIQUE (style, name, hash)
) STRICT;

CREATE TABLE fabric (
    fabric_id INTEGER PRIMARY KEY,
    name TEXT NOT NULL,
    revision INTEGER NOT NULL,
    hash TEXT NOT NULL,
    density_kg_m2 REAL NOT NULL,
    thickness_mm REAL NOT NULL,
    membrane_warp_n_m REAL NOT NULL,
    membrane_weft_n_m REAL NOT NULL,
    membrane_coupling_n_m REAL NOT NULL,
    shear_n_m REAL NOT NULL,
    bending_warp_nm REAL NOT NULL,
    bending_weft_nm REAL NOT NULL,
    friction_body REAL NOT NULL,
    friction_self REAL NOT NULL,
    source TEXT NOT NULL,
    created_at INTEGER NOT NULL,
    UNIQUE (name, revision),
    UNIQUE (name, hash)
) STRICT;

-- A study as it was last run: where its file lies and where its fit classes meet.
CREATE TABLE study (
    study_id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    path TEXT NOT NULL,
    tight_below_mm REAL NOT NULL,
    loose_above_mm REAL NOT NULL,
    paused INTEGER NOT NULL DEFAULT 0,
    updated_at INTEGER NOT NULL
) STRICT;

-- Order of a study's garments, sizes and subjects in its file.
CREATE TABLE study_axis (
    study_id INTEGER NOT NULL REFERENCES study,
    axis TEXT NOT NULL CHECK (axis IN ('garment', 'size', 'subject')),
    name TEXT NOT NULL,
    position INTEGER NOT NULL,
    PRIMARY KEY (study_id, axis, name)
) STRICT, WITHOUT ROWID;

-- One simulation. A cell of a study (garment, size, subject, simulator, repeat) gets a new job when an input changes;
-- the job whose inputs are the study's own now is the current one.
CREATE TABLE job (
    job_id INTEGER PRIMARY KEY,
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    size TEXT NOT NULL,
    subject TEXT NOT NULL,
    simulator TEXT NOT NULL CHECK (simulator IN ('fem', 'hybrid')),
    repeat INTEGER NOT NULL DEFAULT 1,
    input_hash TEXT NOT NULL,
    is_current INTEGER NOT NULL DEFAULT 1,
    priority INTEGER NOT NULL DEFAULT 0,
    status TEXT NOT NULL CHECK (status IN ('queued', 'running', 'done', 'not_converged', 'failed', 'cancelled')),
    attempts INTEGER NOT NULL DEFAULT 0,
    error TEXT,
    owner TEXT,
    heartbeat_at INTEGER,
    queued_at INTEGER NOT NULL,
    started_at INTEGER,
    finished_at INTEGER,
    wall_ms INTEGER,
    subject_id INTEGER NOT NULL REFERENCES subject,
    style_id INTEGER NOT NULL REFERENCES style,
    size_id INTEGER NOT NULL REFERENCES size,
    fabric_id INTEGER NOT NULL REFERENCES fabric,
    UNIQUE (study_id, garment, size, subject, simulator, repeat, input_hash),
    CHECK ((status = 'running') = (owner IS NOT NULL)),
    CHECK (status <> 'running' OR heartbeat_at IS NOT NULL)
) STRICT;

CREATE UNIQUE INDEX job_current ON job (study_id, garment, size, subject, simulator, repeat) WHERE is_current;
CREATE INDEX job_status ON job (status, priority);

-- Every leaf value a job depends on, by name: what a cache miss is explained from.
CREATE TABLE job_input (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (job_id, name)
) STRICT, WITHOUT ROWID;

-- Where a running job stands; rewritten a few times a second by the process that runs it.
CREATE TABLE job_progress (
    job_id INTEGER PRIMARY KEY REFERENCES job ON DELETE CASCADE,
    phase TEXT NOT NULL,
    fraction REAL NOT NULL,
    iteration INTEGER NOT NULL,
    level INTEGER NOT NULL,
    residual REAL,
    seam_gap_mm REAL,
    e_chi REAL,
    updated_at INTEGER NOT NULL
) STRICT;

CREATE TABLE job_log (
    log_id INTEGER PRIMARY KEY,
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    at INTEGER NOT NULL,
    level TEXT NOT NULL CHECK (level IN ('info', 'warn', 'error')),
    text TEXT NOT NULL
) STRICT;

CREATE INDEX job_log_job ON job_log (job_id);

CREATE TABLE chi (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    stage TEXT NOT NULL CHECK (stage IN ('sewn', 'popup', 'drape')),
    measurement_no INTEGER NOT NULL,
    measurement TEXT NOT NULL,
    kind TEXT NOT NULL CHECK (kind IN ('closed_girth', 'open_length')),
    is_free_edge INTEGER NOT NULL,
    is_controlled INTEGER NOT NULL,
    l2d_mm REAL NOT NULL,
    l3d_mm REAL NOT NULL,
    PRIMARY KEY (job_id, stage, measurement_no)
) STRICT, WITHOUT ROWID;

CREATE TABLE metrics (
    job_id INTEGER PRIMARY KEY REFERENCES job ON DELETE CASCADE,
    n INTEGER NOT NULL,
    e_chi REAL NOT NULL,
    sd_chi REAL NOT NULL,
    ei REAL NOT NULL,
    max_abs_error REAL NOT NULL,
    vertices INTEGER NOT NULL,
    faces INTEGER NOT NULL,
    iterations INTEGER NOT NULL,
    residual REAL NOT NULL,
    converged INTEGER NOT NULL,
    penetration_max_mm REAL NOT NULL,
    seam_gap_max_mm REAL NOT NULL,
    self_crossings INTEGER NOT NULL
) STRICT;

CREATE TABLE history (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    step INTEGER NOT NULL,
    iteration INTEGER NOT NULL,
    level INTEGER NOT NULL,
    residual REAL,
    seam_gap_mm REAL,
    e_chi REAL,
    PRIMARY KEY (job_id, step)
) STRICT, WITHOUT ROWID;

-- Ease needs a pattern and a body, no simulation: it belongs to the study.
CREATE TABLE ease (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    size TEXT NOT NULL,
    subject TEXT NOT NULL,
    level TEXT NOT NULL,
    pattern_girth_mm REAL NOT NULL,
    body_girth_mm REAL NOT NULL,
    PRIMARY KEY (study_id, garment, size, subject, level)
) STRICT, WITHOUT ROWID;

-- What the stages made, by the hash of everything it was made from.
CREATE TABLE artefact (
    hash TEXT PRIMARY KEY,
    kind TEXT NOT NULL CHECK (kind IN ('body', 'field', 'mesh', 'drape')),
    bytes BLOB NOT NULL,
    created_at INTEGER NOT NULL
) STRICT;

CREATE TABLE job_artefact (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    kind TEXT NOT NULL,
    hash TEXT NOT NULL REFERENCES artefact,
    was_cached INTEGER NOT NULL,
    PRIMARY KEY (job_id, kind)
) STRICT, WITHOUT ROWID;

CREATE TABLE provenance (
    job_id INTEGER PRIMARY KEY REFERENCES job ON DELETE CASCADE,
    program_version TEXT NOT NULL,
    git_commit TEXT,
    git_dirty INTEGER,
    machine TEXT NOT NULL,
    seed INTEGER NOT NULL
) STRICT;
