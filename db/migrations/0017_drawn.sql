-- What a movement of the body does to the openings of a garment that it carries along: how far each is drawn into the garment, a hem
-- upwards, a cuff towards the shoulder. What went the other way is below 0.
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
