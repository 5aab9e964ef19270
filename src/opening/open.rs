//! Opening a flight: flight.toml with the files that it names, or a reconstruction given directly.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;

use crate::camera::Camera;
use crate::evidence::{compare_all_colours, look_up};
use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::files::{Inputs, Recording};
use crate::flight::{
    CameraEntry, CameraSource, Flight, FlightFile, FlightParts, FlightSettings, Limits, LookedUp,
    Photo, PhotoSource, Review,
};
use crate::flight_poses::{self, PhotosToPose};
use crate::formats::packages::ros;
use crate::formats::photos::photo_folder::PhotoFolder;
use crate::formats::tables::size_distributions::no_flight_but_sizes;
use crate::formats::{CloudFile, Kind, Package, PoseLine, Reconstruction, detect, read_project};
use crate::geodesy::Crs;
use crate::geometry::Similarity;
use crate::jobs::Progress;
use crate::origin::FlightOrigin;
use crate::photo_files::{PhotoFile, files_of, fit_cameras_to_files, set_sizes_from_files};
use crate::scale::{Ground, ImageKind};
use crate::surface::{Surface, SurfaceOptions, UpAxis, doubtful_up};
use crate::units::LengthUnit;
use crate::unstated_surface::taken_to_be_in;
use crate::world_frame::{Frame, Known};

/// What the user says beside the flight itself.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions {
    /// A cloud or mesh to use instead of the flight's own surface.
    pub surface: Option<PathBuf>,
    /// The folder of the image files, instead of the flight's own.
    pub photos: Option<PathBuf>,
    /// The topic of a ROS recording whose poses are taken, instead of the flight's own choice.
    pub topic: Option<String>,
    /// What to set instead of what the flight says.
    pub settings: Option<FlightSettings>,
}

/// The reconstruction that a flight's poses are from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlightReconstruction {
    /// The file or folder.
    pub path: PathBuf,
    /// Who says that it is in the world already, in words; `None` in a frame of its own.
    pub in_world: Option<String>,
}

/// A flight with what was noticed on the way.
#[derive(Debug)]
pub struct Opened {
    /// Ready for scales.
    pub flight: Arc<Flight>,
    /// What was noticed while reading, one sentence each, with the file in front where there is one.
    pub warnings: Vec<String>,
    /// The image file of each photo, in the order of the flight's photos.
    pub photo_files: Vec<PhotoFile>,
    /// What was looked up of the photos, their colours excepted.
    pub looked_up: LookedUp,
    /// The coordinate system of the world where the files state one: "EPSG:n" or WKT.
    pub crs: Option<String>,
    /// What was set, by the flight's file or by [`OpenOptions`].
    pub settings: FlightSettings,
    /// The flight.toml with its path, where the flight came from one.
    pub file: Option<(PathBuf, FlightFile)>,
    /// Where the flight came from, and how to save it.
    pub origin: FlightOrigin,
    /// The reconstruction that it was made of; `None` where its poses are in a file of their own.
    pub reconstruction: Option<FlightReconstruction>,
    /// Every file that was read except the photos, in the order of reading.
    pub inputs: Vec<PathBuf>,
    /// These, the photos and whatever was opened on the way: nothing of it may be written over.
    pub read: Inputs,
}

impl Opened {
    /// What was noticed while reading and what was looked up, one sentence each with the file in front.
    pub fn all_warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        warnings.extend(self.looked_up.warnings_of(self.origin.path.display()));
        warnings
    }

    /// Reviews the flight: with its footprints, and with the colours of its photos, which takes
    /// longest, because every photo is read.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn review(&self, limits: &Limits, progress: &Progress) -> Result<Review, Fault> {
        let (flight, looked_up) = (self.flight.clone(), self.looked_up.clone());
        let mut review = Review::of_scales(flight, looked_up, limits, progress)?;
        review.look(progress)?;
        compare_all_colours(&mut review, &self.photo_files, progress)?;
        Ok(review)
    }
}

