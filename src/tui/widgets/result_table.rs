//! Rows of an answer for a screen: sorted by a column, filtered, scrolled to the selected column.

use std::cmp::Ordering;

use crate::widgets::text;
use geom::units::significant;
use store::{SqlAnswer, Value};

/// Number of rows that decide the width of a column, and if it holds numbers.
const LOOKED_AT: usize = 300;
/// Greatest width of a column.
const WIDEST: usize = 40;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Width in columns of the terminal.
    pub width: usize,
    pub is_number: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResultTable {
    answer: SqlAnswer,
    /// Each row in lower case, for the filter.
    words: Vec<String>,
    columns: Vec<Column>,
    /// Indices of the shown rows, in order.
    shown: Vec<usize>,
    /// Index among the rows shown.
    pub row: usize,
    pub column: usize,
    /// Column that sorts, and true if it falls; `None` for the order of the query.
    pub order: Option<(usize, bool)>,
}

impl ResultTable {
    /// Makes the table of an answer, in a time proportional to its size. Meant for threads.
    pub fn of(answer: SqlAnswer) -> Self {
        let words = answer.table.rows.iter().map(|row| {
            let cells: Vec<String> = row.iter().map(Value::to_string).collect();
            cells.join("\t").to_lowercase()
        });
        let columns = (0..answer.table.columns.len()).map(|k| {
            let values = || answer.table.rows.iter().take(LOOKED_AT).map(|row| &row[k]);
            let widest = values().map(|value| text::width(&cell_text(value))).max().unwrap_or(0);
            let is_number = values().all(|value| !matches!(value, Value::Text(_) | Value::Blob(_)));
            Column { width: widest.max(text::width(&answer.table.columns[k]) + 1).min(WIDEST), is_number }
        });
        let (words, columns) = (words.collect(), columns.collect());
        Self { shown: (0..answer.table.rows.len()).collect(), words, columns, answer, ..Self::default() }
    }

    pub fn names(&self) -> &[String] {
        &self.answer.table.columns
    }

    pub fn column_of(&self, k: usize) -> Column {
        self.columns[k]
    }

    /// Number of rows shown.
    pub fn len(&self) -> usize {
        self.shown.len()
    }

    pub fn total(&self) -> usize {
        self.answer.table.rows.len()
    }

    /// True if the query has more rows than the answer.
    pub fn is_cut(&self) -> bool {
        self.answer.is_cut
    }

    /// Values of a shown row.
    pub fn values(&self, row: usize) -> Option<&[Value]> {
        self.shown.get(row).map(|at| self.answer.table.rows[*at].as_slice())
    }

    pub fn arrange(&mut self, filter: &str) {
        let filter = filter.to_lowercase();
        self.shown = (0..self.words.len()).filter(|row| self.words[*row].contains(&filter)).collect();
        if let Some((column, falls)) = self.order {
            let rows = &self.answer.table.rows;
            self.shown.sort_by(|a, b| {
                let order = compared(&rows[*a][column], &rows[*b][column]);
                if falls { order.reverse() } else { order }
            });
        }
        self.row = self.row.min(self.shown.len().saturating_sub(1));
    }

    /// Sorts by the selected column. The second time returns to the order of the query.
    pub fn sort(&mut self, filter: &str) {
        self.order =
            if self.order.is_some_and(|(by, _)| by == self.column) { None } else { Some((self.column, false)) };
        self.arrange(filter);
    }

    /// Reverses the order; sorts by the selected column where the order is that of the query.
    pub fn reverse(&mut self, filter: &str) {
        let (by, falls) = self.order.unwrap_or((self.column, false));
        self.order = Some((by, !falls));
        self.arrange(filter);
    }

    pub fn sideways(&mut self, step: isize) {
        let last = self.columns.len().saturating_sub(1);
        self.column = self.column.saturating_add_signed(step).min(last);
    }

    /// Columns that fit into `room`: the first, which stays; then the last ones up to the selected column, and those
    /// after it.
    pub fn columns_shown(&self, room: usize) -> Vec<usize> {
        let Some((first, rest)) = self.columns.split_first() else { return vec![] };
        let widths: Vec<usize> = rest.iter().map(|column| column.width + 2).collect();
        let mut left = room.saturating_sub(first.width);
        let mut from = 1;
        // The selected column must fit; columns before it are scrolled away.
        while from < self.column && widths[from - 1..self.column].iter().sum::<usize>() > left {
            from += 1;
        }
        let mut shown = vec![0];
        for k in from..self.columns.len() {
            if widths[k - 1] > left && shown.len() > 1 {
                break;
            }
            left = left.saturating_sub(widths[k - 1]);
            shown.push(k);
        }
        shown
    }

