//! An MP4 file (ISO/IEC 14496-12, -15) with one H.264 track, at a constant frame rate.
//!
//! Coded frames go to disk as they come; only their sizes stay in memory. The index is written before them when the
//! movie ends, so that players and browsers can start before they have all of it.

use std::io::{self, Read, Seek, SeekFrom, Write};

/// Sample sizes and parameter sets of a movie whose coded frames are streamed elsewhere.
pub(super) struct Track {
    pub size: [u16; 2],
    /// Ticks a second, and ticks a frame.
    pub timescale: u32,
    pub frame_ticks: u32,
    sequence_set: Vec<u8>,
    picture_set: Vec<u8>,
    sizes: Vec<u32>,
    /// 1-based numbers of the frames that can be decoded alone.
    sync: Vec<u32>,
}

impl Track {
    pub fn new(size: [u16; 2], frame_rate: f64) -> Self {
        let [timescale, frame_ticks] = clock(frame_rate);
        Self { size, timescale, frame_ticks, sequence_set: vec![], picture_set: vec![], sizes: vec![], sync: vec![] }
    }

    /// Appends one coded frame in Annex B form to `data`, its units prefixed with their length as MP4 wants.
    pub fn append(&mut self, annex_b: &[u8], data: &mut impl Write) -> io::Result<()> {
        let mut size = 0;
        let mut sync = false;
        for unit in units(annex_b) {
            match unit[0] & 31 {
                7 => self.sequence_set = unit.to_vec(),
                8 => self.picture_set = unit.to_vec(),
                kind => {
                    sync |= kind == 5;
                    data.write_all(&(unit.len() as u32).to_be_bytes())?;
                    data.write_all(unit)?;
                    size += 4 + unit.len() as u32;
                }
            }
        }
        self.sizes.push(size);
        if sync {
            self.sync.push(self.sizes.len() as u32);
        }
        Ok(())
    }

    /// Writes the whole file: type, index, then the frames copied from `data`.
    pub fn finish(&self, data: &mut (impl Read + Seek), out: &mut impl Write) -> io::Result<()> {
        let kind = boxed(b"ftyp", &[b"isom", &512_u32.to_be_bytes()[..], b"isom", b"iso2", b"avc1", b"mp41"].concat());
        let length = data.seek(SeekFrom::End(0))?;
        let wide = length + 16 > u64::from(u32::MAX);
        let header = if wide { 16 } else { 8 };
        // The index holds the place of the frames, whose place depends on the index's length, not on its content.
        let before = kind.len() as u64 + self.index(0).len() as u64 + header;
        out.write_all(&kind)?;
        out.write_all(&self.index(before))?;
        if wide {
            out.write_all(&[&1_u32.to_be_bytes()[..], b"mdat", &(length + 16).to_be_bytes()].concat())?;
        } else {
            out.write_all(&[&(length as u32 + 8).to_be_bytes()[..], b"mdat"].concat())?;
        }
        data.seek(SeekFrom::Start(0))?;
        io::copy(data, out)?;
        Ok(())
    }