/// Opens a flight.toml, a folder that holds one, or a reconstruction.
///
/// # Errors
/// With the file and the place in it.
pub fn open_flight(
    path: &Path,
    options: &OpenOptions,
    progress: &Progress,
) -> Result<Opened, FileError> {
    let recording = Recording::start();
    let kind = detect(path)?;
    let source = match &kind {
        Kind::Flight(file) => Source::of_file(file, options, progress)?,
        Kind::Reconstruction(..) => Source::of_reconstruction(path, options, progress)?,
        Kind::SizeDistributions => {
            return Err(FileError::new(path, no_flight_but_sizes()));
        }
        Kind::Cloud(_) | Kind::Camera | Kind::Poses | Kind::Trajectory(_) => {
            return Err(FileError::new(
                path,
                Fault::new(
                    format!("it holds {}, not a flight", kind.in_words()),
                    "name it in a flight.toml and open that",
                ),
            ));
        }
    };
    let mut opened = source.into_flight(options, progress)?;
    let photos = opened.photo_files.iter().flat_map(|file| &file.path);
    opened.read = Inputs::of(opened.inputs.iter().chain(photos)).with_opened(&recording.files());
    Ok(opened)
}

/// What a flight is made of, before its surface is read and its cameras meet their photo files.
struct Source {
    /// What errors of the whole are blamed on.
    file: PathBuf,
    name: String,
    settings: FlightSettings,
    /// Whether somebody says the unit of the world, in `settings`.
    unit_is_stated: bool,
    /// The flight.toml, where there is one.
    flight_file: Option<FlightFile>,
    /// The system of the world that flight.toml names.
    named_crs: Option<Crs>,
    /// Where the poses are from, if from a reconstruction.
    reconstruction: Option<FlightReconstruction>,
    /// The frame of the poses and of the reconstruction's points.
    poses_frame: Frame,
    /// The system that the reconstruction's package works in, where its poses are in another.
    preferred_crs: Option<Crs>,
    inputs: Vec<PathBuf>,
    /// The surface's file; `None` for the reconstruction's own points.
    surface: Option<PathBuf>,
    /// The axis of that file that points up.
    surface_up: UpAxis,
    /// Whether `surface` is what the package left, not what somebody named.
    surface_is_packages: bool,
    /// What its package's reader says about the surface.
    surface_note: Option<String>,
    /// The way of the package's frame to the world, where flight.toml says it.
    package_surface_to_world: Option<Similarity>,
    reconstruction_cloud: CloudFile,
    photo_folder: Option<PathBuf>,
    /// Whether somebody named that folder, so that it must be the photos'.
    photo_folder_is_named: bool,
    /// The size that the package names for each photo, and whether it may have been reduced; empty
    /// without a reconstruction.
    named_sizes: Vec<Option<(u32, u32)>>,
    may_be_reduced: bool,
    /// The unit that the package states for its own frame.
    package_unit: Option<LengthUnit>,
    /// The topic of a recording whose poses are taken.
    topic: Option<String>,
    cameras: Vec<Camera>,
    photos: Vec<Photo>,
    warnings: Vec<String>,
}

impl Source {
    fn new(file: &Path, settings: FlightSettings, options: &OpenOptions) -> Self {
        Self {
            file: file.to_owned(),
            name: name_of(file),
            settings,
            unit_is_stated: true,
            flight_file: None,
            named_crs: None,
            reconstruction: None,
            poses_frame: Frame::AsIs(None),
            preferred_crs: None,
            inputs: Vec::new(),
            surface: options.surface.clone(),
            surface_up: UpAxis::Z,
            surface_is_packages: false,
            surface_note: None,
            package_surface_to_world: None,
            reconstruction_cloud: CloudFile::default(),
            photo_folder: options.photos.clone(),
            photo_folder_is_named: options.photos.is_some(),
            named_sizes: Vec::new(),
            may_be_reduced: false,
            package_unit: None,
            topic: options.topic.clone(),
            cameras: Vec::new(),
            photos: Vec::new(),
            warnings: Vec::new(),
        }
    }

