//! What of a flight's settings is another than it was, in words.

use super::FlightSettings;

impl FlightSettings {
    /// What differs from `before`, in the words that panels have for it; nothing where they are the same.
    pub fn changed_since(&self, before: &Self) -> Vec<&'static str> {
        let Self {
            unit,
            unit_known,
            ground,
            image,
            pair,
            errors,
            surface,
            surface_up,
            scale_objects,
            decisions,
            placed,
            plan,
            control,
        } = self;
        let all = [
            (
                (*unit, *unit_known) != (before.unit, before.unit_known),
                "the unit",
            ),
            (*ground != before.ground, "the ground"),
            (*image != before.image, "the image of the scales"),
            (*pair != before.pair, "the scale for Split-Desktop"),
            (*errors != before.errors, "what is stated of errors"),
            (
                (surface, *surface_up) != (&before.surface, before.surface_up),
                "the surface",
            ),
            (*scale_objects != before.scale_objects, "scale objects"),
            (*decisions != before.decisions, "what was decided of photos"),
            (*placed != before.placed, "where the flight is placed"),
            (*plan != before.plan, "the flight plan"),
            (*control != before.control, "control points"),
        ];
        let changed = all.into_iter().filter(|(is_changed, _)| *is_changed);
        changed.map(|(_, what)| what).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::ScalePair;
    use crate::units::LengthUnit;

    #[test]
    fn what_differs_is_named() {
        let before = FlightSettings::default();
        assert!(before.changed_since(&before).is_empty());
        let after = FlightSettings {
            unit: LengthUnit::Foot,
            pair: ScalePair::Corners,
            ..before.clone()
        };
        let changed = after.changed_since(&before);
        assert_eq!(changed, ["the unit", "the scale for Split-Desktop"]);
        assert_eq!(before.changed_since(&after), changed);
    }
}
