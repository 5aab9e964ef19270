//! What of a flight's settings is another than it was, in words; and settings that two parts of the window changed at once.

use super::{FlightSettings, ScaleObject};
use crate::scale::{PoseErrors, StatedErrors};

impl FlightSettings {
    /// The flight plan, as [`Self::changed_since`] calls it.
    pub const PLAN: &'static str = "the flight plan";

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
            (*plan != before.plan, Self::PLAN),
            (*control != before.control, "control points"),
        ];
        let changed = all.into_iter().filter(|(is_changed, _)| *is_changed);
        changed.map(|(_, what)| what).collect()
    }

    /// These, with what `after` has otherwise than `before`: what two parts of the window made of the same settings is
    /// taken from both. Scale objects and stated errors are taken one by one.
    #[must_use]
    pub fn with_changes(self, before: &Self, after: Self) -> Self {
        fn newer<T: PartialEq>(now: T, before: &T, after: T) -> T {
            if after == *before { now } else { after }
        }
        Self {
            unit: newer(self.unit, &before.unit, after.unit),
            unit_known: newer(self.unit_known, &before.unit_known, after.unit_known),
            ground: newer(self.ground, &before.ground, after.ground),
            image: newer(self.image, &before.image, after.image),
            pair: newer(self.pair, &before.pair, after.pair),
            errors: StatedErrors {
                pose: PoseErrors {
                    position: newer(
                        self.errors.pose.position,
                        &before.errors.pose.position,
                        after.errors.pose.position,
                    ),
                    angle: newer(
                        self.errors.pose.angle,
                        &before.errors.pose.angle,
                        after.errors.pose.angle,
                    ),
                },
                focal: newer(self.errors.focal, &before.errors.focal, after.errors.focal),
                surface: newer(
                    self.errors.surface,
                    &before.errors.surface,
                    after.errors.surface,
                ),
                world_scale: newer(
                    self.errors.world_scale,
                    &before.errors.world_scale,
                    after.errors.world_scale,
                ),
            },
            surface: newer(self.surface, &before.surface, after.surface),
            surface_up: newer(self.surface_up, &before.surface_up, after.surface_up),
            scale_objects: with_objects(
                self.scale_objects,
                &before.scale_objects,
                after.scale_objects,
            ),
            decisions: newer(self.decisions, &before.decisions, after.decisions),
            placed: newer(self.placed, &before.placed, after.placed),
            plan: newer(self.plan, &before.plan, after.plan),
            control: newer(self.control, &before.control, after.control),
        }
    }
}

/// Scale objects with those changed that were, and without those that were taken away.
fn with_objects(
    mut now: Vec<ScaleObject>,
    before: &[ScaleObject],
    after: Vec<ScaleObject>,
) -> Vec<ScaleObject> {
    // One command a frame is exact, also of objects that are alike.
    if now == before {
        return after;
    }
    if after.len() == before.len() {
        for (before, after) in before.iter().zip(after) {
            if *before != after
                && let Some(place) = now.iter().position(|object| object == before)
            {
                now[place] = after;
            }
        }
        return now;
    }
    now.retain(|object| !before.contains(object) || after.contains(object));
    for object in after {
        if !before.contains(&object) && !now.contains(&object) {
            now.push(object);
        }
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::{Ground, ScaleObjectKind, ScalePair};
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

    /// A typed elevation and a decision, a typed size and a card that goes, both begun from the same settings.
    #[test]
    fn what_two_changed_is_taken_from_both() {
        let object = |size: f64| ScaleObject {
            photo: "a.jpg".to_owned(),
            kind: ScaleObjectKind::Bar,
            size,
            outline: Vec::new(),
            mask: false,
        };
        let before = FlightSettings {
            scale_objects: vec![object(1.0), object(2.0), object(3.0)],
            ..FlightSettings::default()
        };
        let typed = FlightSettings {
            ground: Ground::At(0.2),
            scale_objects: vec![object(1.0), object(2.0), object(3.5)],
            ..before.clone()
        };
        let clicked = FlightSettings {
            pair: ScalePair::Corners,
            scale_objects: vec![object(2.0), object(3.0)],
            ..before.clone()
        };
        let both = FlightSettings {
            ground: Ground::At(0.2),
            pair: ScalePair::Corners,
            scale_objects: vec![object(2.0), object(3.5)],
            ..before.clone()
        };
        let one = before.clone().with_changes(&before, typed.clone());
        assert_eq!(one, typed);
        assert_eq!(one.with_changes(&before, clicked.clone()), both);
        let other = before.clone().with_changes(&before, clicked.clone());
        assert_eq!(other, clicked);
        assert_eq!(other.with_changes(&before, typed), both);
    }
}
