-- The thesis's experiment 4.4.2: chi of three lengths by the offset and the bend of the pieces before sewing, ours beside
-- the printed ones (Table 4-1). Its flat pieces (0 degrees) are an arc of one degree here.
WITH swept AS (
    SELECT study, garment, mu.value AS mu, bend.value AS bend_deg, iif(bend.value < 5, 0, bend.value) AS printed_deg
    FROM v_sweep AS mu JOIN v_sweep AS bend USING (study, garment)
    WHERE mu.parameter = 'fem.offset_mu' AND bend.parameter = 'fem.bend_angle_deg'
)
SELECT swept.bend_deg, swept.mu, theirs.measurement, round(ours.chi, 4) AS chi, theirs.chi AS chi_thesis,
    round(ours.chi - theirs.chi, 4) AS difference, converged, iterations, round(residual, 4) AS residual
FROM swept
    JOIN v_chi AS ours USING (study, garment)
    JOIN v_metrics USING (job_id)
    JOIN published_preposition AS theirs ON theirs.bend_deg = printed_deg AND theirs.offset_printed = swept.mu
        AND theirs.measurement = CASE ours.measurement_no
            WHEN 1 THEN 'hem-level girth' WHEN 3 THEN 'center-front length' WHEN 4 THEN 'center-back length' END
WHERE ours.simulator = 'fem'
ORDER BY theirs.measurement, swept.bend_deg DESC, swept.mu DESC;
