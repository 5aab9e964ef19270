//! `fragscale render`: a picture of a flight into a file, without a window.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use clap::{Args, ValueEnum};
use glam::{DVec2, DVec3};
use image::{DynamicImage, RgbaImage};

use super::Answer;
use super::flight_arguments::FlightArguments;
use super::on_surface::places::place;
use super::outputs::{Force, Outputs, ends_otherwise};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::{Kind, marked_png};
use crate::flight::{Limits, Review};
use crate::formats::photos::photo_metadata;
use crate::formats::{self, FileError};
use crate::geometry::{Bounds, LocalFrame};
use crate::jobs::Progress;
use crate::opening::{ComparedFlight, Opened, PhotoFile, StatedTakeOff, compare_flown};
use crate::picture;
use crate::render::{
    Background, ColorBy, Gpu, MOST_PIXELS, Orbit, PhotoGeometry, PhotoImage, Renderer, Scope,
    Shapes, Show, SurfaceBuffers, Taken, View, drawn_ground, flight_line, flown_lines,
};
use crate::scale::Corner;

/// Longer edge of the photo that is laid on the surface or over the view.
const PHOTO_EDGE: u32 = 2048;

#[derive(Debug, Args)]
pub(super) struct RenderArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The picture to write, a PNG.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    force: Force,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    size: Size,
    /// Where to look from: orbit, top, front, side, or photo:NAME to look through its camera.
    #[arg(long, value_name = "VIEW", default_value = "orbit")]
    view: Viewpoint,
    /// What is shown, separated by commas. frusta, images, rays, outlines and fills may end in
    /// :selected to show them for that photo only.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "mesh,frusta,rays,outlines,fills,axes,bar"
    )]
    show: Vec<Item>,
    /// What the surface's colours mean.
    #[arg(long, value_enum, default_value = "rgb")]
    color_by: Colors,
    /// What is behind everything.
    #[arg(long, value_enum, default_value = "white")]
    background: Backdrop,
    /// The selected photo.
    #[arg(long, value_name = "PHOTO")]
    select: Option<String>,
    /// A mission that this flight came of: its path and cameras, the flown path, and which photos were not taken (red).
    #[arg(long, value_name = "FILE")]
    mission: Option<PathBuf>,
    /// Where the drone of the mission took off, in the world and on the surface, if that is not where the mission says.
    #[arg(long, value_name = "X,Y", value_parser = place, requires = "mission", allow_hyphen_values = true)]
    take_off: Option<DVec2>,
    /// How much of the photo lies over the view through its camera, 0 to 1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    blend: f64,
}

#[derive(Debug, Clone, Copy)]
struct Size([u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once(['x', 'X', '×']);
        let number = |text: &str| text.trim().parse::<u32>().ok().filter(|side| *side > 0);
        let size = sides.and_then(|(w, h)| Some([number(w)?, number(h)?]));
        match size {
            Some([w, h]) if u64::from(w) * u64::from(h) <= MOST_PIXELS => Ok(Self([w, h])),
            Some(_) => Err(format!(
                "give at most {} million pixels",
                MOST_PIXELS / 1_000_000
            )),
            None => Err("give width and height like 1280x720".to_owned()),
        }
    }
}

#[derive(Debug, Clone)]
enum Viewpoint {
    Orbit,
    Top,
    Front,
    Side,
    Photo(String),
}

impl FromStr for Viewpoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "orbit" => Ok(Self::Orbit),
            "top" => Ok(Self::Top),
            "front" => Ok(Self::Front),
            "side" => Ok(Self::Side),
            _ => match text.strip_prefix("photo:") {
                Some(name) if !name.is_empty() => Ok(Self::Photo(name.to_owned())),
                _ => Err("give orbit, top, front, side or photo:NAME".to_owned()),
            },
        }
    }
}

/// Something to show, perhaps only of the selected photo.
#[derive(Debug, Clone)]
struct Item {
    name: &'static str,
    scope: Scope,
}

