//! The plan of what is asked for, as a job.

use std::sync::Arc;

use super::made::MadePlan;
use super::no_system;
use crate::camera::Camera;
use crate::exports::{PlanReport, plan_warnings};
use crate::fault::Fault;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::plan::{self, AskedPlan, Edit, Pace, PhotoAt, Plan, Way};
use crate::render::{plan_areas, plan_way};
use crate::state::{Severity, State};
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
                Ok(made) => {
                    let before = planning.made.as_ref().map(|before| &before.not_taken[..]);
                    let is_new = before.unwrap_or_default() != made.not_taken;
                    let said = made.not_taken_in_words().filter(|_| is_new);
                    planning.take(made);
                    if let Some(said) = said {
                        state.say(Severity::Warning, &said);
                    }
                }
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
    // What was planned over another surface, or by another flight's camera, says nothing here.
    let known = before.filter(|before| Arc::ptr_eq(&before.surface, &over.surface));
    let before =
        known.filter(|before| before.asked.base() == asked.base() && before.camera == over.camera);
    let pile = match (&asked.area, known.and_then(|known| known.pile.as_ref())) {
        (Some(_), pile) => pile.cloned(),
        (None, Some(pile)) => Some(pile.clone()),
        (None, None) => {
            progress.stage("looking for the pile");
            Some(plan::pile(&over.surface, progress)?)
        }
    };
    let pile_heights = match (known.and_then(|known| known.pile_heights.clone()), &pile) {
        (None, Some(pile)) => plan::heights_in_and_about(&over.surface, pile)
            .map(|heights| plan::heights_in_words(heights, over.unit.symbol())),
        (known, _) => known,
    };
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
            let area = match (&asked.area, &pile) {
                (None, Some(pile)) => pile.clone(),
                (corners, _) => {
                    Polygon::new(corners.as_deref().unwrap_or_default()).map_err(no_area)?
                }
            };
            let wish = asked.wish(metres).map_err(no_area)?;
            let known = known.map(|known| &*known.base);
            let plan = Plan::after(known, (&*over.surface, &camera), area, wish, progress)?;
            Arc::new(match asked.fill_gaps {
                true => plan.with_gaps_filled(&over.surface, progress)?,
                false => plan,
            })
        }
    };
    // What was done by hand is not done again where it is more of the same.
    let done = before.filter(|before| {
        before.not_taken.is_empty() && asked.edits.starts_with(&before.asked.edits)
    });
    let (mut plan, edits) = match done {
        Some(done) => (done.plan.clone(), &asked.edits[done.asked.edits.len()..]),
        None => (base.clone(), &asked.edits[..]),
    };
    let mut not_taken: Vec<String> = Vec::new();
    for edit in edits {
        match edited(&plan, edit, &over.surface, progress) {
            Some(edited) => plan = Arc::new(edited?),
            None => not_taken.extend(name_of(edit).map(str::to_owned)),
        }
    }
    let pace = Pace::of(&asked.flying, metres);
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
    let mut warnings: Vec<String> = plan::lying(&over.surface).into_iter().collect();
    warnings.extend(plan_warnings(&PlanReport {
        flight: &over.name,
        world: over.unit,
        scales: over.unit,
        plan: &plan,
        ways: &ways,
        pace,
        is_nominal: asked.drone.is_some(),
        sun: None,
    }));
    let sun = asked.when.as_deref().map(|when| {
        progress.stage("where the sun stands");
        let crs = over.crs.as_deref().ok_or_else(no_system);
        plan.sun_at(when, &Crs::understand(crs?)?)
    });
    let (sun, no_sun) = match sun.transpose() {
        Ok(sun) => (sun, None),
        Err::<_, Fault>(fault) => (None, Some(fault.to_string())),
    };
    let mut lines = plan_areas(&plan);
    lines.extend(ways.iter().flat_map(|way| plan_way(way, &plan)));
    Ok(MadePlan {
        asked: asked.clone(),
        surface: over.surface.clone(),
        camera: over.camera.clone(),
        pile,
        pile_heights,
        base,
        plan,
        ways,
        no_way,
        pace,
        sun,
        no_sun,
        not_taken,
        warnings,
        lines,
    })
}

/// How far, in parts of a photo's footprint, a photo may show another place and be the same: plans are computed alike everywhere but for
/// rounding.
const SAME_PLACE: f64 = 1e-3;

/// The plan after a change by hand; `None` where it is of a photo that is not there any more.
fn edited(
    plan: &Plan,
    edit: &Edit,
    surface: &Surface,
    progress: &Progress,
) -> Option<Result<Plan, Fault>> {
    let place_of = |wanted: &PhotoAt| {
        let near = SAME_PLACE * plan.footprint.max_element();
        plan.photos.iter().position(|photo| {
            photo.name == wanted.name && photo.target.truncate().distance(wanted.at) <= near
        })
    };
    Some(match edit {
        Edit::Add(place) => plan.with_photo(*place, surface, progress),
        Edit::Move(photo, to) => plan.with_photo_at(place_of(photo)?, *to, surface, progress),
        Edit::Leave(photo) => Ok(plan.without_photo(place_of(photo)?)),
    })
}

