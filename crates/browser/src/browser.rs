//! A browser, and the program that a keeper starts for it.

use etalon_keeper::{KeptProgram, new_folder};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The part of a word that is replaced by the page's address.
const URL: &str = "{url}";
/// The part of a word that is replaced by the profile's folder.
const PROFILE: &str = "{profile}";

/// A browser, as an adapter's description defines it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Browser {
    /// The words of its command. `{url}` and `{profile}` are replaced.
    pub command: Vec<String>,
    /// The files of its profile, which is a new folder: names and contents.
    pub profile: BTreeMap<String, String>,
}

impl Browser {
    /// Returns what is wrong with the description, if anything.
    pub fn fault(&self) -> Option<&'static str> {
        let has = |word: &str| self.command.iter().any(|w| w.contains(word));
        if self.command.first().is_none_or(String::is_empty) {
            Some("`browser` names no command")
        } else if !has(URL) {
            Some("`browser` needs a word with `{url}`, the address of the page")
        } else if !has(PROFILE) {
            Some("`browser` needs a word with `{profile}`, a new folder for the browser's profile")
        } else if self.profile.keys().any(|name| !is_plain(name)) {
            Some("a file of `profile` needs a plain name")
        } else {
            None
        }
    }

    /// Returns the program that opens the page at this address.
    pub(crate) fn program(&self, url: &str) -> KeptProgram {
        let folder = new_folder("etalon-browser-");
        let profile = folder.display().to_string();
        let words = self.command.iter();
        KeptProgram {
            name: "the browser".to_owned(),
            command: words
                .map(|word| word.replace(URL, url).replace(PROFILE, &profile))
                .collect(),
            environment: BTreeMap::new(),
            folder,
            files: self.profile.clone(),
        }
    }
}

/// Returns true for letters, digits, `.`, `_` and `-`, without a `.` first.
fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    !name.starts_with('.') && !name.is_empty() && name.chars().all(plain)
}
