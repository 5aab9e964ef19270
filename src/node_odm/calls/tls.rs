//! Encryption: rustls with the cryptography of ring, and the certificates that the computer trusts, so that a
//! company's own authority counts here as it does in the browser.

use ureq::config::ConfigBuilder;
use ureq::typestate::AgentScope;
use ureq::unversioned::resolver::DefaultResolver;
use ureq::{Agent, Error};

use crate::fault::Fault;
use crate::line::Lines;

/// An agent over these lines.
#[cfg(feature = "tls")]
pub(crate) fn agent(config: ConfigBuilder<AgentScope>, lines: Lines) -> Agent {
    use std::sync::Arc;

    use ureq::tls::{RootCerts, TlsConfig, TlsProvider};
    use ureq::unversioned::transport::{Connector, RustlsConnector};

    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let tls = TlsConfig::builder()
        .provider(TlsProvider::Rustls)
        .root_certs(RootCerts::PlatformVerifier)
        .unversioned_rustls_crypto_provider(provider)
        .build();
    let config = config.tls_config(tls).build();
    Agent::with_parts(
        config,
        lines.chain(RustlsConnector::default()),
        DefaultResolver::default(),
    )
}

/// An agent over these lines; addresses with https do not come this far ([`crate::Address::may_be_used`]).
#[cfg(not(feature = "tls"))]
pub(crate) fn agent(config: ConfigBuilder<AgentScope>, lines: Lines) -> Agent {
    Agent::with_parts(config.build(), lines, DefaultResolver::default())
}

/// What is wrong with the encryption, if that is it.
#[cfg(feature = "tls")]
pub(crate) fn fault(error: &Error) -> Option<Fault> {
    let found = match error {
        Error::Rustls(error) => error,
        Error::Io(error) => error.get_ref()?.downcast_ref::<rustls::Error>()?,
        _ => return None,
    };
    Some(in_words(found))
}

/// Without encryption nothing is wrong with it.
#[cfg(not(feature = "tls"))]
pub(crate) fn fault(_: &Error) -> Option<Fault> {
    None
}

#[cfg(feature = "tls")]
fn in_words(error: &rustls::Error) -> Fault {
    use rustls::{CertificateError, Error};
    let certificate =
        |why: &str, remedy: &str| Fault::new(format!("its certificate {why}"), remedy);
    match error {
        Error::InvalidCertificate(
            CertificateError::Expired | CertificateError::ExpiredContext { .. },
        ) => certificate(
            "has expired",
            "have it renewed, or set this computer's clock",
        ),
        Error::InvalidCertificate(
            CertificateError::NotValidForName | CertificateError::NotValidForNameContext { .. },
        ) => certificate("is of another name", "use the name that stands in it"),
        Error::InvalidCertificate(CertificateError::Revoked) => {
            certificate("was revoked", "have it renewed")
        }
        Error::InvalidCertificate(_) => certificate(
            "is not one that this computer trusts (signed by itself or by an authority that is not known here)",
            "let the computer trust whoever signed it, as for the browser",
        ),
        Error::InvalidMessage(_) => Fault::new(
            "it does not speak TLS there",
            "try http://, or another port",
        ),
        other => Fault::new(
            format!("TLS failed ({other})"),
            "check the address, and the node's TLS settings",
        ),
    }
}
