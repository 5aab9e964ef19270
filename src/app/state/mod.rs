//! What the window shows: everything that panels read. Only `State::apply` and `State::poll` change
//! it.

pub mod bundled;
pub mod history;
pub mod layers;
pub mod leaving;
pub mod preferences;
mod view;

use std::path::PathBuf;

use crate::command::{Asking, Command, PictureRequest, Tab};
use crate::fault::one_line;
use crate::flight::FlightSettings;
use crate::formats::Candidate;
use crate::fragments::Network;
use crate::from_photos::FromPhotos;
use crate::kept_aside::KeptAside;
use crate::open_flight::OpenFlight;
use crate::opening::OpenOptions;
use crate::opening_preview::OpeningPreview;
use crate::photo_view::Middle;
use crate::render::Gpu;
use crate::season::SeasonList;
use crate::size_distributions::{Page, SizeDistributions};
use crate::tasks::work::{Task, Work};
use leaving::{Arrived, Leaving};
use preferences::{Preferences, Theme};

/// How many lines the log keeps.
const LOG_LINES: usize = 2000;

/// How grave a line of the log is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// Something was done.
    Note,
    /// Something to know before trusting a number.
    Warning,
    /// Something was not done.
    Error,
}

/// A line of the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogLine {
    /// How grave it is.
    pub severity: Severity,
    /// What happened.
    pub text: String,
}

/// What is held back until the engineer says that something may be lost.
#[derive(Debug)]
pub enum HeldBack {
    /// Leaving the flight on the screen.
    Leave(Leaving),
    /// Leaving the flight on the screen, and with it points that were picked.
    Points(Leaving),
    /// Leaving the program, and with it tables that were pasted.
    Tables,
    /// Writing where there is something already.
    Replace {
        /// What writes, and may replace.
        command: Box<Command>,
        /// What is there, in a sentence.
        there: String,
    },
}

/// The page, and the photo that is selected.
type Place = (Page, Option<usize>);

/// The whole state of the window.
pub struct State {
    /// For clipboard, theme and window; also what wakes the window up.
    pub context: egui::Context,
    /// The window's graphics device, where there is one: jobs upload what the viewport draws.
    pub gpu: Option<Gpu>,
    /// Remembered from day to day.
    pub preferences: Preferences,
    /// The flight on the screen; `None` on the start page.
    pub open: Option<Box<OpenFlight>>,
    /// Which page is shown.
    pub page: Page,
    /// What is in the middle of the page of the pile.
    pub middle: Middle,
    /// Changes that are not saved, where a crash leaves them.
    pub kept_aside: KeptAside,
    /// The size distributions, with or without a flight.
    pub distributions: SizeDistributions,
    /// The network of hers that can outline fragments.
    pub network: Network,
    /// Jobs under way.
    pub work: Work<State>,
    /// What was said, oldest first.
    pub log: Vec<LogLine>,
    /// How many of its lines are of what was on the screen before this flight.
    log_before: usize,
    /// What was said last of the photo on the screen, and where that was.
    said_there: Option<(String, Place)>,
    /// The import that was refused last, what was said of it, and where that was.
    may_be_mended: Option<(Task, String, Place)>,
    /// What was said of the last undo or redo, and how many steps had been made until then.
    undo_said: Option<(String, u64)>,
    /// The last error, shown over the viewport until it is put away.
    pub notice: Option<LogLine>,
    /// The tab of the right panel.
    pub tab: Tab,
    /// Which small window is open.
    pub asking: Option<Asking>,
    /// What the desktop's dialog answered, for the small window to take over.
    pub answered: Option<PathBuf>,
    /// What waits for "discard".
    pub held_back: Option<HeldBack>,
    /// What goes on once the changes are saved.
    pub after_saving: Option<HeldBack>,
    /// Whether the window may close.
    pub may_quit: bool,
    /// The flight that could not be opened last, with what was named beside it.
    pub tried: Option<(PathBuf, OpenOptions)>,
    /// What the small window for a new flight from photos holds.
    pub from_photos: FromPhotos,
    /// What the small window of a season holds.
    pub season: SeasonList,
    /// The flights of the folder that was named last, to choose from.
    pub choices: Vec<Candidate>,
    /// The cloud that was dropped or opened beside the flight on the screen: it is asked what it is to be.
    pub cloud: Option<PathBuf>,
    /// Whether the flight that is being read is another one than that on the screen.
    pub reads_other: bool,
    /// A flight that was read, until no other question waits.
    pub arrived: Option<Box<Arrived>>,
    /// The settings that the panels of this frame were drawn with, while their commands are applied.
    pub(crate) settings_of_frame: Option<FlightSettings>,
    /// A first look at the surface that is being read.
    pub preview: Option<OpeningPreview>,
    /// How many flights were opened.
    pub opened: u64,
    /// A picture of the viewport that was asked for; the viewport draws it.
    pub picture: Option<PictureRequest>,
}

