//! The line to a node: one TCP connection that is looked after while it waits.
//!
//! ureq's own waits as long as it takes and cannot be called off, and its limits are of a whole body, which may take
//! hours. This one looks ten times a second whether it is still wanted, and gives up when nothing has moved for a
//! while, however long all of it takes. It connects to what the address resolves to and to nothing else: no proxy
//! of the environment comes between.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use ureq::Error;
use ureq::unversioned::transport::{
    Buffers, ConnectionDetails, Connector, LazyBuffers, NextTimeout, Transport,
};

use crate::jobs::Progress;

/// How often it is looked whether the line is still wanted.
const LOOK: Duration = Duration::from_millis(100);

/// Makes lines.
#[derive(Debug)]
pub(crate) struct Lines {
    /// Whoever may call them off.
    pub(crate) wanted_by: Option<Progress>,
    /// How long nothing may move.
    pub(crate) idle: Duration,
}

impl Connector<()> for Lines {
    type Out = Line;

    fn connect(
        &self,
        details: &ConnectionDetails<'_>,
        _: Option<()>,
    ) -> Result<Option<Line>, Error> {
        let mut last = io::Error::new(io::ErrorKind::NotFound, "its name leads to no address");
        for address in details.addrs.iter() {
            match TcpStream::connect_timeout(address, self.idle.min(Duration::from_secs(10))) {
                Ok(stream) => {
                    stream.set_nodelay(true)?;
                    stream.set_read_timeout(Some(LOOK))?;
                    stream.set_write_timeout(Some(LOOK))?;
                    let config = details.config;
                    return Ok(Some(Line {
                        stream,
                        buffers: LazyBuffers::new(
                            config.input_buffer_size(),
                            config.output_buffer_size(),
                        ),
                        wanted_by: self.wanted_by.clone(),
                        idle: self.idle,
                    }));
                }
                Err(error) => last = error,
            }
        }
        Err(Error::Io(last))
    }
}

/// A line.
pub(crate) struct Line {
    stream: TcpStream,
    buffers: LazyBuffers,
    wanted_by: Option<Progress>,
    idle: Duration,
}

impl std::fmt::Debug for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Line").finish_non_exhaustive()
    }
}

impl Line {
    /// Whether to wait on, where nothing has moved since `began`.
    fn waits(&self, began: Instant, what: &str) -> Result<(), Error> {
        if self.wanted_by.as_ref().is_some_and(Progress::is_cancelled) {
            return Err(Error::Io(io::Error::other("cancelled")));
        }
        let waited = began.elapsed();
        if waited >= self.idle {
            let what = format!("{what} for {:.0} s", waited.as_secs_f64());
            return Err(Error::Io(io::Error::new(io::ErrorKind::TimedOut, what)));
        }
        Ok(())
    }
}

/// Whether it is only that nothing moved until the next look.
fn is_a_look(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted
    )
}

impl Transport for Line {
    fn buffers(&mut self) -> &mut dyn Buffers {
        &mut self.buffers
    }

    fn transmit_output(&mut self, amount: usize, _: NextTimeout) -> Result<(), Error> {
        let mut sent = 0;
        let mut began = Instant::now();
        while sent < amount {
            self.waits(began, "the node has taken nothing")?;
            let rest = self.buffers.output().get(sent..amount).unwrap_or_default();
            match self.stream.write(rest) {
                Ok(0) => return Err(Error::Io(io::ErrorKind::WriteZero.into())),
                Ok(now) => {
                    sent += now;
                    began = Instant::now();
                }
                Err(error) if is_a_look(&error) => {}
                Err(error) => return Err(Error::Io(error)),
            }
        }
        Ok(())
    }

    fn await_input(&mut self, _: NextTimeout) -> Result<bool, Error> {
        let began = Instant::now();
        loop {
            self.waits(began, "the node has said nothing")?;
            match self.stream.read(self.buffers.input_append_buf()) {
                Ok(amount) => {
                    self.buffers.input_appended(amount);
                    return Ok(amount > 0);
                }
                Err(error) if is_a_look(&error) => {}
                Err(error) => return Err(Error::Io(error)),
            }
        }
    }

    fn is_open(&mut self) -> bool {
        // Each call has a line of its own: a node closes lines that rest, just when the next call comes.
        false
    }
}
