//! The schedule: every photo coarse to fine against its neighbours' pixels, then once more with the
//! neighbours' depths.

use std::sync::Arc;

use rayon::prelude::*;

use crate::camera::Pose;
use crate::depth_map::DepthMap;
use crate::fault::Fault;
use crate::fusion::agreements;
use crate::jobs::Progress;
use crate::luma::Luma;
use crate::options::DenseOptions;
use crate::patch_match::pair::{Pair, exact, reduced};
use crate::patch_match::plane::{Plane, Planes};
use crate::patch_match::{Backend, MOST_SOURCES, Problem, Source, Sweep};
use crate::view::{Photos, View};

/// The shorter side under which an image is halved no more, pixels.
const COARSEST: usize = 90;
/// The weight of a pixel of reprojection error beside the correlation.
const GEOMETRIC: f32 = 0.1;

/// The depth maps of all views that have neighbours; `None` for the others.
///
/// # Errors
/// Where a photo cannot be read or is of another size than its camera, where no view has neighbours, where
/// the device fails, or where the work was cancelled.
pub fn depth_maps(
    views: &[View],
    photos: &dyn Photos,
    neighbours: &[Vec<usize>],
    options: &DenseOptions,
    backend: &dyn Backend,
    progress: &Progress,
) -> Result<Vec<Option<DepthMap>>, Fault> {
    check(views, neighbours)?;
    let images = read(views, photos, options, progress)?;
    let own = |which: usize| {
        let own = neighbours.get(which).map(Vec::as_slice).unwrap_or_default();
        &own[..own.len().min(options.neighbours.clamp(1, MOST_SOURCES))]
    };
    let mut steps = Steps {
        done: 0,
        total: views.len() as u64 * (2 + u64::from(options.geometric_sweeps > 0)),
    };
    progress.stage("depths from photos");
    let mut found: Vec<Option<Planes>> = Vec::with_capacity(views.len());
    for which in 0..views.len() {
        let planes = match own(which) {
            [] => None,
            others => Some(search(
                views, &images, which, others, options, backend, progress,
            )?),
        };
        found.push(planes);
        steps.next(2, progress)?;
    }
    if options.geometric_sweeps > 0 {
        progress.stage("depths that agree between photos");
        // All from the first answer, so that the order of the photos has no part in it.
        let depths: Vec<_> = found
            .iter()
            .map(|planes| planes.as_ref().map(inverse_depths))
            .collect();
        for (which, planes) in found.iter_mut().enumerate() {
            if let Some(planes) = planes {
                let mut problem = problem(views, &images, which, own(which), 0);
                for (source, other) in problem.sources.iter_mut().zip(own(which)) {
                    source.inverse_depths = depths[*other].clone();
                }
                let sweeps: Vec<_> = (0..options.geometric_sweeps)
                    .map(|i| Sweep {
                        amplitude: 0.5 * 0.5_f32.powi(i.cast_signed()),
                        anywhere: false,
                        geometric: GEOMETRIC,
                        salt: salt(which, 100 + i),
                    })
                    .collect();
                backend.sweep(&problem, planes, &sweeps, progress)?;
            }
            steps.next(1, progress)?;
        }
    }
    let maps = found.into_iter().enumerate().map(|(which, planes)| {
        planes.map(|planes| {
            let per_pixel = problem(views, &images, which, own(which), 0).per_pixel;
            DepthMap::of(
                &views[which],
                images[which].halvings,
                planes,
                per_pixel,
                own(which),
            )
        })
    });
    let mut maps: Vec<_> = maps.collect();
    support(views, &mut maps);
    Ok(maps)
}

