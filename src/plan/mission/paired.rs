//! Which photo that was taken is which planned one.
//!
//! By names, where these say it: all planned photos have one of theirs, or all that were taken are named for a planned one, also
//! behind what the camera calls them (DJI adds the name to its own: `DJI_20260601_0001_P001.JPG`). Else by place and by where the
//! camera looks, once what all are off alike is taken off: a receiver's error over a flight is nearly the same in all its photos,
//! and stops lie nearer together than that. So it is looked for from several starts, and what fits best is taken. Where the photos'
//! names count in the order of the mission, which cameras do, the order decides between those that are alike (an alignment of both,
//! as of sequences: Needleman & Wunsch 1970).

use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::camera::{Camera, Pose};
use crate::geometry::median;

/// An axis that is turned by so much, degrees, tells no more than one that is turned further: a gimbal may fail.
const TURNED: f64 = 30.0;
/// How much that weighs against the place: in parts of the farthest that a photo may be from its plan.
const TURNED_WEIGHS: f64 = 0.6;
/// How much a turn about the axis weighs, half around: it decides between photos that are alike otherwise.
const ROLLED_WEIGHS: f64 = 0.05;
/// In an alignment a plan without its photo and a photo without its plan cost together as much as a pair that is so many times as far
/// off as pairs are in the middle: else all behind a photo that is missing would be moved on by one.
const FAR_OFF: f64 = 4.0;
/// And at least so far, in parts of the farthest: what nobody flies more exactly.
const LEAST_OFF: f64 = 0.02;
/// Photos of which any two follow each other by their names as in the mission are in its order; so many parts of all pairs more
/// than those that do not.
const IN_ORDER: f64 = 0.8;
/// How often pairs and what all are off are found from each other, from each start.
const ROUNDS: usize = 5;
/// Of fewer nobody knows what all are off.
const LEAST: usize = 3;
/// Pairs that cost less by more than so many parts of what their distances cost fit better; else that is by chance.
const BY_CHANCE: f64 = 0.5;
/// Of so many photos that are nearest to a plan one is taken at first: of all pairs of 5000 a list had 1.1 GB.
const NEAREST: usize = 8;
/// The most pairs of all with all that an alignment is made of: 25 MB.
const MOST_ALIGNED: usize = 25_000_000;

/// A photo as it was planned.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPose {
    /// Its name in the mission; where it has none, that of its number as a plan has it.
    pub name: String,
    /// In the world.
    pub pose: Pose,
}

/// A photo that was taken.
#[derive(Debug, Clone, Copy)]
pub struct Taken<'a> {
    /// The name of its file.
    pub name: &'a str,
    /// In the world.
    pub pose: &'a Pose,
    /// With what.
    pub camera: &'a Camera,
}

/// Which photo each planned one is. `farthest` is how far each may be from its plan.
pub(super) fn pairs(
    planned: &[PlannedPose],
    taken: &[Taken<'_>],
    farthest: &[Option<f64>],
) -> Vec<Option<usize>> {
    if let Some(named) = by_name(planned, taken) {
        return named;
    }
    Matching::new(planned, taken, farthest).pairs()
}

/// By the photos' names, where these say it.
fn by_name(planned: &[PlannedPose], taken: &[Taken<'_>]) -> Option<Vec<Option<usize>>> {
    let stems: Vec<String> = taken.iter().map(|taken| stem(taken.name)).collect();
    let mut photos: HashMap<&str, usize> = HashMap::new();
    // The first of several.
    for (photo, name) in stems.iter().enumerate().rev() {
        photos.insert(name, photo);
        if let Some((_, own)) = name.rsplit_once('_') {
            photos.insert(own, photo);
        }
    }
    let named: Vec<Option<usize>> = (planned.iter())
        .map(|plan| photos.get(stem(&plan.name).as_str()).copied())
        .collect();
    let different: HashSet<usize> = named.iter().copied().flatten().collect();
    let found = named.iter().flatten().count();
    let is_said = found == different.len()
        && !different.is_empty()
        && (different.len() == planned.len() || different.len() == taken.len());
    is_said.then_some(named)
}

fn stem(name: &str) -> String {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    stem.to_lowercase()
}

struct Matching<'a> {
    planned: &'a [PlannedPose],
    taken: &'a [Taken<'a>],
    /// How far each photo may be from its plan.
    farthest: Vec<f64>,
    /// The farthest of all.
    most: f64,
}

