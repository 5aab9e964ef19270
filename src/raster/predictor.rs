//! Rows that hold differences, back to numbers (TIFF 6.0, section 14; Technical Note 3).

/// Turns the bytes of each number around.
pub(super) fn reverse_numbers(bytes: &mut [u8], number_bytes: usize) {
    if number_bytes > 1 {
        for number in bytes.chunks_exact_mut(number_bytes) {
            number.reverse();
        }
    }
}

/// Each number is stored as its difference to the one of the cell before, and wraps. Little-endian.
pub(super) fn undo_horizontal(row: &mut [u8], samples: usize, number_bytes: usize) {
    match number_bytes {
        1 => add::<1>(row, samples),
        2 => add::<2>(row, samples),
        4 => add::<4>(row, samples),
        _ => add::<8>(row, samples),
    }
}

fn add<const BYTES: usize>(row: &mut [u8], samples: usize) {
    let numbers = row.as_chunks_mut::<BYTES>().0;
    for at in samples..numbers.len() {
        let (before, rest) = numbers.split_at_mut(at);
        if let (Some(before), Some(number)) = (before.get(at - samples), rest.first_mut()) {
            let mut carry = 0;
            for (byte, before) in number.iter_mut().zip(before) {
                let sum = u16::from(*byte) + u16::from(*before) + carry;
                // The low eight bits stay.
                *byte = (sum & 0xff) as u8;
                carry = sum >> 8;
            }
        }
    }
}

/// The row's bytes were sorted by their weight, the heaviest of all numbers first, and then stored as
/// differences. This order is the same in files of both byte orders; the numbers come out
/// little-endian.
pub(super) fn undo_floating_point(row: &mut [u8], samples: usize, number_bytes: usize) {
    for at in samples..row.len() {
        row[at] = row[at].wrapping_add(row[at - samples]);
    }
    let sorted = row.to_vec();
    let count = row.len() / number_bytes;
    for (place, number) in row.chunks_exact_mut(number_bytes).enumerate() {
        for (byte, weight) in number.iter_mut().zip((0..number_bytes).rev()) {
            *byte = sorted[weight * count + place];
        }
    }
}
