//! Transactions, and the clock of their rows.

use std::time::{SystemTime, UNIX_EPOCH};

use rusqlite::{Connection, Transaction, TransactionBehavior};

use crate::error::{Result, StudyError};

/// A transaction that takes the write lock at once, so that what it read stays true until it commits.
pub fn write(connection: &mut Connection) -> rusqlite::Result<Transaction<'_>> {
    connection.transaction_with_behavior(TransactionBehavior::Immediate)
}

/// Does something in a transaction that a power cut may undo, though nothing else may: what a queue is told need not wait
/// for the disk. The next result that is stored makes it last, too.
pub fn lightly<T>(connection: &mut Connection, act: impl FnOnce(&Transaction<'_>) -> Result<T>) -> Result<T> {
    let usual: i64 = connection.pragma_query_value(None, "synchronous", |row| row.get(0))?;
    connection.pragma_update(None, "synchronous", "normal")?;
    let done = write(connection).map_err(StudyError::from).and_then(|transaction| {
        let done = act(&transaction)?;
        transaction.commit()?;
        Ok(done)
    });
    connection.pragma_update(None, "synchronous", usual)?;
    done
}

/// The clock, ms since 1970 (UTC). Only queue bookkeeping reads it; results never depend on it.
#[must_use]
pub fn now_ms() -> i64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis() as i64)
}
