//! What is learnt from size distributions, going out: tables for people, JSON for programs, CSV, the
//! figure as SVG and PNG, and the report.

mod figure;

pub use figure::{Band, Dash, FigureContents, Look, Marker, Panel, Series, SizeAxis, SizeTick};
