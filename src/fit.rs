//! Fit (thesis 6.2.3): ease at a level and the fit class it means.
