//! A face: the vertices at its corners.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use crate::fault::Fault;

pub(super) struct Face {
    pub(super) corners: Result<Vec<u32>, Fault>,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self {
            corners: Ok(Vec::new()),
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        fn indices<T: TryInto<u32> + Copy + std::fmt::Display>(
            list: Vec<T>,
        ) -> Result<Vec<u32>, Fault> {
            list.into_iter()
                .map(|i| {
                    i.try_into().map_err(|_| {
                        Fault::new(format!("a face names vertex {i}"), "export the mesh again")
                    })
                })
                .collect()
        }
        self.corners = match property {
            Property::ListChar(list) => indices(list),
            Property::ListUChar(list) => indices(list),
            Property::ListShort(list) => indices(list),
            Property::ListUShort(list) => indices(list),
            Property::ListInt(list) => indices(list),
            Property::ListUInt(list) => indices(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}
