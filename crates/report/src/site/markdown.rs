//! Markdown as HTML, with the anchors that forges give to headings.

use pulldown_cmark::{CowStr, Event, LinkType, Options, Parser, Tag, TagEnd, html};
use std::collections::HashMap;

/// The fate of a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// It leads to this address.
    To(String),
    /// Its text stays, without a link.
    Text,
}

/// A document as HTML.
pub(crate) struct Rendered {
    /// The text of the first heading.
    pub(crate) title: String,
    /// The content of the page.
    pub(crate) html: String,
    /// The anchors of the headings, in their order.
    pub(crate) anchors: Vec<String>,
}

/// Returns a text as HTML. `target` is asked for each link, and for each picture by its second argument.
pub(crate) fn render(text: &str, mut target: impl FnMut(&str, bool) -> Target) -> Rendered {
    let parser = Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH);
    let mut events: Vec<Event<'_>> = Vec::new();
    let mut anchors = Anchors::default();
    let mut title = None;
    let mut all = Vec::new();
    // The heading at hand: its place among the events, and its text.
    let mut heading: Option<(usize, String)> = None;
    // True for each open link that stays a link.
    let mut links = Vec::new();
    for event in parser {
        match event {
            // Comments, and what a page with a strict policy would not show.
            Event::Html(_) | Event::InlineHtml(_) => {}
            Event::Start(Tag::HtmlBlock) | Event::End(TagEnd::HtmlBlock) => {}
            Event::Start(Tag::Heading { .. }) => {
                heading = Some((events.len(), String::new()));
                events.push(event);
            }
            Event::End(TagEnd::Heading(_)) => {
                if let Some((start, text)) = heading.take() {
                    let anchor = anchors.of(&text);
                    title.get_or_insert(text);
                    all.push(anchor.clone());
                    if let Event::Start(Tag::Heading { id, .. }) = &mut events[start] {
                        *id = Some(CowStr::from(anchor));
                    }
                }
                events.push(event);
            }
            Event::Start(mut tag @ (Tag::Link { .. } | Tag::Image { .. })) => {
                let to = redirected(&mut tag, &mut target);
                links.push(to);
                if to {
                    events.push(Event::Start(tag));
                }
            }
            Event::End(TagEnd::Link | TagEnd::Image) => {
                if links.pop() == Some(true) {
                    events.push(event);
                }
            }
            Event::Start(Tag::Table(_)) => {
                events.push(Event::Html(CowStr::from("<div class=\"wide\">")));
                events.push(event);
            }
            Event::End(TagEnd::Table) => {
                events.push(event);
                events.push(Event::Html(CowStr::from("</div>")));
            }
            Event::Text(ref words) | Event::Code(ref words) => {
                if let Some((_, text)) = &mut heading {
                    text.push_str(words);
                }
                events.push(event);
            }
            other => events.push(other),
        }
    }
    let mut html = String::new();
    html::push_html(&mut html, events.into_iter());
    Rendered {
        title: title.unwrap_or_default(),
        html,
        anchors: all,
    }
}

/// Sends a link or a picture where `target` says. True if it stays one.
fn redirected(tag: &mut Tag<'_>, target: &mut impl FnMut(&str, bool) -> Target) -> bool {
    let picture = matches!(tag, Tag::Image { .. });
    let (Tag::Link {
        link_type,
        dest_url,
        ..
    }
    | Tag::Image {
        link_type,
        dest_url,
        ..
    }) = tag
    else {
        return true;
    };
    if *link_type == LinkType::Email {
        return false;
    }
    match target(dest_url, picture) {
        Target::To(to) => {
            *dest_url = CowStr::from(to);
            true
        }
        Target::Text => false,
    }
}

/// Returns the anchors of a document's headings.
pub(crate) fn anchors(text: &str) -> Vec<String> {
    render(text, |_, _| Target::Text).anchors
}

/// Anchors as GitHub makes them: lower case, without punctuation, spaces as hyphens, numbered where they repeat.
#[derive(Default)]
struct Anchors {
    taken: HashMap<String, u32>,
}

impl Anchors {
    fn of(&mut self, heading: &str) -> String {
        let kept = heading.trim().to_lowercase();
        let anchor: String = kept
            .chars()
            .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | ' '))
            .map(|c| if c == ' ' { '-' } else { c })
            .collect();
        let count = self.taken.entry(anchor.clone()).or_default();
        *count += 1;
        match *count {
            1 => anchor,
            n => format!("{anchor}-{}", n - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(text: &str) -> Rendered {
        render(text, |to, _| Target::To(to.to_owned()))
    }

    #[test]
    fn headings_have_the_anchors_of_forges() {
        let text = "# The `cpu` adapter, and: more\n## Twice\n## Twice\n### Where do I …?\n";
        let all = [
            "the-cpu-adapter-and-more",
            "twice",
            "twice-1",
            "where-do-i-",
        ];
        assert_eq!(anchors(text), all);
        let rendered = plain(text);
        assert_eq!(rendered.title, "The cpu adapter, and: more");
        for anchor in all {
            let id = format!("id=\"{anchor}\"");
            assert!(rendered.html.contains(&id), "{id}: {}", rendered.html);
        }
    }

    #[test]
    fn links_and_pictures_go_where_they_are_sent_or_stay_text() {
        let text = "[one](a.md) [two](b.md#c) ![three](p.png) [![four](q.png)](d.md)";
        let rendered = render(text, |to, picture| match (to, picture) {
            ("a.md", false) => Target::Text,
            ("p.png", true) => Target::Text,
            (to, _) => Target::To(format!("x/{to}")),
        });
        let due = "<p>one <a href=\"x/b.md#c\">two</a> three <a href=\"x/d.md\"><img src=\"x/q.png\" alt=\"four\" /></a></p>\n";
        assert_eq!(rendered.html, due);
    }

    #[test]
    fn raw_html_is_dropped_and_text_is_escaped() {
        let text = "<!-- list -->\n\na < b <script>alert(1)</script>\n\n`<i>`\n";
        let rendered = plain(text);
        assert_eq!(
            rendered.html,
            "<p>a &lt; b alert(1)</p>\n<p><code>&lt;i&gt;</code></p>\n"
        );
    }
}
