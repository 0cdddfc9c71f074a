//! Statistics for SQL that SQLite does not have.

use rusqlite::functions::{Aggregate, Context, FunctionFlags};
use rusqlite::{Connection, Error};

pub(crate) fn add_functions(connection: &Connection) -> rusqlite::Result<()> {
    let flags = FunctionFlags::SQLITE_UTF8 | FunctionFlags::SQLITE_DETERMINISTIC;
    connection.create_aggregate_function("median", 1, flags, Quantile)?;
    connection.create_aggregate_function("quantile", 2, flags, Quantile)?;
    connection.create_aggregate_function("stddev", 1, flags, Deviation)
}

/// `quantile(x, p)`: linear between order statistics; `median(x)` is p = 1/2.
struct Quantile;

struct Sample {
    values: Vec<f64>,
    share: f64,
}

impl Aggregate<Sample, Option<f64>> for Quantile {
    fn init(&self, _: &mut Context<'_>) -> rusqlite::Result<Sample> {
        Ok(Sample { values: Vec::new(), share: 0.5 })
    }

    fn step(&self, context: &mut Context<'_>, sample: &mut Sample) -> rusqlite::Result<()> {
        if context.len() > 1 {
            sample.share = context.get(1)?;
            if !(0.0..=1.0).contains(&sample.share) {
                let message = format!("quantile: share {} is not between 0 and 1", sample.share);
                return Err(Error::UserFunctionError(message.into()));
            }
        }
        sample.values.extend(context.get::<Option<f64>>(0)?);
        Ok(())
    }

    fn finalize(&self, _: &mut Context<'_>, sample: Option<Sample>) -> rusqlite::Result<Option<f64>> {
        Ok(sample.and_then(|mut sample| {
            sample.values.sort_by(f64::total_cmp);
            let last = sample.values.len().checked_sub(1)?;
            let place = sample.share * last as f64;
            let (low, high) = (sample.values[place.floor() as usize], sample.values[place.ceil() as usize]);
            Some(low + (high - low) * place.fract())
        }))
    }
}

/// `stddev(x)`: sample standard deviation by Welford's update [Welford 1962]; NULL for fewer than two numbers.
struct Deviation;

/// Running mean and sum of squared deviations.
#[derive(Default)]
struct Moments {
    n: f64,
    mean: f64,
    squares: f64,
}

impl Aggregate<Moments, Option<f64>> for Deviation {
    fn init(&self, _: &mut Context<'_>) -> rusqlite::Result<Moments> {
        Ok(Moments::default())
    }

    fn step(&self, context: &mut Context<'_>, moments: &mut Moments) -> rusqlite::Result<()> {
        if let Some(x) = context.get::<Option<f64>>(0)? {
            moments.n += 1.0;
            let off = x - moments.mean;
            moments.mean += off / moments.n;
            moments.squares += off * (x - moments.mean);
        }
        Ok(())
    }

    fn finalize(&self, _: &mut Context<'_>, moments: Option<Moments>) -> rusqlite::Result<Option<f64>> {
        Ok(moments.filter(|m| m.n > 1.0).map(|m| (m.squares / (m.n - 1.0)).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_those_of_the_textbook() {
        let connection = Connection::open_in_memory().expect("memory");
        add_functions(&connection).expect("new names");
        let check = |expression: &str, values: &str, expected: Option<f64>| {
            let sql = format!("SELECT {expression} FROM (SELECT value AS x FROM json_each('{values}'))");
            let found: Option<f64> = connection.query_row(&sql, [], |row| row.get(0)).expect("valid");
            match (found, expected) {
                (Some(found), Some(expected)) => {
                    assert!((found - expected).abs() < 1e-12, "{expression} {values}: {found}")
                }
                _ => assert_eq!(found, expected, "{expression} {values}"),
            }
        };
        check("median(x)", "[3, 1, 2]", Some(2.0));
        check("median(x)", "[4, 1, 2, 3]", Some(2.5));
        check("median(x)", "[]", None);
        check("median(x)", "[1, null]", Some(1.0));
        check("quantile(x, 0.25)", "[0, 1, 2, 3, 4]", Some(1.0));
        check("stddev(x)", "[2, 4, 4, 4, 5, 5, 7, 9]", Some((32.0f64 / 7.0).sqrt()));
        check("stddev(x)", "[1]", None);
        assert!(connection.query_row("SELECT quantile(1, 2)", [], |_| Ok(())).is_err());
    }
}
