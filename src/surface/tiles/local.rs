//! The triangulation of the sites in and around one tile, and which triangles of it are the tile's own.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use glam::DVec2;
use robust::{incircle, orient2d};

use super::triangulated::{Triangulated, coord};
use crate::surface::SurfaceError;
use crate::surface::sites::{Cells, Sites};

/// Cells around a tile. Of random points hardly a circle reaches further.
pub(super) const MARGIN: usize = 4;

/// How many sites found in one circle join at once: the nearest settle most circles.
const SITES_AT_ONCE: usize = 64;

/// The triangulation of the sites in and around a tile.
pub(super) struct Local<'a> {
    sites: &'a Sites,
    /// The tile with its margin: all of its sites are here.
    region: Cells,
    /// The indices of these sites, a range a row, ascending.
    held: Vec<Range<usize>>,
    /// The sites that are here: those of the region row by row, then those that joined.
    here: Vec<u32>,
    /// Of each of them: whether it is one of the tile's own.
    is_own: Vec<bool>,
    /// Where each of them is.
    places: Vec<DVec2>,
    /// Those that joined.
    joined: HashSet<u32>,
    made: Triangulated,
}

impl<'a> Local<'a> {
    /// `None` where the tile has no sites.
    pub(super) fn new(sites: &'a Sites, cells: &Cells) -> Result<Option<Self>, SurfaceError> {
        if sites.ranges_of(cells).all(|range| range.is_empty()) {
            return Ok(None);
        }
        Self::around(sites, cells).map(Some)
    }

    /// The same, although the tile may have none.
    pub(super) fn around(sites: &'a Sites, cells: &Cells) -> Result<Self, SurfaceError> {
        let region = sites.widened(cells, MARGIN);
        let (mut here, mut is_own) = (Vec::new(), Vec::new());
        let own_columns = Cells {
            rows: region.rows.clone(),
            ..cells.clone()
        };
        let own_columns = sites.ranges_of(&own_columns);
        let rows = region.rows.clone().zip(sites.ranges_of(&region));
        for ((row, all), own) in rows.zip(own_columns) {
            let is_own_row = cells.rows.contains(&row);
            is_own.extend(all.clone().map(|index| is_own_row && own.contains(&index)));
            // `Sites` holds no more than u32 counts.
            here.extend(all.filter_map(|index| u32::try_from(index).ok()));
        }
        let mut local = Self {
            sites,
            held: sites.ranges_of(&region).collect(),
            region,
            here,
            is_own,
            places: Vec::new(),
            joined: HashSet::new(),
            made: Triangulated::default(),
        };
        // At the border it will be asked for.
        let (columns, rows) = sites.grid_size();
        let region = &local.region;
        let is_at_border = region.columns.start == 0
            || region.rows.start == 0
            || region.columns.end == columns
            || region.rows.end == rows;
        if is_at_border {
            local.add(sites.hull_indices().to_vec());
        }
        local.triangulate()?;
        Ok(local)
    }

    /// Whether the tile has sites.
    pub(super) fn has_own(&self) -> bool {
        self.is_own.iter().any(|&is_own| is_own)
    }

    /// Adds sites. Says whether there were any that were not here.
    fn add(&mut self, mut more: Vec<u32>) -> bool {
        more.retain(|&site| !self.is_here(site));
        more.sort_unstable();
        more.dedup();
        let is_more = !more.is_empty();
        self.joined.extend(&more);
        self.here.extend(more);
        self.is_own.resize(self.here.len(), false);
        is_more
    }

    fn is_here(&self, site: u32) -> bool {
        // Around a gap of the cloud circles hold many sites, and each is asked for.
        let index = site as usize;
        let row = self.held.partition_point(|range| range.end <= index);
        let is_held = self
            .held
            .get(row)
            .is_some_and(|range| range.contains(&index));
        is_held || self.joined.contains(&site)
    }

