use std::fmt::{Debug, Formatter};
use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// Stream to which the pictures of an output are passed on as they are made, such as standard output. It gets nothing before the first
/// picture is whole.
#[derive(Clone)]
pub struct PictureSink(Arc<Mutex<Passing>>);

struct Passing {
    goal: Box<dyn Write + Send>,
    /// Bytes before the end of the first picture.
    held: Option<Vec<u8>>,
}

impl PictureSink {
    /// Creates a sink that passes pictures on to a goal.
    pub fn new(goal: impl Write + Send + 'static) -> Self {
        Self(Arc::new(Mutex::new(Passing { goal: Box::new(goal), held: Some(Vec::new()) })))
    }

    fn with<T>(&self, pass: impl FnOnce(&mut Passing) -> T) -> T {
        pass(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Debug for PictureSink {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str("PictureSink")
    }
}

impl Write for PictureSink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.with(|Passing { goal, held }| match held {
            Some(held) => held.write(bytes),
            None => goal.write(bytes),
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.with(|Passing { goal, held }| {
            goal.write_all(&held.take().unwrap_or_default())?;
            goal.flush()
        })
    }
}