    fn of_file(path: &Path, options: &OpenOptions, progress: &Progress) -> Result<Self, FileError> {
        let at_file = |fault| FileError::new(path, fault);
        let text = read_text(path)?;
        let file = FlightFile::parse(&text).map_err(at_file)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut source = Self::new(path, file.settings(), options);
        source.name = file.name.clone().unwrap_or_else(|| name_of(path));
        source.named_crs = file
            .crs()
            .map(Crs::understand)
            .transpose()
            .map_err(|fault| {
                at_file(Fault::new(
                    format!("world.crs: {}", fault.what),
                    fault.remedy,
                ))
            })?;
        source.inputs.push(path.to_owned());
        let file_in = |name: Option<&str>| name.map(|name| folder.join(name));
        source.surface = source.surface.or(file_in(file.surface()));
        source.photo_folder = source.photo_folder.or(file_in(file.photo_folder()));
        source.photo_folder_is_named = source.photo_folder.is_some();
        source.unit_is_stated = file.unit().is_some();
        source.topic = source.topic.or(file.topic().map(str::to_owned));
        source.surface_up = file.surface_up();
        match file.photo_source() {
            PhotoSource::Poses(name) => {
                let names = source.add_cameras(path, folder, &file.cameras)?;
                let topic = source.topic.clone();
                let photos = PhotosToPose {
                    flight_folder: folder,
                    cameras: &file.cameras,
                    folder: source.photo_folder.clone(),
                    topic: topic.as_deref(),
                };
                source.add_poses(&folder.join(name), &photos, &names, progress)?;
            }
            PhotoSource::Reconstruction(name, transform) => {
                let path = folder.join(name);
                let mut reconstruction = source.read_reconstruction(&path, progress)?;
                let moved = transform.map(|_| "a transform in its flight.toml".to_owned());
                let named = || Some(format!("{} in its flight.toml", file.crs()?));
                source.reconstruction = Some(FlightReconstruction {
                    path: path.clone(),
                    in_world: moved.or_else(named).or(reconstruction.crs.clone()),
                });
                if let Some(matrix) = transform {
                    let similarity = Similarity::from_row_major(&matrix).map_err(|error| {
                        at_file(Fault::new(
                            format!("photos.transform: {error}"),
                            "give a row-major similarity from the package's frame to the world",
                        ))
                    })?;
                    reconstruction.transform(&similarity);
                    // Now it is in the world, whatever that is called.
                    reconstruction.crs = None;
                    reconstruction.preferred_crs = None;
                    reconstruction.enu_origin = None;
                    reconstruction.unit = None;
                    source.package_surface_to_world = Some(similarity);
                }
                source
                    .take_reconstruction(&path, reconstruction, &file.cameras)
                    .map_err(|error| {
                        if error.file == path {
                            at_file(error.fault)
                        } else {
                            error
                        }
                    })?;
            }
        }
        source.flight_file = Some(file);
        Ok(source)
    }

    fn of_reconstruction(
        path: &Path,
        options: &OpenOptions,
        progress: &Progress,
    ) -> Result<Self, FileError> {
        let settings = FlightSettings {
            unit: LengthUnit::Metre,
            unit_known: false,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            surface: SurfaceOptions::default(),
            scale_objects: Vec::new(),
        };
        let mut source = Self::new(path, settings, options);
        source.unit_is_stated = false;
        let reconstruction = source.read_reconstruction(path, progress)?;
        source.reconstruction = Some(FlightReconstruction {
            path: path.to_owned(),
            in_world: reconstruction.crs.clone(),
        });
        if source.photo_folder.is_none() && !reconstruction.sizes_known {
            // Packages name photos relative to their own file; a folder has them in it.
            source.photo_folder = match path.is_dir() {
                true => Some(path.to_owned()),
                false => path.parent().map(Path::to_owned),
            };
        }
        source.take_reconstruction(path, reconstruction, &[])?;
        Ok(source)
    }

