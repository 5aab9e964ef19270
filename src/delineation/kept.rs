//! What was measured of a photo as JSON, to the bit: kept while a command is under way, so that one that was stopped goes on
//! with the same numbers.
//!
//! Numbers are the bits of their IEEE 754 doubles, as whole numbers.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use crate::mass::PhotoFragments;
use crate::measures::{Fragment, Measures};

/// Numbers of a fragment: number, pixels, whether it is cut, middle, extent, and what is measured in the world.
const OWN: usize = 7;
const IN_WORLD: usize = 15;

impl PhotoFragments {
    /// As JSON.
    pub fn to_json(&self) -> Value {
        let fragments = self.fragments.iter().map(|of| {
            let own = [
                f64::from(of.number),
                of.pixels as f64,
                // 1 by the photo's edge, 2 by what is no rock alone.
                match (of.is_cut, of.is_at_edge) {
                    (false, _) => 0.0,
                    (true, true) => 1.0,
                    (true, false) => 2.0,
                },
                of.middle.x,
                of.middle.y,
                of.extent.x,
                of.extent.y,
            ];
            let world = of.world.map_or_else(Vec::new, |of| numbers(&of).to_vec());
            bits(own.into_iter().chain(world))
        });
        let rest = [self.frame.x, self.frame.y, self.fines, self.limit, self.mm];
        json!({"of_photo": bits(rest), "fragments": fragments.collect::<Vec<Value>>()})
    }

    /// From JSON; `None` where it is none of these.
    pub fn from_json(value: &Value) -> Option<Self> {
        let [width, height, fines, limit, mm] = of_bits(value.get("of_photo")?)?.try_into().ok()?;
        let fragments = value.get("fragments")?.as_array()?.iter().map(fragment);
        Some(Self {
            fragments: fragments.collect::<Option<_>>()?,
            frame: DVec2::new(width, height),
            fines,
            limit,
            mm,
        })
    }
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> Value {
    let bits = numbers
        .into_iter()
        .map(|number| Value::from(number.to_bits()));
    Value::Array(bits.collect())
}

fn of_bits(value: &Value) -> Option<Vec<f64>> {
    let bits = value.as_array()?.iter();
    bits.map(|bits| bits.as_u64().map(f64::from_bits)).collect()
}

fn numbers(of: &Measures) -> [f64; IN_WORLD] {
    [
        of.place.x,
        of.place.y,
        of.place.z,
        of.scale,
        of.area,
        of.surface_area,
        of.diameter,
        of.rectangle[0],
        of.rectangle[1],
        of.widths[0],
        of.widths[1],
        of.inscribed,
        of.roundness,
        of.height.unwrap_or(f64::NAN),
        of.sieve_size,
    ]
}

fn fragment(value: &Value) -> Option<Fragment> {
    let all = of_bits(value)?;
    let (own, world) = all.split_at_checked(OWN)?;
    let &[number, pixels, is_cut, x, y, across, down] = own else {
        return None;
    };
    let world = match *world {
        [] => None,
        [
            px,
            py,
            pz,
            scale,
            area,
            surface_area,
            diameter,
            r0,
            r1,
            w0,
            w1,
            inscribed,
            roundness,
            height,
            sieve_size,
        ] => Some(Measures {
            place: DVec3::new(px, py, pz),
            scale,
            area,
            surface_area,
            diameter,
            rectangle: [r0, r1],
            widths: [w0, w1],
            inscribed,
            roundness,
            height: (!height.is_nan()).then_some(height),
            sieve_size,
        }),
        _ => return None,
    };
    Some(Fragment {
        // Casts of floats end at the limits of their type.
        number: number as u32,
        pixels: pixels as usize,
        middle: DVec2::new(x, y),
        is_cut: is_cut != 0.0,
        is_at_edge: is_cut == 1.0,
        extent: DVec2::new(across, down),
        world,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass::tests::fragment as ball;

    #[test]
    fn reads_back_to_the_bit() {
        let mut odd = ball(0.1 + 0.2, 3.7, true);
        odd.number = 70_000;
        if let Some(world) = &mut odd.world {
            world.height = None;
            world.place = DVec3::new(452_310.123_456_789, -1e-300, 0.0);
        }
        let mut nowhere = ball(2.0, 1.0, false);
        nowhere.world = None;
        let mut beside_no_rock = ball(1.5, 0.4, true);
        beside_no_rock.is_at_edge = false;
        let photo = PhotoFragments {
            fragments: vec![ball(1.0, 0.3, false), odd, nowhere, beside_no_rock],
            frame: DVec2::new(4000.0, 3000.0),
            fines: 1.0 / 3.0,
            limit: 0.011,
            mm: 304.8,
        };
        let text = photo.to_json().to_string();
        let read: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(PhotoFragments::from_json(&read), Some(photo));
        for broken in [
            "{}",
            "{\"of_photo\":[1,2,3],\"fragments\":[]}",
            "{\"of_photo\":[1,2,3,4],\"fragments\":[[1]]}",
        ] {
            assert_eq!(
                PhotoFragments::from_json(&serde_json::from_str(broken).unwrap()),
                None
            );
        }
    }
}
