//! The scales of a flight, ready to be written: in the unit asked for, with notes in words.

use super::ReportObject;
use crate::fault::Fault;
use crate::flight::{Doubt, Evidence, Flight, Outcome, ScaleObject};
use crate::scale::{CornerName, CornerOutcome, EdgeScales, ImageKind};
use crate::units::LengthUnit;

/// The scales of a flight in a unit.
#[derive(Debug)]
pub struct ScaleReport {
    /// The flight's name.
    pub flight: String,
    /// Scales are in pixels per this.
    pub unit: LengthUnit,
    /// The unit of points and elevations.
    pub world_unit: LengthUnit,
    /// Whether anybody says that it is this unit; else no number here is a scale.
    pub unit_known: bool,
    /// Which image the scales are for.
    pub image: ImageKind,
    /// One a photo, in the order of the flight.
    pub lines: Vec<ReportLine>,
}

/// The scale of one photo.
#[derive(Debug)]
pub struct ReportLine {
    /// The photo's name.
    pub photo: String,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Elevation of the ground, where a ray needed it.
    pub ground: Option<f64>,
    /// Pixels per unit.
    pub scale: EdgeScales,
    /// The four corners in the contract's order.
    pub corners: [ReportCorner; 4],
    /// How many corners are on the surface.
    pub corners_on_surface: usize,
    /// What fell back or failed, one sentence each.
    pub notes: Vec<String>,
    /// Scale objects that were traced on it.
    pub scale_objects: Vec<ReportObject>,
}

/// A corner of a photo; x, y, z in the world.
#[derive(Debug, Clone, Copy)]
pub struct ReportCorner {
    /// Which one.
    pub name: CornerName,
    /// In the image.
    pub pixel: [f64; 2],
    /// Unit vector, where there is a ray.
    pub direction: Option<[f64; 3]>,
    /// The corner point, where there is one.
    pub point: Option<[f64; 3]>,
    /// "surface" or "ground", where there is a point.
    pub on: Option<&'static str>,
}

impl ScaleReport {
    /// Puts the outcomes of [`Flight::scales`] into words and the unit.
    pub fn new(flight: &Flight, outcomes: &[Outcome], unit: LengthUnit) -> Self {
        let parts = flight.parts();
        let lines = parts.photos.iter().zip(outcomes).map(|(photo, outcome)| {
            let camera = flight.camera(photo);
            let mut line = ReportLine {
                photo: photo.name.clone(),
                width: camera.width,
                height: camera.height,
                ground: None,
                scale: EdgeScales::default(),
                corners: CornerName::ALL.map(|name| ReportCorner {
                    name,
                    pixel: name.pixel(camera).to_array(),
                    direction: None,
                    point: None,
                    on: None,
                }),
                corners_on_surface: 0,
                notes: Vec::new(),
                scale_objects: Vec::new(),
            };
            match outcome {
                Outcome::Trouble(trouble) => line.notes.push(trouble.clone()),
                Outcome::Scale(scale) => {
                    line.ground = scale.ground;
                    // Pixels per world unit, times world units per unit.
                    line.scale = scale.scale.times(unit.in_units_of(parts.unit));
                    for (corner, computed) in line.corners.iter_mut().zip(&scale.corners) {
                        corner.direction = computed.direction.map(|d| d.to_array());
                        corner.point = computed.point().map(|p| p.to_array());
                        corner.on = match computed.outcome {
                            CornerOutcome::OnSurface { .. } => Some("surface"),
                            CornerOutcome::OnGround { .. } => Some("ground"),
                            CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => None,
                        };
                    }
                    line.corners_on_surface = scale.corners_on_surface();
                    line.notes = scale.notes(parts.unit.symbol());
                }
            }
            if !parts.unit_known {
                line.notes.insert(0, Doubt::UnitUnknown.to_string());
            }
            line
        });
        Self {
            flight: parts.name.clone(),
            unit,
            world_unit: parts.unit,
            unit_known: parts.unit_known,
            image: parts.image,
            lines: lines.collect(),
        }
    }

    /// The same report with scale objects beside their photos' scales; of the same flight, with the
    /// same outcomes.
    ///
    /// # Errors
    /// Where the surface cannot be met.
    pub fn with_scale_objects(
        mut self,
        flight: &Flight,
        objects: &[ScaleObject],
        outcomes: &[Outcome],
    ) -> Result<Self, Fault> {
        let factor = self.unit.in_units_of(self.world_unit);
        let of_photos = ReportObject::of_photos(flight, objects, outcomes, factor)?;
        for (line, objects) in self.lines.iter_mut().zip(of_photos) {
            line.scale_objects = objects;
        }
        Ok(self)
    }

    /// The same report with what was looked up and concerns the numbers themselves in the notes; of
    /// the same flight.
    #[must_use]
    pub fn with_evidence(mut self, evidence: &[Evidence]) -> Self {
        for (line, evidence) in self.lines.iter_mut().zip(evidence) {
            let doubts = evidence.doubts.iter();
            let of_number = doubts.filter(|doubt| doubt.is_of_the_number());
            line.notes.extend(of_number.map(Doubt::to_string));
        }
        self
    }

    /// The same report to type scales from: without those that are none, because nobody knows the
    /// world's unit.
    #[must_use]
    pub fn to_type_from(mut self) -> Self {
        if !self.unit_known {
            for line in &mut self.lines {
                line.scale = EdgeScales::default();
            }
        }
        self
    }

    /// The report of some of the photos, those that are `true` in `selected`, in the same order.
    #[must_use]
    pub fn of_photos(mut self, selected: &[bool]) -> Self {
        let mut selected = selected.iter();
        self.lines.retain(|_| selected.next() == Some(&true));
        self
    }
}

impl ReportLine {
    /// Whether Split-Desktop gets the two scales that it asks for.
    pub fn has_top_and_bottom(&self) -> bool {
        self.scale.top.is_some() && self.scale.bottom.is_some()
    }
}
