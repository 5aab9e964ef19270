//! The tie points of a project: `point_cloud/point_cloud.zip` beside the frame.zip.
//!
//! ```text
//! doc.xml      <point_cloud> <points component_id="" path="points0.ply"/>
//!              <projections camera_id="" path="p0.ply"/> ...
//! points0.ply  x y z id: a point in the chunk's frame (or its component's)
//! p0.ply       x y size id: where the camera shows the point, in pixels from the corner
//! ```
//!
//! Written from the readers and writers of others (DBAT's loadpsz), not from a real file: a cloud
//! that cannot be read is left out with a warning. Colours (tracks.ply) are not read, nor are
//! projections with a property of 64 bits, which newer versions may have.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read};

use glam::DVec3;
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};
use roxmltree::Node;
use zip::ZipArchive;

use super::georeference::Placing;
use super::xml::children;
use crate::Observation;
use crate::Reconstruction;
use crate::clouds::ply::{number, read_vertices};
use crate::fault::Fault;

/// How large all files of a cloud may be, inflated, in bytes.
const LARGEST: u64 = 1 << 30;

/// The points of one frame.
#[derive(Debug, Default)]
pub(super) struct TiePoints {
    /// By component, where the file names it.
    points: Vec<(Option<String>, Vec<Record>)>,
    /// By camera id.
    projections: Vec<(String, Vec<Record>)>,
    /// Why not all was read.
    trouble: Option<Fault>,
}

/// A vertex of either file.
#[derive(Debug, Clone, Copy)]
struct Record {
    position: DVec3,
    id: f64,
}

impl PropertyAccess for Record {
    fn new() -> Self {
        Self {
            position: DVec3::ZERO,
            id: -1.0,
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let field = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            "id" => &mut self.id,
            _ => return PropertyAccessResult::Ignored,
        };
        let Some(number) = number(&property) else {
            return PropertyAccessResult::UnsupportedType;
        };
        *field = number;
        PropertyAccessResult::Set
    }
}

impl TiePoints {
    /// Reads what a `<point_cloud>` lists from its zip file, as far as it goes.
    pub(super) fn read(archive: &mut ZipArchive<BufReader<File>>, listed: Node<'_, '_>) -> Self {
        let mut found = Self::default();
        if let Err(fault) = found.read_all(archive, listed) {
            found.trouble = Some(fault);
        }
        found
    }

    fn read_all(
        &mut self,
        archive: &mut ZipArchive<BufReader<File>>,
        listed: Node<'_, '_>,
    ) -> Result<(), Fault> {
        let mut budget = LARGEST;
        for points in children(listed, "points") {
            let component = points.attribute("component_id").map(str::to_owned);
            self.points
                .push((component, records(archive, points, &mut budget)?));
        }
        for projections in children(listed, "projections") {
            let camera = projections.attribute("camera_id").unwrap_or_default();
            let records = records(archive, projections, &mut budget)?;
            self.projections.push((camera.to_owned(), records));
        }
        Ok(())
    }

    /// Adds the points that share the frame of the photos, in the world, and where those photos
    /// (index by camera id) show them.
    pub(super) fn add_to(
        self,
        found: &mut Reconstruction,
        placing: &Placing<'_>,
        is_kept: impl Fn(Option<&str>) -> bool,
        photo_of_camera: &HashMap<&str, u32>,
    ) {
        let mut point_of_id: HashMap<u64, u32> = HashMap::new();
        for (component, records) in self.points {
            let component = component.as_deref();
            if !is_kept(component) {
                continue;
            }
            let world = placing.of(component);
            for record in records
                .into_iter()
                .filter(|record| record.position.is_finite())
            {
                let Ok(index) = u32::try_from(found.cloud.points.len()) else {
                    break;
                };
                let point = world.map_or(record.position, |world| world.apply(record.position));
                found.cloud.points.push(point);
                if record.id >= 0.0 {
                    point_of_id.insert(record.id as u64, index);
                }
            }
        }
        for (camera, records) in self.projections {
            let Some(&photo) = photo_of_camera.get(camera.as_str()) else {
                continue;
            };
            for record in records {
                let point = point_of_id
                    .get(&(record.id as u64))
                    .filter(|_| record.id >= 0.0);
                if let Some(&point) = point
                    && record.position.is_finite()
                {
                    let pixel = record.position.truncate();
                    found.observations.push(Observation {
                        photo,
                        point,
                        pixel,
                    });
                }
            }
        }
        if let Some(fault) = self.trouble {
            found
                .warnings
                .push(format!("its tie points are not all read: {}", fault.what));
        }
    }
}

/// The vertices of the PLY file that an element names.
fn records(
    archive: &mut ZipArchive<BufReader<File>>,
    named: Node<'_, '_>,
    budget: &mut u64,
) -> Result<Vec<Record>, Fault> {
    let path = named.attribute("path").unwrap_or_default();
    let entry = archive
        .by_name(path)
        .map_err(|error| Fault::new(format!("'{path}' ({error})"), "copy the project again"))?;
    let mut limited = entry.take(*budget);
    let mut records = Vec::new();
    let read = read_vertices(BufReader::new(&mut limited), |record: Record| {
        records.push(record);
        Ok(())
    });
    *budget = limited.limit();
    read.map_err(|fault| Fault::new(format!("'{path}': {}", fault.what), fault.remedy))?;
    Ok(records)
}
