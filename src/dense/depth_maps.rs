//! The schedule: every photo coarse to fine against its neighbours' pixels, then once more with the
//! neighbours' depths.

use std::sync::Arc;

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::found_maps::{DepthMaps, Outline, final_name};
use crate::jobs::Progress;
use crate::luma::Luma;
use crate::options::DenseOptions;
use crate::patch_match::pair::{Pair, exact, reduced};
use crate::patch_match::plane::Planes;
use crate::patch_match::{Backend, MOST_SOURCES, Problem, Source, Sweep};
use crate::shelf::{Recent, Shelf};
use crate::view::{Photos, View};

/// The shorter side under which an image is halved no more, pixels.
const COARSEST: usize = 90;
/// The weight of a pixel of reprojection error beside the correlation.
const GEOMETRIC: f32 = 0.3;

/// Bytes of inverse depths that are kept in memory for the second pass.
const MOST_BYTES: usize = 512 << 20;

/// Finds the depth maps of all views that have neighbours. What is found is put on the shelf photo by photo, and
/// what lies there of a run that was interrupted is taken as it is: give each survey and each choice of options a
/// shelf of its own. An interrupted run that goes on ends with the same maps to the bit.
///
/// # Errors
/// Where a photo cannot be read or is of another size than its camera, where no view has neighbours, where
/// the device or the shelf fails, or where the work was cancelled.
pub fn depth_maps<'a>(
    views: &'a [View],
    photos: &dyn Photos,
    neighbours: &[Vec<usize>],
    options: &DenseOptions,
    backend: &dyn Backend,
    shelf: &'a dyn Shelf,
    progress: &Progress,
) -> Result<DepthMaps<'a>, Fault> {
    check(views, neighbours)?;
    let own = |which: usize| {
        let own = neighbours.get(which).map(Vec::as_slice).unwrap_or_default();
        own[..own.len().min(options.neighbours.clamp(1, MOST_SOURCES))].to_vec()
    };
    let outlines: Vec<Option<Outline>> = (0..views.len())
        .map(|which| outline(views, which, own(which), options))
        .collect();
    let survey = Survey {
        views,
        photos,
        outlines: &outlines,
        options,
        backend,
        shelf,
        progress,
    };
    survey.find()?;
    Ok(DepthMaps::new(views, outlines, shelf))
}

fn first_name(which: usize) -> String {
    format!("first-{which}")
}

/// Of a view with neighbours.
fn outline(
    views: &[View],
    which: usize,
    neighbours: Vec<usize>,
    options: &DenseOptions,
) -> Option<Outline> {
    if neighbours.is_empty() {
        return None;
    }
    let at_size = |view: usize| {
        let camera = &views[view].camera;
        reduced(camera, halvings(camera, options))
    };
    let camera = at_size(which);
    let others = neighbours.iter();
    let others = others.map(|other| (at_size(*other), &views[*other].pose));
    let View { pose, depths, .. } = &views[which];
    let per_pixel = pixels_per_inverse_depth(&camera, pose, *depths, others);
    Some(Outline {
        halvings: halvings(&views[which].camera, options),
        per_pixel: per_pixel.recip() as f32,
        camera,
        neighbours,
    })
}

/// How many times a photo is halved before its depths are looked for.
fn halvings(camera: &Camera, options: &DenseOptions) -> u32 {
    let mut halvings = 0;
    let pixels = |halvings: u32| {
        let camera = reduced(camera, halvings);
        u64::from(camera.width) * u64::from(camera.height)
    };
    while pixels(halvings) > options.most_pixels.max(1) {
        halvings += 1;
    }
    halvings
}

/// The work on all views.
struct Survey<'a> {
    views: &'a [View],
    photos: &'a dyn Photos,
    outlines: &'a [Option<Outline>],
    options: &'a DenseOptions,
    backend: &'a dyn Backend,
    shelf: &'a dyn Shelf,
    progress: &'a Progress,
}

