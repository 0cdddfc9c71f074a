//! Comments of fittings, in rounds: what a round of a garment on a subject asked, and in which later round it was met.

use rusqlite::{OptionalExtension, Row, Transaction, params};
use serde::Serialize;

use crate::database::Store;
use crate::error::{Result, StudyError};
use crate::transaction::{now_ms, write};

/// Side from which a comment is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    Front,
    Side,
    Back,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// May stay.
    Minor,
    /// To be mended before the next round.
    Major,
    /// The garment cannot be worn.
    Critical,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// To be done.
    Open,
    /// A later round no longer measures it.
    Met,
    /// Somebody closed it.
    Closed,
}

/// Names of the variants of an enum, in the database and on the command line.
macro_rules! named {
    ($type:ident { $($variant:ident = $name:literal),+ }) => {
        impl $type {
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|one| one.as_str() == name)
            }
        }
    };
}

named!(Side { Front = "front", Side = "side", Back = "back" });
named!(Severity { Minor = "minor", Major = "major", Critical = "critical" });
named!(State { Open = "open", Met = "met", Closed = "closed" });

/// Content of a comment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Remark {
    pub side: Side,
    /// Place on the garment, such as `hip`.
    pub place: String,
    pub said: String,
    pub severity: Severity,
    /// Empty if not known.
    pub cause: String,
    /// Empty if none is known.
    pub action: String,
    /// Measured quantity by which a later round finds it again; `None` for a fitter's own comment.
    pub quantity: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comment {
    pub garment: String,
    pub subject: String,
    pub size: String,
    /// Round that asked first.
    pub round: i64,
    /// Number of the callout, through all rounds of the garment on the subject.
    pub number: i64,
    #[serde(flatten)]
    pub remark: Remark,
    pub status: State,
    pub met_in: Option<i64>,
    /// Empty if nobody is to act.
    pub owner: String,
    /// Person who signed the round off.
    pub signed_by: Option<String>,
    /// True if somebody worded it: later rounds leave its words.
    pub is_worded: bool,
}

/// Last round of a fitting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Round {
    pub garment: String,
    pub subject: String,
    /// Counts from 1.
    pub round: i64,
    pub size: String,
    pub signed_by: Option<String>,
}

/// A garment on a subject, of a study.
#[derive(Clone, Copy, Debug)]
pub struct Fitting<'a> {
    pub study: &'a str,
    pub garment: &'a str,
    pub subject: &'a str,
}

/// Change of a comment. `None` leaves a field as it is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edit {
    pub status: Option<State>,
    pub severity: Option<Severity>,
    pub said: Option<String>,
    pub action: Option<String>,
    pub owner: Option<String>,
    /// True if later rounds leave the words, false if they do not; `None` leaves new words alone, and other words as
    /// they are.
    pub is_worded: Option<bool>,
}

impl Edit {
    /// The change that takes this one of a comment back.
    pub fn before(&self, comment: &Comment) -> Self {
        let remark = &comment.remark;
        Self {
            status: self.status.map(|_| comment.status),
            severity: self.severity.map(|_| remark.severity),
            said: self.said.as_ref().map(|_| remark.said.clone()),
            action: self.action.as_ref().map(|_| remark.action.clone()),
            owner: self.owner.as_ref().map(|_| comment.owner.clone()),
            is_worded: Some(comment.is_worded),
        }
    }
}

/// Sorted by garment, subject and number.
pub fn comments(store: &Store, study: &str) -> Result<Vec<Comment>> {
    let sql =
        "SELECT garment, subject, size, round, number, side, place, said, severity, cause, action, quantity, status,
            met_in, owner, signed_by, (SELECT is_worded FROM fit_comment WHERE comment_id = v_comment.comment_id)
        FROM v_comment WHERE study = ? ORDER BY garment, subject, number";
    let mut statement = store.reader.prepare_cached(sql)?;
    Ok(statement.query_map([study], comment)?.collect::<rusqlite::Result<_>>()?)
}

