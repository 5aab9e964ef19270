//! Which values of a point are its position and its colour.

use e57::{PointCloud, Record, RecordDataType, RecordName, RecordValue};
use glam::DVec3;

use crate::fault::Fault;

/// A field's place among a point's values, and its type.
#[derive(Debug, Clone)]
struct Field {
    place: usize,
    kind: RecordDataType,
}

impl Field {
    fn find(prototype: &[Record], name: &RecordName) -> Option<Self> {
        let place = prototype.iter().position(|record| record.name == *name)?;
        let kind = prototype.get(place)?.data_type.clone();
        Some(Self { place, kind })
    }

    fn value(&self, values: &[RecordValue]) -> Option<f64> {
        values.get(self.place)?.to_f64(&self.kind).ok()
    }
}

/// A colour channel with the values that are black and full.
#[derive(Debug)]
struct Channel {
    field: Field,
    min: f64,
    max: f64,
}

impl Channel {
    fn new(field: Field, limits: Option<(&RecordValue, &RecordValue)>) -> Self {
        let of_limits = limits.and_then(|(min, max)| {
            let number = |value: &RecordValue| value.to_f64(&field.kind).ok();
            Some((number(min)?, number(max)?))
        });
        let of_kind = || match field.kind {
            RecordDataType::Single {
                min: Some(min),
                max: Some(max),
            } => (f64::from(min), f64::from(max)),
            RecordDataType::Double {
                min: Some(min),
                max: Some(max),
            } => (min, max),
            RecordDataType::Integer { min, max } => (min as f64, max as f64),
            RecordDataType::ScaledInteger {
                min,
                max,
                scale,
                offset,
            } => (min as f64 * scale + offset, max as f64 * scale + offset),
            _ => (0.0, 1.0),
        };
        let (min, max) = of_limits
            .filter(|(min, max)| max > min)
            .unwrap_or_else(of_kind);
        Self { field, min, max }
    }

    fn value(&self, values: &[RecordValue]) -> Option<u8> {
        let fraction = (self.field.value(values)? - self.min) / (self.max - self.min);
        // `as` saturates; limits that are equal give 0.
        Some((fraction * 255.0).round() as u8)
    }
}

/// Which values of a point are what.
#[derive(Debug)]
pub(super) struct Layout {
    cartesian: Option<[Field; 3]>,
    cartesian_state: Option<Field>,
    spherical: Option<[Field; 3]>,
    spherical_state: Option<Field>,
    color: Option<[Channel; 3]>,
    color_state: Option<Field>,
    /// Whether the coordinates are 32-bit floats.
    pub(super) floats: bool,
}

impl Layout {
    pub(super) fn of(scan: &PointCloud) -> Result<Self, Fault> {
        let find = |name| Field::find(&scan.prototype, &name);
        let three = |names: [RecordName; 3]| {
            let [a, b, c] = names.map(find);
            Some([a?, b?, c?])
        };
        let cartesian = three([
            RecordName::CartesianX,
            RecordName::CartesianY,
            RecordName::CartesianZ,
        ]);
        let spherical = three([
            RecordName::SphericalRange,
            RecordName::SphericalAzimuth,
            RecordName::SphericalElevation,
        ]);
        if cartesian.is_none() && spherical.is_none() {
            return Err(Fault::new(
                "its points have no x, y, z and no range, azimuth, elevation",
                "export points",
            ));
        }
        // Fields whose values are all equal take no bytes: of such fields alone the crate would make
        // points without end.
        let takes_bytes = |record: &Record| match record.data_type {
            RecordDataType::Integer { min, max }
            | RecordDataType::ScaledInteger { min, max, .. } => max > min,
            RecordDataType::Single { .. } | RecordDataType::Double { .. } => true,
        };
        if !scan.prototype.iter().any(takes_bytes) {
            return Err(Fault::new("all its points are the same", "export it again"));
        }
        let limits = scan.color_limits.as_ref();
        let color = three([
            RecordName::ColorRed,
            RecordName::ColorGreen,
            RecordName::ColorBlue,
        ])
        .map(|[red, green, blue]| {
            let of =
                |min: &Option<RecordValue>, max: &Option<RecordValue>| min.clone().zip(max.clone());
            let channel = |field, limits: Option<(RecordValue, RecordValue)>| {
                Channel::new(field, limits.as_ref().map(|(min, max)| (min, max)))
            };
            [
                channel(red, limits.and_then(|l| of(&l.red_min, &l.red_max))),
                channel(green, limits.and_then(|l| of(&l.green_min, &l.green_max))),
                channel(blue, limits.and_then(|l| of(&l.blue_min, &l.blue_max))),
            ]
        });
        let floats = cartesian.as_ref().is_some_and(|axes| {
            axes.iter()
                .any(|axis| matches!(axis.kind, RecordDataType::Single { .. }))
        });
        Ok(Self {
            cartesian,
            cartesian_state: find(RecordName::CartesianInvalidState),
            spherical,
            spherical_state: find(RecordName::SphericalInvalidState),
            color,
            color_state: find(RecordName::IsColorInvalid),
            floats,
        })
    }

    pub(super) fn position(&self, values: &[RecordValue]) -> Option<DVec3> {
        let triple = |fields: &Option<[Field; 3]>, state: &Option<Field>| {
            let [a, b, c] = fields.as_ref()?;
            if let Some(state) = state
                && state.value(values)? != 0.0
            {
                return None;
            }
            let triple = DVec3::new(a.value(values)?, b.value(values)?, c.value(values)?);
            triple.is_finite().then_some(triple)
        };
        triple(&self.cartesian, &self.cartesian_state).or_else(|| {
            let of_sphere = triple(&self.spherical, &self.spherical_state)?;
            let [range, azimuth, elevation] = of_sphere.to_array();
            let direction = DVec3::new(
                elevation.cos() * azimuth.cos(),
                elevation.cos() * azimuth.sin(),
                elevation.sin(),
            );
            Some(range * direction)
        })
    }

    pub(super) fn color(&self, values: &[RecordValue]) -> Option<[u8; 3]> {
        if let Some(state) = &self.color_state
            && state.value(values)? != 0.0
        {
            return None;
        }
        let [red, green, blue] = self.color.as_ref()?;
        Some([
            red.value(values)?,
            green.value(values)?,
            blue.value(values)?,
        ])
    }
}
