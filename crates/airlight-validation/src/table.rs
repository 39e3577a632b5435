//! Embedded comma-separated tables with a header, after lines of comment that begin with `#`.
//!
//! They are compiled in and read completely by the tests, so parsing panics with a message on malformed ones.

/// A table of text fields with a header.
#[derive(Debug)]
pub struct Table {
    head: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

impl Table {
    /// Parses a text.
    pub fn new(text: &'static str) -> Self {
        let split = |line: &'static str| line.split(',').collect::<Vec<_>>();
        let lines = text
            .lines()
            .filter(|line| !line.is_empty() && !line.starts_with('#'));
        let mut lines = lines.map(split);
        Self {
            head: lines.next().unwrap_or_default(),
            rows: lines.collect(),
        }
    }

    /// Lines of the table.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.rows.iter().map(|fields| Line {
            head: &self.head,
            fields,
        })
    }

    /// Indices and names of the columns whose names begin with `start`.
    pub fn columns_from(&self, start: &str) -> impl Iterator<Item = (usize, &'static str)> {
        let columns = self.head.iter().copied().enumerate();
        columns.filter(move |(_, name)| name.starts_with(start))
    }

    /// Indices and wavelengths (nm) of the columns `L_NM`.
    pub fn radiance_columns(&self) -> Vec<(usize, f64)> {
        let wavelength = |(column, name): (usize, &str)| (column, parse(&name[2..]));
        self.columns_from("L_").map(wavelength).collect()
    }
}

/// A line of a table.
#[derive(Debug, Clone, Copy)]
pub struct Line<'a> {
    head: &'a [&'static str],
    fields: &'a [&'static str],
}

impl Line<'_> {
    /// True if the table has a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.head.contains(&name)
    }

    /// Text in a named column.
    pub fn text(&self, name: &str) -> &'static str {
        let column = self.head.iter().position(|head| *head == name);
        column
            .and_then(|column| self.fields.get(column).copied())
            .unwrap_or_else(|| {
                panic!(
                    "expected a field '{name}' in an embedded table, got {:?}",
                    self.fields
                )
            })
    }

    /// Number in a named column.
    pub fn number(&self, name: &str) -> f64 {
        parse(self.text(name))
    }

    /// Number in a column by index.
    pub fn at(&self, column: usize) -> f64 {
        parse(self.fields[column])
    }
}

fn parse(text: &str) -> f64 {
    text.parse()
        .unwrap_or_else(|_| panic!("expected a number in an embedded table, got '{text}'"))
}