    /// Triangulates the sites that are here.
    fn triangulate(&mut self) -> Result<(), SurfaceError> {
        let points = self.sites.points();
        let here = self.here.iter();
        self.places = here.map(|&site| points[site as usize].truncate()).collect();
        self.made = Triangulated::new(&self.places)?;
        Ok(())
    }

    /// Adds sites until no circle around a triangle at an own site holds one that is not here, and no own
    /// site is at the rim unless the hull of all is here, which settles where the surface ends. Then the
    /// triangles around each own site are all there, and proven. With a rectangle (its least and its greatest
    /// corner) the same holds of all triangles that reach into it.
    pub(super) fn settle(&mut self, into: Option<[DVec2; 2]>) -> Result<(), SurfaceError> {
        loop {
            let mut missing: Vec<u32> = Vec::new();
            let mut at_the_rim = self.made.at_the_rim();
            if self.made.is_empty()
                || at_the_rim.any(|corner| self.is_own[corner as usize])
                || into.is_some_and(|into| !self.covers(into))
            {
                missing.extend(self.sites.hull_indices());
            }
            drop(at_the_rim);
            for triangle in 0..self.made.len() {
                let corners = self.made.corners(triangle);
                if corners.iter().any(|&corner| self.is_own[corner as usize])
                    || into.is_some_and(|into| self.reaches_into(triangle, into))
                {
                    self.find_missing(corners, &mut missing);
                }
            }
            if !self.add(missing) {
                return Ok(());
            }
            self.triangulate()?;
        }
    }

    /// Whether its triangles cover a rectangle, but for what rounding leaves open.
    fn covers(&self, [min, max]: [DVec2; 2]) -> bool {
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        let is_inside = |[from, to]: [u32; 2]| {
            let [from, to] = [from, to].map(|place| coord(self.places[place as usize]));
            let turn = |corner: &DVec2| orient2d(from, to, coord(*corner));
            corners.iter().all(|corner| turn(corner) >= 0.0)
        };
        self.made.rim().all(is_inside)
    }

