-- What wants a look: failed, cancelled and unconverged jobs, and results that are not sound.
SELECT job_id, study, garment, size, subject, simulator, status,
    coalesce(error, iif(seam_gap_max_mm > 0.01, 'seam open by ' || round(seam_gap_max_mm, 2) || ' mm', NULL),
        iif(penetration_max_mm > 1, 'in the body by ' || round(penetration_max_mm, 2) || ' mm', NULL),
        'residual ' || round(residual, 4)) AS why
FROM v_jobs LEFT JOIN v_metrics USING (job_id, study, garment, size, subject, simulator)
WHERE v_jobs.is_current AND (status IN ('failed', 'cancelled', 'not_converged') OR seam_gap_max_mm > 0.01 OR penetration_max_mm > 1)
ORDER BY job_id;
