-- The views other programs may rely on. Results are those of each cell's current job.

CREATE VIEW v_jobs AS
SELECT job_id, study.name AS study, garment, size, subject, simulator, repeat, status, attempts, error,
    strftime('%Y-%m-%dT%H:%M:%fZ', queued_at / 1000.0, 'unixepoch') AS queued_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', started_at / 1000.0, 'unixepoch') AS started_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', finished_at / 1000.0, 'unixepoch') AS finished_at,
    wall_ms, priority, is_current, phase, fraction
FROM job JOIN study USING (study_id) LEFT JOIN job_progress USING (job_id);

CREATE VIEW v_chi AS
SELECT study.name AS study, garment, size, subject, simulator, stage, measurement_no, measurement, kind,
    is_free_edge, is_controlled, l2d_mm, l3d_mm, l3d_mm / l2d_mm AS chi, repeat, job_id
FROM chi JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE VIEW v_metrics AS
SELECT study.name AS study, garment, size, subject, simulator, n, e_chi, sd_chi, ei, max_abs_error, vertices, faces,
    iterations, residual, converged, penetration_max_mm, seam_gap_max_mm, wall_ms, repeat, self_crossings, job_id
FROM metrics JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE VIEW v_ease AS
WITH eased AS (
    SELECT study.name AS study, garment, size, subject, level, pattern_girth_mm, body_girth_mm,
        pattern_girth_mm - body_girth_mm AS ease_mm, tight_below_mm, loose_above_mm
    FROM ease JOIN study USING (study_id)
)
SELECT study, garment, size, subject, level, pattern_girth_mm, body_girth_mm, ease_mm,
    CASE WHEN ease_mm < tight_below_mm THEN 'tight' WHEN ease_mm > loose_above_mm THEN 'loose' ELSE 'just' END AS fit_class,
    ease_mm < 0 AS undersized,
    (ease_mm >= tight_below_mm - 10 AND ease_mm < tight_below_mm)
        OR (ease_mm > loose_above_mm AND ease_mm <= loose_above_mm + 20) AS borderline,
    ease_mm = min(ease_mm) OVER (PARTITION BY study, garment, size, subject) AS decides
FROM eased;

-- Repeats of one cell are averaged: the subject is the unit.
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

-- The thesis's rule (6.4.2, 6.5), with the paired evidence beside it. No test is applied to the pairs here, so the
-- verdict abstains and the rule stands.
CREATE VIEW v_recommendation AS
WITH present AS (
    SELECT study, garment, fit_class, count(DISTINCT subject) AS subjects
    FROM v_ease WHERE decides GROUP BY study, garment, fit_class
),
by_subject AS (
    SELECT study, garment, fit_class, subject, avg(d_ei) AS d_ei FROM v_pair GROUP BY study, garment, fit_class, subject
),
paired AS (
    SELECT study, garment, fit_class, avg(d_ei) AS effect, count(*) AS n_subjects
    FROM by_subject GROUP BY study, garment, fit_class
)
SELECT study, garment, fit_class, rule_says AS recommended, 'rule' AS basis, 'insufficient_evidence' AS verdict,
    rule_says, effect, CAST(NULL AS REAL) AS ci_low, CAST(NULL AS REAL) AS ci_high,
    coalesce(n_subjects, 0) AS n_subjects,
    CASE WHEN n_subjects IS NULL
        THEN 'No subject has a converged result of both simulators (' || subjects || ' with this fit); the thesis''s rule stands.'
        ELSE n_subjects || ' subject(s) paired; the difference has not been tested, so the thesis''s rule stands.'
    END AS reason
FROM (SELECT *, CASE fit_class WHEN 'loose' THEN 'fem' ELSE 'hybrid' END AS rule_says FROM present)
LEFT JOIN paired USING (study, garment, fit_class);

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

CREATE VIEW v_subjects AS
SELECT name AS subject, revision, sex, stature_mm, weight_kg, chest_girth_mm, waist_girth_mm, hip_girth_mm, neck_girth_mm,
    across_shoulder_mm, hash, revision = max(revision) OVER (PARTITION BY name) AS is_latest
FROM subject;

CREATE VIEW v_styles AS
SELECT name AS style, revision, seam_file, hash, revision = max(revision) OVER (PARTITION BY name) AS is_latest,
    (SELECT count(DISTINCT size.name) FROM size WHERE size.style = style.name) AS sizes
FROM style;

CREATE VIEW v_sizes AS
SELECT style, name AS size, revision, pattern_file, unit, length(pattern) AS bytes, hash,
    revision = max(revision) OVER (PARTITION BY style, name) AS is_latest
FROM size;

CREATE VIEW v_fabrics AS
SELECT name AS fabric, revision, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m, membrane_coupling_n_m,
    shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source, hash,
    revision = max(revision) OVER (PARTITION BY name) AS is_latest
FROM fabric;
