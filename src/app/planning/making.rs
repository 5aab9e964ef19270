//! The plan of what is asked for, as a job.

use std::sync::Arc;

use super::asked::{AskedPlan, Edit};
use super::lines;
use super::made::MadePlan;
use crate::camera::Camera;
use crate::exports::{PlanReport, plan_warnings};
use crate::fault::Fault;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::plan::{self, Pace, Plan, Way};
use crate::state::State;
use crate::surface::Surface;
use crate::survey::Polygon;
use crate::tasks::Task;
use crate::units::LengthUnit;

impl Task {
    /// Making a flight plan.
    pub const PLAN: Self = Self::new("Flight plan").of_flight();
}

/// What a plan is made over.
struct Over {
    name: String,
    surface: Arc<Surface>,
    /// The flight's first camera, where it has one.
    camera: Option<Camera>,
    unit: LengthUnit,
    crs: Option<String>,
}

impl State {
    /// Makes the plan of what is asked for now.
    pub(super) fn make_plan(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let parts = open.flight().parts();
        let (Some(asked), true) = (open.planning.now().cloned(), parts.unit_known) else {
            return;
        };
        let over = Over {
            name: parts.name.clone(),
            surface: parts.surface.clone(),
            camera: parts.cameras.first().cloned(),
            unit: parts.unit,
            crs: open.files.crs.clone(),
        };
        let before = open.planning.made.clone();
        let wish = asked.clone();
        let work = move |progress: &Progress| {
            // That nothing can be planned is an answer, and stands on the page; it is no failure of the window.
            match made(&asked, &over, before.as_deref(), progress) {
                Err(fault) if progress.is_cancelled() => Err(fault),
                made => Ok((asked, made)),
            }
        };
        self.start_wished(Task::PLAN, wish, work, |state, (asked, made)| {
            let Some(open) = &mut state.open else {
                return;
            };
            let planning = &mut open.planning;
            match made {
                Ok(made) => planning.take(made),
                Err(fault) => planning.refused = Some((asked, fault.to_string())),
            }
        });
    }
}

fn made(
    asked: &AskedPlan,
    over: &Over,
    before: Option<&MadePlan>,
    progress: &Progress,
) -> Result<MadePlan, Fault> {
    let metres = over.unit.metres();
    let no_area = |error: crate::survey::SurveyError| {
        Fault::new(format!("the area is none: {error}"), "draw it again")
    };
    let before = before.filter(|before| before.asked.base() == asked.base());
    let base = match before {
        Some(before) => before.base.clone(),
        None => {
            let camera = match (asked.drone, &over.camera) {
                (Some(drone), _) => drone.camera(),
                (None, Some(camera)) => camera.clone(),
                (None, None) => {
                    let what = "nobody says which camera is to fly";
                    return Err(Fault::new(what, "choose a drone"));
                }
            };
            let area = match &asked.area {
                Some(corners) => Polygon::new(corners).map_err(no_area)?,
                None => {
                    progress.stage("looking for the pile");
                    plan::pile(&over.surface, progress)?
                }
            };
            let wish = asked.wish(metres).map_err(no_area)?;
            let plan = Plan::new(&over.surface, &camera, area, wish, progress)?;
            Arc::new(match asked.fill_gaps {
                true => plan.with_gaps_filled(&over.surface, progress)?,
                false => plan,
            })
        }
    };
    // What was done by hand is not done again where it is more of the same.
    let done = before.filter(|before| asked.edits.starts_with(&before.asked.edits));
    let (mut plan, edits) = match done {
        Some(done) => (done.plan.clone(), &asked.edits[done.asked.edits.len()..]),
        None => (base.clone(), &asked.edits[..]),
    };
    for edit in edits {
        plan = Arc::new(edited(&plan, edit, &over.surface, progress)?);
    }
    let pace = Pace::of(asked.speed, asked.settle, asked.battery, metres);
    let ways = match asked.take_off {
        None => Ok(Vec::new()),
        Some(place) => {
            progress.stage("the way through the photos");
            Way::through(&plan, &over.surface, place, &pace)
        }
    };
    let (ways, no_way) = match ways {
        Ok(ways) => (ways, None),
        Err(fault) => (Vec::new(), Some(fault.to_string())),
    };
    let warnings = plan_warnings(&PlanReport {
        flight: &over.name,
        world: over.unit,
        scales: over.unit,
        plan: &plan,
        ways: &ways,
        pace,
        is_nominal: asked.drone.is_some(),
        sun: None,
    });
    let sun = asked.when.as_deref().map(|when| {
        progress.stage("where the sun stands");
        let crs = over.crs.as_deref().ok_or_else(|| {
            let what = "nobody says in which coordinate system the flight's places are";
            Fault::new(what, "set it under Flight")
        });
        plan.sun_at(when, &Crs::understand(crs?)?)
    });
    let (sun, no_sun) = match sun.transpose() {
        Ok(sun) => (sun, None),
        Err::<_, Fault>(fault) => (None, Some(fault.to_string())),
    };
    let mut lines = lines::areas(&plan);
    lines.extend(ways.iter().flat_map(|way| lines::way(way, &plan)));
    Ok(MadePlan {
        asked: asked.clone(),
        base,
        plan,
        ways,
        no_way,
        pace,
        sun,
        no_sun,
        warnings,
        lines,
    })
}

/// The plan after a change by hand; a photo that is not there any more is left as it is.
fn edited(plan: &Plan, edit: &Edit, surface: &Surface, progress: &Progress) -> Result<Plan, Fault> {
    let place_of = |name: &str| plan.photos.iter().position(|photo| photo.name == name);
    match edit {
        Edit::Add(place) => plan.with_photo(*place, surface, progress),
        Edit::Move(name, to) => match place_of(name) {
            Some(photo) => plan.with_photo_at(photo, *to, surface, progress),
            None => Ok(plan.clone()),
        },
        Edit::Leave(name) => Ok(match place_of(name) {
            Some(photo) => plan.without_photo(photo),
            None => plan.clone(),
        }),
    }
}
