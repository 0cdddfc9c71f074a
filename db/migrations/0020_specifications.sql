-- The specification sheet of a style, as a buyer wrote it, with the answers to what was asked about its rows.
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

-- Lengths of the flat pattern of a revision at the points of its sheet.
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
