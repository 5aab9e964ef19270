//! The table `[plan]` of a flight.toml: what the engineer asks of a flight plan, as the window saves it. Lengths are
//! in world units, angles in degrees, overlaps shares of a photo. Who writes it by hand needs the pattern, a size and the clearance; the rest is
//! what is usual.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use toml_edit::{DocumentMut, Item};

use crate::fault::Fault;
use crate::plan::{
    AskedPlan, Drone, Edit, Flying, Pattern, PhotoAt, Positioning, Size, SurveyWish, USUAL_CLIMB,
    USUAL_DESCENT, USUAL_OFF_NORMAL, USUAL_SETTLE, USUAL_SPEED, USUAL_TILT,
};
use crate::survey::Polygon;

/// The keys of `[plan]`; of its inner tables serde knows them.
pub(super) const PLAN_KEYS: &[&str] = &[
    "pattern",
    "scale",
    "within",
    "distance",
    "overlap",
    "fill_gaps",
    "tilt",
    "off_normal",
    "drone",
    "positioning",
    "clearance",
    "area",
    "keep_out",
    "take_off",
    "speed",
    "settle",
    "climb",
    "descent",
    "battery",
    "steepest",
    "when",
    "survey",
    "edit",
];

/// Places in the world: x and y of each.
type Corners = Vec<[f64; 2]>;

/// `[plan]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PlanEntry {
    pattern: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    within: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distance: Option<f64>,
    #[serde(default)]
    overlap: f64,
    #[serde(default)]
    fill_gaps: bool,
    #[serde(default = "usual_tilt")]
    tilt: f64,
    #[serde(default = "usual_off_normal")]
    off_normal: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    drone: Option<String>,
    #[serde(default = "usual_positioning")]
    positioning: String,
    clearance: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    area: Option<Corners>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    keep_out: Vec<Corners>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    take_off: Option<[f64; 2]>,
    #[serde(default = "usual_speed")]
    speed: f64,
    #[serde(default = "usual_settle")]
    settle: f64,
    #[serde(default = "usual_climb")]
    climb: f64,
    #[serde(default = "usual_descent")]
    descent: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    battery: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    steepest: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    when: Option<String>,
    #[serde(default = "usual_survey")]
    survey: SurveyEntry,
    #[serde(default, rename = "edit", skip_serializing_if = "Vec::is_empty")]
    edits: Vec<EditEntry>,
}

fn usual_tilt() -> f64 {
    USUAL_TILT
}

fn usual_off_normal() -> f64 {
    USUAL_OFF_NORMAL
}

fn usual_positioning() -> String {
    Positioning::default().as_str().to_owned()
}

fn usual_speed() -> f64 {
    USUAL_SPEED
}

fn usual_settle() -> f64 {
    USUAL_SETTLE
}

fn usual_climb() -> f64 {
    USUAL_CLIMB
}

fn usual_descent() -> f64 {
    USUAL_DESCENT
}

fn usual_survey() -> SurveyEntry {
    let SurveyWish {
        overlap,
        cross,
        ring,
        size: _,
    } = SurveyWish::default();
    SurveyEntry {
        overlap,
        cross,
        ring,
        scale: None,
        within: None,
        distance: None,
    }
}

/// `[plan.survey]`: photos for a reconstruction. Without a size they are as large as the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SurveyEntry {
    overlap: f64,
    cross: bool,
    ring: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    within: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distance: Option<f64>,
}

/// `[[plan.edit]]`: a photo that shows another place, one more of a place, or one that is left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EditEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    photo: Option<String>,
    /// What the photo of that name showed then: another plan's photo of the name is another one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shows: Option<[f64; 2]>,
}

/// The size that its three keys say, where they say one and no other.
fn size(scale: Option<f64>, within: Option<f64>, distance: Option<f64>) -> Option<Size> {
    match (scale, within, distance) {
        (Some(pixels), within, None) => Some(Size::Scale { pixels, within }),
        (None, None, Some(distance)) => Some(Size::Distance(distance)),
        _ => None,
    }
}

/// Scale, how far it may be off, and distance: the keys of a size.
fn size_keys(size: Size) -> [Option<f64>; 3] {
    match size {
        Size::Scale { pixels, within } => [Some(pixels), within, None],
        Size::Distance(distance) => [None, None, Some(distance)],
    }
}

fn pattern(name: &str) -> Option<Pattern> {
    Pattern::ALL
        .into_iter()
        .find(|known| known.as_str() == name)
}

fn positioning(name: &str) -> Option<Positioning> {
    Positioning::ALL
        .into_iter()
        .find(|known| known.as_str() == name)
}

fn places(corners: &Corners) -> Vec<DVec2> {
    corners.iter().copied().map(DVec2::from_array).collect()
}

