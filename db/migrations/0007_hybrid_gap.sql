-- Where a garment of Hybrid-GS does not close around the body: girths of the draped garment and of the body at a level.

CREATE TABLE gap (
    job_id INTEGER NOT NULL REFERENCES job ON DELETE CASCADE,
    level TEXT NOT NULL,
    -- Where the garment was measured; the level itself may lie at an armhole.
    height_mm REAL NOT NULL,
    body_girth_mm REAL NOT NULL,
    garment_girth_mm REAL NOT NULL,
    PRIMARY KEY (job_id, level)
) STRICT, WITHOUT ROWID;

-- A shortfall below 0 is room left.
CREATE VIEW v_gap AS
SELECT study.name AS study, garment, size, subject, simulator, level, height_mm, body_girth_mm, garment_girth_mm,
    body_girth_mm - garment_girth_mm AS shortfall_mm, repeat, job_id
FROM gap JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;
