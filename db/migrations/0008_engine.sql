-- What the engine needs beyond a first study: sweeps, jobs handed to other machines, and indices for ten thousand jobs.

-- Names and values that a sweep gave to the garments it made of one style.
CREATE TABLE study_sweep (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    style TEXT NOT NULL,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (study_id, garment, name)
) STRICT, WITHOUT ROWID;

-- Numbers are numbers, so that they can be ordered and compared.
CREATE VIEW v_sweep AS
SELECT study.name AS study, garment, style, study_sweep.name AS parameter,
    CASE WHEN json_valid(value) AND json_type(value) IN ('integer', 'real') THEN value + 0 ELSE value END AS value
FROM study_sweep JOIN study USING (study_id);

-- Every leaf value that each current job was made from.
CREATE VIEW v_inputs AS
SELECT job_id, study.name AS study, garment, size, subject, simulator, repeat, job_input.name AS input, value
FROM job_input JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;

-- The next job of a queue, found without looking at the others.
CREATE INDEX job_queue ON job (status, priority DESC, job_id) WHERE is_current;

-- What the program brought into the catalogue, by the hash of all of it.
CREATE TABLE built_in (hash TEXT PRIMARY KEY) STRICT, WITHOUT ROWID;

-- The page of a study's report as it was last written from this database: while the file is of that time it is that page.
CREATE TABLE study_report (
    study_id INTEGER PRIMARY KEY REFERENCES study,
    page TEXT NOT NULL,
    written_at INTEGER NOT NULL
) STRICT;