/// Counts who agrees, and grades the pixels by it.
fn support(views: &[View], maps: &mut [Option<DepthMap>]) {
    let all: Vec<Vec<u8>> = (0..maps.len())
        .map(|which| {
            let agreements = agreements(views, maps, which);
            let Some(map) = &maps[which] else {
                return Vec::new();
            };
            let count = |at: usize| {
                let same = agreements.iter().filter_map(|other| other.look(map, at));
                u8::try_from(same.filter(|seen| seen.is_same).count()).unwrap_or(u8::MAX)
            };
            (0..map.depths.len()).into_par_iter().map(count).collect()
        })
        .collect();
    for (map, supports) in maps.iter_mut().zip(all) {
        if let Some(map) = map {
            let most = map.neighbours.len().max(1) as f32;
            let grades = map.costs.iter().zip(&supports).map(|(cost, support)| {
                (1.0 - cost).clamp(0.0, 1.0) * (0.2 + 0.8 * f32::from(*support) / most)
            });
            map.confidences = grades.collect();
            map.supports = supports;
        }
    }
}

/// How much is done, over all stages.
struct Steps {
    done: u64,
    total: u64,
}

impl Steps {
    fn next(&mut self, steps: u64, progress: &Progress) -> Result<(), Fault> {
        self.done += steps;
        progress.advance(self.done, self.total)
    }
}

fn check(views: &[View], neighbours: &[Vec<usize>]) -> Result<(), Fault> {
    for (which, view) in views.iter().enumerate() {
        view.check(which)?;
    }
    if neighbours.iter().all(Vec::is_empty) {
        return Err(Fault::new(
            "no photo sees what another sees from an angle that serves",
            "take photos that overlap, from places apart",
        ));
    }
    let is_strange = |(which, others): (usize, &Vec<usize>)| {
        which >= views.len() || others.iter().any(|o| *o >= views.len() || *o == which)
    };
    if neighbours.iter().enumerate().any(is_strange) {
        return Err(Fault::new(
            "the neighbours are not those of these views",
            "choose them anew",
        ));
    }
    Ok(())
}

/// A photo's grey levels, at the map's size and halved from there.
struct Image {
    halvings: u32,
    levels: Vec<Arc<Luma>>,
}

fn read(
    views: &[View],
    photos: &dyn Photos,
    options: &DenseOptions,
    progress: &Progress,
) -> Result<Vec<Image>, Fault> {
    progress.stage("photos");
    let mut images = Vec::with_capacity(views.len());
    for (which, view) in views.iter().enumerate() {
        let photo = photos.photo(which)?;
        let (width, height) = (view.camera.width, view.camera.height);
        if photo.dimensions() != (width, height) {
            let (w, h) = photo.dimensions();
            return Err(Fault::new(
                format!("photo {which} is {w} x {h}, its camera is for {width} x {height}"),
                "give the photo that the camera is for",
            ));
        }
        let mut luma = Luma::of(&photo);
        let mut halvings = 0;
        while luma.levels.len() as u64 > options.most_pixels.max(1) {
            luma = luma.half();
            halvings += 1;
        }
        let mut levels = vec![Arc::new(luma)];
        while let Some(last) = levels.last()
            && last.width.min(last.height) >= 2 * COARSEST
        {
            levels.push(Arc::new(last.half()));
        }
        images.push(Image { halvings, levels });
        progress.advance(which as u64 + 1, views.len() as u64)?;
    }
    Ok(images)
}

/// A view's problem at a size: 0 is the map's, the next is half of it.
fn problem(
    views: &[View],
    images: &[Image],
    which: usize,
    others: &[usize],
    level: usize,
) -> Problem {
    // Photos of another size than the reference have their own number of levels.
    let at = |view: usize| {
        let image = &images[view];
        let level = level.min(image.levels.len() - 1);
        let halvings = image.halvings + u32::try_from(level).unwrap_or(0);
        let camera = reduced(&views[view].camera, halvings);
        (camera, Arc::clone(&image.levels[level]))
    };
    let (camera, luma) = at(which);
    let pose = &views[which].pose;
    let sources: Vec<_> = others
        .iter()
        .map(|other| {
            let (theirs, luma) = at(*other);
            Source {
                luma,
                pair: Pair::of((&camera, pose), (&theirs, &views[*other].pose)),
                inverse_depths: None,
            }
        })
        .collect();
    let [near, far] = views[which].depths;
    let cameras = others
        .iter()
        .map(|other| (at(*other).0, &views[*other].pose));
    let per_pixel = pixels_per_inverse_depth(&camera, pose, [near, far], cameras);
    Problem {
        luma,
        sources,
        range: [far.recip() as f32, near.recip() as f32],
        per_pixel: per_pixel.recip() as f32,
        focal: (0.5 * (camera.fx + camera.fy)) as f32,
        seed: salt(which, u32::try_from(level).unwrap_or(0)),
    }
}

