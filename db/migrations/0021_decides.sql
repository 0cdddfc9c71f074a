-- Which levels decide: too much ease counts where the cut holds the garment to the body (`is_held`), and where the maker
-- means it (`is_firm`). A closed girth of a fabric that does not stretch (`must_close`) cannot be worn smaller than the
-- body; it counts a grade step more.

ALTER TABLE ease ADD COLUMN is_held INTEGER NOT NULL DEFAULT 1;
ALTER TABLE fit_target ADD COLUMN is_firm INTEGER NOT NULL DEFAULT 0;
ALTER TABLE fit_target ADD COLUMN must_close INTEGER NOT NULL DEFAULT 0;

DROP VIEW v_size;
DROP VIEW v_fit;

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
