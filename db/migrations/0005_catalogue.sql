-- Which revision of each entry of the catalogue is the current one, whether a user or a study made it (the program
-- replaces only its own), and whether it was removed while results still depend on it. A size is named STYLE/SIZE.
CREATE TABLE catalogue_entry (
    part TEXT NOT NULL CHECK (part IN ('subject', 'style', 'size', 'fabric')),
    name TEXT NOT NULL,
    revision INTEGER NOT NULL,
    is_own INTEGER NOT NULL,
    is_retired INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY (part, name)
) STRICT, WITHOUT ROWID;

INSERT INTO catalogue_entry (part, name, revision, is_own)
SELECT 'subject', name, max(revision), max(revision) > 1 FROM subject GROUP BY name
UNION ALL SELECT 'style', name, max(revision), 1 FROM style GROUP BY name
UNION ALL SELECT 'size', style || '/' || name, max(revision), 1 FROM size GROUP BY style, name
UNION ALL SELECT 'fabric', name, max(revision), max(revision) > 1 FROM fabric GROUP BY name;

-- More measurements by which a subject may be known.
ALTER TABLE subject ADD COLUMN underbust_girth_mm REAL;
ALTER TABLE subject ADD COLUMN thigh_girth_mm REAL;
ALTER TABLE subject ADD COLUMN knee_girth_mm REAL;
ALTER TABLE subject ADD COLUMN calf_girth_mm REAL;
ALTER TABLE subject ADD COLUMN ankle_girth_mm REAL;
ALTER TABLE subject ADD COLUMN upper_arm_girth_mm REAL;
ALTER TABLE subject ADD COLUMN forearm_girth_mm REAL;
ALTER TABLE subject ADD COLUMN wrist_girth_mm REAL;
ALTER TABLE subject ADD COLUMN inseam_mm REAL;
ALTER TABLE subject ADD COLUMN arm_length_mm REAL;
ALTER TABLE subject ADD COLUMN foot_length_mm REAL;

DROP VIEW v_subjects;
CREATE VIEW v_subjects AS
SELECT name AS subject, subject.revision, sex, stature_mm, weight_kg, chest_girth_mm, waist_girth_mm, hip_girth_mm,
    neck_girth_mm, across_shoulder_mm, underbust_girth_mm, thigh_girth_mm, knee_girth_mm, calf_girth_mm,
    ankle_girth_mm, upper_arm_girth_mm, forearm_girth_mm, wrist_girth_mm, inseam_mm, arm_length_mm, foot_length_mm,
    hash, subject.revision = entry.revision AS is_latest, is_retired
FROM subject JOIN catalogue_entry AS entry USING (name) WHERE part = 'subject';

DROP VIEW v_styles;
CREATE VIEW v_styles AS
SELECT name AS style, style.revision, seam_file, hash, style.revision = entry.revision AS is_latest,
    (SELECT count(DISTINCT size.name) FROM size WHERE size.style = style.name) AS sizes, is_retired
FROM style JOIN catalogue_entry AS entry USING (name) WHERE part = 'style';

DROP VIEW v_sizes;
CREATE VIEW v_sizes AS
SELECT style, size.name AS size, size.revision, pattern_file, unit, length(pattern) AS bytes, hash,
    size.revision = entry.revision AS is_latest, is_retired
FROM size JOIN catalogue_entry AS entry ON entry.name = size.style || '/' || size.name WHERE part = 'size';

DROP VIEW v_fabrics;
CREATE VIEW v_fabrics AS
SELECT name AS fabric, fabric.revision, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m,
    membrane_coupling_n_m, shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source, hash,
    fabric.revision = entry.revision AS is_latest, is_retired
FROM fabric JOIN catalogue_entry AS entry USING (name) WHERE part = 'fabric';
