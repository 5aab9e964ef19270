//! The world that known positions are brought to, and their way there.

use glam::DVec3;

use crate::fault::Fault;
use crate::geodesy::{Crs, Geographic};
use crate::geometry::median;
use crate::units::LengthUnit;
use crate::world::{Known, NoWorld, WorldFrame};

/// The world, and the coordinate system of a list.
#[derive(Debug, Clone)]
pub(super) struct ListWorld {
    /// `None` where neither the user nor the list states a system: then the list's numbers are the
    /// world's, in metres.
    crs: Option<Crs>,
    list: Option<Crs>,
    unit: LengthUnit,
}

impl ListWorld {
    /// `asked` is what the user states, `stated` what the list does, `positions` those of the list.
    pub(super) fn new(
        asked: Option<&str>,
        stated: Option<&str>,
        positions: &[DVec3],
        warnings: &mut Vec<String>,
    ) -> Result<Self, Fault> {
        let asked = asked.map(Crs::understand).transpose()?;
        let list = match stated {
            Some(stated) => Some(Crs::understand(stated)?),
            None => asked.clone(),
        };
        let middle = list
            .as_ref()
            .map(|list| middle_of(list, positions))
            .transpose()?;
        let known = Known {
            named: asked,
            // The reconstruction, which states nothing, is what has to fit.
            surface: Some(WorldFrame::AsIs(None)),
            poses: list
                .clone()
                .map_or(WorldFrame::AsIs(None), WorldFrame::Named),
            preferred: None,
            place: middle,
        };
        let crs = match known.world() {
            Ok(WorldFrame::Named(crs)) => Some(crs),
            Ok(WorldFrame::AsIs(_) | WorldFrame::Enu(_)) => {
                warnings.push(
                    "the positions state no coordinate system: they are taken as metres of a local one with z up"
                        .to_owned(),
                );
                None
            }
            Err(NoWorld::NoMap(crs)) => {
                return Err(Fault::new(
                    format!("{} is no projected coordinate system", crs.name()),
                    "give a projected one such as EPSG:32633, or none for UTM",
                ));
            }
            Err(error @ NoWorld::NoPlace(_)) => return Err(error.into()),
        };
        let mut unit = LengthUnit::Metre;
        if let Some(crs) = &crs {
            unit = LengthUnit::of_metres(crs.unit_metres()).ok_or_else(|| {
                let what = format!("the unit of {} is {} m long", crs.name(), crs.unit_metres());
                Fault::new(what, "give a system in metres or feet")
            })?;
            if let Some(middle) = middle {
                warnings.extend(crs.check_lengths(middle)?);
            }
            if let Some(list) = &list
                && list.heights() != crs.heights()
                && crs.states_heights()
            {
                warnings.push(format!(
                    "heights are carried over as they are: they count from {} ({})",
                    list.heights(),
                    "no geoid is added"
                ));
            }
        }
        Ok(Self { crs, list, unit })
    }

    /// The same world for another list.
    pub(super) fn with_list(
        &self,
        stated: Option<&str>,
        asked: Option<&str>,
    ) -> Result<Self, Fault> {
        let list = stated.or(asked).map(Crs::understand).transpose()?;
        if list.is_some() != self.crs.is_some() {
            return Err(Fault::new(
                "the photos' positions and the control points are not in one world",
                "state the coordinate system of both, or of neither",
            ));
        }
        Ok(Self {
            list,
            ..self.clone()
        })
    }

    /// The name of its coordinate system.
    pub(super) fn name(&self) -> Option<&str> {
        self.crs.as_ref().map(Crs::name)
    }

    pub(super) fn unit(&self) -> LengthUnit {
        self.unit
    }

    /// What heights count from: what the list's do.
    pub(super) fn heights(&self) -> &str {
        let mut systems = [&self.list, &self.crs].into_iter().flatten();
        let states = systems.find(|system| system.states_heights());
        states.map_or("not said", Crs::heights)
    }

    /// A position of the list in the world.
    pub(super) fn of(&self, position: DVec3) -> Result<DVec3, Fault> {
        let (Some(crs), Some(list)) = (&self.crs, &self.list) else {
            return Ok(position);
        };
        let point = if list.same_as(crs) {
            Some(position)
        } else {
            list.to_geographic(position)
                .and_then(|place| crs.from_geographic(place))
        };
        let point = point.ok_or_else(|| {
            let shown = position.to_array().map(|x| x.to_string()).join(", ");
            Fault::new(
                format!(
                    "the position {shown} of {} has no place in {}",
                    list.name(),
                    crs.name()
                ),
                "check the coordinate system and the order of the coordinates",
            )
        })?;
        // One unit of length for all three.
        let up = crs.vertical_unit_metres() / self.unit.metres();
        Ok(point.with_z(point.z * up))
    }
}

/// The middle of a list's positions on the Earth.
fn middle_of(list: &Crs, positions: &[DVec3]) -> Result<Geographic, Fault> {
    let places: Vec<_> = positions
        .iter()
        .filter_map(|p| list.to_geographic(*p))
        .collect();
    let of =
        |part: fn(&Geographic) -> f64| median(&mut places.iter().map(part).collect::<Vec<f64>>());
    match (of(|p| p.longitude), of(|p| p.latitude)) {
        (Some(longitude), Some(latitude)) => Ok(Geographic {
            longitude,
            latitude,
            height: 0.0,
        }),
        _ => Err(Fault::new(
            format!("its positions are not places in {}", list.name()),
            "check the coordinate system and the order of the coordinates",
        )),
    }
}
