//! A file from which small pieces are read at many places.

use std::io::{self, Read, Seek, SeekFrom};

/// Bytes that are fetched at once. Longer pieces are read where they go.
const BYTES: usize = 8192;

/// A buffered file for small reads at many places. An archive has 100,000 neighbouring numbers, which one system call
/// reads together. (A `BufReader` discards its buffer on every seek.)
#[derive(Debug)]
pub struct Window<R> {
    from: R,
    /// Where `from` stands.
    stands: u64,
    /// Where reading goes on.
    at: u64,
    /// What was fetched, and where it begins.
    held: Vec<u8>,
    begins: u64,
}

impl<R: Read + Seek> Window<R> {
    /// Starts at the current position of `from`.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn new(mut from: R) -> io::Result<Self> {
        let at = from.stream_position()?;
        Ok(Self { from, stands: at, at, held: Vec::new(), begins: 0 })
    }

    fn fetch(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.stands != self.at {
            self.stands = self.from.seek(SeekFrom::Start(self.at))?;
        }
        let read = self.from.read(to)?;
        self.stands += read as u64;
        Ok(read)
    }
}

impl<R: Read + Seek> Read for Window<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let held = |begins: u64, held: &[u8], at: u64| {
            let from = usize::try_from(at.checked_sub(begins)?).ok()?;
            (from < held.len()).then_some(from)
        };
        let mut from = held(self.begins, &self.held, self.at);
        if from.is_none() {
            if to.len() >= BYTES {
                let read = self.fetch(to)?;
                self.at += read as u64;
                return Ok(read);
            }
            let mut bytes = std::mem::take(&mut self.held);
            bytes.resize(BYTES, 0);
            let read = self.fetch(&mut bytes);
            bytes.truncate(*read.as_ref().unwrap_or(&0));
            (self.held, self.begins) = (bytes, self.at);
            read?;
            from = held(self.begins, &self.held, self.at);
        }
        let Some(from) = from else { return Ok(0) };
        let count = to.len().min(self.held.len() - from);
        to[..count].copy_from_slice(&self.held[from..from + count]);
        self.at += count as u64;
        Ok(count)
    }
}

impl<R: Read + Seek> Seek for Window<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = match to {
            SeekFrom::Start(at) => at,
            SeekFrom::Current(by) => self.at.checked_add_signed(by).ok_or(io::ErrorKind::InvalidInput)?,
            SeekFrom::End(_) => {
                self.stands = self.from.seek(to)?;
                self.stands
            }
        };
        Ok(self.at)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Counts what is asked of it.
    struct Asked(Cursor<Vec<u8>>, std::rc::Rc<std::cell::Cell<usize>>);

    impl Read for Asked {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            self.1.set(self.1.get() + 1);
            self.0.read(to)
        }
    }

    impl Seek for Asked {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.1.set(self.1.get() + 1);
            self.0.seek(to)
        }
    }

    #[test]
    fn what_is_read_is_what_is_there_however_it_is_gone_to() {
        let bytes: Vec<u8> = (0..100_000_u32).flat_map(|n| (n as u16).to_le_bytes()).collect();
        let (mut plain, mut window) = (Cursor::new(&bytes), Window::new(Cursor::new(&bytes)).unwrap());
        let mut state = 7_u64;
        for _ in 0..3000 {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let [kind, place, length] = [state >> 62, state >> 20, state >> 40].map(|x| x as usize);
            let to = match kind {
                0 => SeekFrom::Start((place % (bytes.len() + 9)) as u64),
                1 => SeekFrom::End(-((place % bytes.len()) as i64)),
                _ => SeekFrom::Current((place % 64) as i64),
            };
            assert_eq!(window.seek(to).unwrap(), plain.seek(to).unwrap());
            let length = if kind == 3 { length % 20_000 } else { length % 40 };
            let (mut a, mut b) = (Vec::new(), Vec::new());
            (&mut window).take(length as u64).read_to_end(&mut a).unwrap();
            (&mut plain).take(length as u64).read_to_end(&mut b).unwrap();
            assert_eq!(a, b);
            assert_eq!(window.stream_position().unwrap(), plain.stream_position().unwrap());
        }
        assert!(window.seek(SeekFrom::Start(3)).is_ok() && window.seek(SeekFrom::Current(-4)).is_err());
    }

    #[test]
    fn neighbours_are_asked_for_once() {
        let asked = std::rc::Rc::new(std::cell::Cell::new(0));
        let mut window = Window::new(Asked(Cursor::new(vec![1; 1 << 20]), asked.clone())).unwrap();
        let mut number = [0; 8];
        for n in 0..10_000_u64 {
            // Back and forth within a few kilobytes.
            window.seek(SeekFrom::Start(8 * n + 512 * (n % 3))).unwrap();
            window.read_exact(&mut number).unwrap();
        }
        assert!(asked.get() < 2000, "{}", asked.get());
    }
}
