-- What the evidence says: judged by the program whenever a result, an ease or a study changes, kept beside a sum of what it
-- was judged from. The view gives it only while that sum is still the results' own; until it is judged again the rule stands.

CREATE TABLE evidence (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    fit_class TEXT NOT NULL CHECK (fit_class IN ('tight', 'just', 'loose')),
    verdict TEXT NOT NULL CHECK (verdict IN ('fem', 'hybrid', 'no_difference', 'insufficient_evidence')),
    effect REAL,
    ci_low REAL,
    ci_high REAL,
    effect_size REAL,
    p REAL,
    p_holm REAL,
    p_equivalence REAL,
    n_subjects INTEGER NOT NULL,
    reason TEXT NOT NULL,
    would_settle TEXT NOT NULL,
    pairs INTEGER NOT NULL,
    checksum REAL NOT NULL,
    PRIMARY KEY (study_id, garment, fit_class)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_evidence_basis AS
SELECT name AS study, count(garment) AS pairs, total(d_ei) + total(ease_mm) AS checksum
FROM study LEFT JOIN v_pair ON v_pair.study = study.name
GROUP BY study_id;

DROP VIEW v_recommendation;

CREATE VIEW v_recommendation AS
WITH present AS (
    SELECT study, garment, fit_class, CASE fit_class WHEN 'loose' THEN 'fem' ELSE 'hybrid' END AS rule_says
    FROM v_ease WHERE decides GROUP BY study, garment, fit_class
),
judged AS (
    SELECT study, evidence.*
    FROM evidence JOIN (SELECT study_id, name AS study FROM study) USING (study_id) JOIN v_evidence_basis AS basis USING (study)
    WHERE evidence.pairs = basis.pairs AND abs(evidence.checksum - basis.checksum) < 1e-6
)
SELECT study, garment, fit_class,
    iif(verdict IN ('fem', 'hybrid'), verdict, rule_says) AS recommended,
    iif(verdict IN ('fem', 'hybrid'), 'evidence', 'rule') AS basis,
    coalesce(verdict, 'insufficient_evidence') AS verdict,
    rule_says, effect, ci_low, ci_high, coalesce(n_subjects, 0) AS n_subjects,
    coalesce(reason, 'Not judged since the results changed; the rule stands.') AS reason,
    effect_size, p, p_holm, p_equivalence,
    coalesce(would_settle, '`toile recommend` judges them.') AS would_settle
FROM present LEFT JOIN judged USING (study, garment, fit_class);
