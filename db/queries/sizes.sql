-- Which size fits whom: of each garment the size whose ease is nearest the middle of a just fit, undersized ones last.
SELECT study, garment, subject, size, level, round(ease_mm, 1) AS ease_mm, fit_class, undersized
FROM (
    SELECT *, row_number() OVER (
        PARTITION BY study, garment, subject ORDER BY undersized, abs(ease_mm - 75), size) AS place
    FROM v_ease WHERE decides
)
WHERE place = 1
ORDER BY study, garment, size, subject;
