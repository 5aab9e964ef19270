//! Encryption.

#![cfg(feature = "tls")]

use std::net::TcpListener;
use std::sync::Arc;

use rustls::pki_types::{CertificateDer, PrivateKeyDer, PrivatePkcs8KeyDer};
use rustls::{ServerConfig, ServerConnection};

use super::*;

/// Greets one after the other with a certificate that it has signed itself (`openssl req -x509`, of localhost and
/// 127.0.0.1, for a hundred years), and counts who believes it.
fn signed_by_itself() -> (u16, std::thread::JoinHandle<usize>) {
    let certificate = CertificateDer::from(&include_bytes!("self_signed/certificate.der")[..]);
    let key = PrivatePkcs8KeyDer::from(&include_bytes!("self_signed/key.der")[..]);
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = ServerConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()
        .unwrap()
        .with_no_client_auth()
        .with_single_cert(vec![certificate], PrivateKeyDer::from(key))
        .unwrap();
    let config = Arc::new(config);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let serves = std::thread::spawn(move || {
        let mut believed = 0;
        // One call, and one that ends it.
        for _ in 0..2 {
            let (mut stream, _) = listener.accept().unwrap();
            let mut line = ServerConnection::new(config.clone()).unwrap();
            while line.is_handshaking() {
                if line.complete_io(&mut stream).is_err() {
                    break;
                }
            }
            believed += usize::from(!line.is_handshaking());
        }
        believed
    });
    (port, serves)
}

#[test]
fn an_unknown_certificate_is_refused() {
    let desk = Desk::faulty(ServerFault::None);
    let (port, serves) = signed_by_itself();
    for host in ["127.0.0.1", "localhost"] {
        let request = NodeRequest {
            node: Address::parse(&format!("https://{host}:{port}")).unwrap(),
            // It does not say that anything is believed.
            insecure: true,
            ..desk.request()
        };
        let error = desk.run_request(&request).unwrap_err();
        assert!(
            error.contains("its certificate is not one that this computer trusts"),
            "{error}"
        );
        assert!(!desk.to().exists());
    }
    assert_eq!(serves.join().unwrap(), 0);
}

/// Where nobody speaks TLS.
#[test]
fn a_node_without_encryption_is_said() {
    let desk = Desk::faulty(ServerFault::None);
    let request = NodeRequest {
        node: Address::parse(&desk.server.address().replace("http://", "https://")).unwrap(),
        ..desk.request()
    };
    let error = desk.run_request(&request).unwrap_err();
    assert!(error.contains("TLS"), "{error}");
    assert!(!desk.to().exists());
}