/// How far a pixel in the middle moves in other views per inverse depth: the median over them.
pub(crate) fn pixels_per_inverse_depth<'a>(
    camera: &crate::camera::Camera,
    pose: &Pose,
    [near, far]: [f64; 2],
    others: impl Iterator<Item = (crate::camera::Camera, &'a Pose)>,
) -> f64 {
    let middle = 0.5 * (near.recip() + far.recip());
    let pixel = glam::DVec2::new(f64::from(camera.width), f64::from(camera.height)) * 0.5;
    let mut moves: Vec<f64> = others
        .map(|(theirs, their_pose)| {
            let (a, b) = exact((camera, pose), (&theirs, their_pose));
            let m = a * pixel.extend(1.0) + b * middle;
            ((b.truncate() - m.truncate() / m.z * b.z) / m.z).length()
        })
        .filter(|moved| moved.is_finite() && *moved > 0.0)
        .collect();
    moves.sort_by(f64::total_cmp);
    moves
        .get(moves.len() / 2)
        .copied()
        .unwrap_or(camera.fx * near)
}

fn salt(which: usize, step: u32) -> u32 {
    u32::try_from(which)
        .unwrap_or(0)
        .wrapping_mul(1000)
        .wrapping_add(step)
}

/// Coarse to fine, by the photos alone.
fn search(
    views: &[View],
    images: &[Image],
    which: usize,
    others: &[usize],
    options: &DenseOptions,
    backend: &dyn Backend,
    progress: &Progress,
) -> Result<Planes, Fault> {
    let coarsest = images[which].levels.len() - 1;
    let coarse = problem(views, images, which, others, coarsest);
    let mut planes = Planes::anywhere(&coarse);
    for level in (0..=coarsest).rev() {
        let problem = problem(views, images, which, others, level);
        let is_first = level == coarsest;
        if !is_first {
            planes = planes.doubled(problem.luma.width, problem.luma.height);
        }
        let (count, widest) = match (is_first, level) {
            (true, _) => (options.sweeps + 6, 8.0_f32),
            (false, 0) => (options.sweeps, 1.0),
            (false, _) => (options.sweeps + 2, 2.0),
        };
        let sweeps: Vec<_> = (0..count)
            .map(|i| Sweep {
                amplitude: widest * 0.6_f32.powi(i.cast_signed()),
                anywhere: is_first,
                geometric: 0.0,
                salt: salt(which, 1000 + 32 * u32::try_from(level).unwrap_or(0) + i),
            })
            .collect();
        backend.sweep(&problem, &mut planes, &sweeps, progress)?;
        progress.advance(0, 1)?;
    }
    Ok(planes)
}

fn inverse_depths(planes: &Planes) -> Arc<Vec<f32>> {
    Arc::new(
        planes
            .planes
            .iter()
            .map(|plane| plane.inverse_depth)
            .collect(),
    )
}

impl DepthMap {
    fn of(
        view: &View,
        halvings: u32,
        planes: Planes,
        per_pixel: f32,
        neighbours: &[usize],
    ) -> Self {
        let list = |of: fn(&Plane) -> f32| planes.planes.iter().map(of).collect();
        let costs: Vec<f32> = list(|plane| plane.cost);
        Self {
            camera: reduced(&view.camera, halvings),
            halvings,
            depths: list(|plane| plane.inverse_depth.recip()),
            slopes: planes.planes.iter().map(|plane| plane.slope).collect(),
            supports: vec![0; costs.len()],
            confidences: costs
                .iter()
                .map(|cost| (1.0 - cost).clamp(0.0, 1.0))
                .collect(),
            costs,
            per_pixel,
            neighbours: neighbours.to_vec(),
        }
    }
}