/// What [`Item`]s there are, and whether they belong to photos.
const ITEMS: [(&str, bool); 13] = [
    ("mesh", false),
    ("cloud", false),
    ("wireframe", false),
    ("frusta", true),
    ("images", true),
    ("rays", true),
    ("outlines", true),
    ("fills", true),
    ("line", false),
    ("ground", false),
    ("photo", false),
    ("axes", false),
    ("bar", false),
];

impl FromStr for Item {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (wanted, scope) = match text.strip_suffix(":selected") {
            Some(name) => (name, Scope::Selected),
            None => (text, Scope::All),
        };
        ITEMS
            .into_iter()
            .find(|(name, of_photos)| *name == wanted && (*of_photos || scope == Scope::All))
            .map(|(name, _)| Self { name, scope })
            .ok_or_else(|| {
                let names: Vec<&str> = ITEMS.into_iter().map(|(name, _)| name).collect();
                format!("give some of {}", names.join(", "))
            })
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Colors {
    /// Their own.
    Rgb,
    /// Height.
    Elevation,
    /// Angle to the horizontal.
    Slope,
    /// Pixels of the selected photo per unit.
    Scale,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Backdrop {
    Dark,
    Light,
    White,
    Transparent,
}

fn share(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|e| format!("{e}"))?;
    if (0.0..=1.0).contains(&number) {
        return Ok(number);
    }
    Err("give 0 to 1".to_owned())
}

pub(super) fn render(arguments: &RenderArguments, progress: &Progress) -> Result<Answer, String> {
    let inputs = arguments.flight.files().chain(&arguments.mission);
    let outputs = Outputs::new(arguments.force, inputs);
    let mut outputs = outputs.and(&arguments.output, Kind::Result)?;
    let opened = arguments.flight.open(progress)?;
    outputs.read(&opened.read)?;
    let ending = arguments.output.extension().unwrap_or_default();
    if !ending.is_empty() && !ending.eq_ignore_ascii_case("png") {
        let (file, ending) = (&arguments.output, ending.to_string_lossy());
        return Err(ends_otherwise(
            file,
            &ending,
            "a PNG",
            "end the name in .png",
        ));
    }
    let path = &arguments.flight.flight;
    let compared = compared(arguments, &opened, progress).map_err(|error| error.to_string())?;
    let at_flight = |fault| FileError::new(path, fault).to_string();
    let picture = draw(arguments, &opened, compared.as_ref(), progress).map_err(at_flight)?;
    progress.stage("writing the picture");
    let mut bytes = Vec::new();
    picture
        .write_to(
            &mut std::io::Cursor::new(&mut bytes),
            image::ImageFormat::Png,
        )
        .map_err(|error| {
            let fault = Fault::new(
                format!("it cannot be encoded ({error})"),
                "draw a smaller picture",
            );
            FileError::new(&arguments.output, fault).to_string()
        })?;
    outputs.write(&arguments.output, &marked_png(bytes), Kind::Result)?;
    let mut warnings = opened.all_warnings();
    warnings.extend(compared.into_iter().flat_map(|compared| compared.notes));
    Ok(Answer::new(String::new(), warnings))
}

/// The mission beside the flight, where one is named.
fn compared(
    arguments: &RenderArguments,
    opened: &Opened,
    progress: &Progress,
) -> Result<Option<ComparedFlight>, FileError> {
    let of = arguments.flight.of_mission(opened);
    let mission = arguments.mission.as_deref();
    let take_off = arguments.take_off.map(StatedTakeOff::Given);
    mission
        .map(|mission| compare_flown(&[mission], of, take_off, progress))
        .transpose()
}

/// Opens the graphics device and draws.
fn draw(
    arguments: &RenderArguments,
    opened: &Opened,
    compared: Option<&ComparedFlight>,
    progress: &Progress,
) -> Result<RgbaImage, Fault> {
    let flight = &opened.flight;
    let parts = flight.parts();
    let looked_through = match &arguments.view {
        Viewpoint::Photo(name) => Some(flight.photo_typed(name)?),
        _ => None,
    };
    let selected = match &arguments.select {
        Some(name) => Some(flight.photo_typed(name)?),
        None => looked_through,
    };
    if selected.is_none()
        && let Some(reason) = needs_selected(arguments)
    {
        return Err(Fault::new(
            format!("{reason} is of one photo, and none is selected"),
            "name it with --select PHOTO",
        ));
    }
    let gpu = Gpu::headless()?;
    let looked_up = opened.looked_up.clone();
    let limits = Limits::default();
    let mut review = Review::of_scales(flight.clone(), looked_up, &limits, progress)?;
    review.look(progress)?;

    let surface = &parts.surface;
    let bounds = surface.bounds();
    let frame = LocalFrame::near(&bounds);
    let photos = PhotoGeometry::of_review(&frame, &review);
    let bulk = surface.bulk_bounds();
    let mut show = show(arguments, &review, selected, &bulk);
    if let Some(ComparedFlight {
        planned,
        places,
        flown,
        ..
    }) = compared
    {
        let lines = flown_lines(planned, places, flown, parts.cameras.first());
        show.planned_lines = Arc::new(lines);
    }
    let mut renderer = Renderer::new(&gpu);
    renderer.start(&frame);
    let wanted = Shapes {
        cloud: show.cloud,
        mesh: show.mesh || show.wireframe,
    };
    let buffers = SurfaceBuffers::new(&gpu, &frame, surface, wanted, progress)?;
    renderer.set_surface(Some(&buffers));
    progress.stage("drawing");
    renderer.set_photos(photos);
    renderer.set_bulk(Some(&bulk));
    if show.flight_line {
        renderer.set_flight_line(line(opened));
    }
    set_images(&mut renderer, opened, &show, progress)?;

    let size = DVec2::from(arguments.size.0.map(f64::from));
    let view = match looked_through.and_then(|index| review.photo(index)) {
        Some(photo) => View::through(&photo, 1.0),
        None => {
            let mut points = points_to_fit(&review);
            let planned = compared.iter().flat_map(|compared| &compared.planned);
            points.extend(planned.map(|plan| plan.pose.center));
            orbit(&arguments.view, &points, &bounds, size).view()
        }
    };
    renderer.picture_with_words(&view, &show, arguments.size.0)
}

/// The photos in the order in which they were taken.
fn line(opened: &Opened) -> Vec<usize> {
    let photos = &opened.flight.parts().photos;
    let times: Vec<Option<String>> = opened
        .photo_files
        .iter()
        .map(|file| photo_metadata::read_file(file.path.as_deref()?).ok()?.time)
        .collect();
    let taken = photos.iter().zip(&times).map(|(photo, time)| Taken {
        name: &photo.name,
        time: time.as_deref(),
    });
    flight_line(&taken.collect::<Vec<_>>())
}

/// What of the arguments is of the selected photo alone.
fn needs_selected(arguments: &RenderArguments) -> Option<&'static str> {
    if matches!(arguments.color_by, Colors::Scale) {
        return Some("the scale");
    }
    let of_one = |item: &&Item| item.name == "photo" || item.scope == Scope::Selected;
    arguments.show.iter().find(of_one).map(|item| item.name)
}