    fn read_reconstruction(
        &mut self,
        path: &Path,
        progress: &Progress,
    ) -> Result<Reconstruction, FileError> {
        progress.stage(format!("reading {}", path.display()));
        self.inputs.push(path.to_owned());
        let project = match (&self.topic, detect(path)?) {
            (None, _) => read_project(path, progress)?,
            (Some(topic), Kind::Reconstruction(Package::Ros, recording)) => {
                ros::read_with_topic(&recording, topic, progress)?
            }
            (Some(topic), _) => {
                let fault = flight_poses::topic_without_recording(topic);
                return Err(FileError::new(path, fault));
            }
        };
        if self.surface.is_none() {
            self.surface_is_packages = project.surface.is_some();
            self.surface = project.surface;
            self.warn(path, project.surface_note.as_slice());
            self.surface_note = project.surface_note;
        }
        self.photo_folder = self.photo_folder.take().or(project.photos);
        Ok(project.reconstruction)
    }

    fn take_reconstruction(
        &mut self,
        path: &Path,
        mut reconstruction: Reconstruction,
        entries: &[CameraEntry],
    ) -> Result<(), FileError> {
        let at = |fault| FileError::new(path, fault);
        self.warn(path, &reconstruction.warnings);
        let (crs, origin) = (reconstruction.crs.as_deref(), reconstruction.enu_origin);
        let mut said = Vec::new();
        self.poses_frame = Frame::of_poses(crs, origin, &mut said).map_err(at)?;
        self.warn(path, &said);
        let preferred = reconstruction.preferred_crs.as_deref();
        // One that is not understood cannot be a target; nothing else depends on it.
        self.preferred_crs = preferred.and_then(|crs| Crs::understand(crs).ok());
        let sizes = sizes_of_entries(entries).map_err(at)?;
        let given = |name: &str| {
            sizes
                .iter()
                .find(|(camera, _)| camera.is_none_or(|camera| camera == name))
                .map(|(_, size)| *size)
        };
        if reconstruction.sizes_known {
            for camera in &reconstruction.cameras {
                if given(&camera.name).is_some_and(|size| size != (camera.width, camera.height)) {
                    let (w, h) = (camera.width, camera.height);
                    let what = format!(
                        "camera '{}' is for {w} x {h} in the reconstruction",
                        camera.name
                    );
                    return Err(at(Fault::new(what, "remove its [[camera]] table")));
                }
            }
        } else {
            let folder = PhotoFolder::new(self.photo_folder.as_deref());
            let mut said = Vec::new();
            set_sizes_from_files(&mut reconstruction, &folder, given, &mut said).map_err(at)?;
            self.warn(path, &said);
        }
        let photos = reconstruction.photos.iter();
        let named = photos.map(|photo| {
            // The size that the package solved on is none beside it.
            let camera = reconstruction.cameras.get(photo.camera)?;
            let solved_on = (camera.width, camera.height);
            let named = reconstruction.named_size(photo);
            named.filter(|size| *size != solved_on)
        });
        self.named_sizes = named.collect();
        self.may_be_reduced = reconstruction.may_be_reduced;
        self.package_unit = reconstruction.unit;
        self.cameras = reconstruction.cameras;
        self.photos = reconstruction
            .photos
            .into_iter()
            .map(|photo| Photo {
                name: photo.name,
                camera: photo.camera,
                pose: photo.pose,
                trouble: None,
            })
            .collect();
        self.reconstruction_cloud.cloud = reconstruction.cloud;
        Ok(())
    }

