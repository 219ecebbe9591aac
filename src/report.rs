//! Plots and pages: what a trial or an experiment looks like on paper.
//!
//! A plot is described once ([`plot`]) and becomes an SVG and a PNG file; a page ([`page`]) is one HTML file that needs
//! nothing else. Nothing here computes results, and nothing here shows a number that was not handed in.

pub mod page;
pub mod plot;
pub mod trial;