    /// Whether the box around a triangle touches a rectangle.
    fn reaches_into(&self, triangle: usize, [min, max]: [DVec2; 2]) -> bool {
        let [a, b, c] = (self.made.corners(triangle)).map(|corner| self.places[corner as usize]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        high.cmpge(min).all() && low.cmple(max).all()
    }

    /// The first corners (indices of sites) of the triangles that reach into a rectangle: whose tile owns them.
    pub(super) fn first_of_reaching(&self, into: [DVec2; 2]) -> Vec<u32> {
        let reaching = (0..self.made.len()).filter(|&triangle| self.reaches_into(triangle, into));
        let mut first: Vec<u32> = reaching
            .filter_map(|triangle| {
                let on_the_circle = match self.made.shares_circle(triangle) {
                    true => self.on_one_circle(triangle),
                    false => vec![triangle],
                };
                let corners = on_the_circle.iter().flat_map(|&t| self.made.corners(t));
                corners.map(|corner| self.here[corner as usize]).min()
            })
            .collect();
        first.sort_unstable();
        first.dedup();
        first
    }

    /// Finds sites that are not here and lie in or on the circle of a triangle.
    fn find_missing(&self, corners: [u32; 3], missing: &mut Vec<u32>) {
        let [a, b, c] = corners.map(|corner| self.places[corner as usize]);
        let (center, radius_squared) = circle([a, b, c]);
        let radius = radius_squared.sqrt() * (1.0 + 1e-9);
        if self.sites.holds_disc(&self.region, center, radius) {
            return;
        }
        let mut found: Vec<(u32, DVec2)> = Vec::new();
        self.sites.near_disc(center, radius, |index, site| {
            let place = site.truncate();
            // Clearly outside; NaN, of a circle too large for f64, is left to the predicate.
            if place.distance_squared(center) > radius_squared * (1.0 + 1e-6) {
                return;
            }
            let is_in = incircle(coord(a), coord(b), coord(c), coord(place)) >= 0.0;
            // Before they are cut to the nearest: those that are here may all be on the circle.
            if is_in && !self.is_here(index) {
                found.push((index, place));
            }
        });
        if found.is_empty() {
            // Of a part of the sites: that nothing else is there is known of what is here alone.
            self.sites.want_disc(center, radius);
        }
        if found.len() > SITES_AT_ONCE {
            let middle = (a + b + c) / 3.0;
            found.select_nth_unstable_by(SITES_AT_ONCE, |p, q| {
                let distance = |place: DVec2| place.distance_squared(middle);
                distance(p.1).total_cmp(&distance(q.1))
            });
            found.truncate(SITES_AT_ONCE);
        }
        missing.extend(found.into_iter().map(|(index, _)| index));
    }

    /// The triangles (indices of sites) whose first corner is one of the tile's own.
    pub(super) fn owned(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::with_capacity(self.made.len());
        let mut in_a_fan = vec![false; self.made.len()];
        let site = |corner: u32| self.here[corner as usize];
        for triangle in 0..self.made.len() {
            let corners = self.made.corners(triangle);
            let is_own = |corner: u32| self.is_own[corner as usize];
            if in_a_fan[triangle] || !corners.iter().any(|&corner| is_own(corner)) {
                continue;
            }
            if !self.made.shares_circle(triangle) {
                let corners = first_first(corners, site);
                if is_own(corners[0]) {
                    triangles.push(corners.map(site));
                }
                continue;
            }
            let on_the_circle = self.on_one_circle(triangle);
            for &triangle in &on_the_circle {
                in_a_fan[triangle] = true;
            }
            let polygon = self.outline(&on_the_circle);
            if let [first, rest @ ..] = &polygon[..]
                && is_own(*first)
            {
                let fan = rest.windows(2).map(|edge| [*first, edge[0], edge[1]]);
                triangles.extend(fan.map(|corners| corners.map(site)));
            }
        }
        triangles
    }

    /// The triangles whose corners lie on this one's circle, itself first.
    fn on_one_circle(&self, triangle: usize) -> Vec<usize> {
        let mut found = vec![triangle];
        let mut next = 0;
        while let Some(&triangle) = found.get(next) {
            next += 1;
            for neighbour in self.made.on_its_circle(triangle) {
                if !found.contains(&neighbour) {
                    found.push(neighbour);
                }
            }
        }
        found
    }

    /// The corners of the polygon that these triangles make, counter-clockwise, the first one first.
    fn outline(&self, triangles: &[usize]) -> Vec<u32> {
        let mut next: HashMap<u32, u32> = HashMap::new();
        for &triangle in triangles {
            let corners = self.made.corners(triangle);
            for k in 0..3 {
                let neighbour = self.made.neighbour(triangle, k);
                if neighbour.is_none_or(|neighbour| !triangles.contains(&neighbour)) {
                    next.insert(corners[k], corners[(k + 1) % 3]);
                }
            }
        }
        let first = next
            .keys()
            .min_by_key(|&&corner| self.here[corner as usize]);
        let Some(&first) = first else {
            return Vec::new();
        };
        let mut corners = vec![first];
        while let Some(&corner) = corners.last().and_then(|last| next.get(last))
            && corner != first
            && corners.len() < next.len()
        {
            corners.push(corner);
        }
        corners
    }
}

/// The circle through three places: its middle and its radius squared.
fn circle([a, b, c]: [DVec2; 3]) -> (DVec2, f64) {
    let (ab, ac) = (b - a, c - a);
    let to_center = (ab.length_squared() * ac.perp() - ac.length_squared() * ab.perp())
        / (-2.0 * ab.perp_dot(ac));
    (a + to_center, to_center.length_squared())
}

/// The same triangle with its first corner, in the order of `index`, first.
pub(super) fn first_first(corners: [u32; 3], index: impl Fn(u32) -> u32) -> [u32; 3] {
    let [a, b, c] = corners;
    let [i, j, k] = corners.map(index);
    if i < j && i < k {
        [a, b, c]
    } else if j < k {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