    /// Reads the cameras of the tables; returns what poses may call each.
    fn add_cameras(
        &mut self,
        path: &Path,
        folder: &Path,
        entries: &[CameraEntry],
    ) -> Result<Vec<Option<String>>, FileError> {
        let at = |what: String, remedy: &str| FileError::new(path, Fault::new(what, remedy));
        if entries.is_empty() {
            return Err(at(
                "there is no [[camera]]".to_owned(),
                "add one, with a file or inline",
            ));
        }
        let mut names: Vec<Option<String>> = Vec::new();
        for entry in entries {
            let mut camera = match entry
                .source()
                .map_err(|fault| FileError::new(path, fault))?
            {
                CameraSource::File(name) => {
                    let file = folder.join(name);
                    let camera = crate::formats::read_camera(&file)?;
                    self.inputs.push(file);
                    camera
                }
                CameraSource::Inline(camera) => camera,
                CameraSource::Size(..) => {
                    return Err(at(
                        "a [[camera]] has only a size".to_owned(),
                        "add fx, fy, cx and cy, or name a calibration file",
                    ));
                }
            };
            if let Some(name) = &entry.name {
                camera.name.clone_from(name);
            }
            let name = entry.name.clone().or_else(|| {
                (entries.len() > 1 && !camera.name.is_empty()).then(|| camera.name.clone())
            });
            if entries.len() > 1 && name.is_none() {
                return Err(at(
                    "one of several cameras has no name".to_owned(),
                    "name each",
                ));
            }
            if names.contains(&name) {
                let name = name.unwrap_or_default();
                return Err(at(
                    format!("two cameras are called '{name}'"),
                    "give each its own name",
                ));
            }
            names.push(name);
            self.cameras.push(camera);
        }
        Ok(names)
    }

    fn add_poses(
        &mut self,
        path: &Path,
        photos: &PhotosToPose<'_>,
        cameras: &[Option<String>],
        progress: &Progress,
    ) -> Result<(), FileError> {
        let mut poses = flight_poses::read(path, photos, progress)?;
        self.poses_frame = Frame::of_poses(poses.crs.as_deref(), None, &mut poses.warnings)
            .map_err(|fault| FileError::new(path, fault))?;
        self.warn(path, &poses.warnings);
        self.inputs.push(path.to_owned());
        for line in poses.lines {
            let camera = camera_of(&line, cameras).map_err(|fault| FileError::new(path, fault))?;
            self.photos.push(Photo {
                name: line.photo,
                camera,
                pose: line.pose,
                trouble: None,
            });
        }
        Ok(())
    }