    fn index(&self, frames_at: u64) -> Vec<u8> {
        let count = self.sizes.len() as u32;
        let ticks = u64::from(count) * u64::from(self.frame_ticks);
        let [width, height] = self.size;
        let matrix = [0x1_0000_u32, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];

        // Version 1, whose times and durations have 64 bits: 32 are half a day of the usual clock, and less of a finer one.
        let mvhd = Body::full(1, 0)
            .longs(&[0, 0])
            .words(&[self.timescale])
            .longs(&[ticks])
            .words(&[0x1_0000])
            .bytes(&[1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0])
            .words(&matrix)
            .words(&[0; 6])
            .words(&[2]);
        let tkhd = Body::full(1, 3)
            .longs(&[0, 0])
            .words(&[1, 0])
            .longs(&[ticks])
            .words(&[0; 4])
            .words(&matrix)
            .words(&[u32::from(width) << 16, u32::from(height) << 16]);
        let mdhd = Body::full(1, 0).longs(&[0, 0]).words(&[self.timescale]).longs(&[ticks]).bytes(&[0x55, 0xC4, 0, 0]);
        let hdlr = Body::full(0, 0).words(&[0]).bytes(b"vide").words(&[0, 0, 0]).bytes(b"video\0");
        let vmhd = Body::full(0, 1).words(&[0, 0]);
        let dref = Body::full(0, 0).words(&[1]).bytes(&boxed(b"url ", &Body::full(0, 1).0));
        let dinf = boxed(b"dinf", &boxed(b"dref", &dref.0));

        let stsd = Body::full(0, 0).words(&[1]).bytes(&self.sample_entry());
        let stts = Body::full(0, 0).words(&[1, count, self.frame_ticks]);
        let stss = Body::full(0, 0).words(&[self.sync.len() as u32]).words(&self.sync);
        let stsc = Body::full(0, 0).words(&[1, 1, count, 1]);
        let stsz = Body::full(0, 0).words(&[0, count]).words(&self.sizes);
        let co64 = Body::full(0, 0).words(&[1]).longs(&[frames_at]);
        let stbl = [
            boxed(b"stsd", &stsd.0),
            boxed(b"stts", &stts.0),
            boxed(b"stss", &stss.0),
            boxed(b"stsc", &stsc.0),
            boxed(b"stsz", &stsz.0),
            boxed(b"co64", &co64.0),
        ]
        .concat();
        let minf = [boxed(b"vmhd", &vmhd.0), dinf, boxed(b"stbl", &stbl)].concat();
        let mdia = [boxed(b"mdhd", &mdhd.0), boxed(b"hdlr", &hdlr.0), boxed(b"minf", &minf)].concat();
        let trak = [boxed(b"tkhd", &tkhd.0), boxed(b"mdia", &mdia)].concat();
        boxed(b"moov", &[boxed(b"mvhd", &mvhd.0), boxed(b"trak", &trak)].concat())
    }

    fn sample_entry(&self) -> Vec<u8> {
        let set = &self.sequence_set;
        let profile = [set.get(1), set.get(2), set.get(3)].map(|b| b.copied().unwrap_or(0));
        let mut avcc = vec![1, profile[0], profile[1], profile[2], 0xFF, 0xE1];
        avcc.extend((self.sequence_set.len() as u16).to_be_bytes());
        avcc.extend(&self.sequence_set);
        avcc.push(1);
        avcc.extend((self.picture_set.len() as u16).to_be_bytes());
        avcc.extend(&self.picture_set);
        if !matches!(profile[0], 66 | 77 | 88) {
            // 4:2:0, 8 bit, no extension sets.
            avcc.extend([0xFD, 0xF8, 0xF8, 0]);
        }
        // Rec. 709 primaries, transfer and matrix; studio range.
        let colr = boxed(b"colr", &[&b"nclx"[..], &[0, 1, 0, 1, 0, 1, 0]].concat());
        let entry = Body(vec![0, 0, 0, 0, 0, 0, 0, 1])
            .bytes(&[0; 16])
            .bytes(&self.size[0].to_be_bytes())
            .bytes(&self.size[1].to_be_bytes())
            .words(&[72 << 16, 72 << 16, 0])
            .bytes(&[0, 1])
            .bytes(&[0; 32])
            .bytes(&[0, 24, 0xFF, 0xFF])
            .bytes(&boxed(b"avcC", &avcc))
            .bytes(&colr);
        boxed(b"avc1", &entry.0)
    }
}

/// Ticks a second and ticks a frame, whose quotient is the frame rate (1..240 a second) to a millionth of it.
fn clock(frame_rate: f64) -> [u32; 2] {
    // The usual video clock, where frames are whole ticks of it, as 24, 25, 30, 50 and 60 a second are. Elsewhere, as for
    // 23.976, so many ticks a frame that what is rounded is less than a millionth.
    const USUAL: f64 = 90_000.0;
    const FINE: f64 = 1e6;
    let ticks = (USUAL / frame_rate).round();
    if (frame_rate * ticks / USUAL - 1.0).abs() < 1e-9 {
        return [USUAL as u32, ticks as u32];
    }
    [(frame_rate * FINE).round() as u32, FINE as u32]
}

/// The units of an Annex B stream, without their start codes and trailing zeros.
fn units(stream: &[u8]) -> impl Iterator<Item = &[u8]> {
    let starts: Vec<usize> =
        stream.windows(3).enumerate().filter(|(_, w)| *w == [0, 0, 1]).map(|(i, _)| i + 3).collect();
    (0..starts.len()).filter_map(move |i| {
        let end = starts.get(i + 1).map_or(stream.len(), |next| next - 3);
        let unit = &stream[starts[i]..end];
        let length = unit.iter().rposition(|&b| b != 0)? + 1;
        Some(&unit[..length])
    })
}