impl State {
    /// The start page.
    pub fn new(context: egui::Context, preferences: Preferences) -> Self {
        let state = Self {
            work: Work::new(context.clone()),
            context,
            gpu: None,
            preferences,
            open: None,
            page: Page::default(),
            middle: Middle::default(),
            kept_aside: KeptAside::default(),
            distributions: SizeDistributions::default(),
            network: Network::default(),
            log: Vec::new(),
            log_before: 0,
            said_there: None,
            may_be_mended: None,
            undo_said: None,
            notice: None,
            tab: Tab::default(),
            asking: None,
            answered: None,
            held_back: None,
            after_saving: None,
            may_quit: false,
            tried: None,
            from_photos: FromPhotos::default(),
            season: SeasonList::default(),
            choices: Vec::new(),
            cloud: None,
            reads_other: false,
            arrived: None,
            settings_of_frame: None,
            preview: None,
            opened: 0,
            picture: None,
        };
        state.apply_theme();
        state
    }

    /// Writes a line into the log; an error is shown over the viewport as well.
    pub fn say(&mut self, severity: Severity, text: &str) {
        let line = LogLine {
            severity,
            text: one_line(text),
        };
        if severity == Severity::Error {
            self.notice = Some(line.clone());
            // Offered beside another error.
            self.from_photos.offered = None;
        }
        if self.log.len() == LOG_LINES {
            self.log.remove(0);
            self.log_before = self.log_before.saturating_sub(1);
        }
        self.log.push(line);
    }

    /// The same of something that matters for this photo alone, on this page.
    pub(crate) fn say_of_photo(&mut self, severity: Severity, text: &str, photo: Option<usize>) {
        self.say(severity, text);
        let said = self.log.last().map(|line| line.text.clone());
        self.said_there = said.map(|text| (text, (self.page, photo)));
    }

    /// Says that a file was not taken, or nothing written, until the next of its kind is, or another photo or page is looked at.
    pub(crate) fn say_until_mended(&mut self, task: Task, text: &str) {
        let (_, photo) = self.place();
        self.say_of_photo(Severity::Error, text, photo);
        let said = self.said_there.clone();
        self.may_be_mended = said.map(|(text, place)| (task, text, place));
    }

    /// A file of that kind was taken, or written: what was wrong with the one before is mended. The log keeps it.
    pub(crate) fn mended(&mut self, task: Task) {
        self.put_away_mended(|(of, ..)| *of == task);
    }

    /// Another photo or page is looked at, perhaps: what was wrong with a file there is no matter here.
    pub(crate) fn look_at_notice(&mut self) {
        let now = self.place();
        self.put_away_mended(|(.., place)| *place != now);
    }

    fn put_away_mended(&mut self, is_old: impl FnOnce(&(Task, String, Place)) -> bool) {
        if let Some((_, text, _)) = self.may_be_mended.take_if(|refused| is_old(refused)) {
            self.notice.take_if(|notice| notice.text == text);
        }
    }

    /// What is looked at.
    fn place(&self) -> Place {
        let selected = self.open.as_ref().and_then(|open| open.selected);
        (self.page, selected)
    }