    fn into_flight(
        mut self,
        options: &OpenOptions,
        progress: &Progress,
    ) -> Result<Opened, FileError> {
        let folder = PhotoFolder::new(self.photo_folder.as_deref());
        if let Some(path) = &self.photo_folder
            && self.photo_folder_is_named
        {
            folder
                .check(
                    &self
                        .photos
                        .iter()
                        .map(|photo| photo.name.as_str())
                        .collect::<Vec<_>>(),
                )
                .map_err(|fault| FileError::new(path, fault))?;
        }
        let mut photo_files = files_of(&folder, &self.photos);
        for (index, file) in photo_files.iter_mut().enumerate() {
            file.named_size = self.named_sizes.get(index).copied().flatten();
            file.may_be_reduced = self.may_be_reduced;
        }
        fit_cameras_to_files(
            &folder,
            &photo_files,
            &mut self.cameras,
            &mut self.photos,
            &mut self.warnings,
        );
        if options.surface.is_some() {
            // What is said of the flight's own file does not hold for another.
            self.surface_up = UpAxis::Z;
        }
        let surface = self.surface.take();
        let origin = FlightOrigin {
            path: self.file.clone(),
            is_flight_file: self.flight_file.is_some(),
            name: self.name.clone(),
            is_changed: options.surface.is_some() || options.photos.is_some(),
            photo_folder: self.photo_folder.clone(),
            surface: surface.clone(),
        };
        let file = match &surface {
            Some(path) => {
                let mut file = crate::formats::read_cloud(path, progress)?;
                for point in &mut file.cloud.points {
                    *point = self.surface_up.to_z_up(*point);
                }
                // The package's own cloud is in the frame of its poses, unless it says otherwise.
                if let Some(similarity) = &self.package_surface_to_world
                    && self.surface_is_packages
                    && file.crs.is_none()
                    && !file.geographic
                {
                    for point in &mut file.cloud.points {
                        *point = similarity.apply(*point);
                    }
                }
                if let Some((axis, along_axis, along_z)) = doubtful_up(&file.cloud) {
                    let (along_axis, along_z) = (100.0 * along_axis, 100.0 * along_z);
                    let axis = axis.name();
                    file.warnings.push(format!(
                        "seen along {axis}, {along_axis:.0} % of its area faces one way, along z {along_z:.0} %: where {axis} is up in the file, write up = \"{axis}\" below [surface] in a flight.toml (a steep wall looks the same)"
                    ));
                }
                self.warn(path, &file.warnings);
                self.inputs.push(path.clone());
                Some(file)
            }
            None => None,
        };
        let surface_file = surface.unwrap_or_else(|| self.file.clone());
        let (cloud, world) = self.bring_to_world(&surface_file, file, progress)?;
        let at_surface = |fault| FileError::new(&surface_file, fault);
        if cloud.cloud.points.is_empty() {
            let looked = self.surface_note.map(|note| format!(": {note}"));
            let looked = looked.unwrap_or_default();
            return Err(at_surface(Fault::new(
                format!("it has no 3D points to make a surface of{looked}"),
                "add its cloud or mesh: drop it on the window, or name it with --surface or as [surface] file in a flight.toml",
            )));
        }
        let settings = options.settings.clone().unwrap_or(self.settings);
        if settings.surface.thinning.is_some() && !cloud.cloud.triangles.is_empty() {
            let file = surface_file.display();
            self.warnings.push(format!(
                "{file}: it has faces, so it is used as it is and not thinned"
            ));
        }
        progress.stage("building the surface");
        let surface = Surface::with_options(cloud.cloud, &settings.surface).map_err(|error| {
            let remedy = match settings.surface.thinning {
                Some(_) => "check the surface file, or thin less",
                None => "check the surface file",
            };
            at_surface(Fault::new(error.to_string(), remedy))
        })?;
        let flight = Flight::new(FlightParts {
            name: self.name,
            unit: settings.unit,
            unit_known: settings.unit_known,
            ground: settings.ground,
            image: settings.image,
            surface: Arc::new(surface),
            cameras: self.cameras,
            photos: self.photos,
        })
        .map_err(|fault| FileError::new(&self.file, fault))?;
        let file = self.file.display();
        let looked_up = look_up(&flight, &photo_files);
        let without_photo = flight.objects_without_photo(&settings.scale_objects);
        self.warnings.extend(
            without_photo
                .into_iter()
                .map(|warning| format!("{file}: {warning}")),
        );
        Ok(Opened {
            flight: Arc::new(flight),
            warnings: self.warnings,
            photo_files,
            looked_up,
            crs: world.crs().map(str::to_owned),
            settings,
            file: self.flight_file.map(|file| (self.file, file)),
            origin,
            reconstruction: self.reconstruction,
            inputs: self.inputs,
            read: Inputs::default(),
        })
    }

