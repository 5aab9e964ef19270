//! What commands do to the control points.

use std::path::{Path, PathBuf};

use super::finding::{Basis, Found};
use super::{Applied, ControlStep};
use crate::control::{ControlList, ControlPoint, ScaleBar};
use crate::fault::one_line;
use crate::flight::{FlightSettings, Placed, moved_errors};
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::open_flight::tracing::rounded;
use crate::opening::{GeoreferenceRequest, Georeferenced, georeference_flight, read_control};
use crate::photo_view::Middle;
use crate::scale::{Ground, StatedErrors};
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::units::LengthUnit;

impl Task {
    /// Bringing the flight to the world by its control points.
    pub const CONTROL: Self = Self::new("Fitting the control points").of_flight();
    /// Reading a list of control points.
    pub const READ_CONTROL: Self = Self::new("Reading control points").of_flight();
}

/// A name without what would break the lines of a list.
fn cleaned(name: &str) -> String {
    one_line(name).replace('\t', " ").trim().to_owned()
}

impl State {
    /// Does a step with the control points.
    pub(crate) fn control_step(&mut self, step: ControlStep) {
        let Some(open) = &mut self.open else {
            return;
        };
        match step {
            ControlStep::Toggle => self.toggle_control(),
            ControlStep::Choose(point) => open.control.chosen = point,
            ControlStep::Level(level) => open.control.level = level,
            ControlStep::Load(path) => self.load_control(path),
            ControlStep::Apply => self.start_control(),
            step => {
                let mut list = open.control_list().clone();
                open.change_control(&mut list, step);
                self.set_control(list);
            }
        }
    }

    /// Takes another list, as a step that can be undone.
    fn set_control(&mut self, control: ControlList) {
        if let Some(open) = &self.open {
            let settings = open.settings();
            self.set_settings(FlightSettings {
                control,
                ..settings
            });
        }
    }

    fn toggle_control(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        open.control.is_on ^= true;
        if !open.control.is_on {
            return;
        }
        open.objects.tracing = None;
        if open.control.chosen.is_none() && !open.control_list().points.is_empty() {
            open.control.chosen = Some(0);
        }
        self.asking = None;
        self.preferences.left_open = true;
        if self.middle == Middle::Pile {
            self.middle = Middle::Both;
            self.load_full_photo();
        }
    }

    fn load_control(&mut self, path: PathBuf) {
        let Some(open) = &self.open else {
            return;
        };
        let flight = open.flight().clone();
        self.asking = None;
        let work = move |_: &Progress| {
            let photos = flight.parts().photos.iter();
            let photos: Vec<&str> = photos.map(|photo| photo.name.as_str()).collect();
            let read = read_control(&path, &photos);
            (path, read.map_err(|error| error.to_string()))
        };
        self.start(Task::READ_CONTROL, work, |state, (path, read)| match read {
            Err(message) => state.say_until_mended(Task::READ_CONTROL, &message),
            Ok((list, warnings)) => {
                state.mended(Task::READ_CONTROL);
                for warning in warnings {
                    let text = format!("{}: {warning}", path.display());
                    state.say(Severity::Warning, &text);
                }
                if let Some(open) = &mut state.open {
                    open.files.read.add(&path);
                    let merged = merged(open.control_list(), list);
                    open.control.chosen = open.control.chosen.or(Some(0));
                    state.set_control(merged);
                }
            }
        });
    }

    /// Fits the flight to them.
    fn start_control(&mut self) {
        if self.is_busy(Task::CONTROL) || self.is_opening() {
            return;
        }
        let Some(open) = &mut self.open else {
            return;
        };
        open.control.applied = None;
        let request = GeoreferenceRequest {
            photos: open.files.origin.photo_folder().map(Path::to_owned),
            photos_are_packages: !open.files.photos_are_named,
            marked: Some(open.control_list().clone()),
            crs: open.files.crs.clone(),
            level: open.control.level,
            ..GeoreferenceRequest::default()
        };
        let (flight, file) = (open.flight().clone(), open.files.origin.file().to_owned());
        // Where nobody says how sure its poses are, its model may.
        let is_stated = open.settings().errors.pose.is_stated();
        let behind = open.files.reconstruction.as_ref().filter(|_| !is_stated);
        let behind = behind.map(|behind| behind.path.clone());
        let photos = request.photos.clone();
        let work = move |progress: &Progress| {
            progress.stage("fitting");
            let found = georeference_flight(&file, &flight, &request).and_then(|mut found| {
                if let Some(model) = behind {
                    found.look_up_errors(&flight, &model, photos.as_deref(), progress)?;
                }
                Ok(found)
            });
            found.map_err(|error| error.fault.to_string())
        };
        let by = open.control_list().clone();
        let fitted = (open.first_number, place_of(open.settings_now()));
        self.start(Task::CONTROL, work, move |state, found| {
            let Some(open) = &mut state.open else {
                return;
            };
            if (open.first_number, place_of(open.settings_now())) != fitted {
                let text = "the flight was brought elsewhere while its control points were fitted: apply them again";
                state.say(Severity::Warning, text);
                return;
            }
            match found {
                Ok(found) => state.take_control(found, by),
                Err(message) => open.control.applied = Some(Applied::Failed(message)),
            }
        });
    }

