//! How the values that the surface is coloured by are spread.

use super::work::Task;
use crate::jobs::Progress;
use crate::state::State;

impl Task {
    /// Looking at the values that the surface is coloured by.
    pub const HISTOGRAM: Self = Self::new("Histogram").of_flight().to_the_end();
}

impl State {
    /// Has the values looked at that the surface is coloured by now, where they are not known yet.
    pub(crate) fn look_at_values(&mut self) {
        let by = self.preferences.layers.color_by;
        let open = self.open.as_mut();
        if let Some(values) = open.and_then(|open| open.values_to_look_at(by)) {
            let work = move |progress: &Progress| (values.of, values.look(progress));
            self.start(Task::HISTOGRAM, work, |state, (of, histogram)| {
                if let Some(open) = &mut state.open {
                    open.colors.take(of, histogram);
                }
            });
        }
    }
}
