//! A summary in Markdown, parsed as Markdown.

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// The parts of a summary.
#[derive(Default)]
pub(crate) struct Read {
    /// Rows of all tables, their heads included, as the text of their cells.
    pub(crate) rows: Vec<Vec<String>>,
    /// Items of lists.
    pub(crate) items: usize,
    /// All text, code included.
    pub(crate) text: String,
}

pub(crate) fn read_markdown(markdown: &str) -> Read {
    let mut read = Read::default();
    let mut in_cell = false;
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH | Options::ENABLE_MATH;
    for event in Parser::new_ext(markdown, options) {
        match event {
            Event::Html(html) | Event::InlineHtml(html) => panic!("HTML: {html}"),
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                panic!("link to {dest_url}")
            }
            Event::Start(Tag::Strikethrough | Tag::CodeBlock(_) | Tag::BlockQuote(_))
            | Event::InlineMath(_)
            | Event::DisplayMath(_) => panic!("{event:?}"),
            Event::Start(Tag::TableHead | Tag::TableRow) => read.rows.push(Vec::new()),
            Event::Start(Tag::TableCell) => {
                read.rows.last_mut().unwrap().push(String::new());
                in_cell = true;
            }
            Event::End(TagEnd::TableCell) => in_cell = false,
            Event::Start(Tag::Item) => read.items += 1,
            Event::End(TagEnd::Table) => read.text.push('\n'),
            Event::Text(text) | Event::Code(text) => {
                read.text.push_str(&text);
                if in_cell {
                    read.rows
                        .last_mut()
                        .unwrap()
                        .last_mut()
                        .unwrap()
                        .push_str(&text);
                }
            }
            Event::SoftBreak | Event::HardBreak => read.text.push('\n'),
            _ => {}
        }
    }
    read
}
