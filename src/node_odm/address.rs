//! The address of a node, as the user typed it, and the token that opens it.
//!
//! The token is kept apart from the address, and nothing here prints it: an address may be said, written and
//! remembered.

use std::fmt;
use std::net::Ipv6Addr;
use std::net::{IpAddr, Ipv4Addr};

use crate::fault::Fault;

/// Where a NodeODM or ClusterODM answers: scheme, host, port and the folder below which its calls lie.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address {
    is_encrypted: bool,
    /// As it stands in a URL: an IPv6 address in brackets.
    host: String,
    port: Option<u16>,
    /// Empty, or "/folder" without a slash at its end.
    folder: String,
}

const EXAMPLE: &str = "write it as http://localhost:3000 or https://node.mine.example";

impl Address {
    /// What was typed: `http://HOST[:PORT][/FOLDER]`, or the same with https.
    ///
    /// # Errors
    /// Where it is something else. A token or a password in it is refused and not repeated.
    pub fn parse(typed: &str) -> Result<Self, Fault> {
        let typed = typed.trim();
        // Before anything of it is quoted.
        if typed.contains(['?', '@']) {
            let what = "the node's address holds a token, a name or a password";
            let remedy =
                "give the address alone, and the token in FRAGSCALE_NODE_TOKEN or with --token";
            return Err(Fault::new(what, remedy));
        }
        let wrong =
            |why: &str| Fault::new(format!("\"{typed}\" is no node's address: {why}"), EXAMPLE);
        let (scheme, rest) = typed
            .split_once("://")
            .ok_or_else(|| wrong("it does not begin with http:// or https://"))?;
        let is_encrypted = match scheme.to_ascii_lowercase().as_str() {
            "http" => false,
            "https" => true,
            _ => return Err(wrong("it does not begin with http:// or https://")),
        };
        let (authority, folder) = match rest.find('/') {
            Some(at) => rest.split_at(at),
            None => (rest, ""),
        };
        let folder = folder.trim_end_matches('/');
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "-._~/%".contains(c);
        if !folder.chars().all(is_plain)
            || folder.contains("//")
            || folder.split('/').any(|part| part == "..")
        {
            return Err(wrong("what follows the host is no folder"));
        }
        let (host, port) = match authority.rsplit_once(':') {
            // A colon inside brackets is the address's own.
            Some((host, port)) if !port.ends_with(']') => (host, Some(port)),
            _ => (authority, None),
        };
        let port = port.map(|port| match port.parse::<u16>() {
            Ok(number) if number > 0 && port.bytes().all(|byte| byte.is_ascii_digit()) => {
                Ok(number)
            }
            _ => Err(wrong("its port is no number from 1 to 65535")),
        });
        let is_host = match host.strip_prefix('[').map(|inner| inner.strip_suffix(']')) {
            Some(inner) => inner.is_some_and(|inner| inner.parse::<Ipv6Addr>().is_ok()),
            None => {
                let is_named = |c: char| c.is_ascii_alphanumeric() || "-._".contains(c);
                !host.is_empty() && host.len() < 254 && host.chars().all(is_named)
            }
        };
        if !is_host {
            return Err(wrong("its host is no name and no IP address"));
        }
        Ok(Self {
            is_encrypted,
            host: host.to_ascii_lowercase(),
            port: port.transpose()?,
            folder: folder.to_owned(),
        })
    }

    /// Whether what is sent to it is encrypted.
    pub fn is_encrypted(&self) -> bool {
        self.is_encrypted
    }

    /// Whether it is this computer.
    pub fn is_here(&self) -> bool {
        let bare = self.host.trim_start_matches('[').trim_end_matches(']');
        match bare.parse() {
            Ok(IpAddr::V4(address)) => Ipv4Addr::is_loopback(&address),
            Ok(IpAddr::V6(address)) => Ipv6Addr::is_loopback(&address),
            Err(_) => self.host == "localhost",
        }
    }

    /// Whether photos and the token may go there.
    ///
    /// # Errors
    /// Where they would cross a network that everybody can listen to, and nobody said that this is all right.
    pub fn may_be_used(&self, insecure: bool) -> Result<(), Fault> {
        if self.is_encrypted && !cfg!(feature = "tls") {
            let what = format!("{self}: this fragscale was built without TLS");
            return Err(Fault::new(
                what,
                "build it with the feature tls, or use a node with http://",
            ));
        }
        if self.is_encrypted || self.is_here() || insecure {
            return Ok(());
        }
        let what = format!("{self}: photos and token would cross the network unencrypted");
        let remedy = "use https://, or say that this network may be trusted: --insecure (in the window \"Not encrypted\")";
        Err(Fault::new(what, remedy))
    }

    /// The URL of a call, `path` beginning with a slash; `query` is without the token.
    pub(crate) fn url(&self, path: &str, query: &str, token: Option<&Token>) -> String {
        let mut url = format!("{self}{path}");
        let token = token.map(|token| format!("token={}", percent_encoded(&token.0)));
        let queries = [
            Some(query).filter(|query| !query.is_empty()),
            token.as_deref(),
        ];
        let mut sign = '?';
        for query in queries.into_iter().flatten() {
            url.push(sign);
            url += query;
            sign = '&';
        }
        url
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = if self.is_encrypted { "https" } else { "http" };
        write!(f, "{scheme}://{}", self.host)?;
        if let Some(port) = self.port {
            write!(f, ":{port}")?;
        }
        f.write_str(&self.folder)
    }
}

