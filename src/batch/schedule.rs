//! Which flight begins next: a pure function of what waits and what runs.

/// How many flights run at once, and in how much memory together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Limits {
    /// At least 1.
    pub(super) jobs: usize,
    /// Bytes.
    pub(super) memory: u64,
}

/// Whether the flight that waits longest begins now, given what it needs and what runs. Flights begin in their order:
/// one that needs much is not overtaken for ever by those that need little. One that needs more than there is begins
/// when nothing else runs.
pub(super) fn begins(limits: Limits, running: &[u64], need: u64) -> bool {
    if running.is_empty() {
        return true;
    }
    let taken = running
        .iter()
        .fold(need, |sum, need| sum.saturating_add(*need));
    running.len() < limits.jobs && taken <= limits.memory
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plays a season: flights end in an order that nobody can foresee, and at no moment is more taken than there is,
    /// unless one flight alone takes more.
    #[test]
    fn never_more_than_there_is() {
        let mut random: u64 = 7;
        let mut next = |below: u64| {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 33) % below
        };
        for _ in 0..300 {
            let limits = Limits {
                jobs: 1 + next(6) as usize,
                memory: 1 + next(100),
            };
            let needs: Vec<u64> = (0..next(40)).map(|_| next(130)).collect();
            let mut waiting = needs.iter().copied();
            let mut first = waiting.next();
            let mut running: Vec<u64> = Vec::new();
            let mut done = 0;
            while first.is_some() || !running.is_empty() {
                while let Some(need) = first
                    && begins(limits, &running, need)
                {
                    running.push(need);
                    first = waiting.next();
                    let sum: u64 = running.iter().sum();
                    assert!(running.len() <= limits.jobs);
                    assert!(sum <= limits.memory || running.len() == 1, "{running:?}");
                }
                assert!(!running.is_empty(), "nothing goes on");
                running.swap_remove(next(running.len() as u64) as usize);
                done += 1;
            }
            assert_eq!(done, needs.len());
        }
    }

    #[test]
    fn as_many_as_there_is_room_for() {
        let limits = Limits {
            jobs: 3,
            memory: 10,
        };
        assert!(begins(limits, &[4, 2], 4));
        assert!(!begins(limits, &[4, 2], 5));
        assert!(!begins(limits, &[1, 1, 1], 1), "no job is free");
        assert!(begins(limits, &[], 99), "alone");
        assert!(!begins(limits, &[u64::MAX], u64::MAX), "no overflow");
    }
}
