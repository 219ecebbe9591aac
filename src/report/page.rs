//! One HTML page that needs nothing else: sections, tables and pictures, for a browser and for paper.
//!
//! Words that come from outside are escaped. The page loads nothing and runs nothing.

use super::plot::{Figure, PlotError};
use std::fmt::Write as _;
use std::path::Path;

/// The page's looks, on the screen and on paper.
const STYLE: &str = include_str!("page/style.css");

/// Rows of a table that is not broken between two sheets of paper: it fits on one in any case.
const ROWS_KEPT_TOGETHER: usize = 20;

/// A page in the making.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    contents: Vec<String>,
    body: String,
}

impl Page {
    /// A page with a title and a line below it.
    #[must_use]
    pub fn new(title: impl Into<String>, lead: &str) -> Self {
        let title = title.into();
        let body = format!("<header><h1>{}</h1><p>{}</p></header>\n", escape(&title), escape(lead));
        Self { title, contents: Vec::new(), body }
    }

    /// Begins a section.
    pub fn section(&mut self, heading: &str) -> &mut Self {
        self.contents.push(heading.to_owned());
        self.append(&format!("<h2 id=\"section-{}\">{}</h2>\n", self.contents.len(), escape(heading)))
    }

    /// Begins a part of a section.
    pub fn subsection(&mut self, heading: &str) -> &mut Self {
        self.append(&format!("<h3>{}</h3>\n", escape(heading)))
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) -> &mut Self {
        self.append(&format!("<p>{}</p>\n", escape(text)))
    }

    /// Adds a paragraph that stands out: a stop, or something that is missing.
    pub fn notice(&mut self, text: &str) -> &mut Self {
        self.append(&format!("<p class=\"notice\">{}</p>\n", escape(text)))
    }

    /// Adds a list of names and what belongs to them.
    pub fn facts<'a>(&mut self, facts: impl IntoIterator<Item = (&'a str, String)>) -> &mut Self {
        let mut rows = String::new();
        for (name, value) in facts {
            let _ = writeln!(rows, "<dt>{}</dt><dd>{}</dd>", escape(name), escape(&value));
        }
        self.append(&format!("<dl>\n{rows}</dl>\n"))
    }

    /// Adds a table. Cells that hold a number only are set flush right.
    pub fn table(&mut self, caption: &str, head: &[&str], rows: &[Vec<String>]) -> &mut Self {
        let class = if rows.len() <= ROWS_KEPT_TOGETHER { " class=\"whole\"" } else { "" };
        let mut text = format!("<table{class}><caption>{}</caption>\n<thead><tr>", escape(caption));
        for cell in head {
            let _ = write!(text, "<th scope=\"col\">{}</th>", escape(cell));
        }
        text.push_str("</tr></thead>\n<tbody>\n");
        for row in rows {
            text.push_str("<tr>");
            for cell in row {
                let class = if is_number(cell) { " class=\"number\"" } else { "" };
                let _ = write!(text, "<td{class}>{}</td>", escape(cell));
            }
            text.push_str("</tr>\n");
        }
        text.push_str("</tbody></table>\n");
        self.append(&text)
    }

    /// Adds a figure with its caption, drawn into the page.
    ///
    /// # Errors
    /// [`PlotError`] where the figure cannot be drawn.
    pub fn figure(&mut self, figure: &Figure, caption: &str) -> Result<&mut Self, PlotError> {
        let drawing = figure.svg()?;
        Ok(self.drawing(&drawing, caption))
    }

    /// Adds a figure that is drawn already, as the SVG document of [`Figure::svg`], with its caption.
    pub fn drawing(&mut self, drawing: &str, caption: &str) -> &mut Self {
        let caption = escape(caption);
        self.append(&format!("<figure>\n{drawing}\n<figcaption>{caption}</figcaption></figure>\n"))
    }

    /// The finished page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut list = String::new();
        if self.contents.len() > 2 {
            for (index, heading) in self.contents.iter().enumerate() {
                let _ = write!(list, "<li><a href=\"#section-{}\">{}</a></li>", index + 1, escape(heading));
            }
            list = format!("<nav><ol>{list}</ol></nav>\n");
        }
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n{list}<main>\n{}</main>\n</body>\n</html>\n",
            escape(&self.title),
            self.body
        )
    }

    /// Writes the page to a file.
    ///
    /// # Errors
    /// [`PlotError::Writing`] names the file and the reason.
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        std::fs::write(path, self.html()).map_err(|source| PlotError::Writing { path: path.to_path_buf(), source })
    }

    fn append(&mut self, text: &str) -> &mut Self {
        self.body.push_str(text);
        self
    }
}

fn is_number(cell: &str) -> bool {
    !cell.is_empty() && cell.chars().all(|sign| sign.is_ascii_digit() || "+-\u{2212}.,%\u{b1} \u{2013}".contains(sign))
}

/// Text that HTML shows as it is.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            _ => escaped.push(sign),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::{Axis, Plot};

    #[test]
    fn words_from_outside_cannot_become_markup() {
        let mut page = Page::new("<script>", "a & b");
        page.section("\"quoted\"").table("t", &["<b>"], &[vec!["</td><script>".into()]]);
        let html = page.html();
        assert!(!html.contains("<script>"));
        assert!(html.contains("&lt;script&gt;"));
        assert!(html.contains("a &amp; b"));
    }

    #[test]
    fn a_page_needs_nothing_from_elsewhere() {
        let mut page = Page::new("Trial", "one trial");
        let plot = Plot::new("", Axis::new("time (s)"), Axis::new("force (N)")).line("x", [[0.0, 1.0], [1.0, 2.0]]);
        page.section("One").section("Two").section("Three");
        page.figure(&Figure::single(plot), "force").unwrap();
        let html = page.html().replace("http://www.w3.org/2000/svg", "");
        for foreign in ["http://", "https://", "src=", "@import", "url("] {
            assert!(!html.contains(foreign), "{foreign}");
        }
        assert!(html.contains("href=\"#section-3\""));
    }

    #[test]
    fn only_numbers_are_set_as_numbers() {
        assert!(is_number("12.5 \u{b1} 0.3"));
        assert!(!is_number("22 N"));
        assert!(!is_number(""));
    }
}