fn comment(row: &Row<'_>) -> rusqlite::Result<Comment> {
    let text = |column: usize| row.get::<_, String>(column);
    Ok(Comment {
        garment: text(0)?,
        subject: text(1)?,
        size: text(2)?,
        round: row.get(3)?,
        number: row.get(4)?,
        remark: Remark {
            side: Side::named(&text(5)?).unwrap_or(Side::Front),
            place: text(6)?,
            said: text(7)?,
            severity: Severity::named(&text(8)?).unwrap_or(Severity::Minor),
            cause: text(9)?,
            action: text(10)?,
            quantity: row.get(11)?,
        },
        status: State::named(&text(12)?).unwrap_or(State::Open),
        met_in: row.get(13)?,
        owner: text(14)?,
        signed_by: row.get(15)?,
        is_worded: row.get(16)?,
    })
}

/// Last round of each fitting, by garment and subject.
pub fn last_rounds(store: &Store, study: &str) -> Result<Vec<Round>> {
    // The other columns are those of the row with the greatest round.
    let sql = "SELECT garment, subject, max(round), size, signed_by FROM fit_round JOIN study USING (study_id)
        WHERE study.name = ? GROUP BY garment, subject ORDER BY garment, subject";
    let round = |row: &Row<'_>| {
        Ok(Round {
            garment: row.get(0)?,
            subject: row.get(1)?,
            round: row.get(2)?,
            size: row.get(3)?,
            signed_by: row.get(4)?,
        })
    };
    let mut statement = store.reader.prepare_cached(sql)?;
    Ok(statement.query_map([study], round)?.collect::<rusqlite::Result<_>>()?)
}

/// Begins the next round of a fitting with what was measured. An open comment of an earlier round whose quantity is no
/// longer measured is met; one that is measured again has the new words, unless somebody worded it. Returns the number
/// of the round; `None` where `basis` is that of the last round.
pub fn begin_round(
    store: &mut Store,
    fitting: Fitting<'_>,
    size: &str,
    basis: &str,
    found: &[Remark],
) -> Result<Option<i64>> {
    let transaction = write(store.writer()?)?;
    let study_id = study_id(&transaction, fitting.study)?;
    let (garment, subject) = (fitting.garment, fitting.subject);
    let last: Option<(i64, String)> = transaction
        .query_row(
            "SELECT round, basis FROM fit_round WHERE study_id = ? AND garment = ? AND subject = ?
            ORDER BY round DESC LIMIT 1",
            params![study_id, garment, subject],
            |row| Ok((row.get(0)?, row.get(1)?)),
        )
        .optional()?;
    if last.as_ref().is_some_and(|(_, known)| known == basis) {
        return Ok(None);
    }
    let round = last.map_or(1, |(round, _)| round + 1);
    transaction.execute(
        "INSERT INTO fit_round (study_id, garment, subject, round, size, basis, made_at) VALUES (?, ?, ?, ?, ?, ?, ?)",
        params![study_id, garment, subject, round, size, basis, now_ms()],
    )?;
    let open: Vec<(i64, String)> = {
        let sql = "SELECT comment_id, quantity FROM fit_comment
            WHERE study_id = ? AND garment = ? AND subject = ? AND status = 'open' AND quantity IS NOT NULL";
        let mut statement = transaction.prepare(sql)?;
        let rows = statement.query_map(params![study_id, garment, subject], |row| Ok((row.get(0)?, row.get(1)?)))?;
        rows.collect::<rusqlite::Result<_>>()?
    };
    let again = |quantity: &str| found.iter().find(|remark| remark.quantity.as_deref() == Some(quantity));
    for (id, quantity) in &open {
        match again(quantity) {
            Some(remark) => transaction.execute(
                "UPDATE fit_comment SET said = ?, action = ?, changed_at = ? WHERE comment_id = ? AND NOT is_worded",
                params![remark.said, remark.action, now_ms(), id],
            )?,
            None => transaction.execute(
                "UPDATE fit_comment SET status = 'met', met_in = ?, changed_at = ? WHERE comment_id = ?",
                params![round, now_ms(), id],
            )?,
        };
    }
    let is_known =
        |remark: &&Remark| open.iter().any(|(_, quantity)| remark.quantity.as_deref() == Some(quantity.as_str()));
    for remark in found.iter().filter(|remark| !is_known(remark)) {
        insert(&transaction, study_id, fitting, round, remark)?;
    }
    transaction.commit()?;
    Ok(Some(round))
}

/// Adds a fitter's comment to the last round and returns its number. Fails with [`StudyError::NotFound`] before the
/// first round.
pub fn add(store: &mut Store, fitting: Fitting<'_>, remark: &Remark) -> Result<i64> {
    let transaction = write(store.writer()?)?;
    let study_id = study_id(&transaction, fitting.study)?;
    let round = last_round(&transaction, study_id, fitting)?;
    let number = insert(&transaction, study_id, fitting, round, remark)?;
    transaction.commit()?;
    Ok(number)
}