impl<'a> Matching<'a> {
    fn new(planned: &'a [PlannedPose], taken: &'a [Taken<'a>], farthest: &[Option<f64>]) -> Self {
        // Of a photo that shows nothing as far as of the others; of none that does, as far as there are any.
        let known = farthest.iter().copied().flatten();
        let all = || {
            let places = planned.iter().flat_map(|plan| {
                let centers = taken.iter().map(|taken| taken.pose.center);
                centers.map(|center| center.distance(plan.pose.center))
            });
            places.fold(f64::MIN_POSITIVE, f64::max)
        };
        let most = known.reduce(f64::max).unwrap_or_else(all);
        Self {
            planned,
            taken,
            farthest: farthest.iter().map(|own| own.unwrap_or(most)).collect(),
            most,
        }
    }

    /// What all are off and the pairs are found from each other, from several starts: where stops lie near each other, one start
    /// alone may end with every photo at the stop beside its own, or at one of another height.
    fn pairs(&self) -> Vec<Option<usize>> {
        let by_name = self.order_of_names();
        let mut known: Vec<DVec3> = Vec::new();
        let mut best: Option<Fit> = None;
        for start in self.starts(&by_name) {
            let Some(fit) = self.fit(start, &by_name, &mut known) else {
                continue;
            };
            if best.as_ref().is_none_or(|best| fit.is_better_than(best)) {
                best = Some(fit);
            }
        }
        best.map_or_else(|| vec![None; self.planned.len()], |best| best.chosen)
    }

    /// What all may be off: nothing; as much higher as those on the map; where there are as many photos as stops, what each is off
    /// the stop of its number, in the middle; what the middles of all are off each other. None beside the stop by more
    /// than a photo may be from its plan: that would be another place.
    fn starts(&self, by_name: &[usize]) -> Vec<DVec3> {
        let mut starts = vec![DVec3::ZERO, DVec3::Z * self.height_off()];
        let (planned, taken) = (self.planned.len(), self.taken.len());
        if planned.min(taken) < LEAST {
            return starts;
        }
        let in_order: Vec<Option<usize>> = by_name.iter().copied().map(Some).collect();
        let in_order = (planned == taken).then(|| self.all_are_off(&in_order));
        let stops: DVec3 = self.planned.iter().map(|plan| plan.pose.center).sum();
        let photos: DVec3 = self.taken.iter().map(|taken| taken.pose.center).sum();
        let middles = photos / taken as f64 - stops / planned as f64;
        let more = in_order.flatten().into_iter().chain([middles]);
        starts.extend(more.filter(|off| off.truncate().length() <= self.most));
        starts
    }

    /// Where the rounds lead to from a start; `None` where others came by there: `known` are what all were off in their rounds.
    fn fit(&self, start: DVec3, by_name: &[usize], known: &mut Vec<DVec3>) -> Option<Fit> {
        let mut own = vec![start];
        let mut off = start;
        if known.contains(&off) {
            return None;
        }
        let mut chosen = self.matched(off, by_name);
        for _ in 0..ROUNDS {
            let Some(next) = self.all_are_off(&chosen).filter(|next| *next != off) else {
                break;
            };
            if known.contains(&next) {
                return None;
            }
            off = next;
            own.push(off);
            chosen = self.matched(off, by_name);
        }
        known.extend(own);
        let (mut away, mut looks_off) = (0.0, 0.0);
        let pairs = chosen.iter().enumerate();
        for (number, photo) in pairs.filter_map(|(number, photo)| Some((number, (*photo)?))) {
            // In parts that are the same for all: else what was planned from farther away would fit better.
            away += (self.away(number, photo, off)? / self.most).powi(2);
            looks_off += self.looks_off(number, photo)?;
        }
        Some(Fit {
            chosen,
            off,
            away,
            looks_off,
        })
    }

    /// The nearest ones, or, where these follow each other as their names do, those of an alignment.
    fn matched(&self, off: DVec3, by_name: &[usize]) -> Vec<Option<usize>> {
        let chosen = self.nearest(off);
        match self.is_in_order(&chosen, by_name) {
            true => self.aligned(&chosen, off, by_name),
            false => chosen,
        }
    }

    /// What a pair costs, squares in parts of the farthest: 1 as far from its plan as it may be; `None` where it is farther.
    fn cost(&self, number: usize, photo: usize, off: DVec3) -> Option<f64> {
        let away = self.away(number, photo, off)? / self.farthest.get(number)?;
        if away > 1.0 {
            return None;
        }
        Some(away.powi(2) + self.looks_off(number, photo)?)
    }

    /// How far a photo is from a plan.
    fn away(&self, number: usize, photo: usize, off: DVec3) -> Option<f64> {
        let (plan, taken) = (self.planned.get(number)?, self.taken.get(photo)?);
        Some((taken.pose.center - off).distance(plan.pose.center))
    }

    /// What it costs that a photo looks elsewhere than a plan.
    fn looks_off(&self, number: usize, photo: usize) -> Option<f64> {
        let (plan, taken) = (self.planned.get(number)?, self.taken.get(photo)?);
        let angle = |a: DVec3, b: DVec3| a.dot(b).clamp(-1.0, 1.0).acos().to_degrees();
        let [own, its] = [plan.pose.rotation, taken.pose.rotation];
        let turned = angle(own.z_axis, its.z_axis).min(TURNED) / TURNED;
        let rolled = angle(own.x_axis, its.x_axis) / 180.0;
        Some((TURNED_WEIGHS * turned).powi(2) + (ROLLED_WEIGHS * rolled).powi(2))
    }

    /// How much higher all photos are than the plan of each that is nearest on the map and looks alike: the take-off or the datum
    /// of heights may be another.
    fn height_off(&self) -> f64 {
        let heights = self.taken.iter().filter_map(|taken| {
            let (center, axis) = (taken.pose.center, taken.pose.rotation.z_axis);
            let alike = self.planned.iter().zip(&self.farthest).filter(|(plan, _)| {
                plan.pose.rotation.z_axis.dot(axis) > TURNED.to_radians().cos()
            });
            let on_map = alike.map(|(plan, farthest)| {
                let off = center - plan.pose.center;
                (off.truncate().length(), off.z, *farthest)
            });
            let (level, height, farthest) = on_map.min_by(|a, b| a.0.total_cmp(&b.0))?;
            (level <= farthest).then_some(height)
        });
        let mut heights: Vec<f64> = heights.collect();
        match heights.len() < LEAST {
            true => 0.0,
            false => median(&mut heights).unwrap_or_default(),
        }
    }

    /// What the photos of pairs are off their plans, in the middle; `None` of too few.
    fn all_are_off(&self, chosen: &[Option<usize>]) -> Option<DVec3> {
        let offs: Vec<DVec3> = (self.planned.iter().zip(chosen))
            .filter_map(|(plan, photo)| {
                Some(self.taken.get((*photo)?)?.pose.center - plan.pose.center)
            })
            .collect();
        let along = |of: fn(&DVec3) -> f64| {
            let mut offs: Vec<f64> = offs.iter().map(of).collect();
            median(&mut offs)
        };
        if offs.len() < LEAST {
            return None;
        }
        Some(DVec3::new(
            along(|off| off.x)?,
            along(|off| off.y)?,
            along(|off| off.z)?,
        ))
    }

    /// The cheapest pair first, and so on, of each plan with the photos nearest to it; where these are all of others, the
    /// nearest that is left.
    fn nearest(&self, off: DVec3) -> Vec<Option<usize>> {
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        let cheapest = |a: &(f64, usize, usize), b: &(f64, usize, usize)| {
            a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2)))
        };
        for number in 0..self.planned.len() {
            let photos = (0..self.taken.len())
                .filter_map(|photo| Some((self.cost(number, photo, off)?, number, photo)));
            let mut own: Vec<_> = photos.collect();
            if own.len() > NEAREST {
                own.select_nth_unstable_by(NEAREST, cheapest);
                own.truncate(NEAREST);
            }
            pairs.extend(own);
        }
        pairs.sort_by(cheapest);
        let mut chosen = vec![None; self.planned.len()];
        let mut used = vec![false; self.taken.len()];
        for (_, number, photo) in pairs {
            if chosen[number].is_none() && !used[photo] {
                chosen[number] = Some(photo);
                used[photo] = true;
            }
        }
        self.rest(chosen, off)
    }

    /// The photos in the order of their names, in which numbers count.
    fn order_of_names(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.taken.len()).collect();
        let name = |photo: &usize| self.taken.get(*photo).map_or("", |taken| taken.name);
        order.sort_by(|a, b| by_numbers(name(a), name(b)));
        order
    }

    /// Whether the photos of pairs follow each other by their names as their plans do: nearly any two of them (Kendall's tau).
    fn is_in_order(&self, chosen: &[Option<usize>], by_name: &[usize]) -> bool {
        let mut rank = vec![0; by_name.len()];
        for (place, photo) in by_name.iter().enumerate() {
            rank[*photo] = place;
        }
        let ranks: Vec<usize> = (chosen.iter().flatten())
            .filter_map(|photo| rank.get(*photo).copied())
            .collect();
        let is_small = self.planned.len().saturating_mul(self.taken.len()) <= MOST_ALIGNED;
        if !is_small || ranks.len() < LEAST {
            return false;
        }
        let rising = ranks.iter().enumerate().map(|(place, own)| {
            let behind = ranks.get(place + 1..).unwrap_or_default();
            behind.iter().filter(|other| *other > own).count()
        });
        let all = ranks.len() * (ranks.len() - 1) / 2;
        2.0 * rising.sum::<usize>() as f64 - all as f64 >= IN_ORDER * all as f64
    }

    /// The cheapest pairs of which none overtakes another; what is left by that is given out as it is near. `chosen` are pairs that
    /// tell how far off they are.
    fn aligned(
        &self,
        chosen: &[Option<usize>],
        off: DVec3,
        by_name: &[usize],
    ) -> Vec<Option<usize>> {
        let (rows, columns) = (self.planned.len(), by_name.len());
        let pairs = chosen.iter().enumerate();
        let costs = pairs.filter_map(|(number, photo)| self.cost(number, (*photo)?, off));
        let usual = median(&mut costs.collect::<Vec<f64>>()).unwrap_or_default();
        let alone = FAR_OFF.powi(2) * usual.max(LEAST_OFF.powi(2)) / 2.0;
        // What the best of all before each costs, and by which step.
        let mut above: Vec<f64> = (0..=columns).map(|photo| alone * photo as f64).collect();
        let mut steps = vec![Step::Photo; (rows + 1) * (columns + 1)];
        for number in 0..rows {
            let mut own = vec![above[0] + alone];
            steps[(number + 1) * (columns + 1)] = Step::Plan;
            for (column, photo) in by_name.iter().enumerate() {
                let pair = self
                    .cost(number, *photo, off)
                    .map(|cost| above[column] + cost);
                let plan = (above[column + 1] + alone, Step::Plan);
                let photo = (own[column] + alone, Step::Photo);
                let best = if photo.0 < plan.0 { photo } else { plan };
                let (cost, step) = match pair {
                    Some(pair) if pair <= best.0 => (pair, Step::Pair),
                    _ => best,
                };
                own.push(cost);
                steps[(number + 1) * (columns + 1) + column + 1] = step;
            }
            above = own;
        }
        let mut chosen = vec![None; rows];
        let (mut number, mut column) = (rows, columns);
        while number > 0 || column > 0 {
            match steps[number * (columns + 1) + column] {
                Step::Pair => {
                    (number, column) = (number - 1, column - 1);
                    chosen[number] = Some(by_name[column]);
                }
                Step::Plan => number -= 1,
                Step::Photo => column -= 1,
            }
        }
        self.rest(chosen, off)
    }

    /// Photos that are left are of plans that have none: in an order such as were taken again, later.
    fn rest(&self, mut chosen: Vec<Option<usize>>, off: DVec3) -> Vec<Option<usize>> {
        let mut used: HashSet<usize> = chosen.iter().copied().flatten().collect();
        for (number, own) in chosen.iter_mut().enumerate() {
            if own.is_some() {
                continue;
            }
            let left = (0..self.taken.len()).filter(|photo| !used.contains(photo));
            let costs = left.filter_map(|photo| Some((self.cost(number, photo, off)?, photo)));
            let best = costs.min_by(|a, b| a.0.total_cmp(&b.0));
            *own = best.map(|(_, photo)| photo);
            used.extend(*own);
        }
        chosen
    }
}

