//! Areas of plans, and places: corners that are typed or in a file, in the world, or polygons of a map, in degrees.

use std::path::{Path, PathBuf};

use glam::DVec2;

use crate::fault::Fault;
use crate::formats::{
    FileError, MapAreas, holds_areas, read_areas, read_places, read_rings, typed_places,
};
use crate::geodesy::{Crs, Geographic};
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

    /// The same for who only draws them: polygons may have holes.
    ///
    /// # Errors
    /// As [`Areas::read`], but for holes.
    pub fn read_to_draw(text: &str) -> Result<Self, String> {
        let path = Path::new(text);
        if !holds_areas(path) {
            return Self::read(text);
        }
        let areas = read_rings(path).map_err(|error| error.to_string())?;
        Ok(Self::OnEarth(path.to_owned(), areas))
    }

    /// As rings in the world to draw, those of holes, too, with what was mended. `what` they are is in front of what is wrong.
    ///
    /// # Errors
    /// As [`Areas::in_world`]; of rings of a map none is refused for what no area may be.
    pub fn rings_in_world(
        self,
        what: &str,
        crs: impl FnOnce() -> Result<Crs, String>,
    ) -> Result<(Vec<Vec<DVec2>>, Vec<String>), String> {
        let (path, areas) = match self {
            Self::OnEarth(path, areas) => (path, areas),
            typed @ Self::InWorld(..) => {
                let (polygons, said) = typed.in_world(what, crs)?;
                let rings = polygons.iter().map(|polygon| polygon.corners().to_vec());
                return Ok((rings.collect(), said));
            }
        };
        let crs = crs()?;
        let rings = areas.polygons.iter().chain(&areas.holes);
        let rings = rings.map(|corners| in_system(corners, &crs));
        let rings: Option<Vec<Vec<DVec2>>> = rings.collect();
        let rings = rings.ok_or_else(|| off(&path, "a polygon", &crs))?;
        Ok((rings, Vec::new()))
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
            let corners = in_system(corners, &crs);
            let corners = corners.ok_or_else(|| off(&path, &format!("polygon {number}"), &crs))?;
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

/// Corners in a coordinate system; `None` where it does not hold.
fn in_system(corners: &[Geographic], crs: &Crs) -> Option<Vec<DVec2>> {
    let corners = corners.iter();
    corners
        .map(|place| Some(crs.from_geographic(*place)?.truncate()))
        .collect()
}

/// That a polygon of a file lies where a coordinate system does not hold.
fn off(path: &Path, polygon: &str, crs: &Crs) -> String {
    let what = format!("{polygon} lies where {} does not hold", crs.name());
    let remedy = "check that it is of this place, and that longitudes come first";
    FileError::new(path, Fault::new(what, remedy)).to_string()
}
