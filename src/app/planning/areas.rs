//! Areas of the plan that are typed or in a file: what the command's `--area` and `--keep-out` take.

use super::{PlanTool, no_system};
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::opening::Areas;
use crate::plan::AskedPlan;
use crate::state::{Severity, State};
use crate::survey::Polygon;
use crate::tasks::Task;

impl Task {
    /// Reading areas of the plan.
    pub const READ_AREAS: Self = Self::new("Reading areas").of_flight();
}

impl State {
    /// Takes outlines as the area, or as more ground to keep out of: `x,y;x,y;…`, or a file.
    pub(super) fn read_areas(&mut self, tool: PlanTool, text: String) {
        let Some(open) = &mut self.open else {
            return;
        };
        open.begin_planning();
        let crs = open.files.crs.clone();
        // What is typed counts at once, so that saving behind it has it; a file may lie on a drive that sleeps.
        if text.contains(';') && !text.contains(['/', '\\']) {
            let read = read(tool, &text, crs.as_deref());
            return self.take_areas(tool, read);
        }
        let work = move |_: &Progress| read(tool, &text, crs.as_deref());
        self.start(Task::READ_AREAS, work, move |state, read| {
            state.take_areas(tool, read);
        });
    }

    fn take_areas(&mut self, tool: PlanTool, read: Result<(Vec<Polygon>, Vec<String>), String>) {
        match read {
            Ok((areas, said)) => {
                self.mended(Task::READ_AREAS);
                for sentence in said {
                    self.say(Severity::Warning, &sentence);
                }
                if let Some(open) = &mut self.open
                    && let Some(now) = open.planning.now().cloned()
                {
                    let asked = with(now, tool, areas);
                    self.plan_step(super::PlanStep::Ask(Box::new(asked)));
                }
            }
            Err(why) => self.say_until_mended(Task::READ_AREAS, &why),
        }
    }
}

/// What is asked with other areas.
fn with(mut asked: AskedPlan, tool: PlanTool, areas: Vec<Polygon>) -> AskedPlan {
    let mut corners = areas.iter().map(|area| area.corners().to_vec());
    match tool {
        PlanTool::KeepOut => asked.keep_out.extend(corners),
        _ => asked.area = corners.next().or(asked.area),
    }
    asked
}

fn read(
    tool: PlanTool,
    text: &str,
    crs: Option<&str>,
) -> Result<(Vec<Polygon>, Vec<String>), String> {
    let crs = || {
        let stated = crs.ok_or_else(no_system);
        stated
            .and_then(Crs::understand)
            .map_err(|fault| fault.to_string())
    };
    let areas = Areas::read(text)?;
    match tool {
        PlanTool::KeepOut => areas.to_keep_out_of(crs),
        _ => {
            let (area, said) = areas.one_in_world("area", crs)?;
            Ok((vec![area], said))
        }
    }
}