    /// Brings the poses and the surface (that of `file`, or the reconstruction's own points) to the
    /// flight's world.
    fn bring_to_world(
        &mut self,
        surface_file: &Path,
        file: Option<CloudFile>,
        progress: &Progress,
    ) -> Result<(CloudFile, Frame), FileError> {
        let at_surface = |fault| FileError::new(surface_file, fault);
        let path = self.file.clone();
        let at_poses = |fault| FileError::new(&path, fault);
        let mut said = Vec::new();
        let surface = file.as_ref().map(|file| Frame::of_cloud(file, &mut said));
        let surface = surface.transpose().map_err(at_surface)?;
        self.warn(surface_file, &said);
        let centers = self.photos.iter().map(|photo| photo.pose.center);
        let first_point = file.as_ref().and_then(|file| file.cloud.points.first());
        let known = Known {
            named: self.named_crs.clone(),
            on_surface: first_point.copied().unwrap_or_default(),
            surface: surface.clone(),
            poses: self.poses_frame.clone(),
            preferred: self.preferred_crs.clone(),
            middle: centers.sum::<DVec3>() / self.photos.len().max(1) as f64,
        };
        let world = known.world().map_err(at_poses)?;
        let of_poses = self.poses_frame.to(&world);
        let (mut cloud, of_points) = match (file, &surface) {
            (Some(file), Some(frame)) => (file, frame.to(&world)),
            _ => (std::mem::take(&mut self.reconstruction_cloud), of_poses),
        };
        if !of_poses.is_none() || !of_points.is_none() {
            progress.stage("bringing poses and surface to one coordinate system");
        }
        for photo in &mut self.photos {
            photo.pose = of_poses.pose(&photo.name, &photo.pose).map_err(at_poses)?;
        }
        of_points
            .points(&mut cloud.cloud.points)
            .map_err(at_surface)?;
        let middle = cloud.cloud.points.first().copied();
        let doubt = middle.map(|point| world.check_lengths(point)).transpose();
        let doubt = doubt.map_err(at_surface)?.flatten();
        let poses_moved = of_poses.in_words("the poses");
        let points_moved = of_points.in_words("the points");
        self.warn(surface_file, doubt.as_slice());
        self.warn(&path, poses_moved.as_slice());
        match surface {
            Some(Frame::AsIs(_)) if !self.poses_frame.is_as_it_is() => {
                let centers = self.photos.iter().map(|photo| photo.pose.center);
                let centers: Vec<DVec3> = centers.collect();
                let said = taken_to_be_in(&world, &cloud.cloud.points, &centers);
                // A package's own surface is in its package's frame, as long as that stays.
                let said = match (said, self.surface_is_packages) {
                    (Err(fault), true) => Some(fault.what),
                    (Ok(_), true) if poses_moved.is_none() => None,
                    (said, _) => Some(said.map_err(at_surface)?),
                };
                self.warn(surface_file, said.as_slice());
            }
            Some(_) => self.warn(surface_file, points_moved.as_slice()),
            None => {}
        }
        let Some(unit) = world.unit().map_err(at_poses)? else {
            self.take_package_unit();
            return Ok((cloud, world));
        };
        let stated = self.settings.unit;
        if !self.unit_is_stated {
            self.settings.unit = unit;
            self.settings.unit_known = true;
        } else if unit != stated {
            let what = format!(
                "the world is {}, which counts in {unit}, not {stated}",
                world.in_words()
            );
            if poses_moved.is_some() || !self.poses_frame.is_as_it_is() {
                let remedy = format!("write world.unit = \"{unit}\"");
                return Err(at_poses(Fault::new(what, remedy)));
            }
            self.warn(surface_file, &[what]);
        }
        Ok((cloud, world))
    }

    /// The unit of a world without a coordinate system: what flight.toml says, else the package.
    fn take_package_unit(&mut self) {
        let settings = &mut self.settings;
        match (self.unit_is_stated, self.package_unit) {
            (false, unit) => {
                settings.unit = unit.unwrap_or(settings.unit);
                settings.unit_known = unit.is_some();
            }
            (true, Some(unit)) if unit != settings.unit => {
                let path = self.file.clone();
                let stated = settings.unit;
                let what = format!("world.unit is {stated}, but the package counts in {unit}");
                self.warn(&path, &[what]);
            }
            (true, _) => {}
        }
    }

    fn warn(&mut self, path: &Path, warnings: &[String]) {
        let path = path.display();
        self.warnings
            .extend(warnings.iter().map(|warning| format!("{path}: {warning}")));
    }
}