impl Survey<'_> {
    /// Puts the final planes of every view with neighbours on the shelf.
    fn find(&self) -> Result<(), Fault> {
        let with_neighbours = (0..self.views.len()).filter(|which| self.outlines[*which].is_some());
        let missing: Vec<usize> = with_neighbours
            .filter(|which| self.planes(&final_name(*which), *which).is_none())
            .collect();
        if missing.is_empty() {
            return Ok(());
        }
        let images = self.read()?;
        if self.options.geometric_sweeps == 0 {
            return self.by_photos(&images, &missing, final_name);
        }
        // How many of the missing need the first answer of a view.
        let mut users = vec![0_u32; self.views.len()];
        for &which in &missing {
            for user in self.neighbours(which).iter().chain([&which]) {
                users[*user] += u32::from(self.outlines[*user].is_some());
            }
        }
        let needed: Vec<usize> = (0..users.len()).filter(|which| users[*which] > 0).collect();
        let needed_first: Vec<usize> = (needed.into_iter())
            .filter(|which| self.planes(&first_name(*which), *which).is_none())
            .collect();
        self.by_photos(&images, &needed_first, first_name)?;
        self.by_each_other(&images, &missing, &mut users)
    }

    fn neighbours(&self, which: usize) -> &[usize] {
        let outline = self.outlines.get(which).and_then(Option::as_ref);
        outline.map_or(&[], |outline| &outline.neighbours)
    }

    /// What lies on the shelf, if it is whole.
    fn planes(&self, name: &str, which: usize) -> Option<Planes> {
        let camera = &self.outlines[which].as_ref()?.camera;
        let bytes = self.shelf.get(name)?;
        Planes::from_bytes(&bytes, camera.width as usize, camera.height as usize)
    }

    /// The first answer, by the photos alone.
    fn by_photos(
        &self,
        images: &[Image],
        missing: &[usize],
        name: fn(usize) -> String,
    ) -> Result<(), Fault> {
        let all = self.outlines.iter().flatten().count() as u64;
        let before = all.saturating_sub(missing.len() as u64);
        self.progress
            .stage(format!("finding depths of {all} photos (1 of 2)"));
        for (done, &which) in (before..).zip(missing) {
            self.progress.advance(done, all)?;
            let planes = self.search(images, which)?;
            self.shelf.put(&name(which), planes.to_bytes())?;
        }
        Ok(())
    }

    /// The final answer. All from the first one, so that the order of the photos has no part in it.
    fn by_each_other(
        &self,
        images: &[Image],
        missing: &[usize],
        users: &mut [u32],
    ) -> Result<(), Fault> {
        let all = self.outlines.iter().flatten().count() as u64;
        let before = all.saturating_sub(missing.len() as u64);
        self.progress
            .stage(format!("refining depths of {all} photos (2 of 2)"));
        let recent = Recent::new(MOST_BYTES);
        for (done, &which) in (before..).zip(missing) {
            self.progress.advance(done, all)?;
            let lost = || {
                Fault::new(
                    "depths were taken away while they were needed",
                    "start again, and leave the folder alone meanwhile",
                )
            };
            let mut problem = problem(self.views, images, which, self.neighbours(which), 0);
            for (source, &other) in problem.sources.iter_mut().zip(self.neighbours(which)) {
                if self.outlines[other].is_none() {
                    continue;
                }
                let depths = match recent.get(other) {
                    Some(depths) => depths,
                    None => {
                        let planes = self.planes(&first_name(other), other).ok_or_else(lost)?;
                        let depths = inverse_depths(&planes);
                        let bytes = size_of::<f32>() * depths.len();
                        recent.hold(other, bytes, Arc::clone(&depths));
                        depths
                    }
                };
                source.inverse_depths = Some(depths);
            }
            let mut planes = self.planes(&first_name(which), which).ok_or_else(lost)?;
            let sweeps: Vec<_> = (0..self.options.geometric_sweeps)
                .map(|i| Sweep {
                    amplitude: 0.5 * 0.5_f32.powi(i.cast_signed()),
                    anywhere: false,
                    geometric: GEOMETRIC,
                    salt: salt(which, 100 + i),
                })
                .collect();
            self.backend
                .sweep(&problem, &mut planes, &sweeps, self.progress)?;
            self.shelf.put(&final_name(which), planes.to_bytes())?;
            for &user in self.neighbours(which).iter().chain([&which]) {
                users[user] = users[user].saturating_sub(1);
                if users[user] == 0 {
                    self.shelf.discard(&first_name(user));
                }
            }
        }
        Ok(())
    }

    fn read(&self) -> Result<Vec<Image>, Fault> {
        let count = self.views.len();
        self.progress
            .stage(format!("reading {count} photos for their depths"));
        let mut images = Vec::with_capacity(count);
        for (which, view) in self.views.iter().enumerate() {
            self.progress.advance(which as u64, count as u64)?;
            let photo = self.photos.photo(which)?;
            let (width, height) = (view.camera.width, view.camera.height);
            if photo.dimensions() != (width, height) {
                let (w, h) = photo.dimensions();
                return Err(Fault::new(
                    format!("photo {which} is {w} x {h}, its camera is for {width} x {height}"),
                    "give the photo that the camera is for",
                ));
            }
            let mut luma = Luma::of(&photo);
            let halvings = halvings(&view.camera, self.options);
            for _ in 0..halvings {
                luma = luma.half();
            }
            let mut levels = vec![Arc::new(luma)];
            while let Some(last) = levels.last()
                && last.width.min(last.height) >= 2 * COARSEST
            {
                levels.push(Arc::new(last.half()));
            }
            images.push(Image { halvings, levels });
        }
        Ok(images)
    }

    /// Coarse to fine, by the photos alone.
    fn search(&self, images: &[Image], which: usize) -> Result<Planes, Fault> {
        let (views, others) = (self.views, self.neighbours(which));
        let coarsest = images[which].levels.len() - 1;
        let coarse = problem(views, images, which, others, coarsest);
        let mut planes = Planes::anywhere(&coarse);
        for level in (0..=coarsest).rev() {
            let problem = problem(views, images, which, others, level);
            let is_first = level == coarsest;
            if !is_first {
                planes = planes.doubled(problem.luma.width, problem.luma.height);
            }
            let sweeps = self.options.sweeps;
            let (count, widest) = match (is_first, level) {
                (true, _) => (sweeps + 6, 8.0_f32),
                (false, 0) => (sweeps, 1.0),
                (false, _) => (sweeps + 2, 2.0),
            };
            let sweeps: Vec<_> = (0..count)
                .map(|i| Sweep {
                    amplitude: widest * 0.6_f32.powi(i.cast_signed()),
                    anywhere: is_first,
                    geometric: 0.0,
                    salt: salt(which, 1000 + 32 * u32::try_from(level).unwrap_or(0) + i),
                })
                .collect();
            self.backend
                .sweep(&problem, &mut planes, &sweeps, self.progress)?;
        }
        Ok(planes)
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
    camera: &Camera,
    pose: &Pose,
    [near, far]: [f64; 2],
    others: impl Iterator<Item = (Camera, &'a Pose)>,
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

fn inverse_depths(planes: &Planes) -> Arc<Vec<f32>> {
    Arc::new(
        planes
            .planes
            .iter()
            .map(|plane| plane.inverse_depth)
            .collect(),
    )
}
