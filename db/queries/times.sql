-- What the simulations cost: seconds by simulator and size, median and 90th percentile.
SELECT study, garment, size, simulator, count(*) AS n, round(median(wall_ms) / 1000, 1) AS median_s,
    round(quantile(wall_ms, 0.9) / 1000, 1) AS p90_s, round(avg(iterations)) AS iterations
FROM v_metrics
GROUP BY 1, 2, 3, 4
ORDER BY 1, 2, 3, 4;
