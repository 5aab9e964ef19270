//! The numbers of a glTF file: accessors look into views, views into buffers.

use super::document::{Accessor, Document};
use crate::fault::Fault;

const REMEDY: &str = "export it again";

/// The document with its buffers.
pub(super) struct Data<'a> {
    pub(super) document: &'a Document,
    pub(super) buffers: Vec<Vec<u8>>,
}

/// How a component is stored.
#[derive(Debug, Clone, Copy)]
struct Component {
    /// The code in the file.
    code: u32,
    size: usize,
    /// Whether integers stand for fractions.
    normalized: bool,
}

impl Component {
    fn new(code: u32, normalized: bool) -> Result<Self, Fault> {
        let size = match code {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => {
                return Err(Fault::new(
                    format!("an accessor has the component type {code}"),
                    REMEDY,
                ));
            }
        };
        Ok(Self {
            code,
            size,
            normalized,
        })
    }

    /// The component whose bytes begin `bytes`.
    fn value(self, bytes: &[u8]) -> Option<f64> {
        let one = || bytes.first().copied();
        let two = || bytes.first_chunk::<2>().copied();
        let four = || bytes.first_chunk::<4>().copied();
        let (value, full) = match self.code {
            5120 => (f64::from(one()?.cast_signed()), 127.0),
            5121 => (f64::from(one()?), 255.0),
            5122 => (f64::from(i16::from_le_bytes(two()?)), 32_767.0),
            5123 => (f64::from(u16::from_le_bytes(two()?)), 65_535.0),
            5125 => (f64::from(u32::from_le_bytes(four()?)), f64::from(u32::MAX)),
            _ => return Some(f64::from(f32::from_le_bytes(four()?))),
        };
        Some(if self.normalized {
            (value / full).max(-1.0)
        } else {
            value
        })
    }
}

impl Data<'_> {
    /// The values of an accessor, each with `N` components or, where it has fewer, padded with 1
    /// (colours without alpha). Integers that are not normalized stay as they are.
    pub(super) fn read<const N: usize>(
        &self,
        index: usize,
        kinds: &[&str],
    ) -> Result<Vec<[f64; N]>, Fault> {
        let accessor = self.accessor(index)?;
        if !kinds.contains(&accessor.kind.as_str()) {
            return Err(Fault::new(
                format!(
                    "accessor {index} is of type {}, not {}",
                    accessor.kind,
                    kinds.join(" or ")
                ),
                REMEDY,
            ));
        }
        let width = match accessor.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let component = Component::new(accessor.component_type, accessor.normalized)?;
        let mut values = match accessor.buffer_view {
            Some(view) => self.values(
                view,
                accessor.byte_offset,
                accessor.count,
                component,
                width,
                index,
            )?,
            None => {
                // Zeros that sparse values replace take no room in the file.
                let bytes: usize = self.buffers.iter().map(Vec::len).sum();
                if accessor.count > bytes {
                    return Err(beyond(index));
                }
                vec![[0.0; N]; accessor.count]
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let whole = Component::new(sparse.indices.component_type, false)?;
            let (view, offset) = (sparse.indices.buffer_view, sparse.indices.byte_offset);
            let places: Vec<[f64; 1]> = self.values(view, offset, sparse.count, whole, 1, index)?;
            let (view, offset) = (sparse.values.buffer_view, sparse.values.byte_offset);
            let others: Vec<[f64; N]> =
                self.values(view, offset, sparse.count, component, width, index)?;
            for ([place], other) in places.into_iter().zip(others) {
                // `as` saturates, and what is too large is not there.
                *values
                    .get_mut(place as usize)
                    .ok_or_else(|| beyond(index))? = other;
            }
        }
        Ok(values)
    }

    /// How many values an accessor says to have.
    pub(super) fn accessor(&self, index: usize) -> Result<&Accessor, Fault> {
        let there = self.document.accessors.get(index);
        there.ok_or_else(|| Fault::new(format!("there is no accessor {index}"), REMEDY))
    }

    fn values<const N: usize>(
        &self,
        view: usize,
        offset: usize,
        count: usize,
        component: Component,
        width: usize,
        accessor: usize,
    ) -> Result<Vec<[f64; N]>, Fault> {
        let bytes = self.view(view).ok_or_else(|| beyond(accessor))?;
        let bytes = bytes.get(offset..).ok_or_else(|| beyond(accessor))?;
        let one = component.size * width;
        let stride = self
            .document
            .buffer_views
            .get(view)
            .and_then(|view| view.byte_stride)
            .unwrap_or(one);
        // The last one needs no padding behind it. A stride below its own size would let a few
        // bytes stand for many values.
        let room = bytes
            .len()
            .checked_sub(one)
            .filter(|_| stride >= one)
            .map_or(0, |rest| rest / stride + 1);
        if count > room {
            return Err(beyond(accessor));
        }
        let mut values = Vec::with_capacity(count);
        for place in 0..count {
            let mut value = [1.0; N];
            for (index, component_value) in value.iter_mut().enumerate().take(width) {
                let at = place * stride + index * component.size;
                *component_value = bytes
                    .get(at..)
                    .and_then(|bytes| component.value(bytes))
                    .ok_or_else(|| beyond(accessor))?;
            }
            values.push(value);
        }
        Ok(values)
    }

    fn view(&self, index: usize) -> Option<&[u8]> {
        let view = self.document.buffer_views.get(index)?;
        let end = view.byte_offset.checked_add(view.byte_length)?;
        self.buffers.get(view.buffer)?.get(view.byte_offset..end)
    }
}

fn beyond(accessor: usize) -> Fault {
    Fault::new(
        format!("accessor {accessor} reaches beyond its buffer"),
        "copy or export it again",
    )
}
