-- Rounds of fitting of a garment on a subject, and the comments of a fitting. A comment that was made from a measured
-- `quantity` is met in the round that no longer measures it; a later round words it anew unless somebody has (`is_worded`). `basis` tells what a round was measured on.

CREATE TABLE fit_round (
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    subject TEXT NOT NULL,
    round INTEGER NOT NULL,
    size TEXT NOT NULL,
    basis TEXT NOT NULL,
    made_at INTEGER NOT NULL,
    signed_by TEXT,
    signed_at INTEGER,
    PRIMARY KEY (study_id, garment, subject, round)
) STRICT, WITHOUT ROWID;

CREATE TABLE fit_comment (
    comment_id INTEGER PRIMARY KEY,
    study_id INTEGER NOT NULL REFERENCES study,
    garment TEXT NOT NULL,
    subject TEXT NOT NULL,
    round INTEGER NOT NULL,
    number INTEGER NOT NULL,
    side TEXT NOT NULL CHECK (side IN ('front', 'side', 'back')),
    place TEXT NOT NULL,
    said TEXT NOT NULL,
    severity TEXT NOT NULL CHECK (severity IN ('minor', 'major', 'critical')),
    cause TEXT NOT NULL DEFAULT '',
    action TEXT NOT NULL DEFAULT '',
    quantity TEXT,
    status TEXT NOT NULL DEFAULT 'open' CHECK (status IN ('open', 'met', 'closed')),
    met_in INTEGER,
    owner TEXT NOT NULL DEFAULT '',
    is_worded INTEGER NOT NULL DEFAULT 0,
    changed_at INTEGER NOT NULL,
    UNIQUE (study_id, garment, subject, number)
) STRICT;

CREATE VIEW v_comment AS
SELECT study.name AS study, garment, subject, fit_round.size, round, number, side, place, said, severity, cause, action,
    quantity, status, met_in, owner, signed_by, comment_id
FROM fit_comment JOIN study USING (study_id) JOIN fit_round USING (study_id, garment, subject, round);
