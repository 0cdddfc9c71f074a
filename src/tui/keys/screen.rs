//! The screens by their numbers.

/// A screen of the workbench. Its number is its key; 0 is the key of the tenth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// Grid of sizes by subjects.
    Study,
    Subjects,
    /// Styles and sizes of the catalogue, and the seams of one size.
    Styles,
    Jobs,
    /// One result: its measurements and its picture.
    Results,
    Compare,
    Sql,
    Reports,
    Fabrics,
    /// Fit of a garment on a subject, size by size.
    Fit,
}

impl Screen {
    pub const ALL: [Self; 10] = [
        Self::Study,
        Self::Subjects,
        Self::Styles,
        Self::Jobs,
        Self::Results,
        Self::Compare,
        Self::Sql,
        Self::Reports,
        Self::Fabrics,
        Self::Fit,
    ];

    pub fn number(self) -> usize {
        (self as usize + 1) % Self::ALL.len()
    }

    /// Name, and a short name for narrow tabs.
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Self::Study => ["Study", "Stu"],
            Self::Subjects => ["Subjects", "Sub"],
            Self::Styles => ["Styles", "Sty"],
            Self::Jobs => ["Jobs", "Job"],
            Self::Results => ["Results", "Res"],
            Self::Compare => ["Compare", "Cmp"],
            Self::Sql => ["SQL", "SQL"],
            Self::Reports => ["Reports", "Rep"],
            Self::Fabrics => ["Fabrics", "Fab"],
            Self::Fit => ["Fit", "Fit"],
        }
    }
}