    /// Says what was undone or done again.
    pub(crate) fn say_undone(&mut self, text: &str) {
        self.say(Severity::Note, text);
        let said = self.log.last().map(|line| line.text.clone());
        self.undo_said = said.map(|text| (text, self.steps_made()));
    }

    /// The line at the foot of the window: the last one of the log. What was undone is old once a new step is made, and what was said of
    /// a photo once another one is selected.
    pub fn last_said(&self) -> Option<&LogLine> {
        let last = self.log.last()?;
        let undone = self.undo_said.as_ref();
        let is_old =
            undone.is_some_and(|(text, steps)| *text == last.text && *steps != self.steps_made());
        let there = self.said_there.as_ref();
        let (_, photo) = self.place();
        let is_elsewhere = there.is_some_and(|(text, (_, of))| *text == last.text && *of != photo);
        (!is_old && !is_elsewhere).then_some(last)
    }

    /// How many steps were made that undo goes back over.
    fn steps_made(&self) -> u64 {
        self.open.as_deref().map_or(0, |open| {
            let picked = &open.pointer.picked.history;
            open.history.steps_made() + open.clip_history.steps_made() + picked.steps_made()
        })
    }

    /// Another flight comes onto the screen: what was said until now is not of it.
    pub(crate) fn begin_log_of_flight(&mut self) {
        self.log_before = self.log.len();
    }

    /// The warnings and errors of the flight on the screen.
    pub fn warnings(&self) -> impl Iterator<Item = &LogLine> {
        let of_flight = self.log.iter().skip(self.log_before);
        of_flight.filter(|line| line.severity != Severity::Note)
    }

    /// Whether the flight's settings are not saved.
    pub fn is_changed(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.is_changed())
    }

    /// The window's title.
    pub fn title(&self) -> String {
        match &self.open {
            None => "fragscale".to_owned(),
            Some(open) => {
                let mark = if open.is_changed() { "*" } else { "" };
                format!("{}{mark} – fragscale", open.flight().parts().name)
            }
        }
    }

    /// Tells egui which theme is wanted.
    pub fn apply_theme(&self) {
        self.context.set_theme(match self.preferences.theme {
            Theme::System => egui::ThemePreference::System,
            Theme::Light => egui::ThemePreference::Light,
            Theme::Dark => egui::ThemePreference::Dark,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Until the next one of its kind is taken, or another page is looked at; another error stays.
    #[test]
    fn a_refused_file_is_no_matter_elsewhere() {
        let mut state = State::new(egui::Context::default(), Preferences::default());
        let [tables, clouds] = ["Reading", "Cloud"].map(Task::new);
        state.say_until_mended(tables, "a.csv: it is empty");
        state.mended(clouds);
        state.look_at_notice();
        assert!(state.notice.is_some());
        state.mended(tables);
        assert_eq!(state.notice, None);
        state.say_until_mended(tables, "b.csv: it is empty");
        state.page = Page::Map;
        state.look_at_notice();
        assert_eq!(state.notice, None);
        state.say_until_mended(tables, "c.csv: it is empty");
        state.say(Severity::Error, "not written");
        state.mended(tables);
        assert!(state.notice.is_some());
    }

    #[test]
    fn warnings_are_of_the_flight_on_the_screen() {
        let mut state = State::new(egui::Context::default(), Preferences::default());
        state.say(Severity::Warning, "of the flight before");
        state.begin_log_of_flight();
        assert_eq!(state.warnings().count(), 0);
        state.say(Severity::Warning, "its poses are turned");
        state.say(Severity::Note, "read");
        state.say(Severity::Error, "not written");
        assert_eq!(state.warnings().count(), 2);
        // The oldest lines go, first those of the flight before.
        for _ in 0..LOG_LINES - 2 {
            state.say(Severity::Note, "read again");
        }
        assert_eq!(state.log.len(), LOG_LINES);
        let said: Vec<&str> = state.warnings().map(|line| line.text.as_str()).collect();
        assert_eq!(said, ["not written"]);
    }
}
