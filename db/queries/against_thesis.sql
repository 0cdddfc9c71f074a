-- Each measured chi beside the thesis's for the same size, subject, simulator and pattern length (within 0.5 mm).
-- A subject is called as in the thesis (`ii`), or as in the catalogue (`male-ii`).
SELECT ours.study, ours.garment, ours.size, ours.subject, ours.simulator, ours.measurement_no, ours.measurement,
    round(ours.chi, 4) AS chi, round(theirs.chi, 4) AS thesis_chi, theirs.chi_printed AS printed_chi,
    round(ours.chi - theirs.chi, 4) AS difference
FROM v_chi AS ours
JOIN v_published AS theirs ON lower(theirs.size) = lower(ours.size) AND ours.subject IN (theirs.subject, iif(theirs.garment LIKE 'male%', 'male-', 'female-') || theirs.subject)
    AND theirs.simulator = ours.simulator AND theirs.measurement_no = ours.measurement_no
    AND abs(theirs.l2d_mm - ours.l2d_mm) < 0.5
WHERE ours.stage = 'drape'
ORDER BY 1, 2, 3, 4, 5, 6;
