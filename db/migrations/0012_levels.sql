-- Ease is found at more levels than those that the fit class is made for: chest and hip decide, and of a garment that has neither,
-- whatever is least.
DROP VIEW v_ease;
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

-- Points of measure of a result: flat on the pieces, and on the drape.
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

-- Least and greatest ease that a garment is to have at a level; `is_top` where it covers the chest.
CREATE TABLE fit_target (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    level TEXT NOT NULL,
    is_top INTEGER NOT NULL,
    intended TEXT NOT NULL CHECK (intended IN ('compression', 'slim', 'regular', 'loose')),
    least_mm REAL NOT NULL,
    most_mm REAL NOT NULL,
    PRIMARY KEY (study_id, garment, level, is_top)
) STRICT, WITHOUT ROWID;

-- Ease beside the target. `off_mm` is how far it lies outside: negative where too tight. `weight_mm` counts what is too tight double:
-- that cannot be worn.
CREATE VIEW v_fit AS
WITH tops AS (
    SELECT DISTINCT study_id, garment FROM ease WHERE level IN ('chest', 'bust')
), aimed AS (
    SELECT ease.study_id, study.name AS study, ease.garment, ease.size, ease.subject, ease.level, pattern_girth_mm, body_girth_mm,
        pattern_girth_mm - body_girth_mm AS ease_mm, intended, least_mm, most_mm
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
    CASE WHEN off_mm < 0 THEN 'tight' WHEN off_mm > 0 THEN 'loose' WHEN off_mm = 0 THEN 'as_meant' END AS verdict,
    CASE WHEN off_mm < 0 THEN -2 * off_mm ELSE off_mm END AS weight_mm
FROM off;

-- The size to wear has place 1: whose worst level is nearest to its target, and of two alike the smaller.
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
