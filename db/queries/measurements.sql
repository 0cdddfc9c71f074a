-- How each measurement fares over all results: centre, spread and the worst case.
SELECT study, garment, simulator, measurement_no, measurement, count(*) AS n, round(median(chi), 4) AS median_chi,
    round(avg(chi), 4) AS mean_chi, round(stddev(chi), 4) AS sd_chi, round(max(abs(chi - 1)), 4) AS worst
FROM v_chi
WHERE stage = 'drape'
GROUP BY 1, 2, 3, 4, 5
ORDER BY 1, 2, 3, worst DESC;
