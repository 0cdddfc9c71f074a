-- What the migrations add up to. Written by `TOILE_BLESS=1 cargo test schema_file`.

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
    created_at INTEGER NOT NULL, underbust_girth_mm REAL, thigh_girth_mm REAL, knee_girth_mm REAL, calf_girth_mm REAL, ankle_girth_mm REAL, upper_arm_girth_mm REAL, forearm_girth_mm REAL, wrist_girth_mm REAL, inseam_mm REAL, arm_length_mm REAL, foot_length_mm REAL, pose TEXT, figure TEXT,
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
    created_at INTEGER NOT NULL, stretch_pct REAL, stretched_warp_n_m REAL, stretched_weft_n_m REAL,
    UNIQUE (name, revision),
    UNIQUE (name, hash)
) STRICT;

CREATE TABLE study (
    study_id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    path TEXT NOT NULL,
    tight_below_mm REAL NOT NULL,
    loose_above_mm REAL NOT NULL,
    paused INTEGER NOT NULL DEFAULT 0,
    updated_at INTEGER NOT NULL
) STRICT;

CREATE TABLE study_axis (
    study_id INTEGER NOT NULL REFERENCES study,
    axis TEXT NOT NULL CHECK (axis IN ('garment', 'size', 'subject')),
    name TEXT NOT NULL,
    position INTEGER NOT NULL,
    PRIMARY KEY (study_id, axis, name)
) STRICT, WITHOUT ROWID;

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
    fabric_id INTEGER NOT NULL REFERENCES fabric, time_limit_s REAL, memory_limit_mb INTEGER,
    UNIQUE (study_id, garment, size, subject, simulator, repeat, input_hash),
    CHECK ((status = 'running') = (owner IS NOT NULL)),
    CHECK (status <> 'running' OR heartbeat_at IS NOT NULL)
) STRICT;

CREATE UNIQUE INDEX job_current ON job (study_id, garment, size, subject, simulator, repeat) WHERE is_current;

CREATE INDEX job_status ON job (status, priority);

CREATE TABLE job_input (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (job_id, name)
) STRICT, WITHOUT ROWID;

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

CREATE TABLE ease (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    size TEXT NOT NULL,
    subject TEXT NOT NULL,
    level TEXT NOT NULL,
    pattern_girth_mm REAL NOT NULL,
    body_girth_mm REAL NOT NULL, is_held INTEGER NOT NULL DEFAULT 1,
    PRIMARY KEY (study_id, garment, size, subject, level)
) STRICT, WITHOUT ROWID;

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

CREATE VIEW v_chi AS
SELECT study.name AS study, garment, size, subject, simulator, stage, measurement_no, measurement, kind,
    is_free_edge, is_controlled, l2d_mm, l3d_mm, l3d_mm / l2d_mm AS chi, repeat, job_id
FROM chi JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE VIEW v_pair AS
WITH ei AS (
    SELECT study, garment, size, subject,
        avg(ei) FILTER (WHERE simulator = 'fem') AS ei_fem,
        avg(ei) FILTER (WHERE simulator = 'hybrid') AS ei_hybrid
    FROM v_metrics
    WHERE converged
    GROUP BY study, garment, size, subject
)
SELECT ei.study, ei.garment, ei.size, ei.subject, fit_class, ease_mm, ei_fem, ei_hybrid, ei_fem - ei_hybrid AS d_ei
FROM ei JOIN v_ease USING (study, garment, size, subject)
WHERE decides AND ei_fem IS NOT NULL AND ei_hybrid IS NOT NULL;

CREATE VIEW v_provenance AS
SELECT job_id, study.name AS study, garment, size, job.subject, simulator, repeat, input_hash,
    subject.hash AS subject_hash, style.hash AS style_hash, size.hash AS pattern_hash, fabric.hash AS fabric_hash,
    (SELECT hash FROM job_artefact WHERE job_artefact.job_id = job.job_id AND kind = 'body') AS body_hash,
    (SELECT hash FROM job_artefact WHERE job_artefact.job_id = job.job_id AND kind = 'field') AS field_hash,
    (SELECT hash FROM job_artefact WHERE job_artefact.job_id = job.job_id AND kind = 'mesh') AS mesh_hash,
    (SELECT hash FROM job_artefact WHERE job_artefact.job_id = job.job_id AND kind = 'drape') AS drape_hash,
    program_version, git_commit, git_dirty, machine, seed
