//! Undo and redo as a list of states.

/// How many steps back are kept.
const STEPS: usize = 200;

/// A state with those before it and those that were undone.
#[derive(Debug, Clone)]
pub struct History<T> {
    undone_to: Vec<T>,
    now: T,
    redo: Vec<T>,
    /// How many new steps were made.
    steps: u64,
}

impl<T: PartialEq> History<T> {
    /// Begins with this state.
    pub fn new(now: T) -> Self {
        Self {
            undone_to: Vec::new(),
            now,
            redo: Vec::new(),
            steps: 0,
        }
    }

    /// The state of now.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// Goes on to another state; what was undone is forgotten. The same state again is no step.
    pub fn set(&mut self, next: T) {
        if next == self.now {
            return;
        }
        if self.undone_to.len() == STEPS {
            self.undone_to.remove(0);
        }
        self.undone_to.push(std::mem::replace(&mut self.now, next));
        self.redo.clear();
        self.steps += 1;
    }

    /// How many new steps were made: undo and redo make none.
    pub fn steps_made(&self) -> u64 {
        self.steps
    }

    /// Changes the state of now without a step: for what no person did. Where it becomes the state
    /// before it or after it, there is no step between the two any more.
    pub fn replace(&mut self, now: T) {
        self.now = now;
        self.undone_to.pop_if(|before| *before == self.now);
        self.redo.pop_if(|after| *after == self.now);
    }

    /// Changes every state, done and undone, without a step: for what no person did. Where two
    /// neighbours become the same, there is no step between them any more.
    pub fn each(&mut self, change: impl FnMut(&mut T)) {
        let states = self.undone_to.iter_mut().chain([&mut self.now]);
        states.chain(&mut self.redo).for_each(change);
        self.undone_to.dedup();
        self.redo.dedup();
        self.undone_to.pop_if(|before| *before == self.now);
        self.redo.pop_if(|after| *after == self.now);
    }

    /// Whether there is a state before this one.
    pub fn can_undo(&self) -> bool {
        !self.undone_to.is_empty()
    }

    /// Whether something was undone.
    pub fn can_redo(&self) -> bool {
        !self.redo.is_empty()
    }

    /// Goes one state back; false at the first.
    pub fn undo(&mut self) -> bool {
        let Some(before) = self.undone_to.pop() else {
            return false;
        };
        self.redo.push(std::mem::replace(&mut self.now, before));
        true
    }

    /// Takes the last undo back; false where there is none.
    pub fn redo(&mut self) -> bool {
        let Some(after) = self.redo.pop() else {
            return false;
        };
        self.undone_to.push(std::mem::replace(&mut self.now, after));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_go_back_and_forth() {
        let mut history = History::new(1);
        history.set(2);
        history.set(2);
        history.set(3);
        assert!(history.undo());
        assert_eq!(*history.now(), 2);
        assert!(history.undo());
        assert!(!history.undo(), "the same state again was no step");
        assert_eq!(*history.now(), 1);
        assert!(history.redo() && history.redo() && !history.redo());
        assert_eq!(*history.now(), 3);
        assert_eq!(history.steps_made(), 2);
    }

    #[test]
    fn a_new_step_forgets_what_was_undone() {
        let mut history = History::new('a');
        history.set('b');
        assert!(history.undo());
        history.set('c');
        assert!(!history.can_redo());
        assert!(history.undo());
        assert_eq!(*history.now(), 'a');
    }

    #[test]
    fn a_state_that_is_taken_back_is_no_step() {
        let mut history = History::new('a');
        history.set('b');
        history.set('c');
        history.replace('b');
        assert!(history.undo());
        assert_eq!(*history.now(), 'a');
        history.replace('b');
        assert!(!history.can_redo() && !history.can_undo());
    }

    #[test]
    fn what_no_person_did_is_in_every_state() {
        let mut history = History::new((1, false));
        history.set((2, false));
        history.set((3, false));
        history.undo();
        history.each(|state| state.1 = true);
        for expected in [(2, true), (1, true)] {
            assert_eq!(*history.now(), expected);
            history.undo();
        }
        assert!(history.redo() && history.redo());
        assert_eq!(*history.now(), (3, true));
    }

    #[test]
    fn the_list_is_bounded() {
        let mut history = History::new(0);
        for step in 1..=1000 {
            history.set(step);
        }
        let mut back = 0;
        while history.undo() {
            back += 1;
        }
        assert_eq!(back, STEPS);
        assert_eq!(*history.now(), 800);
    }
}
