//! The shell of every page: one self-contained file that works offline. Its content security policy forbids
//! all requests, even if a name in a record is hostile, and all scripts except the page's own, which it names
//! by digest.

pub(crate) mod adapter;
pub(crate) mod link;
pub(crate) mod origin;

use crate::words::glossary;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, Render, html};
use sha2::{Digest, Sha256};

const STYLE: &str = include_str!("page/style.css");

/// A page.
pub(crate) struct Page<'a> {
    title: &'a str,
    source: &'a str,
    main: &'a Markup,
    styles: String,
    script: Option<&'static str>,
    /// True if the page's script loads other scripts from the page's folder.
    beside: bool,
}

impl<'a> Page<'a> {
    /// Returns a page with the title of its window, the files from which it was made, and its content.
    pub(crate) fn new(title: &'a str, source: &'a str, main: &'a Markup) -> Self {
        Self {
            title,
            source,
            main,
            styles: STYLE.to_owned(),
            script: None,
            beside: false,
        }
    }

    /// Adds a style sheet to the style sheet of all pages.
    pub(crate) fn style(mut self, style: &str) -> Self {
        self.styles.push_str(style);
        self
    }

    /// Allows this script, which the content includes by [`script`]. If `beside` is true, the script can load
    /// others from the page's folder.
    pub(crate) fn script(mut self, script: &'static str, beside: bool) -> Self {
        (self.script, self.beside) = (Some(script), beside);
        self
    }

    /// Returns the HTML text.
    pub(crate) fn html(&self) -> String {
        html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(policy(self.script, self.beside));
                    @if let (Some(script), true) = (self.script, self.beside) {
                        // Both policies apply together: a script must be added by the page's script and come
                        // from the page's folder.
                        meta http-equiv="Content-Security-Policy" content={ "script-src " (digest(script)) " 'self'" };
                    }
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(&self.styles)) }
                }
                body {
                    a.skip href="#main" { "Skip to the content" }
                    a.words href="#words" { "Words" }
                    main id="main" tabindex="-1" { (self.main) }
                    footer {
                        (glossary())
                        "Made by etalon from " (self.source) "."
                    }
                }
            }
        }
        .into_string()
    }
}

/// Returns totals that are also a legend: the class, number, name and meaning of each.
pub(crate) fn totals<N: Render>(
    items: impl IntoIterator<Item = (&'static str, u64, N, &'static str)>,
) -> Markup {
    html! {
        section id="totals" {
            h2 { "Totals" }
            ul.totals {
                @for (class, n, name, about) in items {
                    li class=(class) { span.big { (n) } " " span.m { (name) } small { (about) } }
                }
            }
        }
    }
}

/// Returns the element of a page's script.
pub(crate) fn script(text: &'static str) -> Markup {
    html! { script { (PreEscaped(text)) } }
}

fn digest(script: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(script)))
}

fn policy(script: Option<&str>, beside: bool) -> String {
    let script = script.map_or(String::new(), |text| {
        let others = if beside { " 'strict-dynamic'" } else { "" };
        format!("script-src {}{others}; ", digest(text))
    });
    format!(
        "default-src 'none'; img-src data:; style-src 'unsafe-inline'; {script}base-uri 'none'; form-action 'none'"
    )
}