fn show(
    arguments: &RenderArguments,
    review: &Review,
    selected: Option<usize>,
    bounds: &Bounds,
) -> Show {
    let scope = |name: &str| {
        let item = arguments.show.iter().find(|item| item.name == name);
        item.map_or(Scope::None, |item| item.scope)
    };
    let shown = |name: &str| scope(name) != Scope::None;
    let parts = review.flight().parts();
    let [width, height] = arguments.size.0.map(f64::from);
    Show {
        cloud: shown("cloud"),
        mesh: shown("mesh"),
        wireframe: shown("wireframe"),
        color_by: match arguments.color_by {
            Colors::Rgb => ColorBy::Rgb,
            Colors::Elevation => ColorBy::Elevation,
            Colors::Slope => ColorBy::Slope,
            Colors::Scale => ColorBy::Scale,
        },
        frusta: scope("frusta"),
        images: scope("images"),
        corner_rays: scope("rays"),
        outlines: scope("outlines"),
        fills: scope("fills"),
        flight_line: shown("line"),
        ground: shown("ground").then(|| drawn_ground(parts.ground, review.outcomes(), bounds)),
        axes: shown("axes"),
        scale_bar: shown("bar"),
        unit: parts.unit,
        lengths_in: parts.unit_of_lengths(),
        project_photo: shown("photo"),
        photo_blend: arguments.blend,
        selected,
        background: match arguments.background {
            Backdrop::Dark => Background::Color([24, 26, 30]),
            Backdrop::Light => Background::Color([236, 238, 240]),
            Backdrop::White => Background::Color([255, 255, 255]),
            Backdrop::Transparent => Background::Transparent,
        },
        // Lines and letters keep their share of the picture.
        pixels_per_point: (width / 1280.0).min(height / 720.0).clamp(0.5, 16.0),
        ..Show::default()
    }
}

