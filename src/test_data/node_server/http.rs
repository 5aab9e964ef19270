//! As much of HTTP as the server speaks: a call a connection, forms, bodies with a length.

use std::collections::HashMap;
use std::io::{Read, Write};
use std::net::TcpStream;

/// A call.
pub(super) struct Call {
    pub(super) method: String,
    pub(super) path: String,
    pub(super) query: HashMap<String, String>,
    pub(super) kind: String,
    pub(super) body: Vec<u8>,
}

pub(super) fn json(stream: &TcpStream, text: &str) -> std::io::Result<()> {
    send(
        stream,
        "200 OK",
        &[("Content-Type", "application/json; charset=utf-8")],
        text.as_bytes(),
    )
}

pub(super) fn send(
    mut stream: &TcpStream,
    status: &str,
    headers: &[(&str, &str)],
    body: &[u8],
) -> std::io::Result<()> {
    let mut text = format!("HTTP/1.1 {status}\r\nX-Powered-By: Express\r\n");
    for (name, value) in headers {
        text += &format!("{name}: {value}\r\n");
    }
    text += &format!(
        "Content-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(text.as_bytes())?;
    stream.write_all(body)
}

/// Reads up to the body, whose length it is made of.
pub(super) fn head(mut stream: &TcpStream) -> std::io::Result<Call> {
    let mut bytes = Vec::new();
    let mut byte = [0];
    while !bytes.ends_with(b"\r\n\r\n") && bytes.len() < 1 << 16 {
        stream.read_exact(&mut byte)?;
        if bytes.is_empty() && byte == [0x16] {
            // The greeting of TLS; Node.js says that it is no HTTP.
            send(stream, "400 Bad Request", &[], b"")?;
            return Err(std::io::ErrorKind::InvalidData.into());
        }
        bytes.extend(byte);
    }
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let mut lines = text.lines();
    let mut first = lines.next().unwrap_or_default().split(' ');
    let (method, target) = (
        first.next().unwrap_or_default(),
        first.next().unwrap_or_default(),
    );
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let headers: HashMap<String, String> = lines
        .filter_map(|line| line.split_once(": "))
        .map(|(name, value)| (name.to_ascii_lowercase(), value.to_owned()))
        .collect();
    let length = headers
        .get("content-length")
        .and_then(|length| length.parse().ok());
    Ok(Call {
        method: method.to_owned(),
        path: path.to_owned(),
        query: query
            .split('&')
            .filter_map(|pair| pair.split_once('='))
            .map(|(key, value)| (key.to_owned(), decoded(value)))
            .collect(),
        kind: headers.get("content-type").cloned().unwrap_or_default(),
        body: vec![0; length.unwrap_or(0)],
    })
}

pub(super) fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let digits: Vec<u8> = rest.by_ref().take(2).collect();
            let digits = String::from_utf8_lossy(&digits).into_owned();
            bytes.push(u8::from_str_radix(&digits, 16).unwrap_or(b'?'));
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

pub(super) struct FormPart {
    pub(super) name: String,
    pub(super) file: String,
    pub(super) bytes: Vec<u8>,
}

/// The parts of a form; the last may be cut off.
pub(super) fn form(call: &Call) -> Vec<FormPart> {
    let Some((_, boundary)) = call.kind.split_once("boundary=") else {
        return Vec::new();
    };
    let between = format!("\r\n--{boundary}").into_bytes();
    // The first has no line before it.
    let mut body = b"\r\n".to_vec();
    body.extend(&call.body);
    let mut parts = Vec::new();
    let mut places: Vec<usize> = (0..body.len().saturating_sub(between.len() - 1))
        .filter(|at| body.get(*at..*at + between.len()) == Some(&between))
        .collect();
    places.push(body.len());
    for pair in places.windows(2) {
        let part = body
            .get(pair[0] + between.len()..pair[1])
            .unwrap_or_default();
        let Some(end) = part.windows(4).position(|bytes| bytes == b"\r\n\r\n") else {
            continue;
        };
        let head = String::from_utf8_lossy(&part[..end]).into_owned();
        let value = |key: &str| {
            let from = head.find(&format!(" {key}=\""))? + key.len() + 3;
            head.get(from..)?.split('"').next().map(str::to_owned)
        };
        parts.push(FormPart {
            name: value("name").unwrap_or_default(),
            file: value("filename").unwrap_or_default(),
            bytes: part[end + 4..].to_vec(),
        });
    }
    parts
}