/// Of the photo that is changed.
fn name_of(edit: &Edit) -> Option<&str> {
    match edit {
        Edit::Add(_) => None,
        Edit::Move(photo, _) | Edit::Leave(photo) => Some(&photo.name),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::plan::{Drone, Flying, Pattern, Size};
    use crate::surface::Cloud;

    fn over() -> Over {
        let points = (0..161 * 161).map(|i| {
            let place = DVec2::new(f64::from(i % 161), f64::from(i / 161)) - 80.0;
            let pile = (12.0 - 0.5 * place.length()).max(0.0);
            place.extend(pile + 0.3 * (place.x * 0.4).sin())
        });
        let cloud = Cloud {
            points: points.collect(),
            ..Cloud::default()
        };
        Over {
            name: "pile".to_owned(),
            surface: Arc::new(Surface::new(cloud).unwrap()),
            camera: None,
            unit: LengthUnit::Metre,
            crs: None,
        }
    }

    fn asked() -> AskedPlan {
        AskedPlan {
            take_off: Some(DVec2::new(-60.0, -60.0)),
            ..AskedPlan::usual(Size::scale(150.0), Some(Drone::ALL[0]), 1.0)
        }
    }

    fn make(asked: &AskedPlan, over: &Over, before: Option<&MadePlan>) -> MadePlan {
        made(asked, over, before, &Progress::default()).unwrap()
    }

    /// Whatever was planned before, the plan is that of the command: with another clearance, area, overlap, pattern or
    /// scale, and with the same again. What stays is kept, not made anew.
    #[test]
    fn a_plan_does_not_depend_on_the_one_before() {
        let over = over();
        let first = make(&asked(), &over, None);
        let smaller = first.plan.area.corners().iter();
        let smaller: Vec<DVec2> = smaller.map(|corner| *corner * 0.7).collect();
        let larger: Vec<DVec2> = smaller.iter().map(|corner| *corner * 1.6).collect();
        let changes: [&dyn Fn(&mut AskedPlan); 8] = [
            &|asked| asked.clearance = 7.0,
            &|asked| asked.area = Some(smaller.clone()),
            &|asked| asked.area = Some(larger.clone()),
            &|asked| asked.overlap = 0.2,
            &|asked| asked.pattern = Pattern::Both,
            &|asked| asked.size = Size::scale(140.0),
            &|asked| asked.take_off = Some(DVec2::new(70.0, 10.0)),
            &|asked| asked.positioning = crate::plan::Positioning::Rtk,
        ];
        let mut before = first;
        for (change, number) in changes.into_iter().zip(1..) {
            let mut asked = before.asked.clone();
            change(&mut asked);
            let behind = make(&asked, &over, Some(&before));
            let fresh = make(&asked, &over, None);
            assert_eq!(behind.plan.photos, fresh.plan.photos, "{number}");
            assert_eq!(behind.plan.cover, fresh.plan.cover, "{number}");
            assert_eq!(behind.ways, fresh.ways, "{number}");
            before = behind;
        }
        // Another surface is looked at for itself.
        let other = self::over();
        let there = make(&before.asked, &other, Some(&before));
        assert!(Arc::ptr_eq(&there.surface, &other.surface));
    }

    /// A photo's time and its share of the battery, by hand: legs at 4 m/s, upwards no faster than 5 and downwards than 3, and at
    /// each photo 2 s of wait, 2 for the shot, 2 for braking and starting.
    #[test]
    fn a_photo_has_its_share_of_the_battery() {
        let over = over();
        let mut asked = asked();
        asked.flying = Flying {
            battery: Some(12.0),
            ..asked.flying
        };
        let made = make(&asked, &over, None);
        assert_eq!(made.ways.len(), 1);
        let way = &made.ways[0];
        let mut last = way.take_off.truncate().extend(way.safe_height);
        let mut seconds = (last.z - way.take_off.z) / 4.0;
        let mut seen = 0;
        for point in &way.points {
            let rise = point.place.z - last.z;
            let upright = if rise > 0.0 { rise / 5.0 } else { -rise / 3.0 };
            seconds += upright.max(point.place.distance(last) / 4.0);
            last = point.place;
            if let Some(photo) = point.photo {
                seconds += 6.0;
                let (minutes, share) = made.flown_at(photo).unwrap();
                assert!((minutes - seconds / 60.0).abs() < 1e-9, "{minutes}");
                assert!((share.unwrap() - seconds / 720.0).abs() < 1e-9, "{share:?}");
                seen += 1;
            }
        }
        assert_eq!(seen, made.plan.photos.len());
        assert!(made.flown_at(seen).is_none());
    }
}
