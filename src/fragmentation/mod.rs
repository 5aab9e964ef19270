//! Size distributions of broken rock.

mod swebrec;

pub use swebrec::{Swebrec, SwebrecError};
