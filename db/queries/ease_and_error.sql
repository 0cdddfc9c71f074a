-- EI against the ease that decides the fit class.
SELECT m.study, m.garment, m.size, m.subject, m.simulator, e.level, round(e.ease_mm, 1) AS ease_mm, e.fit_class,
    round(m.ei, 4) AS ei, m.converged
FROM v_metrics AS m JOIN v_ease AS e USING (study, garment, size, subject)
WHERE e.decides
ORDER BY e.ease_mm;