    /// Shown rows as text, separated by tabs, below the names of the columns.
    pub fn copied(&self, rows: impl Iterator<Item = usize>) -> String {
        let line = |values: &[Value]| values.iter().map(Value::to_string).collect::<Vec<_>>().join("\t");
        let lines = rows.filter_map(|row| self.values(row).map(line));
        std::iter::once(self.names().join("\t")).chain(lines).collect::<Vec<_>>().join("\n") + "\n"
    }
}

/// Value in one line: numbers with at most six significant digits, texts without line feeds.
pub fn cell_text(value: &Value) -> String {
    match value {
        Value::Null => "—".to_owned(),
        Value::Real(number) => significant(*number, 6),
        other => other.to_string().split_whitespace().collect::<Vec<_>>().join(" "),
    }
}

/// Order of two values, as in SQLite: nulls, numbers, texts, blobs.
fn compared(a: &Value, b: &Value) -> Ordering {
    let rank = |value: &Value| match value {
        Value::Null => 0,
        Value::Integer(_) | Value::Real(_) => 1,
        Value::Text(_) => 2,
        Value::Blob(_) => 3,
    };
    let number = |value: &Value| match value {
        Value::Integer(number) => *number as f64,
        Value::Real(number) => *number,
        _ => 0.0,
    };
    match (a, b) {
        (Value::Text(a), Value::Text(b)) => a.cmp(b),
        (Value::Blob(a), Value::Blob(b)) => a.cmp(b),
        _ => rank(a).cmp(&rank(b)).then(number(a).total_cmp(&number(b))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use store::Table;

    fn table() -> ResultTable {
        let row = |name: &str, value: Value| vec![Value::Text(name.to_owned()), value, Value::Text("x".repeat(30))];
        let rows = vec![
            row("beta", Value::Real(0.5)),
            row("alpha", Value::Null),
            row("gamma", Value::Integer(-2)),
            row("delta", Value::Real(12.345_678_9)),
        ];
        let columns = ["name", "n", "long"].map(str::to_owned).to_vec();
        ResultTable::of(SqlAnswer { table: Table { columns, rows }, is_cut: false })
    }

    fn names(table: &ResultTable) -> Vec<String> {
        (0..table.len()).filter_map(|row| table.values(row)).map(|values| values[0].to_string()).collect()
    }

    #[test]
    fn rows_are_sorted_by_value_and_narrowed() {
        let mut table = table();
        table.sort("");
        assert_eq!(names(&table), ["alpha", "beta", "delta", "gamma"]);
        table.sideways(1);
        table.sort("");
        assert_eq!(names(&table), ["alpha", "gamma", "beta", "delta"], "nothing first, then numbers by size");
        table.reverse("");
        assert_eq!(names(&table), ["delta", "beta", "gamma", "alpha"]);
        table.arrange("ALPHA");
        assert_eq!(names(&table), ["alpha"]);
        table.sort("");
        assert_eq!(names(&table), ["beta", "alpha", "gamma", "delta"], "a second time: as the query has them");
    }

    #[test]
    fn the_first_column_stays_and_the_selected_is_in_sight() {
        let mut table = table();
        assert_eq!(table.columns_shown(80), [0, 1, 2]);
        assert_eq!(table.columns_shown(20), [0, 1]);
        table.sideways(9);
        assert_eq!(table.column, 2);
        assert_eq!(table.columns_shown(38), [0, 2]);
        assert_eq!(table.columns_shown(5), [0, 2]);
        assert!(ResultTable::default().columns_shown(80).is_empty());
    }

    #[test]
    fn numbers_are_short_and_texts_one_line() {
        let check = |value: Value, expect: &str| assert_eq!(cell_text(&value), expect);
        check(Value::Real(12.345_678_9), "12.3457");
        check(Value::Real(0.000_001), "1.00000e-6");
        check(Value::Real(-0.25), "-0.25");
        check(Value::Text("a\n  b".to_owned()), "a b");
        check(Value::Null, "—");
    }
}
