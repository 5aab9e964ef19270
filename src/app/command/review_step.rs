//! Steps of a review: through the doubtful photos, one after the other.

/// A step of a review.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReviewStep {
    /// The next doubtful photo that nobody has decided about; begins the review.
    Next,
    /// The doubtful photo before.
    Back,
    /// Shows this one of the photo's reasons for doubt.
    Reason(usize),
    /// What is typed as the note of this photo.
    Note(usize, String),
    /// The field of this photo's note is left: a decision that holds has the note from now on.
    TakeNote(usize),
    /// The keys go into the note.
    WriteNote,
    /// Takes the photo along, with the note; from a doubtful one in a review it goes on.
    Accept,
    /// Leaves the photo out, with the note; from a doubtful one in a review it goes on.
    LeaveOut,
    /// Ends the review.
    Leave,
}