fn corners(places: &[DVec2]) -> Corners {
    places.iter().map(DVec2::to_array).collect()
}

impl PlanEntry {
    /// The first key whose value is none, with what is wrong and what to do. Whether anything can be flown by it,
    /// the plan itself says.
    pub(super) fn trouble(&self) -> Option<(&'static str, String, String)> {
        let say = |key, what: String, remedy: String| Some((key, what, remedy));
        let known = |names: &[&str]| format!("write one of {}", names.join(", "));
        if pattern(&self.pattern).is_none() {
            let what = format!("plan.pattern '{}' is not known", self.pattern);
            return say("pattern", what, known(&Pattern::ALL.map(Pattern::as_str)));
        }
        if positioning(&self.positioning).is_none() {
            let what = format!("plan.positioning '{}' is not known", self.positioning);
            let names = Positioning::ALL.map(Positioning::as_str);
            return say("positioning", what, known(&names));
        }
        if let Some(name) = self
            .drone
            .as_deref()
            .filter(|name| Drone::named(name).is_none())
        {
            let what = format!("plan.drone '{name}' is not known");
            return say("drone", what, known(&Drone::ALL.map(|drone| drone.name)));
        }
        let survey = &self.survey;
        let one = "give a scale, and how far it may be off, or a distance";
        if size(self.scale, self.within, self.distance).is_none() {
            let what = "plan has no scale and no distance, or both".to_owned();
            return say("pattern", what, one.to_owned());
        }
        let of_survey = [survey.scale, survey.within, survey.distance];
        if of_survey.iter().any(Option::is_some)
            && size(survey.scale, survey.within, survey.distance).is_none()
        {
            let what = "plan.survey has no scale and no distance, or both".to_owned();
            return say("survey", what, one.to_owned());
        }
        let numbers = [
            ("overlap", Some(self.overlap)),
            ("tilt", Some(self.tilt)),
            ("off_normal", Some(self.off_normal)),
            ("clearance", Some(self.clearance)),
            ("scale", self.scale),
            ("within", self.within),
            ("distance", self.distance),
            ("speed", Some(self.speed)),
            ("settle", Some(self.settle)),
            ("climb", Some(self.climb)),
            ("descent", Some(self.descent)),
            ("battery", self.battery),
            ("steepest", self.steepest),
            ("survey", Some(survey.overlap)),
            ("survey", survey.scale),
            ("survey", survey.within),
            ("survey", survey.distance),
        ];
        let is_one = |value: f64| value >= 0.0 && value.is_finite();
        if let Some(share) = [self.overlap, survey.overlap]
            .into_iter()
            .find(|share| *share >= 1.0)
        {
            let what = format!("plan.overlap is {share}, and is a share of a photo");
            return say("overlap", what, "write 0.2 for 20 %".to_owned());
        }
        let wrong = numbers
            .iter()
            .find(|(_, value)| value.is_some_and(|value| !is_one(value)));
        if let Some((key, Some(value))) = wrong {
            let what = format!("plan.{key} is {value}");
            return say(key, what, "give a number of 0 or more".to_owned());
        }
        let areas = self.area.iter().map(|area| ("area", area));
        for (key, area) in areas.chain(self.keep_out.iter().map(|area| ("keep_out", area))) {
            if let Err(error) = Polygon::new(&places(area)) {
                let remedy = "give its corners as [[x, y], ...], or remove the key".to_owned();
                return say(key, format!("plan.{key}: {error}"), remedy);
            }
        }
        let shown = self
            .edits
            .iter()
            .flat_map(|edit| edit.shows.into_iter().chain(edit.at));
        let mut all = self.take_off.iter().copied().chain(shown);
        if all.any(|place| !DVec2::from_array(place).is_finite()) {
            let what = "a place of the plan is not finite".to_owned();
            return say(
                "take_off",
                what,
                "give x and y, or remove the key".to_owned(),
            );
        }
        let is_none = |edit: &EditEntry| {
            edit.photo.is_some() != edit.at.is_some()
                || (edit.photo.is_none() && edit.shows.is_none())
        };
        if self.edits.iter().any(is_none) {
            let what = "an edit of the plan is not whole".to_owned();
            let remedy = "name the photo with the place that it showed (at), the place that it is to show, or both; or remove the table";
            return say("edit", what, remedy.to_owned());
        }
        None
    }
}

