//! Calls to a node.
//!
//! ```text
//! client     the calls, and what their answers mean
//! answers    those answers that are looked at
//! trouble    what can go wrong, by what is to be done about it
//! patience   waiting, and asking again
//! multipart  a form with files, written as it is sent
//! line       a TCP connection that can be called off
//! tls        the same encrypted
//! ```

pub(crate) mod answers;
pub(crate) mod client;
pub(crate) mod line;
pub(crate) mod multipart;
pub(crate) mod patience;
pub(crate) mod tls;
pub(crate) mod trouble;
