-- Our E, SD and EI beside the thesis's printed ones, per style, size and simulator: means over the subjects.
WITH ours AS (
    SELECT CASE WHEN garment = 'tshirt' THEN 'male_tshirt' WHEN garment = 'trousers' THEN 'male_trousers'
            WHEN garment = 'teetop' THEN 'female_teetop' WHEN garment = 'dress' THEN 'female_dress' END AS style,
        lower(size) AS size, simulator, count(*) AS n, avg(e_chi) AS e, avg(sd_chi) AS sd, avg(ei) AS ei,
        count(*) FILTER (WHERE NOT converged) AS not_converged
    FROM v_metrics WHERE study = 'thesis' GROUP BY 1, 2, 3
),
theirs AS (
    -- Recomputed from the printed lengths L3D over L2D; the printed summaries are incomplete (`toile audit thesis`).
    SELECT garment AS style, size, simulator, avg(e) AS e, avg(sd) AS sd, avg(ei) AS ei
    FROM (
        SELECT garment, size, simulator, subject, avg(chi) AS e, stddev(chi) AS sd, avg(abs(chi - 1)) AS ei
        FROM v_published GROUP BY 1, 2, 3, 4
    )
    GROUP BY 1, 2, 3
)
SELECT ours.style, ours.size, ours.simulator, n, not_converged, round(ours.e, 4) AS e, round(theirs.e, 3) AS e_thesis,
    round(ours.sd, 4) AS sd, round(theirs.sd, 3) AS sd_thesis, round(ours.ei, 4) AS ei, round(theirs.ei, 3) AS ei_thesis
FROM ours JOIN theirs USING (style, size, simulator)
ORDER BY ours.style DESC, ours.size DESC, ours.simulator;