impl From<&AskedPlan> for PlanEntry {
    fn from(asked: &AskedPlan) -> Self {
        let AskedPlan {
            pattern,
            size,
            overlap,
            survey,
            fill_gaps,
            tilt,
            off_normal,
            drone,
            positioning,
            clearance,
            area,
            keep_out,
            take_off,
            flying,
            when,
            edits,
        } = asked;
        let [scale, within, distance] = size_keys(*size);
        let [of_survey, within_of_survey, survey_distance] =
            survey.size.map(size_keys).unwrap_or_default();
        Self {
            pattern: pattern.as_str().to_owned(),
            scale,
            within,
            distance,
            overlap: *overlap,
            fill_gaps: *fill_gaps,
            tilt: *tilt,
            off_normal: *off_normal,
            drone: drone.map(|drone| drone.name.to_owned()),
            positioning: positioning.as_str().to_owned(),
            clearance: *clearance,
            area: area.as_deref().map(corners),
            keep_out: keep_out.iter().map(|area| corners(area)).collect(),
            take_off: take_off.map(|place| place.to_array()),
            speed: flying.speed,
            settle: flying.settle,
            climb: flying.climb,
            descent: flying.descent,
            battery: flying.battery,
            steepest: flying.steepest,
            when: when.clone(),
            survey: SurveyEntry {
                overlap: survey.overlap,
                cross: survey.cross,
                ring: survey.ring,
                scale: of_survey,
                within: within_of_survey,
                distance: survey_distance,
            },
            edits: edits.iter().map(EditEntry::from).collect(),
        }
    }
}

impl From<&Edit> for EditEntry {
    fn from(edit: &Edit) -> Self {
        let (photo, shows) = match edit {
            Edit::Move(photo, to) => (Some(photo), Some(to)),
            Edit::Add(place) => (None, Some(place)),
            Edit::Leave(photo) => (Some(photo), None),
        };
        Self {
            photo: photo.map(|photo| photo.name.clone()),
            at: photo.map(|photo| photo.at.to_array()),
            shows: shows.map(|place| place.to_array()),
        }
    }
}

impl PlanEntry {
    /// What is asked for, of a table without [`Self::trouble`].
    pub(super) fn asked(&self) -> Option<AskedPlan> {
        let survey = &self.survey;
        let edits = self.edits.iter().filter_map(|edit| {
            let place = edit.shows.map(DVec2::from_array);
            let photo = edit.photo.clone().zip(edit.at).map(|(name, at)| PhotoAt {
                name,
                at: DVec2::from_array(at),
            });
            match (photo, place) {
                (Some(photo), Some(to)) => Some(Edit::Move(photo, to)),
                (None, Some(place)) => Some(Edit::Add(place)),
                (Some(photo), None) => Some(Edit::Leave(photo)),
                (None, None) => None,
            }
        });
        Some(AskedPlan {
            pattern: pattern(&self.pattern)?,
            size: size(self.scale, self.within, self.distance)?,
            overlap: self.overlap,
            survey: SurveyWish {
                overlap: survey.overlap,
                cross: survey.cross,
                ring: survey.ring,
                size: size(survey.scale, survey.within, survey.distance),
            },
            fill_gaps: self.fill_gaps,
            tilt: self.tilt,
            off_normal: self.off_normal,
            drone: self.drone.as_deref().and_then(Drone::named),
            positioning: positioning(&self.positioning)?,
            clearance: self.clearance,
            area: self.area.as_ref().map(places),
            keep_out: self.keep_out.iter().map(places).collect(),
            take_off: self.take_off.map(DVec2::from_array),
            flying: Flying {
                speed: self.speed,
                settle: self.settle,
                battery: self.battery,
                climb: self.climb,
                descent: self.descent,
                steepest: self.steepest,
            },
            when: self.when.clone(),
            edits: edits.collect(),
        })
    }
}

/// Writes the table anew behind all others, or takes it out.
///
/// # Errors
/// Where it cannot be written.
pub(super) fn set_plan(document: &mut DocumentMut, plan: Option<&AskedPlan>) -> Result<(), Fault> {
    #[derive(Serialize)]
    struct Alone {
        plan: PlanEntry,
    }
    document.remove("plan");
    let Some(plan) = plan else {
        return Ok(());
    };
    let unwritten =
        |why: String| Fault::new(format!("the plan cannot be written ({why})"), "report this");
    let text =
        toml::to_string(&Alone { plan: plan.into() }).map_err(|e| unwritten(e.to_string()))?;
    let mut alone: DocumentMut = text
        .parse()
        .map_err(|e: toml_edit::TomlError| unwritten(e.to_string()))?;
    let mut item = alone.remove("plan").unwrap_or_default();
    let_go_of_places(&mut item);
    document.insert("plan", item);
    Ok(())
}

/// Tables are written by the places that they had in their text, which is another one here.
fn let_go_of_places(item: &mut Item) {
    match item {
        Item::Table(table) => {
            table.set_position(None);
            table
                .iter_mut()
                .for_each(|(_, item)| let_go_of_places(item));
        }
        Item::ArrayOfTables(tables) => {
            tables.iter_mut().for_each(|table| table.set_position(None));
        }
        Item::None | Item::Value(_) => {}
    }
}