/// Pairs, and what all photos are off beside.
struct Fit {
    chosen: Vec<Option<usize>>,
    off: DVec3,
    /// What the distances of all pairs cost.
    away: f64,
    /// What it costs that they look elsewhere.
    looks_off: f64,
}

impl Fit {
    /// Whether it has clearly the better pairs: a plan without a photo costs as much as one as far off as may be, so that none is
    /// moved to pair one more. Of two that fit alike photos are off by the least.
    fn is_better_than(&self, other: &Self) -> bool {
        let alone = |fit: &Self| fit.chosen.iter().filter(|photo| photo.is_none()).count() as f64;
        let chance = |fit: &Self| {
            let pairs = fit.chosen.iter().flatten().count() as f64;
            BY_CHANCE * fit.away + LEAST_OFF.powi(2) * pairs
        };
        let [own, others] = [self, other].map(|fit| fit.away + fit.looks_off + alone(fit));
        if own + chance(self) < others {
            return true;
        }
        others + chance(other) >= own && self.off.length() < other.off.length()
    }
}

/// How a best alignment goes on.
#[derive(Clone, Copy)]
enum Step {
    /// A plan with its photo.
    Pair,
    /// A plan without one.
    Plan,
    /// A photo without a plan.
    Photo,
}

/// Names in the order in which a camera counts: DJI_2 before DJI_10.
fn by_numbers(a: &str, b: &str) -> Ordering {
    let (mut a, mut b) = (a, b);
    loop {
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        match (digits(a), digits(b)) {
            (0, _) | (_, 0) => {
                let (mut ones, mut others) = (a.chars(), b.chars());
                match (ones.next(), others.next()) {
                    (Some(one), Some(other)) if one == other => {
                        (a, b) = (ones.as_str(), others.as_str());
                    }
                    (one, other) => return one.cmp(&other),
                }
            }
            (own, its) => {
                let ((number, rest), (other, behind)) = (a.split_at(own), b.split_at(its));
                let short = |number: &str| number.trim_start_matches('0').to_owned();
                let (number, other) = (short(number), short(other));
                let order = (number.len().cmp(&other.len())).then_with(|| number.cmp(&other));
                if order != Ordering::Equal {
                    return order;
                }
                (a, b) = (rest, behind);
            }
        }
    }
}
