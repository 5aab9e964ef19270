//! Where to fly: what a drone is told.
//!
//! ```text
//! mission   take-off, stops with the camera's direction, what happens at the end
//! ```

mod mission;

pub use mission::{
    Above, DroneCodes, Fence, Finish, Height, Mission, PayloadCodes, PhotoOf, Stop, TakeOff,
};
