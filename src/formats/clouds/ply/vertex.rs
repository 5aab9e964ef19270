//! A vertex: its coordinates and colour among its properties.

use glam::DVec3;
use ply_rs_bw::ply::{
    ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use crate::fault::Fault;

/// What the properties of `vertex` say.
pub(super) struct VertexLayout {
    pub(super) colors: bool,
    /// Whether the coordinates are 32-bit floats.
    pub(super) floats: bool,
}

impl VertexLayout {
    pub(super) fn of(element: &ElementDef) -> Result<Self, Fault> {
        let mut axes = [None, None, None];
        let mut channels = [false; 3];
        for (name, property) in &element.properties {
            if let Some(axis) = axis(name) {
                axes[axis] = Some(&property.data_type);
            } else if let Some(channel) = channel(name) {
                channels[channel] = true;
            }
        }
        for (axis, name) in axes.iter().zip(["x", "y", "z"]) {
            if !matches!(axis, Some(PropertyType::Scalar(_))) {
                return Err(Fault::new(
                    format!("its vertices have no property {name}"),
                    "export points with x, y and z",
                ));
            }
        }
        let float = PropertyType::Scalar(ScalarType::Float);
        Ok(Self {
            colors: channels == [true; 3],
            floats: axes.contains(&Some(&float)),
        })
    }
}

fn axis(name: &str) -> Option<usize> {
    ["x", "y", "z"]
        .iter()
        .position(|axis| name.eq_ignore_ascii_case(axis))
}

fn channel(name: &str) -> Option<usize> {
    let name = name.strip_prefix("diffuse_").unwrap_or(name);
    let is = |long: &str, short: &str| {
        name.eq_ignore_ascii_case(long) || name.eq_ignore_ascii_case(short)
    };
    [("red", "r"), ("green", "g"), ("blue", "b")]
        .iter()
        .position(|(long, short)| is(long, short))
}

/// The number of a scalar property.
pub(crate) fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => f64::from(v),
        Property::UChar(v) => f64::from(v),
        Property::Short(v) => f64::from(v),
        Property::UShort(v) => f64::from(v),
        Property::Int(v) => f64::from(v),
        Property::UInt(v) => f64::from(v),
        Property::Float(v) => f64::from(v),
        Property::Double(v) => v,
        _ => return None,
    })
}

pub(super) struct Vertex {
    pub(super) position: DVec3,
    pub(super) color: [u8; 3],
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: DVec3::ZERO,
            color: [0; 3],
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(axis) = axis(name) {
            let Some(number) = number(&property) else {
                return PropertyAccessResult::UnsupportedType;
            };
            self.position[axis] = number;
        } else if let Some(channel) = channel(name) {
            // `as` saturates.
            self.color[channel] = match property {
                Property::UChar(v) => v,
                Property::Char(v) => v as u8,
                Property::UShort(v) => (v >> 8) as u8,
                Property::Short(v) => v.clamp(0, 255) as u8,
                Property::Int(v) => v.clamp(0, 255) as u8,
                Property::UInt(v) => v.min(255) as u8,
                Property::Float(v) => (v * 255.0).round() as u8,
                Property::Double(v) => (v * 255.0).round() as u8,
                _ => return PropertyAccessResult::UnsupportedType,
            };
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }
}
