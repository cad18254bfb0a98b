//! The head of an HTTP request.

/// The largest length of a head in bytes.
pub(crate) const MAX_BYTES: usize = 16 << 10;

/// The parts of a request that the server uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RequestHead {
    /// The length of the head in bytes.
    pub(crate) length: usize,
    method: String,
    path: String,
    host: String,
    origin: Option<String>,
    /// True if the request asks for a WebSocket.
    pub(crate) upgrades: bool,
}

impl RequestHead {
    /// Parses a head from the first bytes of a request. `None` if the head is not complete.
    ///
    /// # Errors
    /// If the bytes are not a request.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Option<Self>, httparse::Error> {
        let mut headers = [httparse::EMPTY_HEADER; 64];
        let mut request = httparse::Request::new(&mut headers);
        let httparse::Status::Complete(length) = request.parse(bytes)? else {
            return Ok(None);
        };
        let header = |name: &str| {
            let mut headers = request.headers.iter();
            let found = headers.find(|header| header.name.eq_ignore_ascii_case(name))?;
            Some(String::from_utf8_lossy(found.value).into_owned())
        };
        Ok(Some(Self {
            length,
            method: request.method.unwrap_or_default().to_owned(),
            path: request.path.unwrap_or_default().to_owned(),
            host: header("host").unwrap_or_default(),
            origin: header("origin"),
            upgrades: header("upgrade").is_some_and(|to| to.eq_ignore_ascii_case("websocket")),
        }))
    }

    /// Returns the path after the token, or `None` without the right token.
    pub(crate) fn path_behind(&self, token: &str) -> Option<&str> {
        let path = self.path.strip_prefix('/')?.strip_prefix(token)?;
        let path = path.strip_prefix('/')?;
        (self.method == "GET").then(|| path.split('?').next().unwrap_or(path))
    }

    /// Returns true if the request comes from a page of another origin. Browsers send an origin with every WebSocket; a
    /// program without one knows the token.
    pub(crate) fn is_foreign(&self) -> bool {
        let host = |origin: &String| origin.split_once("://").map(|(_, host)| host.to_owned());
        let origin = self.origin.as_ref();
        origin.is_some_and(|origin| host(origin).as_ref() != Some(&self.host))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(text: &str) -> RequestHead {
        let head = RequestHead::parse(text.as_bytes()).expect("a head");
        head.expect("a whole one")
    }

    #[test]
    fn a_path_needs_the_token() {
        let asked = |path: &str| head(&format!("GET {path} HTTP/1.1\r\nHost: a\r\n\r\n"));
        assert_eq!(asked("/t/").path_behind("t"), Some(""));
        assert_eq!(asked("/t/page.js?x").path_behind("t"), Some("page.js"));
        for path in ["/", "/t", "/u/", "/tt/", "t/"] {
            assert_eq!(asked(path).path_behind("t"), None, "{path}");
        }
        let posted = head("POST /t/ HTTP/1.1\r\n\r\n");
        assert_eq!(posted.path_behind("t"), None);
    }

    #[test]
    fn other_origins_are_foreign() {
        let head_with = |lines: &str| head(&format!("GET / HTTP/1.1\r\nHost: a:1\r\n{lines}\r\n"));
        for lines in [
            "",
            "Upgrade: WebSocket\r\n",
            "Upgrade: websocket\r\nOrigin: http://a:1\r\n",
        ] {
            assert!(!head_with(lines).is_foreign(), "{lines}");
        }
        for lines in ["Origin: http://b:1\r\n", "Origin: null\r\n"] {
            assert!(head_with(lines).is_foreign(), "{lines}");
        }
    }

    #[test]
    fn an_incomplete_head_is_waited_for() {
        assert_eq!(RequestHead::parse(b"GET / HTTP/1.1\r\nHost:"), Ok(None));
        assert!(RequestHead::parse(b"\x16\x03\x01\0").is_err());
    }
}
