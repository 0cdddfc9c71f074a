-- In what a subject departs from the standard body of its measurements: `flat_seat=18 round_back=10`.
ALTER TABLE subject ADD COLUMN figure TEXT;

DROP VIEW v_subjects;
CREATE VIEW v_subjects AS
SELECT name AS subject, subject.revision, sex, stature_mm, weight_kg, chest_girth_mm, waist_girth_mm, hip_girth_mm,
    neck_girth_mm, across_shoulder_mm, underbust_girth_mm, thigh_girth_mm, knee_girth_mm, calf_girth_mm,
    ankle_girth_mm, upper_arm_girth_mm, forearm_girth_mm, wrist_girth_mm, inseam_mm, arm_length_mm, foot_length_mm,
    hash, subject.revision = entry.revision AS is_latest, is_retired, scan.file AS scan, pose, figure
FROM subject JOIN catalogue_entry AS entry USING (name) LEFT JOIN scan USING (subject_id) WHERE part = 'subject';
