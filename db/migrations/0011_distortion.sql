-- FEM-GS: how far the cloth is stretched, principal stretch beyond 1 that 1 % of it exceeds; NULL for other results.

ALTER TABLE metrics ADD COLUMN distortion REAL;

DROP VIEW v_metrics;
CREATE VIEW v_metrics AS
SELECT study.name AS study, garment, size, subject, simulator, n, e_chi, sd_chi, ei, max_abs_error, vertices, faces,
    iterations, residual, converged, penetration_max_mm, seam_gap_max_mm, wall_ms, repeat, self_crossings, distortion, job_id
FROM metrics JOIN job USING (job_id) JOIN study USING (study_id)
WHERE is_current;
