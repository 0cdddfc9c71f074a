//! The screens by their numbers.

/// A screen of the workbench; its number is its key, and 0 that of the tenth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The study as a grid of sizes by subjects.
    Study,
    /// The subjects of the catalogue.
    Subjects,
    /// The styles and sizes of the catalogue, and the seams of one.
    Styles,
    /// Jobs of the study in the queue.
    Jobs,
    /// One result: its measurements and its picture.
    Results,
    /// Several results side by side.
    Compare,
    /// Questions in SQL.
    Sql,
    /// Reports that were built.
    Reports,
    /// The fabrics of the catalogue.
    Fabrics,
    /// The fit of a garment on a subject, size by size.
    Fit,
}

impl Screen {
    /// All screens, in order of their numbers.
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

    /// Its number, which is its key.
    #[must_use]
    pub fn number(self) -> usize {
        (self as usize + 1) % Self::ALL.len()
    }

    /// Name, and a short one for tabs with little room.
    #[must_use]
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