    /// Brings the flight to where the control points are: one step of undo.
    fn take_control(&mut self, found: Georeferenced, by: ControlList) {
        let Some(open) = &mut self.open else {
            return;
        };
        let settings = open.placed_settings(&found);
        let unit = found.unit;
        let said = match (&found.crs, found.scale_error) {
            (Some(crs), _) => format!("the flight is in {crs} by its control points"),
            (None, _) => format!("the flight is in {unit} by its control points"),
        };
        for warning in &found.warnings {
            self.say(Severity::Warning, warning);
        }
        self.say(Severity::Note, &said);
        let had_plan = self
            .open
            .as_ref()
            .is_some_and(|open| open.planning.to_save().is_some());
        if had_plan {
            let text =
                "the flight plan was of where the flight was before, and is gone: plan it anew";
            self.say(Severity::Warning, text);
        }
        if let Some(open) = &mut self.open {
            let placed = settings.placed.clone();
            let by = Box::new(by);
            open.control.applied = Some(Applied::Placed(Box::new(found), placed, by));
        }
        self.set_settings(settings);
    }
}

/// What a fit begins from: where the flight stands, and in which unit.
fn place_of(settings: &FlightSettings) -> (Option<Placed>, Option<LengthUnit>) {
    let unit = settings.unit_known.then_some(settings.unit);
    (settings.placed.clone(), unit)
}

/// The list with another one's points behind its own; a point of a name that is there already takes its place.
fn merged(own: &ControlList, other: ControlList) -> ControlList {
    let mut merged = own.clone();
    merged.crs = other.crs.or(merged.crs);
    for point in other.points {
        match merged.points.iter().position(|p| p.name == point.name) {
            Some(place) => merged.points[place] = point,
            None => merged.points.push(point),
        }
    }
    for bar in other.bars {
        if !merged.bars.contains(&bar) {
            merged.bars.push(bar);
        }
    }
    merged
}

impl OpenFlight {
    /// The control points of now.
    pub fn control_list(&self) -> &ControlList {
        &self.history.now().control
    }

    /// Finds what follows from the marks, if that is not known.
    pub(crate) fn look_at_control(&mut self) {
        if !self.control.is_on {
            return;
        }
        let flight = self.flight();
        let list = self.control_list();
        let chosen = self.control.chosen.filter(|&at| at < list.points.len());
        let basis = Basis {
            flight,
            list,
            chosen,
            selected: self.selected,
            image: self.photo_view.image_for(flight.parts().image),
        };
        if self.control.found.is_of(&basis) {
            return;
        }
        let found = Found::of(&basis);
        self.control.chosen = chosen;
        self.control.found = found;
    }

