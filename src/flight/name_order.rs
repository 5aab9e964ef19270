//! The order in which people and file managers put the names of photos.

use std::cmp::Ordering;

/// Compares two names: letters in whatever case, numbers by their value, so IMG_9 is before IMG_10.
/// Allocates nothing: thousands of names are sorted within a frame.
pub fn compare_names(mut a: &str, mut b: &str) -> Ordering {
    let digits = |name: &str| name.bytes().take_while(u8::is_ascii_digit).count();
    loop {
        let order = match (digits(a), digits(b)) {
            (0, _) | (_, 0) => match (a.chars().next(), b.chars().next()) {
                (Some(x), Some(y)) => {
                    (a, b) = (&a[x.len_utf8()..], &b[y.len_utf8()..]);
                    x.to_lowercase().cmp(y.to_lowercase())
                }
                (x, y) => return x.is_some().cmp(&y.is_some()),
            },
            (in_a, in_b) => {
                let (x, y);
                ((x, a), (y, b)) = (a.split_at(in_a), b.split_at(in_b));
                let (x, y) = (x.trim_start_matches('0'), y.trim_start_matches('0'));
                x.len().cmp(&y.len()).then_with(|| x.cmp(y))
            }
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_count_by_their_value() {
        let mut names = ["b", "img_10.jpg", "IMG_9.jpg", "a", "IMG_009b.jpg", "IMG_"];
        names.sort_by(|a, b| compare_names(a, b));
        assert_eq!(
            names,
            ["a", "b", "IMG_", "IMG_9.jpg", "IMG_009b.jpg", "img_10.jpg"]
        );
        // More digits than any integer holds.
        let (long, longer) = ("9".repeat(40), "1".repeat(41));
        assert_eq!(compare_names(&long, &longer), Ordering::Less);
    }
}
