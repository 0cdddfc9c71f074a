//! Tables as Apache Parquet [Parquet format 2.10]: one row group of plain, uncompressed values, so that no package is
//! needed. Every column may have nulls. A column of whole numbers is INT64, one of other numbers DOUBLE, any other
//! UTF-8 text, and so is one without values.

use store::{Table, Value, distinct};

/// First and last bytes of every file.
const MAGIC: &[u8; 4] = b"PAR1";
/// Rows in a page.
const PAGE: usize = 100_000;

/// Physical types of Parquet, with their numbers in the format.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Int64 = 2,
    Double = 5,
    ByteArray = 6,
}

pub fn bytes(table: &Table) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    let mut schema = vec![root(table.columns.len())];
    let mut chunks = Vec::new();
    for (index, name) in distinct(&table.columns).iter().enumerate() {
        let values: Vec<&Value> = table.rows.iter().map(|row| row.get(index).unwrap_or(&Value::Null)).collect();
        let kind = kind(&values);
        schema.push(element(name, kind));
        let start = file.len();
        for page in values.chunks(PAGE) {
            write_page(&mut file, page, kind);
        }
        chunks.push(chunk(name, kind, values.len(), start, file.len() - start));
    }
    let total = file.len() - MAGIC.len();
    let mut group = Struct::default();
    group.list(1, &chunks);
    group.i64(2, total as i64);
    group.i64(3, table.rows.len() as i64);
    let mut footer = Struct::default();
    footer.i32(1, 1);
    footer.list(2, &schema);
    footer.i64(3, table.rows.len() as i64);
    footer.list(4, &[group.end()]);
    footer.text(6, concat!("toile version ", env!("CARGO_PKG_VERSION")));
    let footer = footer.end();
    file.extend_from_slice(&footer);
    file.extend_from_slice(&(footer.len() as u32).to_le_bytes());
    file.extend_from_slice(MAGIC);
    file
}

/// Narrowest type for all values of a column; text for a column without values, of which nobody knows the type.
fn kind(values: &[&Value]) -> Kind {
    let mut kind = None;
    for value in values {
        match value {
            Value::Null => {}
            Value::Integer(_) => kind = kind.or(Some(Kind::Int64)),
            Value::Real(_) => kind = Some(Kind::Double),
            Value::Text(_) | Value::Blob(_) => return Kind::ByteArray,
        }
    }
    kind.unwrap_or(Kind::ByteArray)
}

/// Writes a page: header, definition levels, and the values that are not null.
fn write_page(file: &mut Vec<u8>, values: &[&Value], kind: Kind) {
    let mut levels = Vec::new();
    for run in values.chunk_by(|a, b| (**a == Value::Null) == (**b == Value::Null)) {
        varint(&mut levels, (run.len() as u64) << 1);
        levels.push(u8::from(*run[0] != Value::Null));
    }
    let mut data = (levels.len() as u32).to_le_bytes().to_vec();
    data.extend_from_slice(&levels);
    for value in values {
        match (value, kind) {
            (Value::Null, _) => {}
            (Value::Integer(number), Kind::Int64) => data.extend_from_slice(&number.to_le_bytes()),
            (Value::Integer(number), Kind::Double) => data.extend_from_slice(&(*number as f64).to_le_bytes()),
            (Value::Real(number), Kind::Double) => data.extend_from_slice(&number.to_le_bytes()),
            (other, _) => {
                let text = other.to_string();
                data.extend_from_slice(&(text.len() as u32).to_le_bytes());
                data.extend_from_slice(text.as_bytes());
            }
        }
    }
    const RLE: i32 = 3;
    let mut about = Struct::default();
    about.i32(1, values.len() as i32);
    about.i32(2, 0); // plain
    about.i32(3, RLE);
    about.i32(4, RLE);
    let mut header = Struct::default();
    header.i32(1, 0); // a data page
    header.i32(2, data.len() as i32);
    header.i32(3, data.len() as i32);
    header.inner(5, &about.end());
    file.extend_from_slice(&header.end());
    file.extend_from_slice(&data);
}

/// First element of the schema, which has the number of columns.
fn root(columns: usize) -> Vec<u8> {
    let mut root = Struct::default();
    root.text(4, "schema");
    root.i32(5, columns as i32);
    root.end()
}

fn element(name: &str, kind: Kind) -> Vec<u8> {
    let mut element = Struct::default();
    element.i32(1, kind as i32);
    element.i32(3, 1); // optional
    element.text(4, name);
    if kind == Kind::ByteArray {
        element.i32(6, 0); // UTF-8
    }
    element.end()
}