    /// Changes a list of control points.
    fn change_control(&mut self, list: &mut ControlList, step: ControlStep) {
        let names: Vec<String> = list.points.iter().map(|p| p.name.clone()).collect();
        match step {
            ControlStep::Add => {
                let number = |name: &String| name.strip_prefix('P')?.parse::<u64>().ok();
                let last = names.iter().filter_map(number).max().unwrap_or(0);
                self.control.chosen = Some(list.points.len());
                list.points.push(ControlPoint {
                    name: format!("P{}", last.saturating_add(1)),
                    ..ControlPoint::default()
                });
            }
            ControlStep::Rename(place, name) => {
                let name = cleaned(&name);
                let Some(point) = list.points.get_mut(place) else {
                    return;
                };
                if name.is_empty() || names.contains(&name) {
                    return;
                }
                let before = std::mem::replace(&mut point.name, name.clone());
                for end in list.bars.iter_mut().flat_map(|bar| &mut bar.ends) {
                    if *end == before {
                        end.clone_from(&name);
                    }
                }
            }
            ControlStep::Survey(place, position) => {
                if let Some(point) = list.points.get_mut(place) {
                    point.position = position;
                }
            }
            ControlStep::Remove(place) if place < list.points.len() => {
                let removed = list.points.remove(place);
                list.bars.retain(|bar| !bar.ends.contains(&removed.name));
                self.control.chosen = match self.control.chosen {
                    Some(chosen) if chosen > place => Some(chosen - 1),
                    Some(chosen) if chosen == place => None,
                    chosen => chosen,
                };
            }
            ControlStep::Crs(crs) => list.crs = crs,
            ControlStep::Mark {
                point,
                photo,
                pixel,
            } => {
                let photo = self.name(photo).to_owned();
                if let Some(point) = list.points.get_mut(point) {
                    point.set_mark(&photo, pixel.map(rounded));
                }
            }
            ControlStep::AddBar => {
                let end = |place: usize| names.get(place).cloned().unwrap_or_default();
                let first = names.len().saturating_sub(2);
                list.bars.push(ScaleBar {
                    ends: [end(first), end(first + 1)],
                    length: 0.0,
                    unit: LengthUnit::Metre,
                });
            }
            ControlStep::Bar(place, bar) => {
                if let Some(before) = list.bars.get_mut(place) {
                    *before = bar;
                }
            }
            ControlStep::RemoveBar(place) if place < list.bars.len() => {
                list.bars.remove(place);
            }
            _ => {}
        }
    }

    /// The settings of now with the flight where `found` brings it.
    fn placed_settings(&self, found: &Georeferenced) -> FlightSettings {
        let mut settings = self.settings();
        let before = settings.placed.as_ref();
        // A system that the files state stays theirs.
        let crs = match (
            before.and_then(|placed| placed.crs.clone()),
            &self.files.crs,
        ) {
            (Some(crs), _) => Some(crs),
            (None, Some(_)) => None,
            (None, None) => found.crs.clone(),
        };
        let by = &found.similarity;
        settings.placed = Some(Placed::then(before, by, crs));
        if !settings.unit_known {
            // Their sizes were typed in a unit that nobody knew.
            settings.scale_objects.clear();
        }
        settings.unit = found.unit;
        settings.unit_known = true;
        settings.errors = StatedErrors {
            pose: (found.errors.pose).or(moved_errors(settings.errors.pose, by)),
            focal: settings.errors.focal.or(found.errors.focal),
            surface: settings.errors.surface.map(|error| error * by.scale),
            world_scale: found.stated_world_scale(),
        };
        for length in [
            &mut settings.surface.max_edge,
            &mut settings.surface.thinning,
        ] {
            *length = length.map(|length| length * by.scale);
        }
        // They were said in the frame before.
        settings.ground = Ground::Auto;
        settings.plan = None;
        settings
    }

    /// What Apply lacks so far; `None` where it can be tried.
    pub fn control_lacks(&self) -> Option<String> {
        let list = self.control_list();
        let is_found = |place: usize| matches!(self.control.found.points.get(place), Some(Ok(_)));
        let points = list.points.iter().enumerate();
        let found: Vec<&ControlPoint> = points
            .filter(|(place, _)| is_found(*place))
            .map(|(_, point)| point)
            .collect();
        let surveyed = found
            .iter()
            .filter(|point| point.position.is_some())
            .count();
        if surveyed >= 3 {
            return None;
        }
        let is_end = |name: &String| found.iter().any(|point| point.name == *name);
        let mut bars = list.bars.iter().filter(|bar| bar.ends.iter().all(is_end));
        let is_marked = bars.clone().next().is_some();
        let has_bar = bars.any(ScaleBar::is_known);
        match has_bar {
            false if is_marked => Some("Type how long the scale bar is in truth.".to_owned()),
            true => None,
            false => Some(format!(
                "Mark three surveyed points in two photos each ({surveyed} so far), or both ends of a scale bar."
            )),
        }
    }

    /// How long a scale bar is in the flight, world units; `None` until both ends are found.
    pub fn bar_length(&self, bar: &ScaleBar) -> Option<f64> {
        let place = |name: &String| {
            let points = &self.control_list().points;
            let at = points.iter().position(|point| point.name == *name)?;
            let found = self.control.found.points.get(at)?.as_ref().ok()?;
            Some(found.point)
        };
        let [from, to] = &bar.ends;
        Some(place(from)?.distance(place(to)?))
    }
}
