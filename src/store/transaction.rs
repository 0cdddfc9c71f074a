//! Transactions, and the clock of their rows.

use std::time::{SystemTime, UNIX_EPOCH};

use rusqlite::{Connection, Transaction, TransactionBehavior};

use crate::error::{Result, StudyError};

/// Begins a transaction that takes the write lock at once, so that what it read stays true until it commits.
pub fn write(connection: &mut Connection) -> rusqlite::Result<Transaction<'_>> {
    connection.transaction_with_behavior(TransactionBehavior::Immediate)
}

/// Runs `act` in a transaction that does not wait for the disk. A power cut can undo it until a later transaction
/// waits. The queue's bookkeeping is written this way.
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

/// Time since 1970 (UTC). Only bookkeeping reads it; results never depend on it.
pub fn now_ms() -> i64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis() as i64)
}
