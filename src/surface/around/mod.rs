//! What of a surface lies around a point of it.

mod ring;
mod triangle;