/// The word that opens a node. It is sent, and neither printed nor written.
#[derive(Clone, PartialEq, Eq, Default)]
pub struct Token(String);

impl Token {
    /// A token as it was typed; `None` where nothing was.
    pub fn typed(text: &str) -> Option<Self> {
        let text = text.trim();
        (!text.is_empty()).then(|| Self(text.to_owned()))
    }

    /// The token of a run: that which was typed, else that of the environment variable FRAGSCALE_NODE_TOKEN, which other
    /// users of the computer do not see.
    pub fn typed_or_set(typed: &str) -> Option<Self> {
        Self::first_of(typed, std::env::var("FRAGSCALE_NODE_TOKEN").ok())
    }

    fn first_of(typed: &str, set: Option<String>) -> Option<Self> {
        Self::typed(typed).or_else(|| Self::typed(&set?))
    }

    /// A text of a node without the token, as it is and as it stands in a URL: nodes repeat what they were sent.
    pub(crate) fn hidden_in(&self, text: &str) -> String {
        let mut hidden = text.replace(&self.0, "***");
        let encoded = percent_encoded(&self.0);
        if encoded != self.0 {
            hidden = hidden.replace(&encoded, "***");
        }
        hidden
    }
}

impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("***")
    }
}

/// As it stands in a URL's query or in a form: all but RFC 3986's unreserved characters as %XX.
pub(crate) fn percent_encoded(text: &str) -> String {
    let mut encoded = String::new();
    for byte in text.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => {
                encoded.push(char::from(byte));
            }
            _ => encoded += &format!("%{byte:02X}"),
        }
    }
    encoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_typed_or_set() {
        let set = || Some("set".to_owned());
        assert_eq!(Token::first_of("typed", set()), Token::typed("typed"));
        assert_eq!(Token::first_of(" ", set()), Token::typed("set"));
        assert_eq!(Token::first_of("", Some(String::new())), None);
        assert_eq!(Token::first_of("", None), None);
    }

    #[test]
    fn addresses_are_read_as_they_are_typed() {
        for (typed, said) in [
            ("http://localhost:3000", "http://localhost:3000"),
            (" HTTP://LocalHost:3000/ ", "http://localhost:3000"),
            ("https://node.mine.example", "https://node.mine.example"),
            ("https://mine.example/odm/", "https://mine.example/odm"),
            ("http://[::1]:3000", "http://[::1]:3000"),
            ("http://[fe80::1]", "http://[fe80::1]"),
            ("http://10.0.0.7:65535", "http://10.0.0.7:65535"),
            ("http://node_1:3000", "http://node_1:3000"),
        ] {
            assert_eq!(Address::parse(typed).unwrap().to_string(), said);
        }
    }

    #[test]
    fn what_is_no_address_is_refused() {
        for typed in [
            "",
            "localhost:3000",
            "ftp://localhost",
            "http://",
            "http:///odm",
            "http://:3000",
            "http://localhost:0",
            "http://localhost:65536",
            "http://localhost:+80",
            "http://localhost:",
            "http://local host",
            "http://localhost\r\nHost:a",
            "http://[::1",
            "http://[1.2.3.4]",
            "http://localhost/a b",
            "http://localhost/a/../b",
            "http://localhost//b",
            "http://localhost/#x",
        ] {
            let fault = Address::parse(typed).unwrap_err();
            assert!(
                fault.what.contains("is no node's address"),
                "{typed}: {fault}"
            );
        }
        // What may be secret is not repeated.
        for typed in [
            "http://localhost:3000?token=s3cret",
            "http://me:s3cret@localhost:3000",
        ] {
            let said = Address::parse(typed).unwrap_err().to_string();
            assert!(
                !said.contains("s3cret") && said.contains("FRAGSCALE_NODE_TOKEN"),
                "{said}"
            );
        }
    }

    #[test]
    fn only_this_computer_is_reached_unencrypted() {
        let may =
            |typed: &str, insecure| Address::parse(typed).unwrap().may_be_used(insecure).is_ok();
        for here in [
            "http://localhost:3000",
            "http://127.0.0.1:3000",
            "http://127.9.9.9",
            "http://[::1]:3000",
        ] {
            assert!(may(here, false), "{here}");
        }
        for there in [
            "http://10.0.0.7:3000",
            "http://localhost.example",
            "http://node",
            "http://[fe80::1]",
            "http://127.0.0.1.example",
        ] {
            assert!(!may(there, false), "{there}");
            assert!(may(there, true), "{there}");
        }
        assert_eq!(may("https://node", false), cfg!(feature = "tls"));
    }

    #[test]
    fn the_token_stands_in_the_url_and_nowhere_else() {
        let address = Address::parse("http://localhost:3000/odm").unwrap();
        let token = Token::typed(" s&c t ").unwrap();
        let url = address.url("/info", "", Some(&token));
        assert_eq!(url, "http://localhost:3000/odm/info?token=s%26c%20t");
        let url = address.url("/task/1/output", "line=3", Some(&token));
        assert_eq!(
            url,
            "http://localhost:3000/odm/task/1/output?line=3&token=s%26c%20t"
        );
        assert_eq!(
            address.url("/info", "", None),
            "http://localhost:3000/odm/info"
        );
        assert_eq!(format!("{token:?} {address:?}").matches("s&c").count(), 0);
        assert_eq!(
            token.hidden_in("a s&c t b ?token=s%26c%20t."),
            "a *** b ?token=***."
        );
        assert_eq!(Token::typed(" "), None);
    }
}
