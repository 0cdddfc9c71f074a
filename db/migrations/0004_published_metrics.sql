-- The rest of the thesis's numbers that an audit needs, as printed (misprints included): E, SD and EI of chapter 6,
-- the summaries of its subjects, and the accuracy of prepositions (Table 4-1).

CREATE TABLE published_metric (
    table_no TEXT NOT NULL,
    garment TEXT NOT NULL,
    size TEXT NOT NULL,
    simulator TEXT NOT NULL,
    metric TEXT NOT NULL,
    by_subject TEXT NOT NULL,
    average REAL NOT NULL,
    PRIMARY KEY (garment, size, simulator, metric)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_published_metrics AS
SELECT table_no, garment, size, simulator, metric, names.value AS subject, numbers.value AS printed, average AS average_printed
FROM published_metric, json_each(by_subject) AS numbers, json_each('["i", "ii", "iii", "iv", "v", "vi"]') AS names
WHERE numbers.key = names.key;

CREATE TABLE published_subjects (
    table_no TEXT NOT NULL,
    captioned TEXT NOT NULL,
    sex TEXT NOT NULL,
    statistic TEXT NOT NULL,
    chest_cm REAL NOT NULL,
    waist_cm REAL NOT NULL,
    hip_cm REAL NOT NULL,
    across_shoulder_cm REAL NOT NULL,
    neck_cm REAL NOT NULL,
    PRIMARY KEY (sex, statistic)
) STRICT, WITHOUT ROWID;

CREATE TABLE published_preposition (
    bend_deg REAL NOT NULL,
    measurement TEXT NOT NULL,
    offset_printed REAL NOT NULL,
    chi REAL NOT NULL,
    PRIMARY KEY (bend_deg, measurement, offset_printed)
) STRICT, WITHOUT ROWID;

INSERT INTO published_metric VALUES
    ('6-7', 'male_tshirt', 's', 'fem', 'E', '[1.076, 1.054, 1.075, 1.056, 1.073, 1.101]', 1.073),
    ('6-10', 'male_tshirt', 'm', 'fem', 'E', '[1.065, 1.049, 1.063, 1.062, 1.07, 1.09]', 1.066),
    ('6-10', 'male_tshirt', 'm', 'fem', 'SD', '[0.117, 0.087, 0.124, 0.109, 0.111, 0.169]', 0.119),
    ('6-10', 'male_tshirt', 'm', 'fem', 'EI', '[0.018, 0.049, 0.063, 0.062, 0.07, 0.115]', 0.063),
    ('6-10', 'male_tshirt', 'm', 'hybrid', 'E', '[1.031, 1.047, 1.025, 1.061, 1.045, 1.033]', 1.04),
    ('6-10', 'male_tshirt', 'm', 'hybrid', 'SD', '[0.047, 0.065, 0.064, 0.043, 0.06, 0.063]', 0.057),
    ('6-10', 'male_tshirt', 'm', 'hybrid', 'EI', '[0.042, 0.058, 0.049, 0.061, 0.048, 0.047]', 0.051),
    ('6-13', 'male_tshirt', 'l', 'fem', 'E', '[1.056, 1.045, 1.056, 1.055, 1.058, 1.075]', 1.057),
    ('6-13', 'male_tshirt', 'l', 'fem', 'SD', '[0.104, 0.077, 0.112, 0.101, 0.099, 0.147]', 0.107),
    ('6-13', 'male_tshirt', 'l', 'fem', 'EI', '[0.013, 0.047, 0.056, 0.056, 0.059, 0.092]', 0.054),
    ('6-13', 'male_tshirt', 'l', 'hybrid', 'E', '[1.004, 1.021, 1.021, 1.028, 1.021, 1.019]', 1.019),
    ('6-13', 'male_tshirt', 'l', 'hybrid', 'SD', '[0.072, 0.074, 0.065, 0.043, 0.041, 0.043]', 0.056),
    ('6-13', 'male_tshirt', 'l', 'hybrid', 'EI', '[0.049, 0.046, 0.051, 0.037, 0.032, 0.038]', 0.042),
    ('6-22', 'male_trousers', 'l', 'fem', 'E', '[1.018, 1.016, 1.009, 1.02, 1.039, 1.039]', 1.023),
    ('6-22', 'male_trousers', 'l', 'fem', 'SD', '[0.024, 0.021, 0.012, 0.049, 0.066, 0.037]', 0.035),
    ('6-22', 'male_trousers', 'l', 'fem', 'EI', '[0.048, 0.017, 0.012, 0.042, 0.047, 0.04]', 0.034),
    ('6-22', 'male_trousers', 'l', 'hybrid', 'E', '[1.033, 1.017, 1.031, 1.035, 1.031, 1.069]', 1.036),
    ('6-25', 'female_teetop', 'm', 'fem', 'E', '[1.028, 1.037, 1.046, 1.047, 1.062, 1.033]', 1.042),
    ('6-25', 'female_teetop', 'm', 'fem', 'SD', '[0.066, 0.077, 0.077, 0.092, 0.115, 0.073]', 0.083),
    ('6-25', 'female_teetop', 'm', 'fem', 'EI', '[0.043, 0.064, 0.057, 0.079, 0.097, 0.06]', 0.067),
    ('6-25', 'female_teetop', 'm', 'hybrid', 'E', '[0.978, 0.983, 1.009, 1.015, 1.03, 1.012]', 1.005),
    ('6-28', 'female_teetop', 'l', 'fem', 'E', '[1.023, 1.006, 1.039, 1.012, 1.061, 1.011]', 1.025),
    ('6-28', 'female_teetop', 'l', 'fem', 'SD', '[0.04, 0.076, 0.061, 0.091, 0.084, 0.062]', 0.069),
    ('6-28', 'female_teetop', 'l', 'fem', 'EI', '[0.013, 0.048, 0.043, 0.068, 0.075, 0.039]', 0.048),
    ('6-28', 'female_teetop', 'l', 'hybrid', 'E', '[1.048, 1.036, 1.038, 1.031, 1.038, 1.052]', 1.041),
    ('6-28', 'female_teetop', 'l', 'hybrid', 'SD', '[0.052, 0.051, 0.057, 0.088, 0.052, 0.082]', 0.064),
    ('6-28', 'female_teetop', 'l', 'hybrid', 'EI', '[0.053, 0.046, 0.044, 0.054, 0.047, 0.054]', 0.05),
    ('6-31', 'female_dress', 'one', 'fem', 'E', '[1.017, 1.017, 1.027, 1.02, 1.02, 1.02]', 1.02),
    ('6-31', 'female_dress', 'one', 'fem', 'SD', '[0.057, 0.071, 0.077, 0.071, 0.065, 0.062]', 0.067),
    ('6-31', 'female_dress', 'one', 'fem', 'EI', '[0.002, 0.01, 0.01, 0.002, 0.01, 0.009]', 0.008),
    ('6-31', 'female_dress', 'one', 'hybrid', 'E', '[0.984, 0.997, 1.006, 1.011, 1.055, 1.03]', 1.014),
    ('6-31', 'female_dress', 'one', 'hybrid', 'SD', '[0.273, 0.078, 0.062, 0.061, 0.074, 0.052]', 0.1),
    ('6-31', 'female_dress', 'one', 'hybrid', 'EI', '[0.521, 0.715, 0.515, 0.51, 0.842, 0.517]', 0.603);

INSERT INTO published_subjects VALUES
    ('6-3', 'male', 'male', 'mean', 93.85, 85.17, 97.08, 44.28, 38.52),
    ('6-3', 'male', 'male', 'sd', 5.26, 3.84, 5.58, 2.31, 1.95),
    ('6-4', 'male', 'female', 'mean', 90.72, 75.58, 96.73, 41.6, 34.28),
    ('6-4', 'male', 'female', 'sd', 6.73, 7.46, 3.98, 2.37, 2.62);

INSERT INTO published_preposition VALUES
    (180, 'hem-level girth', 0.45, 1.012),
    (180, 'hem-level girth', 0.4, 1.006),
    (180, 'hem-level girth', 0.35, 1.011),
    (180, 'hem-level girth', 0.3, 1.009),
    (180, 'center-front length', 0.45, 1.030),
    (180, 'center-front length', 0.4, 1.030),
    (180, 'center-front length', 0.35, 1.028),
    (180, 'center-front length', 0.3, 1.025),
    (180, 'center-back length', 0.45, 1.003),
    (180, 'center-back length', 0.4, 1.001),
    (180, 'center-back length', 0.35, 1.002),
    (180, 'center-back length', 0.3, 1.002),
    (120, 'hem-level girth', 0.45, 1.014),
    (120, 'hem-level girth', 0.4, 1.009),
    (120, 'hem-level girth', 0.35, 1.014),
    (120, 'hem-level girth', 0.3, 1.016),
    (120, 'center-front length', 0.45, 1.040),
    (120, 'center-front length', 0.4, 1.042),
    (120, 'center-front length', 0.35, 1.038),
    (120, 'center-front length', 0.3, 1.033),
    (120, 'center-back length', 0.45, 1.001),
    (120, 'center-back length', 0.4, 0.992),
    (120, 'center-back length', 0.35, 1.012),
    (120, 'center-back length', 0.3, 1.007),
    (0, 'hem-level girth', 0.45, 1.009),
    (0, 'hem-level girth', 0.4, 1.010),
    (0, 'hem-level girth', 0.35, 1.016),
    (0, 'hem-level girth', 0.3, 1.016),
    (0, 'center-front length', 0.45, 1.025),
    (0, 'center-front length', 0.4, 1.025),
    (0, 'center-front length', 0.35, 1.025),
    (0, 'center-front length', 0.3, 1.032),
    (0, 'center-back length', 0.45, 1.002),
    (0, 'center-back length', 0.4, 1.002),
    (0, 'center-back length', 0.35, 1.005),
    (0, 'center-back length', 0.3, 1.004);
