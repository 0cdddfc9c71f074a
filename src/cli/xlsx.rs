//! Tables as XLSX workbooks.

use std::io;

use rust_xlsxwriter::{Format, Workbook, XlsxError};
use store::{Table, Value};

/// Headings are bold and stay in view.
pub fn bytes(sheets: &[(&str, &Table)]) -> io::Result<Vec<u8>> {
    written(sheets).map_err(io::Error::other)
}

fn written(sheets: &[(&str, &Table)]) -> Result<Vec<u8>, XlsxError> {
    let mut workbook = Workbook::new();
    for (name, table) in sheets {
        add(&mut workbook, name, table)?;
    }
    workbook.save_to_buffer()
}

fn add(workbook: &mut Workbook, name: &str, table: &Table) -> Result<(), XlsxError> {
    let sheet = workbook.add_worksheet();
    // A sheet may refuse a name; that is no loss, since the file has the name too.
    let _ = sheet.set_name(name);
    let bold = Format::new().set_bold();
    for (column, name) in (0..).zip(&table.columns) {
        sheet.write_with_format(0, column, name, &bold)?;
    }
    for (row, values) in (1..).zip(&table.rows) {
        for (column, value) in (0..).zip(values) {
            match value {
                Value::Null => sheet.write_blank(row, column, &Format::new())?,
                Value::Integer(number) => sheet.write(row, column, *number as f64)?,
                Value::Real(number) => sheet.write(row, column, *number)?,
                Value::Text(text) => sheet.write(row, column, text)?,
                Value::Blob(bytes) => sheet.write(row, column, *bytes as f64)?,
            };
        }
    }
    sheet.set_freeze_panes(1, 1)?;
    sheet.autofit();
    Ok(())
}
