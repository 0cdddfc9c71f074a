-- How a drape sits on its body. Results that were stored before have none of it.

-- Cross sections at the levels of the body that the garment covers.
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

-- Gap from the skin to the first cloth by direction, from the front towards the subject's right.
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

-- Heights of hem and waist edge above the floor, their differences, and how far side seams lean forwards going down.
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

-- Lines in which cloth stands off the skin, the longest first. `from_vertical_deg` is 0 of an upright one; `side_deg` tells where its
-- middle lies, from the front towards the subject's right. A drag line is under tension.
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

-- Pressure of the cloth on a region of the body, over the area that is pressed; `most_kpa` is exceeded by 1 % of it.
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
