//! Many flights, one after the other or several at once.
//!
//! ```text
//! season      which flights, which steps: SEASON.toml, folders
//! asked       the steps with their options, the same words as on the command line
//! told        what the process of one flight is told, and what it says
//! record      what was read and written of a flight: whether it has to be done again
//! memory      how much memory a flight takes, and how much there is
//! schedule    which flight begins next
//! running     the processes; what comes of each
//! results     the tables of a season, written
//! taken_away  what of earlier runs is gone, in words
//! watch       flights that arrive while one looks on
//! ```
//!
//! Each flight is done by a process of its own, `fragscale` with a hidden command: what breaks one flight (no memory
//! left, a defect) breaks no other, and what is taken is given back. A process ends when its standard input does, so
//! that none is left when this one is killed. The steps themselves are those of the single commands
//! (`src/cli/batch`), so that the files are, too.
//!
//! Nothing that is written holds a time, or anything else that differs from run to run: a season that was killed and
//! started again ends with the bytes of one that was not.

mod asked;
mod memory;
mod record;
mod results;
mod running;
mod schedule;
mod season;
mod taken_away;
mod told;
mod watch;

use fragscale_core::{fault, files, flight, jobs, numbers, toml_text, units};
use fragscale_exports as exports;
use fragscale_formats as formats;
use fragscale_opening as opening;

pub use asked::{Asked, AskedStep, MOST_SHARE, Misfit, OptionKind, Step, StepOption, steps_fit};
pub use record::{Record, remove_unfinished_below, remove_what_is_left};
pub use results::{ResultsFolder, notes_on_results, write_results};
pub use running::{BatchOptions, Ended, Event, FLIGHT_COMMAND, Outcome, run};
pub use season::{Found, Season, SeasonFlight};
pub use taken_away::TakenAway;
pub use told::{FlightDone, FlightTold, SaidLine};
pub use watch::{Arrivals, Seen};