/// The name of a flight that says none: that of its folder, or of its file without extension.
fn name_of(path: &Path) -> String {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = if path.file_name().is_some_and(|name| name == "flight.toml") {
        path.parent().and_then(Path::file_name)
    } else if path.is_dir() {
        path.file_name()
    } else {
        path.file_stem()
    };
    name.map_or_else(
        || "flight".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// The size that a table gives: for the camera that it names, or for all.
type GivenSize<'a> = (Option<&'a str>, (u32, u32));

/// The tables of a flight whose cameras come from a reconstruction hold sizes only.
fn sizes_of_entries(entries: &[CameraEntry]) -> Result<Vec<GivenSize<'_>>, Fault> {
    entries
        .iter()
        .map(|entry| match entry.source()? {
            CameraSource::Size(width, height) => Ok((entry.name.as_deref(), (width, height))),
            CameraSource::File(_) | CameraSource::Inline(_) => Err(Fault::new(
                "a [[camera]] has intrinsics, but the reconstruction brings its own",
                "keep only width and height, or remove the table",
            )),
        })
        .collect()
}

/// Which camera a pose belongs to.
fn camera_of(line: &PoseLine, names: &[Option<String>]) -> Result<usize, Fault> {
    let known = || {
        let names: Vec<_> = names.iter().flatten().map(String::as_str).collect();
        names.join(", ")
    };
    match (&line.camera, names) {
        (None, [_]) | (Some(_), [None]) => Ok(0),
        (None, _) => Err(Fault::at(
            line.line,
            "column camera: the flight has several cameras, and this photo names none",
            format!("name one of {}", known()),
        )),
        (Some(name), names) => names
            .iter()
            .position(|known| known.as_ref() == Some(name))
            .ok_or_else(|| {
                Fault::at(
                    line.line,
                    format!("column camera: there is no camera '{name}'"),
                    format!("name one of {}", known()),
                )
            }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fragscale_test_data::shared_data;

    /// Opens a flight over that surface, as the file has it or with `more` below [surface].
    fn opened(surface: &Path, more: &str) -> Opened {
        let folder = tempfile::tempdir().unwrap();
        let flight = folder.path().join("flight.toml");
        let text = format!(
            "format = 1\nworld.unit = \"m\"\n[surface]\nfile = '{}'\n{more}\n[[camera]]\nwidth = 4\nheight = 3\n\
             fx = 4\nfy = 4\ncx = 2\ncy = 1.5\n[photos]\nposes = \"poses.csv\"\n",
            surface.display()
        );
        std::fs::write(&flight, text).unwrap();
        let poses = "photo,x,y,z,qx,qy,qz,qw\na.jpg,50,-300,250,1,0,0,0\n";
        std::fs::write(folder.path().join("poses.csv"), poses).unwrap();
        open_flight(&flight, &OpenOptions::default(), &Progress::default()).unwrap()
    }

    #[test]
    fn a_quarry_with_y_up() {
        let Some(folder) = shared_data("authume-quarry-terrain/Geometries") else {
            return;
        };
        let mut area = 0.0;
        for name in ["DTM_Blue_zone.stl", "DTM_Gray_zone.stl", "DTM_Red_zone.stl"] {
            let path = folder.join("STL").join(name);
            let as_it_is = opened(&path, "");
            let doubts = |opened: &Opened| {
                let about_up = |warning: &&String| warning.contains("up = \"y\"");
                opened.warnings.iter().filter(about_up).count()
            };
            assert_eq!(doubts(&as_it_is), 1, "{:?}", as_it_is.warnings);
            let turned = opened(&path, "up = \"y\"");
            assert_eq!(doubts(&turned), 0);
            let surface = &turned.flight.parts().surface;
            let bounds = surface.bounds();
            assert!(bounds.min.z > 153.0 && bounds.max.z < 214.5, "{bounds:?}");
            let vertices: Vec<_> = surface.vertices().collect();
            for triangle in surface.triangles().unwrap() {
                let [a, b, c] = triangle.map(|corner| vertices[corner as usize].truncate());
                area += (b - a).perp_dot(c - a).abs() / 2.0;
            }
        }
        // The README's number.
        assert!((area - 21_465.0).abs() < 1.0, "{area}");
        let cloud = opened(&folder.join("Point_cloud/Terrain.xyz"), "up = \"y\"");
        let bounds = cloud.flight.parts().surface.bounds();
        assert!(bounds.min.z > 153.0 && bounds.max.z < 214.5, "{bounds:?}");
    }
}
