-- What jobs may take and what they wait for; and what a database made before this version was released may lack.

ALTER TABLE job ADD COLUMN time_limit_s REAL;
ALTER TABLE job ADD COLUMN memory_limit_mb INTEGER;

-- A job is not started before those it needs have results.
CREATE TABLE job_need (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    needs INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    PRIMARY KEY (job_id, needs)
) STRICT, WITHOUT ROWID;

CREATE INDEX job_need_needs ON job_need (needs);

-- One measurement of all results, found without looking at the others.
CREATE INDEX chi_measurement ON chi (measurement_no);

DROP VIEW v_jobs;
CREATE VIEW v_jobs AS
SELECT job_id, study.name AS study, garment, size, subject, simulator, repeat, status, attempts, error,
    strftime('%Y-%m-%dT%H:%M:%fZ', queued_at / 1000.0, 'unixepoch') AS queued_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', started_at / 1000.0, 'unixepoch') AS started_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', finished_at / 1000.0, 'unixepoch') AS finished_at,
    wall_ms, priority, is_current, phase, fraction, time_limit_s, memory_limit_mb,
    (SELECT count(*) FROM job_need JOIN job AS needed ON needed.job_id = needs
        WHERE job_need.job_id = job.job_id AND needed.status IN ('queued', 'running')) AS waits_for
FROM job JOIN study USING (study_id) LEFT JOIN job_progress USING (job_id);

-- Databases of the first days have no count of crossings: their results get none. Within the bracket the name is the
-- column of `metrics` where there is one, else that of `unknown`.
CREATE TEMP TABLE kept AS
SELECT job_id, n, e_chi, sd_chi, ei, max_abs_error, vertices, faces, iterations, residual, converged, penetration_max_mm,
    seam_gap_max_mm, (SELECT self_crossings FROM metrics AS own WHERE own.job_id = result.job_id) AS self_crossings
FROM metrics AS result JOIN (SELECT NULL AS self_crossings) AS unknown;

DROP TABLE metrics;
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
) STRICT;
INSERT INTO metrics SELECT * FROM kept;
DROP TABLE kept;

DROP VIEW v_metrics;
CREATE VIEW v_metrics AS
SELECT study.name AS study, garment, size, subject, simulator, n, e_chi, sd_chi, ei, max_abs_error, vertices, faces,
    iterations, residual, converged, penetration_max_mm, seam_gap_max_mm, wall_ms, repeat, self_crossings, job_id
FROM metrics JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

CREATE TABLE IF NOT EXISTS study_report (
    study_id INTEGER PRIMARY KEY REFERENCES study,
    page TEXT NOT NULL,
    written_at INTEGER NOT NULL
) STRICT;
