//! The order in which people and file managers put the names of photos.

use std::cmp::Ordering;

/// Compares two names: letters in whatever case, numbers by their value, so IMG_9 is before IMG_10.
pub fn compare_names(a: &str, b: &str) -> Ordering {
    let (mut a, mut b) = (a.chars().peekable(), b.chars().peekable());
    loop {
        match (a.peek().copied(), b.peek().copied()) {
            (None, None) => return Ordering::Equal,
            (None, Some(_)) => return Ordering::Less,
            (Some(_), None) => return Ordering::Greater,
            (Some(x), Some(y)) if x.is_ascii_digit() && y.is_ascii_digit() => {
                let digits = |chars: &mut std::iter::Peekable<std::str::Chars<'_>>| {
                    let mut digits = String::new();
                    while let Some(digit) = chars.next_if(char::is_ascii_digit) {
                        digits.push(digit);
                    }
                    digits
                };
                let (x, y) = (digits(&mut a), digits(&mut b));
                let (x, y) = (x.trim_start_matches('0'), y.trim_start_matches('0'));
                let order = x.len().cmp(&y.len()).then_with(|| x.cmp(y));
                if order != Ordering::Equal {
                    return order;
                }
            }
            (Some(x), Some(y)) => {
                let order = x.to_lowercase().cmp(y.to_lowercase());
                if order != Ordering::Equal {
                    return order;
                }
                a.next();
                b.next();
            }
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