/// Metadata of a column chunk: place and size of its pages.
fn chunk(name: &str, kind: Kind, rows: usize, start: usize, length: usize) -> Vec<u8> {
    let mut about = Struct::default();
    about.i32(1, kind as i32);
    about.numbers(2, &[0, 3]); // plain values, run-length levels
    about.texts(3, &[name]);
    about.i32(4, 0); // not compressed
    about.i64(5, rows as i64);
    about.i64(6, length as i64);
    about.i64(7, length as i64);
    about.i64(9, start as i64);
    let mut chunk = Struct::default();
    chunk.i64(2, start as i64);
    chunk.inner(3, &about.end());
    chunk.end()
}

/// A struct in Thrift's compact protocol [Thrift compact protocol], with fields in the order of their numbers.
#[derive(Default)]
struct Struct {
    bytes: Vec<u8>,
    last: u8,
}

impl Struct {
    /// Starts a field: number, as the difference from the last field's, and type.
    fn field(&mut self, number: u8, kind: u8) {
        self.bytes.push(((number - self.last) << 4) | kind);
        self.last = number;
    }

    fn i32(&mut self, number: u8, value: i32) {
        self.field(number, 5);
        zigzag(&mut self.bytes, i64::from(value));
    }

    fn i64(&mut self, number: u8, value: i64) {
        self.field(number, 6);
        zigzag(&mut self.bytes, value);
    }

    fn text(&mut self, number: u8, text: &str) {
        self.field(number, 8);
        varint(&mut self.bytes, text.len() as u64);
        self.bytes.extend_from_slice(text.as_bytes());
    }

    fn inner(&mut self, number: u8, bytes: &[u8]) {
        self.field(number, 12);
        self.bytes.extend_from_slice(bytes);
    }

    fn list(&mut self, number: u8, items: &[Vec<u8>]) {
        self.head(number, items.len(), 12);
        items.iter().for_each(|item| self.bytes.extend_from_slice(item));
    }

    fn numbers(&mut self, number: u8, items: &[i64]) {
        self.head(number, items.len(), 5);
        items.iter().for_each(|item| zigzag(&mut self.bytes, *item));
    }

    fn texts(&mut self, number: u8, items: &[&str]) {
        self.head(number, items.len(), 8);
        for item in items {
            varint(&mut self.bytes, item.len() as u64);
            self.bytes.extend_from_slice(item.as_bytes());
        }
    }

    /// Starts a list: number and type of its items.
    fn head(&mut self, number: u8, items: usize, kind: u8) {
        self.field(number, 9);
        if items < 15 {
            self.bytes.push(((items as u8) << 4) | kind);
        } else {
            self.bytes.push(0xf0 | kind);
            varint(&mut self.bytes, items as u64);
        }
    }

    /// Returns the bytes, ended by the mark for the end of a struct.
    fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

/// Writes a number in groups of seven bits, the lowest first.
fn varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// Writes a number with its sign in the lowest bit.
fn zigzag(bytes: &mut Vec<u8>, number: i64) {
    varint(bytes, ((number << 1) ^ (number >> 63)) as u64);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_the_protocol_says() {
        let check = |number: i64, expect: &[u8]| {
            let mut bytes = Vec::new();
            zigzag(&mut bytes, number);
            assert_eq!(bytes, expect, "{number}");
        };
        check(0, &[0]);
        check(-1, &[1]);
        check(1, &[2]);
        check(-65, &[0x81, 1]);
        check(150, &[0xac, 2]);
        check(i64::MIN, &[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1]);
    }

    #[test]
    fn a_column_has_the_narrowest_type_of_its_values() {
        let check = |values: &[Value], expect: Kind| {
            assert!(kind(&values.iter().collect::<Vec<_>>()) == expect, "{values:?}");
        };
        check(&[Value::Null, Value::Integer(5)], Kind::Int64);
        check(&[Value::Integer(5), Value::Real(0.5), Value::Integer(1)], Kind::Double);
        check(&[Value::Real(0.5), Value::Text("a".into())], Kind::ByteArray);
        check(&[Value::Null, Value::Null], Kind::ByteArray);
        check(&[], Kind::ByteArray);
    }

    #[test]
    fn a_file_is_laid_out_byte_by_byte() {
        let rows = vec![vec![Value::Integer(5)], vec![Value::Null], vec![Value::Integer(-1)]];
        let file = bytes(&Table { columns: vec!["n".into()], rows });
        // Levels: one value, one null, one value; then the two values.
        let levels = [6, 0, 0, 0, 2, 1, 2, 0, 2, 1];
        let page = [&levels[..], &5i64.to_le_bytes(), &(-1i64).to_le_bytes()].concat();
        let header = [0x15, 0, 0x15, 52, 0x15, 52, 0x2c, 0x15, 6, 0x15, 0, 0x15, 6, 0x15, 6, 0, 0];
        assert_eq!(file[..4 + header.len() + page.len()], [&MAGIC[..], &header, &page].concat());
        let length = u32::from_le_bytes(file[file.len() - 8..file.len() - 4].try_into().expect("four")) as usize;
        assert_eq!(4 + header.len() + page.len() + length + 8, file.len());
        assert_eq!(&file[file.len() - 4..], MAGIC);
    }
}
