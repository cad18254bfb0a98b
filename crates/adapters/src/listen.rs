//! The address at which a browser on any machine opens a worker's page.

use serde::{Deserialize, Serialize};
use std::io::IsTerminal;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};

/// An address reserved for documentation (RFC 5737). Nothing is sent there.
const ELSEWHERE: (Ipv4Addr, u16) = (Ipv4Addr::new(192, 0, 2, 1), 9);

/// The address of a page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Listen {
    /// The address at which the worker listens.
    pub address: SocketAddr,
    /// The first part of the page's path, a secret.
    pub token: String,
}

impl Listen {
    /// Makes an address with a new token. All workers of a run share it, so that a page finds the next
    /// worker.
    pub(crate) fn new(address: SocketAddr) -> Self {
        let token = etalon_keeper::token();
        Self { address, token }
    }

    /// Returns a text with the page's URL, and its QR code if standard error is a terminal.
    pub(crate) fn invitation(&self) -> String {
        let host = SocketAddr::new(reached(self.address.ip()), self.address.port());
        let url = format!("http://{host}/{}/", self.token);
        let text = format!("open {url} in the browser to test");
        let code = std::io::stderr()
            .is_terminal()
            .then(|| code(&url))
            .flatten();
        match code {
            Some(code) => format!("{text}\n{code}"),
            None => text,
        }
    }
}

/// Returns the address by which other machines reach this one; chooses one if it listens on all addresses.
fn reached(listening: IpAddr) -> IpAddr {
    if !listening.is_unspecified() {
        return listening;
    }
    let local = || {
        let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
        socket.connect(ELSEWHERE).ok()?;
        Some(socket.local_addr().ok()?.ip())
    };
    local().unwrap_or(Ipv4Addr::LOCALHOST.into())
}

/// Returns a QR code with two rows per line of text.
fn code(url: &str) -> Option<String> {
    let code = qrcode::QrCode::new(url).ok()?;
    let drawn = code.render::<qrcode::render::unicode::Dense1x2>();
    Some(drawn.build())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_invitation_names_the_place_and_its_token() {
        let listen = Listen::new(SocketAddr::from(([127, 0, 0, 1], 8080)));
        let url = format!("http://127.0.0.1:8080/{}/", listen.token);
        assert!(listen.invitation().contains(&url));
        assert_ne!(Listen::new(listen.address).token, listen.token);
        assert_eq!(listen.token.len(), 32);
    }

    #[test]
    fn a_qr_code_is_square() {
        let code = code("http://127.0.0.1:8080/").unwrap();
        let lines: Vec<usize> = code.lines().map(|line| line.chars().count()).collect();
        assert!(
            lines
                .iter()
                .all(|width| (*width).div_ceil(2) == lines.len())
        );
    }
}
