//! Pieces as drawn, changed as the style that they make: so a changed style can be written with its seam file.