/// The content of a box under construction, big-endian.
struct Body(Vec<u8>);

impl Body {
    fn full(version: u8, flags: u8) -> Self {
        Self(vec![version, 0, 0, flags])
    }

    fn words(mut self, words: &[u32]) -> Self {
        self.0.extend(words.iter().flat_map(|w| w.to_be_bytes()));
        self
    }

    fn longs(mut self, longs: &[u64]) -> Self {
        self.0.extend(longs.iter().flat_map(|l| l.to_be_bytes()));
        self
    }

    fn bytes(mut self, bytes: &[u8]) -> Self {
        self.0.extend_from_slice(bytes);
        self
    }
}

fn boxed(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    [&(content.len() as u32 + 8).to_be_bytes()[..], kind, content].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_lose_start_codes_and_padding() {
        let stream = [0, 0, 0, 1, 0x67, 1, 2, 0, 0, 1, 0x68, 3, 0, 0, 0, 1, 0x65, 0, 5];
        let found: Vec<&[u8]> = units(&stream).collect();
        assert_eq!(found, [&[0x67, 1, 2][..], &[0x68, 3], &[0x65, 0, 5]]);
    }

    #[test]
    fn boxes_of_a_movie_fill_it_exactly_and_point_at_its_frames() {
        let mut track = Track::new([640, 360], 24.0);
        let mut data = io::Cursor::new(Vec::new());
        track.append(&[0, 0, 0, 1, 0x67, 66, 0, 30, 0, 0, 1, 0x68, 9, 0, 0, 1, 0x65, 7, 7], &mut data).unwrap();
        track.append(&[0, 0, 0, 1, 0x41, 8], &mut data).unwrap();
        let mut file = Vec::new();
        track.finish(&mut data, &mut file).unwrap();

        let mut at = 0;
        let mut kinds = vec![];
        while at < file.len() {
            let length = u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
            kinds.push(std::str::from_utf8(&file[at + 4..at + 8]).unwrap());
            at += length;
        }
        assert_eq!(at, file.len());
        assert_eq!(kinds, ["ftyp", "moov", "mdat"]);

        let co64 = file.windows(4).position(|w| w == b"co64").unwrap();
        let frames_at = u64::from_be_bytes(file[co64 + 12..co64 + 20].try_into().unwrap()) as usize;
        assert_eq!(&file[frames_at..], [0, 0, 0, 3, 0x65, 7, 7, 0, 0, 0, 2, 0x41, 8]);

        // Width and height close the header of the track, in 1/65536 of a pixel; in the entry of its frames they follow 24 bytes.
        let body = |kind: &[u8; 4]| &file[file.windows(4).rposition(|w| w == kind).unwrap() + 4..];
        assert_eq!(body(b"tkhd")[88..96], [640_u32 << 16, 360 << 16].map(u32::to_be_bytes).concat());
        assert_eq!(body(b"avc1")[24..28], [640_u16, 360].map(u16::to_be_bytes).concat());
    }

    #[test]
    fn ticks_a_second_by_ticks_a_frame_are_the_frame_rate() {
        for rate in [0.5, 1.0, 1.0005, 12.3456, 23.976, 24.0, 29.97, 59.94, 60.0, 119.88, 239.999, 240.0, 1000.0] {
            let [timescale, frame_ticks] = clock(rate).map(f64::from);
            assert!((timescale / frame_ticks / rate - 1.0).abs() < 1e-6, "{rate}: {timescale} / {frame_ticks}");
        }
        assert_eq!([24.0, 25.0, 30.0, 60.0].map(clock), [3750, 3600, 3000, 1500].map(|ticks| [90_000, ticks]));
    }

    #[test]
    fn a_movie_of_a_day_is_as_long_as_its_frames() {
        let mut track = Track::new([16, 16], 1.0);
        track.sizes = vec![0; 86_400];
        let index = track.index(0);
        // In boxes of version 1, behind kind, version and flags and two times: how far behind them the duration stands.
        for (kind, further) in [(b"mvhd", 4), (b"tkhd", 8), (b"mdhd", 4)] {
            let body = index.windows(4).position(|w| w == kind).unwrap() + 4;
            assert_eq!(index[body], 1, "version");
            let duration = &index[body + 4 + 16 + further..][..8];
            assert_eq!(u64::from_be_bytes(duration.try_into().unwrap()), 86_400 * 90_000);
        }
    }
}