FROM provenance JOIN job USING (job_id) JOIN study USING (study_id) JOIN subject USING (subject_id)
    JOIN style USING (style_id) JOIN size USING (size_id) JOIN fabric USING (fabric_id);

CREATE TABLE published (
    table_no TEXT NOT NULL,
    garment TEXT NOT NULL,
    size TEXT NOT NULL,
    simulator TEXT NOT NULL,
    measurement_no INTEGER NOT NULL,
    measurement TEXT NOT NULL,
    l2d_mm REAL NOT NULL,
    l3d_mm TEXT NOT NULL,
    chi TEXT NOT NULL,
    chi_mean REAL NOT NULL,
    chi_sd REAL NOT NULL,
    PRIMARY KEY (garment, size, simulator, measurement_no)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_published AS
SELECT table_no, garment, size, names.value AS subject, simulator, measurement_no, measurement, l2d_mm,
    lengths.value AS l3d_mm, ratios.value AS chi_printed, lengths.value / l2d_mm AS chi,
    chi_mean AS chi_mean_printed, chi_sd AS chi_sd_printed
FROM published, json_each(l3d_mm) AS lengths, json_each(chi) AS ratios,
    json_each('["i", "ii", "iii", "iv", "v", "vi"]') AS names
WHERE lengths.key = ratios.key AND lengths.key = names.key;

CREATE TABLE published_metric (
    table_no TEXT NOT NULL,
    garment TEXT NOT NULL,
    size TEXT NOT NULL,
    simulator TEXT NOT NULL,
    metric TEXT NOT NULL,
    by_subject TEXT NOT NULL,
    average REAL NOT NULL,
    PRIMARY KEY (garment, size, simulator, metric)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_published_metrics AS
SELECT table_no, garment, size, simulator, metric, names.value AS subject, numbers.value AS printed, average AS average_printed
FROM published_metric, json_each(by_subject) AS numbers, json_each('["i", "ii", "iii", "iv", "v", "vi"]') AS names
WHERE numbers.key = names.key;

CREATE TABLE published_subjects (
    table_no TEXT NOT NULL,
    captioned TEXT NOT NULL,
    sex TEXT NOT NULL,
    statistic TEXT NOT NULL,
    chest_cm REAL NOT NULL,
    waist_cm REAL NOT NULL,
    hip_cm REAL NOT NULL,
    across_shoulder_cm REAL NOT NULL,
    neck_cm REAL NOT NULL,
    PRIMARY KEY (sex, statistic)
) STRICT, WITHOUT ROWID;

CREATE TABLE published_preposition (
    bend_deg REAL NOT NULL,
    measurement TEXT NOT NULL,
    offset_printed REAL NOT NULL,
    chi REAL NOT NULL,
    PRIMARY KEY (bend_deg, measurement, offset_printed)
) STRICT, WITHOUT ROWID;

CREATE TABLE catalogue_entry (
    part TEXT NOT NULL CHECK (part IN ('subject', 'style', 'size', 'fabric')),
    name TEXT NOT NULL,
    revision INTEGER NOT NULL,
    is_own INTEGER NOT NULL,
    is_retired INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY (part, name)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_styles AS
SELECT name AS style, style.revision, seam_file, hash, style.revision = entry.revision AS is_latest,
    (SELECT count(DISTINCT size.name) FROM size WHERE size.style = style.name) AS sizes, is_retired
FROM style JOIN catalogue_entry AS entry USING (name) WHERE part = 'style';

CREATE VIEW v_sizes AS
SELECT style, size.name AS size, size.revision, pattern_file, unit, length(pattern) AS bytes, hash,
    size.revision = entry.revision AS is_latest, is_retired
FROM size JOIN catalogue_entry AS entry ON entry.name = size.style || '/' || size.name WHERE part = 'size';

CREATE VIEW v_fabrics AS
SELECT name AS fabric, fabric.revision, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m,
    membrane_coupling_n_m, shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source, hash,
    fabric.revision = entry.revision AS is_latest, is_retired, stretch_pct, stretched_warp_n_m, stretched_weft_n_m
FROM fabric JOIN catalogue_entry AS entry USING (name) WHERE part = 'fabric';

CREATE TABLE gap (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    level TEXT NOT NULL,
    -- Where the garment was measured; the level itself may lie at an armhole.
    height_mm REAL NOT NULL,
    body_girth_mm REAL NOT NULL,
    garment_girth_mm REAL NOT NULL,
    PRIMARY KEY (job_id, level)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_gap AS
SELECT study.name AS study, garment, size, subject, simulator, level, height_mm, body_girth_mm, garment_girth_mm,
    body_girth_mm - garment_girth_mm AS shortfall_mm, repeat, job_id
FROM gap JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE TABLE study_sweep (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    style TEXT NOT NULL,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (study_id, garment, name)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_sweep AS
SELECT study.name AS study, garment, style, study_sweep.name AS parameter,
    CASE WHEN json_valid(value) AND json_type(value) IN ('integer', 'real') THEN value + 0 ELSE value END AS value
FROM study_sweep JOIN study USING (study_id);

CREATE VIEW v_inputs AS
SELECT job_id, study.name AS study, garment, size, subject, simulator, repeat, job_input.name AS input, value
FROM job_input JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE INDEX job_queue ON job (status, priority DESC, job_id) WHERE is_current;

CREATE TABLE built_in (hash TEXT PRIMARY KEY) STRICT, WITHOUT ROWID;

CREATE TABLE study_report (
    study_id INTEGER PRIMARY KEY REFERENCES study,
    page TEXT NOT NULL,
    written_at INTEGER NOT NULL
) STRICT;

CREATE TABLE evidence (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    fit_class TEXT NOT NULL CHECK (fit_class IN ('tight', 'just', 'loose')),
    verdict TEXT NOT NULL CHECK (verdict IN ('fem', 'hybrid', 'no_difference', 'insufficient_evidence')),
    effect REAL,
    ci_low REAL,
    ci_high REAL,
    effect_size REAL,
    p REAL,
    p_holm REAL,
    p_equivalence REAL,
    n_subjects INTEGER NOT NULL,
    reason TEXT NOT NULL,
    would_settle TEXT NOT NULL,
    pairs INTEGER NOT NULL,
    checksum REAL NOT NULL,
    PRIMARY KEY (study_id, garment, fit_class)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_evidence_basis AS
SELECT name AS study, count(garment) AS pairs, total(d_ei) + total(ease_mm) AS checksum
FROM study LEFT JOIN v_pair ON v_pair.study = study.name
GROUP BY study_id;

CREATE VIEW v_recommendation AS
WITH present AS (
    SELECT study, garment, fit_class, CASE fit_class WHEN 'loose' THEN 'fem' ELSE 'hybrid' END AS rule_says
    FROM v_ease WHERE decides GROUP BY study, garment, fit_class
),
judged AS (
    SELECT study, evidence.*
    FROM evidence JOIN (SELECT study_id, name AS study FROM study) USING (study_id) JOIN v_evidence_basis AS basis USING (study)
    WHERE evidence.pairs = basis.pairs AND abs(evidence.checksum - basis.checksum) < 1e-6
)
SELECT study, garment, fit_class,
    iif(verdict IN ('fem', 'hybrid'), verdict, rule_says) AS recommended,
    iif(verdict IN ('fem', 'hybrid'), 'evidence', 'rule') AS basis,
    coalesce(verdict, 'insufficient_evidence') AS verdict,
    rule_says, effect, ci_low, ci_high, coalesce(n_subjects, 0) AS n_subjects,
    coalesce(reason, 'Not judged since the results changed; the rule stands.') AS reason,
    effect_size, p, p_holm, p_equivalence,
    coalesce(would_settle, '`toile recommend` judges them.') AS would_settle
FROM present LEFT JOIN judged USING (study, garment, fit_class);

CREATE TABLE job_need (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    needs INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    PRIMARY KEY (job_id, needs)
) STRICT, WITHOUT ROWID;

CREATE INDEX job_need_needs ON job_need (needs);

CREATE INDEX chi_measurement ON chi (measurement_no);

CREATE VIEW v_jobs AS
SELECT job_id, study.name AS study, garment, size, subject, simulator, repeat, status, attempts, error,
    strftime('%Y-%m-%dT%H:%M:%fZ', queued_at / 1000.0, 'unixepoch') AS queued_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', started_at / 1000.0, 'unixepoch') AS started_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', finished_at / 1000.0, 'unixepoch') AS finished_at,
    wall_ms, priority, is_current, phase, fraction, time_limit_s, memory_limit_mb,
    (SELECT count(*) FROM job_need JOIN job AS needed ON needed.job_id = needs
        WHERE job_need.job_id = job.job_id AND needed.status IN ('queued', 'running')) AS waits_for
FROM job JOIN study USING (study_id) LEFT JOIN job_progress USING (job_id);

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
    self_crossings INTEGER
, distortion REAL) STRICT;

CREATE VIEW v_metrics AS
SELECT study.name AS study, garment, size, subject, simulator, n, e_chi, sd_chi, ei, max_abs_error, vertices, faces,
    iterations, residual, converged, penetration_max_mm, seam_gap_max_mm, wall_ms, repeat, self_crossings, distortion, job_id
FROM metrics JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE VIEW v_ease AS
WITH eased AS (
    SELECT study.name AS study, garment, size, subject, level, pattern_girth_mm, body_girth_mm,
        pattern_girth_mm - body_girth_mm AS ease_mm, tight_below_mm, loose_above_mm,
        level IN ('chest', 'bust', 'hip') AS is_class_level
    FROM ease JOIN study USING (study_id)
), ranked AS (
    SELECT *, min(ease_mm) FILTER (WHERE is_class_level) OVER fitted AS least_class_mm, min(ease_mm) OVER fitted AS least_mm
    FROM eased
    WINDOW fitted AS (PARTITION BY study, garment, size, subject)
)
SELECT study, garment, size, subject, level, pattern_girth_mm, body_girth_mm, ease_mm,
    CASE WHEN ease_mm < tight_below_mm THEN 'tight' WHEN ease_mm > loose_above_mm THEN 'loose' ELSE 'just' END AS fit_class,
    ease_mm < 0 AS undersized,
    (ease_mm >= tight_below_mm - 10 AND ease_mm < tight_below_mm)
        OR (ease_mm > loose_above_mm AND ease_mm <= loose_above_mm + 20) AS borderline,
    CASE WHEN least_class_mm IS NULL THEN ease_mm = least_mm ELSE is_class_level AND ease_mm = least_class_mm END AS decides
FROM ranked;

CREATE TABLE pom (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    position INTEGER NOT NULL,
    point TEXT NOT NULL,
    flat_mm REAL NOT NULL,
    -- Empty of a distance across no cloth.
    draped_mm REAL,
    PRIMARY KEY (job_id, point)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_pom AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, point, flat_mm,
    flat_mm - lag(flat_mm) OVER (
        PARTITION BY job.study_id, job.garment, job.subject, job.simulator, job.repeat, point
        ORDER BY axis.position
    ) AS step_mm,
    draped_mm, pom.position, repeat, job_id
FROM pom JOIN job USING (job_id) JOIN study USING (study_id)
    LEFT JOIN study_axis AS axis ON axis.study_id = job.study_id AND axis.axis = 'size' AND axis.name = job.size
WHERE is_current;

CREATE TABLE fit_target (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    level TEXT NOT NULL,
    is_top INTEGER NOT NULL,
    intended TEXT NOT NULL CHECK (intended IN ('compression', 'slim', 'regular', 'loose')),
    least_mm REAL NOT NULL,
    most_mm REAL NOT NULL, is_firm INTEGER NOT NULL DEFAULT 0, must_close INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY (study_id, garment, level, is_top)
) STRICT, WITHOUT ROWID;

CREATE TABLE section (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    level TEXT NOT NULL,
    height_mm REAL NOT NULL,
    -- What a tape reads of trunk or limb.
    body_girth_mm REAL NOT NULL,
    -- Length of the cloth's outlines, folds and all.
    cloth_length_mm REAL NOT NULL,
    body_area_cm2 REAL NOT NULL,
    -- Between skin and cloth.
    air_area_cm2 REAL NOT NULL,
    PRIMARY KEY (job_id, level)
) STRICT, WITHOUT ROWID;

CREATE TABLE section_gap (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    level TEXT NOT NULL,
    angle_deg REAL NOT NULL,
    -- Below 0 where cloth lies inside the body, empty where there is none.
    gap_mm REAL,
    PRIMARY KEY (job_id, level, angle_deg)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_section AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, level, height_mm, angle_deg, gap_mm, repeat, job_id
FROM section_gap JOIN section USING (job_id, level) JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE VIEW v_section_level AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, level, height_mm, body_girth_mm, cloth_length_mm,
    body_area_cm2, air_area_cm2, mean_gap_mm, least_gap_mm, greatest_gap_mm, repeat, job_id
FROM section
    LEFT JOIN (
        SELECT job_id, level, avg(gap_mm) AS mean_gap_mm, min(gap_mm) AS least_gap_mm, max(gap_mm) AS greatest_gap_mm
        FROM section_gap GROUP BY job_id, level
    ) USING (job_id, level)
    JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE TABLE balance (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    quantity TEXT NOT NULL,
    value REAL NOT NULL,
    unit TEXT NOT NULL CHECK (unit IN ('mm', 'deg')),
    PRIMARY KEY (job_id, quantity)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_balance AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, quantity, value, unit, repeat, job_id
FROM balance JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE TABLE fold (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    number INTEGER NOT NULL,
    kind TEXT NOT NULL CHECK (kind IN ('fold', 'drag_line')),
    length_mm REAL NOT NULL,
    from_vertical_deg REAL NOT NULL,
    height_mm REAL NOT NULL,
    side_deg REAL NOT NULL,
    radius_mm REAL NOT NULL,
    tension_n_m REAL NOT NULL,
    PRIMARY KEY (job_id, number)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_fold AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, number, kind, length_mm, from_vertical_deg, height_mm,
    side_deg, radius_mm, tension_n_m, repeat, job_id
FROM fold JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE TABLE pressure (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    region TEXT NOT NULL,
    area_cm2 REAL NOT NULL,
    mean_kpa REAL NOT NULL,
    most_kpa REAL NOT NULL,
    PRIMARY KEY (job_id, region)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_pressure AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, region, area_cm2, mean_kpa, most_kpa,
    mean_kpa * 7.500616827 AS mean_mmhg, most_kpa * 7.500616827 AS most_mmhg, repeat, job_id
FROM pressure JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE INDEX job_queued ON job (priority DESC, job_id) WHERE status = 'queued' AND is_current;

CREATE TABLE scan (
    subject_id INTEGER PRIMARY KEY REFERENCES subject ON DELETE CASCADE,
    file TEXT NOT NULL,
    unit TEXT,
    mesh BLOB NOT NULL
) STRICT;

CREATE VIEW v_outfit AS
SELECT study.name AS study, name.value AS outfit, CAST(layer.value AS INTEGER) AS layer, job.garment, job.size, job.subject,
    job.simulator, repeat, job_id
FROM job JOIN study USING (study_id)
JOIN job_input AS name USING (job_id) JOIN job_input AS layer USING (job_id)
WHERE is_current AND name.name = 'outfit.name' AND layer.name = 'outfit.layer';

CREATE TABLE drawn (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    opening TEXT NOT NULL,
    mean_mm REAL NOT NULL,
    most_mm REAL NOT NULL,
    PRIMARY KEY (job_id, opening)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_drawn AS
SELECT study.name AS study, job.garment, job.size, job.subject, job.simulator, pose.value AS carried_from, opening,
    mean_mm AS drawn_mm, most_mm AS drawn_most_mm, repeat, job_id
FROM drawn JOIN job USING (job_id) JOIN study USING (study_id) JOIN job_input AS pose USING (job_id)
WHERE is_current AND pose.name = 'carried.from';

CREATE VIEW v_subjects AS
SELECT name AS subject, subject.revision, sex, stature_mm, weight_kg, chest_girth_mm, waist_girth_mm, hip_girth_mm,
    neck_girth_mm, across_shoulder_mm, underbust_girth_mm, thigh_girth_mm, knee_girth_mm, calf_girth_mm,
    ankle_girth_mm, upper_arm_girth_mm, forearm_girth_mm, wrist_girth_mm, inseam_mm, arm_length_mm, foot_length_mm,
    hash, subject.revision = entry.revision AS is_latest, is_retired, scan.file AS scan, pose, figure
FROM subject JOIN catalogue_entry AS entry USING (name) LEFT JOIN scan USING (subject_id) WHERE part = 'subject';

CREATE TABLE spec_sheet (
    style TEXT PRIMARY KEY,
    file TEXT NOT NULL,
    sheet TEXT NOT NULL,
    unit TEXT NOT NULL CHECK (unit IN ('in', 'cm', 'mm')),
    unit_from TEXT NOT NULL,
    bytes BLOB NOT NULL,
    answers TEXT NOT NULL,
    saved_at INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE spec_row (
    style TEXT NOT NULL REFERENCES spec_sheet ON DELETE CASCADE,
    position INTEGER NOT NULL,
    code TEXT NOT NULL,
    description TEXT NOT NULL,
    -- Point of measure, and how many of it were specified: 2 of a girth whose half is the point. Empty without a point.
    point TEXT,
    times REAL NOT NULL,
    matched TEXT NOT NULL CHECK (matched IN ('words', 'lengths', 'answer', 'none', 'asked')),
    minus_mm REAL,
    plus_mm REAL,
    -- Of a row that is asked for: why, and the points that it may be.
    asked TEXT,
    candidates TEXT,
    PRIMARY KEY (style, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE spec_length (
    style TEXT NOT NULL,
    position INTEGER NOT NULL,
    size_position INTEGER NOT NULL,
    size TEXT NOT NULL,
    spec_mm REAL NOT NULL,
    PRIMARY KEY (style, position, size_position),
    FOREIGN KEY (style, position) REFERENCES spec_row ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

CREATE TABLE spec_flat (
    style_id INTEGER NOT NULL REFERENCES style ON DELETE CASCADE,
    size_id INTEGER NOT NULL REFERENCES size ON DELETE CASCADE,
    point TEXT NOT NULL,
    flat_mm REAL NOT NULL,
    PRIMARY KEY (style_id, size_id, point)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_spec AS
WITH made AS (
    SELECT style.name AS style, size.name AS size, style_id, size_id
    FROM size
        JOIN catalogue_entry AS sized ON sized.part = 'size' AND sized.name = size.style || '/' || size.name
            AND sized.revision = size.revision AND NOT sized.is_retired
        JOIN style ON style.name = size.style
        JOIN catalogue_entry AS styled ON styled.part = 'style' AND styled.name = style.name
            AND styled.revision = style.revision AND NOT styled.is_retired
), line AS (
    SELECT spec_row.style, spec_row.position, code, description, spec_row.point AS measure, times, matched, size_position,
        spec_length.size, spec_mm, minus_mm, plus_mm, times * flat_mm AS flat_mm, made.style_id, made.size_id
    FROM spec_row JOIN spec_length USING (style, position)
        LEFT JOIN made ON made.style = spec_row.style AND made.size = spec_length.size
        LEFT JOIN spec_flat ON spec_flat.style_id = made.style_id AND spec_flat.size_id = made.size_id
            AND spec_flat.point = spec_row.point
), stepped AS (
    SELECT *, flat_mm - spec_mm AS deviation_mm,
        iif(size_position = 1 + lag(size_position) OVER sizes, spec_mm - lag(spec_mm) OVER sizes, NULL) AS step_mm,
        iif(size_position = 1 + lag(size_position) OVER sizes, flat_mm - lag(flat_mm) OVER sizes, NULL) AS flat_step_mm
    FROM line
    WINDOW sizes AS (PARTITION BY style, position ORDER BY size_position)
)
SELECT stepped.style, code, description, iif(times = 1, '', printf('%g*', times)) || measure AS point, stepped.size, spec_mm,
    minus_mm, plus_mm, stepped.flat_mm, deviation_mm,
    -- A thousandth of a mm is arithmetic.
    iif(deviation_mm + minus_mm + plus_mm IS NULL, NULL,
        iif(deviation_mm <= plus_mm + 0.001 AND deviation_mm >= -minus_mm - 0.001, 'in', 'out')) AS verdict,
    step_mm, flat_step_mm, times * draped_mm AS worn_mm, matched, study.name AS study, job.garment, job.subject,
    job.simulator, repeat, job.job_id, stepped.position, size_position
FROM stepped
    LEFT JOIN job ON job.style_id = stepped.style_id AND job.size_id = stepped.size_id AND is_current
        AND status IN ('done', 'not_converged')
    LEFT JOIN study USING (study_id)
    LEFT JOIN pom ON pom.job_id = job.job_id AND pom.point = stepped.measure;

CREATE VIEW v_fit AS
WITH tops AS (
    SELECT DISTINCT study_id, garment FROM ease WHERE level IN ('chest', 'bust')
), aimed AS (
    SELECT ease.study_id, study.name AS study, ease.garment, ease.size, ease.subject, ease.level, pattern_girth_mm, body_girth_mm,
        pattern_girth_mm - body_girth_mm AS ease_mm, intended, least_mm, CASE WHEN is_held OR is_firm THEN most_mm END AS most_mm,
        must_close AND pattern_girth_mm < body_girth_mm AS cannot_close
    FROM ease JOIN study USING (study_id)
        LEFT JOIN fit_target AS target ON target.study_id = ease.study_id AND target.garment = ease.garment
            AND target.level = ease.level
            AND target.is_top = ((ease.study_id, ease.garment) IN (SELECT study_id, garment FROM tops))
), off AS (
    SELECT *, CASE WHEN ease_mm < least_mm THEN ease_mm - least_mm WHEN ease_mm > most_mm THEN ease_mm - most_mm
        WHEN least_mm IS NOT NULL THEN 0.0 END AS off_mm
    FROM aimed
)
SELECT study, garment, size, subject, level, pattern_girth_mm, body_girth_mm, ease_mm, intended, least_mm, most_mm, off_mm,
    CASE WHEN cannot_close THEN 'too_small' WHEN off_mm < 0 THEN 'tight' WHEN off_mm > 0 THEN 'loose'
        WHEN off_mm = 0 THEN 'as_meant' END AS verdict,
    CASE WHEN off_mm < 0 THEN -2 * off_mm ELSE off_mm END + CASE WHEN cannot_close THEN 60 ELSE 0 END AS weight_mm
FROM off;

CREATE VIEW v_size AS
WITH worst AS (
    SELECT *, row_number() OVER (
        PARTITION BY study, garment, size, subject ORDER BY weight_mm DESC, level
    ) AS rank
    FROM v_fit WHERE weight_mm IS NOT NULL
), sized AS (
    SELECT worst.study, worst.garment, worst.subject, worst.size, worst.intended, level AS worst_level, off_mm AS worst_off_mm,
        weight_mm, verdict, axis.position
    FROM worst JOIN study ON study.name = worst.study
        LEFT JOIN study_axis AS axis ON axis.study_id = study.study_id AND axis.axis = 'size' AND axis.name = worst.size
    WHERE rank = 1
)
SELECT study, garment, subject, size, intended, worst_level, worst_off_mm, verdict,
    row_number() OVER (PARTITION BY study, garment, subject ORDER BY weight_mm, position) AS place
FROM sized;

CREATE TABLE fit_round (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    subject TEXT NOT NULL,
    round INTEGER NOT NULL,
    size TEXT NOT NULL,
    basis TEXT NOT NULL,
    made_at INTEGER NOT NULL,
    signed_by TEXT,
    signed_at INTEGER,
    PRIMARY KEY (study_id, garment, subject, round)
) STRICT, WITHOUT ROWID;

CREATE TABLE fit_comment (
    comment_id INTEGER PRIMARY KEY,
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    subject TEXT NOT NULL,
    round INTEGER NOT NULL,
    number INTEGER NOT NULL,
    side TEXT NOT NULL CHECK (side IN ('front', 'side', 'back')),
    place TEXT NOT NULL,
    said TEXT NOT NULL,
    severity TEXT NOT NULL CHECK (severity IN ('minor', 'major', 'critical')),
    cause TEXT NOT NULL DEFAULT '',
    action TEXT NOT NULL DEFAULT '',
    quantity TEXT,
    status TEXT NOT NULL DEFAULT 'open' CHECK (status IN ('open', 'met', 'closed')),
    met_in INTEGER,
    owner TEXT NOT NULL DEFAULT '',
    is_worded INTEGER NOT NULL DEFAULT 0,
    changed_at INTEGER NOT NULL,
    UNIQUE (study_id, garment, subject, number)
) STRICT;

CREATE VIEW v_comment AS
SELECT study.name AS study, garment, subject, fit_round.size, round, number, side, place, said, severity, cause, action,
    quantity, status, met_in, owner, signed_by, comment_id
FROM fit_comment JOIN study USING (study_id) JOIN fit_round USING (study_id, garment, subject, round);
