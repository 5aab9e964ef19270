//! Areas of plans, and places: corners that are typed or in a file, in the world, or polygons of a map, in degrees.

use std::path::{Path, PathBuf};

use glam::DVec2;

use crate::fault::Fault;
use crate::formats::{FileError, MapAreas, holds_areas, read_areas, read_places, typed_places};
use crate::geodesy::Crs;
use fragscale_core::survey::Polygon;

/// `x,y;x,y;…`, or a file with a place a line. With what was mended of the file.
///
/// # Errors
/// Where it is none of both, in a line.
pub fn places(text: &str) -> Result<(Vec<DVec2>, Vec<String>), String> {
    match typed_places(text) {
        Ok(places) => Ok((places, Vec::new())),
        Err(fault) => {
            let path = Path::new(text);
            // Who types semicolons or nothing but numbers means no file.
            let means_file = path.exists() || text.chars().any(char::is_alphabetic);
            match means_file && !text.contains(';') {
                true => read_places(path).map_err(|error| error.to_string()),
                false => Err(fault.to_string()),
            }
        }
    }
}

/// Outlines as somebody gave them.
#[derive(Debug, Clone, PartialEq)]
pub enum Areas {
    /// One, in the world, and what was mended of it.
    InWorld(Vec<DVec2>, Vec<String>),
    /// Of a file of a map: one or more.
    OnEarth(PathBuf, MapAreas),
}

impl Areas {
    /// `x,y;x,y;…`, a file with a place a line, or one of GeoJSON or KML.
    ///
    /// # Errors
    /// Where it is none of these, in a line.
    pub fn read(text: &str) -> Result<Self, String> {
        let path = Path::new(text);
        if holds_areas(path) {
            let areas = read_areas(path).map_err(|error| error.to_string())?;
            return Ok(Self::OnEarth(path.to_owned(), areas));
        }
        let (corners, said) = places(text)?;
        Ok(Self::InWorld(corners, said))
    }

    /// What to keep out of, as polygons in the world, with what was mended; `crs` is asked for where they are on the Earth.
    ///
    /// # Errors
    /// Where one is no polygon, or lies where the coordinate system does not hold; where that is not known. Where the file
    /// holds points or lines, too: somebody may mean them, and nothing would keep out of them.
    pub fn to_keep_out_of(
        self,
        crs: impl FnOnce() -> Result<Crs, String>,
    ) -> Result<(Vec<Polygon>, Vec<String>), String> {
        if let Self::OnEarth(path, areas) = &self
            && let Some(others) = areas.others()
        {
            let what = format!("beside polygons it holds {others}, which keep nothing out");
            let remedy =
                "draw what to keep out of as polygons, not as paths, and leave the rest out";
            return Err(FileError::new(path, Fault::new(what, remedy)).to_string());
        }
        self.in_world("keep-out", crs)
    }

    /// As polygons in the world, with what was mended. `what` they are is in front of what is wrong ("area").
    ///
    /// # Errors
    /// Where one is no polygon, or lies where the coordinate system does not hold; where that is not known.
    pub fn in_world(
        self,
        what: &str,
        crs: impl FnOnce() -> Result<Crs, String>,
    ) -> Result<(Vec<Polygon>, Vec<String>), String> {
        let (path, areas) = match self {
            Self::InWorld(corners, said) => {
                let polygon = Polygon::new(&corners).map_err(|error| format!("{what}: {error}"))?;
                return Ok((vec![polygon], said));
            }
            Self::OnEarth(path, areas) => (path, areas),
        };
        let crs = crs()?;
        let polygons = areas.polygons.iter().zip(1..).map(|(corners, number)| {
            let corners: Option<Vec<DVec2>> = (corners.iter())
                .map(|place| Some(crs.from_geographic(*place)?.truncate()))
                .collect();
            let corners = corners.ok_or_else(|| {
                let what = format!("polygon {number} lies where {} does not hold", crs.name());
                let remedy = "check that it is of this place, and that longitudes come first";
                FileError::new(&path, Fault::new(what, remedy)).to_string()
            })?;
            Polygon::new(&corners)
                .map_err(|error| format!("{}: polygon {number}: {error}", path.display()))
        });
        Ok((polygons.collect::<Result<_, String>>()?, Vec::new()))
    }

    /// The same of what is to be one polygon.
    ///
    /// # Errors
    /// Where it is no polygon, or several, or lies where the coordinate system does not hold; where that is not known.
    pub fn one_in_world(
        self,
        what: &str,
        crs: impl FnOnce() -> Result<Crs, String>,
    ) -> Result<(Polygon, Vec<String>), String> {
        if let Self::OnEarth(path, areas) = &self
            && areas.polygons.len() > 1
        {
            let count = areas.polygons.len();
            let several = format!("it holds {count} polygons, where one is needed");
            let remedy = "save the one alone";
            return Err(FileError::new(path, Fault::new(several, remedy)).to_string());
        }
        let (mut polygons, said) = self.in_world(what, crs)?;
        let polygon = polygons.pop().ok_or_else(|| format!("{what}: none"))?;
        Ok((polygon, said))
    }
}