/// Corner points that lie farther outside of the surface, in its size, are near the horizon: a picture
/// with them would show nothing else.
const FAR: f64 = 2.0;

/// What the picture shall hold: the surface without outliers (some thousands of its vertices stand
/// for all), the camera centres and the corner points that are not near the horizon.
fn points_to_fit(review: &Review) -> Vec<DVec3> {
    let parts = review.flight().parts();
    let vertices = parts.surface.vertices();
    let step = (vertices.len() / 20_000).max(1);
    let bulk = parts.surface.bulk_bounds();
    let corners = review.photos().filter_map(|photo| photo.scale());
    let corners = corners.flat_map(|scale| scale.corners.iter().filter_map(Corner::point));
    let near = bulk.widened(FAR * bulk.size().max_element());
    let corners = corners.filter(|&corner| near.contains(corner));
    let centers = parts.photos.iter().map(|photo| photo.pose.center);
    vertices
        .step_by(step)
        .filter(|&vertex| bulk.contains(vertex))
        .chain(corners)
        .chain(centers)
        .collect()
}

fn orbit(view: &Viewpoint, points: &[DVec3], bounds: &Bounds, size: DVec2) -> Orbit {
    let mut orbit = Orbit::new(bounds);
    match view {
        Viewpoint::Top => {
            orbit.top();
            // As on a map.
            orbit.orthographic = true;
        }
        Viewpoint::Front => orbit.front(),
        Viewpoint::Side => orbit.side(),
        Viewpoint::Orbit | Viewpoint::Photo(_) => (orbit.yaw, orbit.pitch) = (0.45, 0.6),
    }
    orbit.fit_into(points, size);
    orbit
}

/// Reads the photos that are seen.
fn set_images(
    renderer: &mut Renderer,
    opened: &Opened,
    show: &Show,
    progress: &Progress,
) -> Result<(), Fault> {
    let photos = &opened.flight.parts().photos;
    progress.stage("reading photos");
    for (index, (photo, file)) in photos.iter().zip(&opened.photo_files).enumerate() {
        progress.advance(index as u64, photos.len() as u64)?;
        let selected = show.selected == Some(index);
        let large = selected && (show.project_photo || show.photo_blend > 0.0);
        let small = show.images == Scope::All || (show.images == Scope::Selected && selected);
        if !large && !small {
            continue;
        }
        let camera = opened.flight.camera(photo);
        let Some(image) = read_photo(file, camera, if large { PHOTO_EDGE } else { 256 })? else {
            continue;
        };
        if small {
            renderer.set_photo_image(index, &PhotoImage::new(&image));
        }
        if large {
            renderer.set_projected_photo(Some((index, &image)));
        }
    }
    Ok(())
}

/// A photo's undistorted, reduced image, where its file is there.
fn read_photo(file: &PhotoFile, camera: &Camera, edge: u32) -> Result<Option<RgbaImage>, Fault> {
    let Some(path) = &file.path else {
        return Ok(None);
    };
    let at_file = |what: String| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Fault::new(format!("{name}: {what}"), "check the photo")
    };
    let bytes = formats::read_bytes(path).map_err(|error| error.fault)?;
    let photo = picture::decode(&bytes).map_err(|fault| at_file(fault.what))?;
    let image = picture::undistorted(&photo, camera, edge);
    Ok(Some(DynamicImage::ImageRgb8(image).into_rgba8()))
}
