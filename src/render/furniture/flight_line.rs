//! In which order the flight line goes through the photos.

use crate::flight::compare_names;

/// What says when a photo was taken.
#[derive(Debug, Clone, Copy)]
pub struct Taken<'a> {
    /// The photo's name.
    pub name: &'a str,
    /// EXIF's "YYYY:MM:DD HH:MM:SS", where it is known.
    pub time: Option<&'a str>,
}

/// The photos in the order in which they were taken: by their times where every photo has one, within a
/// second and otherwise by their names, as drones count them.
pub fn flight_line(photos: &[Taken<'_>]) -> Vec<usize> {
    let timed = photos.iter().all(|photo| time(photo).is_some());
    let mut order: Vec<usize> = (0..photos.len()).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (photos[a], photos[b]);
        let by_time = match timed {
            true => time(&a).cmp(&time(&b)),
            false => std::cmp::Ordering::Equal,
        };
        by_time.then_with(|| compare_names(a.name, b.name))
    });
    order
}

/// A time that a clock has: text of this kind sorts as time does. A camera whose clock was never set writes
/// zeros or blanks.
fn time<'a>(photo: &Taken<'a>) -> Option<&'a str> {
    let time = photo.time?.trim();
    let (is_long, is_set) = (time.len() >= 19, !time.starts_with("0000"));
    let starts_with_year = time.bytes().take(4).all(|byte| byte.is_ascii_digit());
    (is_long && is_set && starts_with_year).then_some(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(photos: &[(&str, Option<&str>)]) -> Vec<usize> {
        let mut taken = Vec::new();
        for &(name, time) in photos {
            taken.push(Taken { name, time });
        }
        flight_line(&taken)
    }

    #[test]
    fn by_time_within_a_second_by_name() {
        // The counter began anew at 9999.
        let found = order(&[
            ("DJI_0001.JPG", Some("2024:05:06 07:10:02")),
            ("DJI_9999.JPG", Some("2024:05:06 07:10:00")),
            ("DJI_0010.JPG", Some("2024:05:06 07:10:09")),
            ("DJI_0009.JPG", Some("2024:05:06 07:10:09")),
        ]);
        assert_eq!(found, [1, 0, 3, 2]);
    }

    #[test]
    fn by_name_where_a_time_is_missing() {
        let names = [
            ("b10", "2024:05:06 07:10:02"),
            ("b9", "2024:05:06 07:10:03"),
        ];
        let timed = names.map(|(name, time)| (name, Some(time)));
        assert_eq!(order(&timed), [0, 1]);
        for missing in [
            None,
            Some("0000:00:00 00:00:00"),
            Some("                   "),
        ] {
            assert_eq!(order(&[timed[0], ("b9", missing)]), [1, 0]);
        }
        assert!(order(&[]).is_empty());
    }
}
