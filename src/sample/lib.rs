//! The paper's lab, simulated: a flight whose every answer is known.
//!
//! Random convex bodies of known sieve size and volume are heaped on a floor (`pile`), photographed
//! by ray tracing from a flight plan (`photo`), and reconstructed as structure from motion would
//! (`sfm_cloud`). The scales that the noise-free geometry gives are written beside it (`truth`).
//! Everything follows from one seed.
//!
//! This room stands on floor 5, one above `formats` and `exports`: it writes whole folders through
//! `exports`, and its tests read them back through `formats`.

pub mod files;
mod flight_plan;
mod image_analysis;
mod material;
mod noise;
mod photo;
mod preset;
mod random;
mod scene;
mod sensor;
mod sfm_cloud;
mod sieve;
mod training;
mod truth;
mod written;

#[cfg(test)]
use fragscale_core::scale;
use fragscale_core::{camera, fault, flight, geodesy, geometry, jobs, surface, units};
use fragscale_exports as exports;
#[cfg(test)]
use fragscale_formats as formats;
use fragscale_fragmentation as fragmentation;
#[cfg(test)]
use fragscale_opening as opening;

use std::fs;
use std::io;
use std::path::Path;

use glam::{DVec2, DVec3};
use serde_json::Value;

pub use flight_plan::{FlightPlan, Shot};
pub use preset::{Lens, Preset, Recipe};
pub use scene::pile::{Fragment, Pile, PilePlan};
pub use scene::{Meeting, Scene, SceneCaster, Sphere, Thing};
pub use sfm_cloud::CloudPlan;
pub use training::training_photos;
pub use written::{DrawnErrors, PoseNoise};

use crate::camera::Camera;
use crate::fault::Fault;
use crate::geodesy::Crs;
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::surface::Cloud;
use crate::units::LengthUnit;
use files::flight::FlightText;
use files::photo_metadata::{DjiGimbal, GpsPosition, PhotoMetadata};
use files::reference::openings_mm;
use fragscale_core::files::make_folder_whole;
use image_analysis::{Analysis, Outlined, PixelPlaces, Scale};
use material::Material;
use photo::Look;
use random::Random;
use scene::light::Light;
use written::Written;

/// What the user asks of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleOptions {
    /// Which place.
    pub preset: Preset,
    /// Everything random follows from it.
    pub seed: u64,
    /// The camera's lens.
    pub lens: Lens,
    /// Whether the surface is the true mesh instead of a reconstructed cloud.
    pub true_mesh: bool,
    /// Matching noise of the cloud in pixels, instead of the preset's.
    pub noise_px: Option<f64>,
    /// How many points the cloud has, instead of the preset's.
    pub points: Option<usize>,
    /// How many photos on a ring around the pile, for reconstruction tests.
    pub ring: u32,
    /// Overlapping photos of a mapping flight, for reconstruction tests; all photos then say where they
    /// were taken, as its receiver does.
    pub survey: Option<Receiver>,
    /// Whether to take the photos.
    pub photos: bool,
    /// Whether to write which fragment each pixel shows.
    pub labels: bool,
    /// Whether the middle of the pile is the world's origin, instead of the preset's place.
    pub at_origin: bool,
    /// Errors of what is written: of poses, of the lens, of the world's lengths.
    pub errors: DrawnErrors,
}

/// How a drone knows where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receiver {
    /// Without corrections.
    Gps,
    /// Corrected by a base station.
    Rtk,
}

impl Receiver {
    /// Standard deviations towards east, north and up, metres.
    fn deviations(self) -> DVec3 {
        match self {
            Self::Gps => DVec3::new(1.5, 1.5, 3.0),
            Self::Rtk => DVec3::new(0.015, 0.015, 0.025),
        }
    }
}

