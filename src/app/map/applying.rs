//! Does what a command of the map says.

use super::{MapCommand, MapLooking};
use crate::state::State;
use crate::tasks::Task;

impl State {
    pub(crate) fn apply_to_map(&mut self, command: MapCommand) {
        match command {
            MapCommand::Make => self.make_map(),
            MapCommand::Draw(part) => self.draw_map(part),
            MapCommand::Ground(ground) => {
                if let Some(open) = &mut self.open {
                    open.map.ground = ground;
                    self.work.try_again(Task::MAP);
                }
            }
            MapCommand::Save { to, pixel } => self.save_map(to, pixel),
            MapCommand::Fit => self.look_at_map(|_, _| MapLooking::default()),
            MapCommand::Zoom {
                cursor,
                factor,
                size,
            } => self.look_at_map(|looking, plan| looking.zoomed(plan, cursor, factor, size)),
            MapCommand::Pan { by, size } => {
                self.look_at_map(|looking, plan| looking.panned(plan, by, size));
            }
        }
    }

    fn look_at_map(&mut self, look: impl FnOnce(MapLooking, &crate::exports::Plan) -> MapLooking) {
        if let Some(open) = &mut self.open
            && let Some(made) = &open.map.made
        {
            open.map.looking = look(open.map.looking, &made.plan);
        }
    }
}
