-- Moduli of a knit under stretch: elongation over rest length, and the secant moduli there. Set together, or none.

ALTER TABLE fabric ADD COLUMN stretch REAL;
ALTER TABLE fabric ADD COLUMN stretched_warp_n_m REAL;
ALTER TABLE fabric ADD COLUMN stretched_weft_n_m REAL;

DROP VIEW v_fabrics;
CREATE VIEW v_fabrics AS
SELECT name AS fabric, revision, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m, membrane_coupling_n_m,
    shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source, hash,
    revision = max(revision) OVER (PARTITION BY name) AS is_latest,
    stretch, stretched_warp_n_m, stretched_weft_n_m
FROM fabric;
