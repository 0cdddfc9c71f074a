-- Moduli of a knit under stretch: elongation in percent of the rest length, and the secant moduli there. Set together, or none.

ALTER TABLE fabric ADD COLUMN stretch_pct REAL;
ALTER TABLE fabric ADD COLUMN stretched_warp_n_m REAL;
ALTER TABLE fabric ADD COLUMN stretched_weft_n_m REAL;

DROP VIEW v_fabrics;
CREATE VIEW v_fabrics AS
SELECT name AS fabric, fabric.revision, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m,
    membrane_coupling_n_m, shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source, hash,
    fabric.revision = entry.revision AS is_latest, is_retired, stretch_pct, stretched_warp_n_m, stretched_weft_n_m
FROM fabric JOIN catalogue_entry AS entry USING (name) WHERE part = 'fabric';