pub fn edit(store: &mut Store, fitting: Fitting<'_>, number: i64, edit: &Edit) -> Result<()> {
    let transaction = write(store.writer()?)?;
    let study_id = study_id(&transaction, fitting.study)?;
    let changed = transaction.execute(
        "UPDATE fit_comment SET status = coalesce(?, status), severity = coalesce(?, severity), said = coalesce(?, said),
            action = coalesce(?, action), owner = coalesce(?, owner), is_worded = coalesce(?, is_worded OR ?), changed_at = ?
        WHERE study_id = ? AND garment = ? AND subject = ? AND number = ?",
        params![
            edit.status.map(State::as_str),
            edit.severity.map(Severity::as_str),
            edit.said,
            edit.action,
            edit.owner,
            edit.is_worded,
            edit.said.is_some() || edit.action.is_some(),
            now_ms(),
            study_id,
            fitting.garment,
            fitting.subject,
            number
        ],
    )?;
    if changed == 0 {
        let sql = "SELECT number FROM fit_comment WHERE study_id = ? AND garment = ? AND subject = ? ORDER BY number";
        let mut statement = transaction.prepare(sql)?;
        let rows = statement
            .query_map(params![study_id, fitting.garment, fitting.subject], |row| row.get::<_, i64>(0))?
            .collect::<rusqlite::Result<Vec<i64>>>()?;
        let known = rows.into_iter().map(|number| number.to_string()).collect();
        return Err(StudyError::NotFound { what: "comment", name: number.to_string(), known });
    }
    Ok(transaction.commit()?)
}

/// Signs the last round off and returns its number. Fails with [`StudyError::NotFound`] before the first round.
pub fn sign(store: &mut Store, fitting: Fitting<'_>, by: &str) -> Result<i64> {
    let transaction = write(store.writer()?)?;
    let study_id = study_id(&transaction, fitting.study)?;
    let round = last_round(&transaction, study_id, fitting)?;
    transaction.execute(
        "UPDATE fit_round SET signed_by = ?, signed_at = ? WHERE study_id = ? AND garment = ? AND subject = ? AND round = ?",
        params![by, now_ms(), study_id, fitting.garment, fitting.subject, round],
    )?;
    transaction.commit()?;
    Ok(round)
}

fn study_id(transaction: &Transaction<'_>, study: &str) -> Result<i64> {
    let found =
        transaction.query_row("SELECT study_id FROM study WHERE name = ?", [study], |row| row.get(0)).optional()?;
    found.ok_or_else(|| StudyError::NotFound { what: "study", name: study.to_owned(), known: vec![] })
}

fn last_round(transaction: &Transaction<'_>, study_id: i64, fitting: Fitting<'_>) -> Result<i64> {
    let found: Option<i64> = transaction.query_row(
        "SELECT max(round) FROM fit_round WHERE study_id = ? AND garment = ? AND subject = ?",
        params![study_id, fitting.garment, fitting.subject],
        |row| row.get(0),
    )?;
    found.ok_or_else(|| StudyError::NotFound {
        what: "round of fitting",
        name: format!("{} on {}", fitting.garment, fitting.subject),
        known: vec![],
    })
}

fn insert(
    transaction: &Transaction<'_>,
    study_id: i64,
    fitting: Fitting<'_>,
    round: i64,
    remark: &Remark,
) -> Result<i64> {
    let number: i64 = transaction.query_row(
        "SELECT coalesce(max(number), 0) + 1 FROM fit_comment WHERE study_id = ? AND garment = ? AND subject = ?",
        params![study_id, fitting.garment, fitting.subject],
        |row| row.get(0),
    )?;
    transaction.execute(
        "INSERT INTO fit_comment (study_id, garment, subject, round, number, side, place, said, severity, cause, action,
            quantity, changed_at) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        params![
            study_id,
            fitting.garment,
            fitting.subject,
            round,
            number,
            remark.side.as_str(),
            remark.place,
            remark.said,
            remark.severity.as_str(),
            remark.cause,
            remark.action,
            remark.quantity,
            now_ms()
        ],
    )?;
    Ok(number)
}
