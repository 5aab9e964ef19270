//! Points as read, with the triangles that the file brings along, if any.

use glam::DVec3;

/// Points as read from a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    /// World coordinates.
    pub points: Vec<DVec3>,
    /// One red, green, blue a point, or empty where the file has none.
    pub colors: Vec<[u8; 3]>,
    /// Indices into `points`, each below its length; empty where the file has no faces.
    pub triangles: Vec<[u32; 3]>,
}

impl Cloud {
    /// Adds a polygon of point indices as a fan of triangles around its first corner, which is
    /// right for every convex polygon. Fewer than three corners add nothing.
    pub fn add_polygon(&mut self, corners: &[u32]) {
        if let [first, rest @ ..] = corners {
            for edge in rest.windows(2) {
                self.triangles.push([*first, edge[0], edge[1]]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_become_fans() {
        let mut cloud = Cloud::default();
        cloud.add_polygon(&[]);
        cloud.add_polygon(&[1, 2]);
        cloud.add_polygon(&[4, 5, 6, 7, 8]);
        assert_eq!(cloud.triangles, [[4, 5, 6], [4, 6, 7], [4, 7, 8]]);
    }
}
