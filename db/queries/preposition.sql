-- The thesis's experiment 4.4.2: chi of three lengths by the offset d and the bend of the pieces before sewing, ours beside
-- the printed ones (Table 4-1). Its four offsets are those of the study in order; its flat pieces (0 degrees) are an arc of
-- one degree here.
WITH swept AS (
    SELECT study, garment, mu.value AS mu, iif(bend.value < 5, 0, bend.value) AS bend_deg,
        dense_rank() OVER (PARTITION BY study ORDER BY mu.value DESC) AS place
    FROM v_sweep AS mu JOIN v_sweep AS bend USING (study, garment)
    WHERE mu.parameter = 'fem.offset_mu' AND bend.parameter = 'fem.bend_angle_deg'
),
theirs AS (
    SELECT bend_deg, offset_printed AS d, measurement, chi, dense_rank() OVER (ORDER BY offset_printed DESC) AS place
    FROM published_preposition
)
SELECT bend_deg, d, swept.mu, theirs.measurement, round(ours.chi, 4) AS chi, theirs.chi AS chi_thesis,
    round(ours.chi - theirs.chi, 4) AS difference, converged, iterations, round(residual, 4) AS residual
FROM swept
    JOIN v_chi AS ours USING (study, garment)
    JOIN v_metrics USING (job_id)
    JOIN theirs USING (place, bend_deg)
WHERE ours.simulator = 'fem' AND theirs.measurement = CASE ours.measurement_no
    WHEN 1 THEN 'hem-level girth' WHEN 3 THEN 'center-front length' WHEN 4 THEN 'center-back length' END
ORDER BY theirs.measurement, bend_deg DESC, d DESC;
