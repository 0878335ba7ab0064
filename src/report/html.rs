//! Pieces of HTML from text that nobody vouches for.

pub use crate::chart::text::{base64, base64_length, escape, escape_whole, number, thousands};

/// A size in bytes, in words.
pub fn bytes(n: u64) -> String {
    match n {
        0..1024 => format!("{n} bytes"),
        1024..1_048_576 => format!("{:.1} KiB", n as f64 / 1024.0),
        _ => format!("{:.1} MiB", n as f64 / 1_048_576.0),
    }
}

/// One cell of a table.
#[derive(Debug, Clone, Default)]
pub struct Cell {
    /// HTML of its content.
    html: String,
    /// What columns are sorted by, where that is a number.
    value: Option<f64>,
    numeric: bool,
    class: &'static str,
    style: String,
    title: String,
}

impl Cell {
    /// Plain text.
    pub fn text(text: &str) -> Self {
        Self {
            html: escape(text),
            ..Self::default()
        }
    }

    /// A number, or a dash where there is none.
    pub fn number(x: Option<f64>) -> Self {
        Self::shown(x, number)
    }

    /// A number in a form of its own, or a dash where there is none.
    pub fn shown(x: Option<f64>, form: impl Fn(f64) -> String) -> Self {
        Self {
            html: x.map_or("–".to_owned(), |x| escape(&form(x))),
            value: x.filter(|x| !x.is_nan()),
            numeric: true,
            ..Self::default()
        }
    }

    /// Memory of a pixel, which may be unbounded.
    pub fn bits(bits: Option<f64>) -> Self {
        let form = |bits: f64| {
            if bits.is_finite() {
                number(bits)
            } else {
                "unbounded".to_owned()
            }
        };
        Self::shown(bits, form)
    }

    /// A drawing of numbers alone.
    pub fn svg(svg: &str) -> Self {
        Self {
            html: svg.to_owned(),
            ..Self::default()
        }
    }

    /// The same in a colour of its own; what the colour says must stand in the text too.
    pub fn classed(self, class: &'static str) -> Self {
        Self { class, ..self }
    }

    /// The same with an inline style; made of numbers alone.
    pub fn styled(self, style: String) -> Self {
        Self { style, ..self }
    }

    /// The same with a text that is shown on hovering.
    pub fn titled(self, title: &str) -> Self {
        Self {
            title: escape(title),
            ..self
        }
    }

    fn open(&self, tag: &str, more: &str) -> String {
        let mut out = format!("<{tag}{more}");
        let class = [if self.numeric { "n" } else { "" }, self.class].join(" ");
        for (name, value) in [("class", class.trim()), ("style", &self.style), ("title", &self.title)] {
            if !value.is_empty() {
                out += &format!(" {name}=\"{value}\"");
            }
        }
        if let Some(value) = self.value {
            out += &format!(" data-v=\"{value:e}\"");
        }
        out + ">" + &self.html + "</" + tag + ">"
    }
}

/// Most rows of a table that are shown.
pub const MAX_ROWS: usize = 400;

/// A table with a caption; the first cell of a row names it. A table can be sorted by each column where scripts run.
#[derive(Debug, Default)]
pub struct Table {
    caption: String,
    head: Vec<String>,
    upright: bool,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table of nothing yet.
    pub fn new(caption: &str, head: &[&str]) -> Self {
        Self {
            caption: escape(caption),
            head: head.iter().map(|h| escape(h)).collect(),
            ..Self::default()
        }
    }

