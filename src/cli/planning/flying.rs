//! How the drone is flown from photo to photo, as it is typed.

use clap::Args;

use crate::plan::{Flying, MOST_SPEED, USUAL_CLIMB, USUAL_DESCENT, USUAL_SETTLE, USUAL_SPEED};

#[derive(Debug, Args)]
pub(super) struct FlyingArguments {
    /// Metres a second between photos.
    #[arg(long, value_name = "M/S", value_parser = speed, allow_hyphen_values = true, default_value_t = USUAL_SPEED)]
    speed: f64,
    /// Metres a second upwards, at most: for the time in the air.
    #[arg(long, value_name = "M/S", value_parser = speed, allow_hyphen_values = true, default_value_t = USUAL_CLIMB)]
    climb: f64,
    /// Metres a second downwards, at most.
    #[arg(long, value_name = "M/S", value_parser = speed, allow_hyphen_values = true, default_value_t = USUAL_DESCENT)]
    descent: f64,
    /// How steeply a slanted leg may climb or fall, degrees: steeper ones are flown upright and level. Else as it comes.
    #[arg(long, value_name = "DEGREES", value_parser = slope, allow_hyphen_values = true)]
    steepest: Option<f64>,
    /// Seconds that the drone waits at a photo, for the gimbal to settle.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true, default_value_t = USUAL_SETTLE)]
    settle: f64,
    /// Minutes in the air that a battery lasts: a longer way becomes several missions, NAME-battery-1 and so on.
    #[arg(long, value_name = "MINUTES", value_parser = positive, allow_hyphen_values = true, requires = "take_off")]
    battery: Option<f64>,
}

impl FlyingArguments {
    pub(super) fn flying(&self) -> Flying {
        Flying {
            speed: self.speed,
            settle: self.settle,
            battery: self.battery,
            climb: self.climb,
            descent: self.descent,
            steepest: self.steepest,
        }
    }
}

/// A number above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    let number = number.filter(|number| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "give a number above zero".to_owned())
}

/// Percent of a photo; who types less than one of it means a share.
pub(super) fn percent(text: &str) -> Result<f64, String> {
    let number: f64 = text
        .trim()
        .parse()
        .map_err(|_| "give a number".to_owned())?;
    if number > 0.0 && number < 1.0 {
        let percent = (number * 1e5).round() / 1e3;
        return Err(format!("it is in percent: {percent} for {text} of a photo"));
    }
    Ok(number)
}

/// Metres a second that a drone flies.
pub(super) fn speed(text: &str) -> Result<f64, String> {
    let number = positive(text)?;
    let flies = number <= MOST_SPEED;
    flies
        .then_some(number)
        .ok_or_else(|| format!("give at most {MOST_SPEED} m/s"))
}

/// Degrees above the horizon.
fn slope(text: &str) -> Result<f64, String> {
    let number = positive(text)?;
    let is_slope = number < 90.0;
    is_slope
        .then_some(number)
        .ok_or_else(|| "give degrees above the horizon, under 90".to_owned())
}
