//! The embedded tables: comma-separated, with a head.
//!
//! They are compiled in and read whole by the tests: a malformed one is a defect of the build, so it panics and says where.

/// A table of text fields under a head.
pub struct Table {
    head: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

impl Table {
    /// Splits a text.
    pub fn new(text: &'static str) -> Self {
        let split = |line: &'static str| line.split(',').collect::<Vec<_>>();
        let mut lines = text.lines().filter(|line| !line.is_empty()).map(split);
        Self {
            head: lines.next().unwrap_or_default(),
            rows: lines.collect(),
        }
    }

    /// Its lines.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.rows.iter().map(|fields| Line {
            head: &self.head,
            fields,
        })
    }

    /// The columns whose names start so: their numbers and names.
    pub fn columns_from(&self, start: &str) -> impl Iterator<Item = (usize, &'static str)> {
        let columns = self.head.iter().copied().enumerate();
        columns.filter(move |(_, name)| name.starts_with(start))
    }

    /// The columns `L_NM`: their numbers and wavelengths, nm.
    pub fn radiance_columns(&self) -> Vec<(usize, f64)> {
        let wavelength = |(column, name): (usize, &str)| (column, parse(&name[2..]));
        self.columns_from("L_").map(wavelength).collect()
    }
}

/// A line of a table.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    head: &'a [&'static str],
    fields: &'a [&'static str],
}

impl Line<'_> {
    /// Whether its table has a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.head.contains(&name)
    }

    /// The text in a column of this name.
    pub fn text(&self, name: &str) -> &'static str {
        let column = self.head.iter().position(|head| *head == name);
        column
            .and_then(|column| self.fields.get(column).copied())
            .unwrap_or_else(|| {
                panic!(
                    "an embedded table has no field '{name}' in {:?}",
                    self.fields
                )
            })
    }

    /// The number in a column of this name.
    pub fn number(&self, name: &str) -> f64 {
        parse(self.text(name))
    }

    /// The number in a column of this number.
    pub fn at(&self, column: usize) -> f64 {
        parse(self.fields[column])
    }
}

fn parse(text: &str) -> f64 {
    text.parse()
        .unwrap_or_else(|_| panic!("an embedded table has '{text}' for a number"))
}