    /// Column names are written from bottom to top, for many narrow columns.
    pub fn upright(self) -> Self {
        Self { upright: true, ..self }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<Cell>) {
        self.rows.push(cells);
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table, in a box of its own that scrolls where it is too wide.
    pub fn html(&self) -> String {
        let upright = if self.upright { " upright" } else { "" };
        let mut out = format!(
            "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table class=\"data{upright}\">",
            self.caption
        );
        out += &format!("<caption><span>{}</span></caption><thead><tr>", self.caption);
        for (i, name) in self.head.iter().enumerate() {
            let numeric = self.rows.iter().any(|row| row.get(i).is_some_and(|cell| cell.numeric));
            out += &format!(
                "<th scope=\"col\"{}><span>{name}</span></th>",
                if numeric { " class=\"n\"" } else { "" }
            );
        }
        out += "</tr></thead><tbody>\n";
        for row in self.rows.iter().take(MAX_ROWS) {
            out += "<tr>";
            for (i, cell) in row.iter().enumerate() {
                out += &if i == 0 {
                    cell.open("th", " scope=\"row\"")
                } else {
                    cell.open("td", "")
                };
            }
            out += "</tr>\n";
        }
        out += "</tbody></table></div>\n";
        if self.rows.len() > MAX_ROWS {
            out += &format!(
                "<p class=\"note\">{} more rows are left out.</p>\n",
                self.rows.len() - MAX_ROWS
            );
        }
        out
    }
}

/// Names and values, each on a line.
pub fn definitions(pairs: &[(&str, String)]) -> String {
    let lines: String = pairs
        .iter()
        .map(|(name, value)| format!("<div><dt>{}</dt><dd>{}</dd></div>", escape(name), escape(value)))
        .collect();
    format!("<dl>{lines}</dl>\n")
}

/// What is hidden until it is asked for.
pub fn details(summary: &str, html: &str) -> String {
    format!("<details><summary>{}</summary>\n{html}</details>\n", escape(summary))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::text::LONGEST;

    #[test]
    fn nothing_in_text_is_markup() {
        let hostile = "<script>alert(\"1\")</script> & 'x'\u{0}\u{202e}";
        assert_eq!(
            escape(hostile),
            "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &#39;x&#39;\u{fffd}\u{fffd}"
        );
        assert_eq!(escape_whole(hostile), escape(hostile));
        let long = "é<".repeat(LONGEST);
        assert_eq!(escape(&long).chars().filter(|&c| c == 'é').count(), LONGEST / 2);
        assert!(escape(&long).ends_with('…') && !escape_whole(&long).contains('…'));
        // Control: what is plain stays as it is.
        assert_eq!(escape("moment-power-4+own: 1e-3\n"), "moment-power-4+own: 1e-3\n");
    }

    /// The examples of RFC 4648, section 10.
    #[test]
    fn base64_as_its_standard_prints_it() {
        for (plain, encoded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), encoded);
            assert_eq!(base64_length(plain.len() as u64), encoded.len() as u64);
        }
        assert_eq!(base64(&[0xfb, 0xef, 0xff]), "++//");
    }

    #[test]
    fn numbers_are_short_and_say_what_they_are() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (50.0, "50"),
            (1.5, "1.50"),
            (0.012_345, "0.012"),
            (5.3e-6, "5.30e-6"),
            (12.345, "12.3"),
            (123_456.0, "123,456"),
            (-1234.0, "-1,234"),
            (1e300, "1.00e300"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "∞"),
            (f64::NEG_INFINITY, "-∞"),
        ];
        for (x, text) in cases {
            assert_eq!(number(x), text);
        }
        assert_eq!(
            [bytes(10), bytes(2048), bytes(3 << 20)],
            ["10 bytes", "2.0 KiB", "3.0 MiB"]
        );
    }

    #[test]
    fn tables_name_rows_and_columns_and_say_what_they_leave_out() {
        let mut table = Table::new("a & b", &["method", "x"]);
        for _ in 0..MAX_ROWS + 2 {
            table.row(vec![
                Cell::text("<m>"),
                Cell::number(Some(f64::NAN)),
                Cell::number(None),
            ]);
        }
        let html = table.html();
        assert!(
            html.contains("<caption><span>a &amp; b</span></caption>")
                && html.contains(
                    "<th scope=\"col\"><span>method</span></th><th scope=\"col\" class=\"n\"><span>x</span></th>"
                )
        );
        assert!(html.contains("<th scope=\"row\">&lt;m&gt;</th><td class=\"n\">NaN</td><td class=\"n\">–</td>"));
        assert!(html.contains("2 more rows are left out") && html.matches("<tr>").count() == MAX_ROWS + 1);
    }
}