/// Makes a simulated flight in `folder`, which must be new or empty.
///
/// # Errors
/// Where the folder cannot be written, or on cancel; then nothing is left.
pub fn make(folder: &Path, options: &SampleOptions, progress: &Progress) -> Result<(), Fault> {
    let recipe = recipe(options)?;
    let written = make_folder_whole(folder, |part| {
        fill(part, &recipe, options, progress).map_err(Stop::Fault)
    });
    written.map_err(|stop| match stop {
        Stop::Fault(fault) => fault,
        Stop::Io(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => {
            Fault::new("the folder is not empty", "name a new folder")
        }
        Stop::Io(error) if error.kind() == io::ErrorKind::NotFound => {
            let within = folder.parent().unwrap_or(folder).display();
            let what = format!("the sample cannot be written: the folder {within} is not there");
            Fault::new(what, "make that folder first")
        }
        Stop::Io(error) => cannot_write(&error),
    })
}

/// Why a folder was not made.
enum Stop {
    Fault(Fault),
    Io(io::Error),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

fn cannot_write(error: &io::Error) -> Fault {
    let what = format!("the sample cannot be written ({error})");
    Fault::new(what, "choose a folder that may be written to")
}

/// Fewer points of a cloud show nothing of a pile.
const LEAST_POINTS: usize = 100;

/// The preset's recipe with what the user asks for.
fn recipe(options: &SampleOptions) -> Result<Recipe, Fault> {
    let mut recipe = options.preset.recipe(options.lens)?;
    if options.at_origin {
        recipe.origin = DVec3::ZERO;
        recipe.epsg = None;
    }
    if let Some(noise) = options.noise_px {
        recipe.cloud.noise_px = noise;
    }
    if let Some(points) = options.points {
        if points < LEAST_POINTS {
            let what = format!("{points} points make no surface");
            return Err(Fault::new(
                what,
                format!("ask for {LEAST_POINTS} at least (--points)"),
            ));
        }
        recipe.cloud.points = points;
    }
    Ok(recipe)
}

fn fill(
    folder: &Path,
    recipe: &Recipe,
    options: &SampleOptions,
    progress: &Progress,
) -> Result<(), Fault> {
    let random = Random::new(options.seed);
    let mut shots = recipe.flight.fly(&mut random.fork(20));
    // Scale objects are laid out for these: those of a ring would all lie where it looks, a heap of spheres.
    let scene_shots = shots.len();
    shots.extend(recipe.flight.ring(options.ring, &mut random.fork(21)));
    if options.survey.is_some() {
        if recipe.epsg.is_none() {
            let what = "there is no receiver's position without a coordinate system";
            let remedy = "choose a preset outdoors (muckpile, stockpile, bench) without --at-origin, or leave --survey out";
            return Err(Fault::new(what, remedy));
        }
        shots.extend(
            recipe
                .flight
                .survey(view(&recipe.camera), &mut random.fork(22)),
        );
    }
    let written = Written::draw(&options.errors, &shots, &random)?;
    let scene = build_scene(recipe, &shots[..scene_shots], &random, progress)?;
    let look = look(options.preset, recipe);

    let (surface, name) = if options.true_mesh {
        (scene.mesh(), "pile.ply")
    } else {
        let name = if recipe.epsg.is_some() {
            "pile.laz"
        } else {
            "pile.ply"
        };
        (reconstruct(&scene, recipe, &look, &random, progress)?, name)
    };
    write_surface(&folder.join(name), surface, recipe, &written, progress)?;
    write_texts(folder, name, recipe, &shots, &written, options)?;
    progress.stage("measuring the truth");
    let truth = truth::truth(&scene, &recipe.camera, &shots, &written, recipe.origin)?;
    write(&folder.join("truth.json"), format!("{truth}\n").as_bytes())?;
    let sieved = sieved(&scene, recipe);
    let reference = files::reference::reference_csv(&sieved);
    let reference = reference.map_err(|e| Fault::new(e, "report this"))?;
    write(&folder.join("reference.csv"), reference.as_bytes())?;
    if options.photos {
        let photos = take_photos(folder, &scene, recipe, &shots, &look, options, progress)?;
        let text = analysed(&scene, recipe, &shots, &truth, &sieved, &photos);
        write(&folder.join("distributions.csv"), text.as_bytes())?;
    }
    Ok(())
}

/// Width and height of a photo in parts of the distance.
fn view(camera: &Camera) -> DVec2 {
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    size / DVec2::new(camera.fx, camera.fy)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Fault> {
    fs::write(path, bytes).map_err(|error| cannot_write(&error))
}

fn build_scene(
    recipe: &Recipe,
    shots: &[Shot],
    random: &Random,
    progress: &Progress,
) -> Result<Scene, Fault> {
    let pile = Pile::strew(&recipe.pile, &mut random.fork(10), progress)?;
    progress.stage("building the scene");
    let mut scene = Scene::new(pile, &recipe.pile, recipe.reach)?;
    let spheres = shots
        .iter()
        .map(|shot| rest_sphere(&scene, recipe, shot))
        .collect::<Result<Vec<_>, Fault>>()?;
    scene.add_spheres(spheres.into_iter().flatten());
    Ok(scene)
}

/// A scale sphere near the middle of a photo, at rest on what lies there.
fn rest_sphere(scene: &Scene, recipe: &Recipe, shot: &Shot) -> Result<Option<Sphere>, Fault> {
    let mut caster = scene.caster()?;
    let pose = shot.pose();
    let aim = Ray {
        origin: pose.center,
        direction: pose.rotation.z_axis,
    };
    let Some(middle) = caster.cast(&aim) else {
        return Ok(None);
    };
    // A little beside the middle, which the engineer wants to see.
    let place = middle.point.truncate() + DVec2::new(0.9, 0.5) * recipe.sphere;
    let radius = recipe.sphere / 2.0;
    let mut height = f64::NEG_INFINITY;
    for step in 0..61 {
        let (share, angle) = (f64::from(step) / 60.0, f64::from(step) * 2.4);
        let offset = DVec2::from_angle(angle) * (radius * share.sqrt() * 0.999);
        let down = Ray {
            origin: (place + offset).extend(recipe.flight.height * 10.0),
            direction: DVec3::NEG_Z,
        };
        if let Some(met) = caster.cast(&down) {
            let sag = (radius * radius - offset.length_squared()).max(0.0).sqrt();
            height = height.max(met.point.z + sag);
        }
    }
    let center = place.extend(height);
    Ok(center.is_finite().then_some(Sphere { center, radius }))
}

fn look(preset: Preset, recipe: &Recipe) -> Look {
    let (rock, floor, light) = match preset {
        Preset::Lab => (Material::gravel(), Material::concrete_floor(), Light::lab()),
        Preset::Stockpile => (
            Material::stockpile(),
            Material::quarry_floor(),
            Light::sun(4.0, 0.75),
        ),
        Preset::Muckpile | Preset::Bench => (
            Material::blasted_rock(),
            Material::quarry_floor(),
            Light::sun(2.2, 0.8),
        ),
    };
    Look {
        rock,
        fines: Material::fines(),
        floor,
        sphere: Material::painted_sphere(),
        light,
        average: if preset == Preset::Lab { 0.22 } else { 0.13 },
        grain: recipe.pile.sizes.size_at(0.5),
    }
}

fn reconstruct(
    scene: &Scene,
    recipe: &Recipe,
    look: &Look,
    random: &Random,
    progress: &Progress,
) -> Result<Cloud, Fault> {
    let survey = sfm_cloud::survey(&recipe.flight, &mut random.fork(30));
    let color_of = |caster: &mut SceneCaster<'_>, met: &Meeting| {
        let radiance = look.radiance(caster, &recipe.camera, DVec3::NEG_Z, met);
        radiance.map(|part| sensor::srgb(sensor::tone(part * 0.18 / look.average)))
    };
    let (plan, numbers) = (&recipe.cloud, random.fork(31));
    sfm_cloud::cloud(
        scene,
        &recipe.camera,
        &survey,
        plan,
        color_of,
        &numbers,
        progress,
    )
}

fn write_surface(
    path: &Path,
    mut cloud: Cloud,
    recipe: &Recipe,
    written: &Written,
    progress: &Progress,
) -> Result<(), Fault> {
    progress.stage("writing the surface");
    for point in &mut cloud.points {
        *point = *point * written.world_factor() + recipe.origin;
    }
    let bytes = match recipe.epsg.filter(|_| cloud.triangles.is_empty()) {
        Some(epsg) => exports::laz(&cloud, epsg, "simulated"),
        None => exports::ply(&cloud, "simulated by fragscale"),
    };
    write(path, &bytes.map_err(|e| Fault::new(e, "report this"))?)
}

/// Poses, camera, and the flight with what it states of their errors; the photos' folder where there
/// are photos.
fn write_texts(
    folder: &Path,
    surface: &str,
    recipe: &Recipe,
    shots: &[Shot],
    written: &Written,
    options: &SampleOptions,
) -> Result<(), Fault> {
    let report = |error: String| Fault::new(error, "report this");
    let rows = written.pose_rows(shots, recipe.origin);
    write(
        &folder.join("poses.csv"),
        exports::poses_csv(&rows).map_err(report)?.as_bytes(),
    )?;
    write(
        &folder.join("ost.yaml"),
        files::calibration::ost_yaml(&written.camera(&recipe.camera))
            .map_err(report)?
            .as_bytes(),
    )?;
    let flight = FlightText {
        name: recipe.name,
        unit: LengthUnit::Metre,
        surface,
        camera: "ost.yaml",
        poses: "poses.csv",
        photos: options.photos.then_some("photos"),
        focal: options.errors.lens,
        world_scale: options.errors.world,
    };
    write(
        &folder.join("flight.toml"),
        files::flight::flight_toml(&flight)
            .map_err(report)?
            .as_bytes(),
    )
}

/// The true cumulative passing by mass on ISO 565's R20/3 sieves, fines included: below the smallest
/// fragment it is the material's distribution, of which the fines are the part that is not bodies.
fn sieved(scene: &Scene, recipe: &Recipe) -> Vec<(f64, f64)> {
    let pile = scene.pile();
    let fines = recipe.pile.sizes.passing(recipe.pile.smallest);
    let total: f64 = pile.fragments.iter().map(|f| pile.volume(f)).sum();
    let passing = |size: f64| {
        if size <= recipe.pile.smallest {
            return recipe.pile.sizes.passing(size);
        }
        let passed = pile.fragments.iter().filter(|f| f.size <= size);
        // All of it is 1, whatever the rounding of the sums.
        let share = passed.map(|f| pile.volume(f)).sum::<f64>() / total;
        (fines + (1.0 - fines) * share).min(1.0)
    };
    let largest = recipe.pile.sizes.size_at(1.0) * 1000.0;
    let openings = openings_mm(largest / 100.0, largest * 1.2);
    openings
        .into_iter()
        .map(|mm| (mm, 100.0 * passing(mm / 1000.0)))
        .collect()
}

/// The text of distributions.csv: the outlined photos with both kinds of scale, beside the sieve. A photo
/// whose corners miss the surface, or whose sphere is cut off, has no scale of that kind.
fn analysed(
    scene: &Scene,
    recipe: &Recipe,
    shots: &[Shot],
    truth: &Value,
    sieved: &[(f64, f64)],
    photos: &[Outlined],
) -> String {
    let camera = &recipe.camera;
    let rows = f64::from(camera.height);
    let columns = recipe.flight.count[0].max(1) as usize;
    // `zip`: the photos of a ring belong to no row.
    let flown = shots.iter().take(columns * recipe.flight.count[1] as usize);
    let flown: Vec<_> = (1..).zip(flown.zip(photos)).collect();
    // Few photos: it fits.
    let trial = |number: usize| (1 + (number - 1) / columns) as u32;
    let by_rows = flown.iter().filter_map(|&(number, (_, photo))| {
        let edge = |edge: &str| {
            let place = format!("/photos/{}/undistorted/scale/{edge}", number - 1);
            truth.pointer(&place).and_then(Value::as_f64)
        };
        let (top, bottom) = (edge("top")?, edge("bottom")?);
        Some(Analysis {
            method: "point cloud",
            trial: trial(number),
            photo,
            scale: Scale { top, bottom, rows },
        })
    });
    let by_spheres = flown.iter().filter_map(|&(number, (shot, photo))| {
        let pose = shot.pose();
        // Its own sphere is the one nearest its middle.
        let off_axis = |sphere: &&Sphere| {
            let direction = pose.camera_from_world(sphere.center).normalize_or_zero();
            1.0 - direction.z
        };
        let sphere = scene
            .spheres()
            .iter()
            .min_by(|a, b| off_axis(a).total_cmp(&off_axis(b)))?;
        let scale = image_analysis::sphere_scale(camera, &pose, sphere)?;
        Some(Analysis {
            method: "scale object",
            trial: trial(number),
            photo,
            scale: Scale {
                top: scale,
                bottom: scale,
                rows,
            },
        })
    });
    let analyses: Vec<Analysis<'_>> = by_rows.chain(by_spheres).collect();
    let smallest = recipe.pile.smallest;
    // A fragment's image may be wider than any sieve that it needs.
    let largest = recipe.pile.sizes.size_at(1.0) * 4.0;
    let material = image_analysis::Material {
        reference: sieved,
        openings: &openings_mm(smallest * 1000.0, largest * 1000.0),
        fines: recipe.pile.sizes.passing(smallest),
        shape_factor: image_analysis::shape_factor(&scene.pile().bodies),
        width: f64::from(camera.width),
    };
    image_analysis::distributions_csv(&material, &analyses)
}

/// Takes the photos, writes them, and gives back what an image analysis would outline on each.
fn take_photos(
    folder: &Path,
    scene: &Scene,
    recipe: &Recipe,
    shots: &[Shot],
    look: &Look,
    options: &SampleOptions,
    progress: &Progress,
) -> Result<Vec<Outlined>, Fault> {
    let report = |error: String| Fault::new(error, "report this");
    let photos = folder.join("photos");
    fs::create_dir(&photos).map_err(|error| cannot_write(&error))?;
    let labels = folder.join("labels");
    if options.labels {
        fs::create_dir(&labels).map_err(|error| cannot_write(&error))?;
    }
    progress.stage("taking photos");
    let camera = &recipe.camera;
    let pixels = PixelPlaces::new(camera);
    let mut outlined = Vec::with_capacity(shots.len());
    for (index, shot) in shots.iter().enumerate() {
        progress.advance(index as u64, shots.len() as u64)?;
        let noise = options.seed ^ ((index as u64 + 1) << 32);
        let photo = photo::take(scene, camera, &shot.pose(), look, noise, progress)?;
        let mut receiver = Random::new(options.seed).fork(23).fork(index as u64);
        let metadata = metadata(recipe, shot, options.survey, &mut receiver)?;
        let jpeg = files::photo::jpeg(&photo.image, 82, &metadata).map_err(report)?;
        write(&photos.join(&shot.name), &jpeg)?;
        if options.labels {
            let label = exports::label_png(camera.width, camera.height, &photo.labels);
            let name = shot.name.replace(".jpg", ".png");
            write(&labels.join(name), &label.map_err(report)?)?;
        }
        outlined.push(Outlined::new(&shot.name, &photo.labels, &pixels));
    }
    Ok(outlined)
}

/// What the camera writes about a photo.
fn metadata(
    recipe: &Recipe,
    shot: &Shot,
    receiver: Option<Receiver>,
    random: &mut Random,
) -> Result<PhotoMetadata, Fault> {
    let camera = &recipe.camera;
    // A one-inch-third sensor is 4.8 mm wide.
    let millimetres = camera.fx / f64::from(camera.width) * 4.8;
    let [tilt, pan] = shot.actual.1;
    let outdoors = recipe.epsg.is_some();
    let gps = receiver.map(|receiver| received(recipe, shot, receiver, random));
    Ok(PhotoMetadata {
        make: Some("fragscale".to_owned()),
        model: Some("simulated".to_owned()),
        date_time_original: Some("2017:01:01 12:00:00".to_owned()),
        exposure_time_s: Some(0.002),
        f_number: Some(2.8),
        iso: Some(100),
        focal_length_mm: Some(millimetres),
        // 36 mm wide film; `as` saturates.
        focal_length_35mm: Some((camera.fx / f64::from(camera.width) * 36.0).round() as u16),
        gps: gps.transpose()?,
        rtk: (receiver == Some(Receiver::Rtk)).then(|| Receiver::Rtk.deviations().to_array()),
        dji: outdoors.then_some(DjiGimbal {
            roll: 0.0,
            yaw: pan,
            pitch: -tilt,
            relative_altitude: shot.actual.0.z,
        }),
    })
}

/// Where the receiver says that a photo was taken.
fn received(
    recipe: &Recipe,
    shot: &Shot,
    receiver: Receiver,
    random: &mut Random,
) -> Result<GpsPosition, Fault> {
    let error = DVec3::new(random.normal(), random.normal(), random.normal());
    let place = recipe.origin + shot.actual.0 + error * receiver.deviations();
    let crs = Crs::understand(&format!("EPSG:{}", recipe.epsg.unwrap_or_default()))?;
    let nowhere = || Fault::new("the sample lies off the map", "report this");
    let place = crs.to_geographic(place).ok_or_else(nowhere)?;
    Ok(GpsPosition {
        latitude: place.latitude,
        longitude: place.longitude,
        altitude: place.height,
    })
}

#[cfg(test)]
mod tests;
