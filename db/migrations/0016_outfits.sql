-- Layers of outfits: which garment is worn under which, the inmost 1. What is worn together has one id.
CREATE VIEW v_outfit AS
SELECT study.name AS study, name.value AS outfit, CAST(layer.value AS INTEGER) AS layer, job.garment, job.size, job.subject,
    job.simulator, repeat, job_id
FROM job JOIN study USING (study_id)
JOIN job_input AS name USING (job_id) JOIN job_input AS layer USING (job_id)
WHERE is_current AND name.name = 'outfit.name' AND layer.name = 'outfit.layer';
