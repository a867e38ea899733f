//! Joins the shards of a motion into the cache that one machine would have written.

use std::path::{Path, PathBuf};

use nabiki_io::SceneId;
use nabiki_io::cache::{Header, Piece, Reader, Shard, Writer};
use nabiki_io::identity::StrandSum;

use crate::error::{Error, Result};
use crate::place;
use crate::told::Told;
use crate::watch::{Watch, each_frame};
use nabiki_io::shell;

/// Joins all shards of a motion, in any order, into the motion cache that [`simulate`](super::simulate()) writes for
/// all strands, byte for byte.
///
/// # Errors
/// Files that are not shards of one motion; a missing shard, with the command that makes it; a place that cannot be
/// written; or cancelled by `watch`.
pub fn join(files: &[PathBuf], output: &Path, watch: &mut dyn Watch) -> Result<()> {
    place::cache(output, "choose another name", files)?;
    let mut pieces = sorted(files)?;
    let header = whole(&pieces)?;
    let frames = pieces[0].reader.frame_count();
    let points = u64::from(header.starts.last().copied().unwrap_or_default());
    place::room(output, frames * (28 + 12 * points), watch)?;
    let strands = header.starts.len() - 1;
    let mut writer = Writer::create(output, &header, frames)?;
    drop(header);
    // The header of a cache has fewer frames than that.
    let last = u32::try_from(frames - 1).unwrap_or(u32::MAX);
    each_frame(watch, "joining", 0..=last, |n| {
        let mut head = None;
        for OpenPiece { reader, .. } in &mut pieces {
            let mut part = reader.header().strands();
            let pose = reader.read(n.into(), &mut part)?;
            match head {
                None => writer.begin_frame(&pose)?,
                Some(head) if head == pose => {}
                Some(_) => {
                    let file = reader.path().display();
                    return Err(Error::refused(format!(
                        "{file}: frame {n}: the head is not where it is in the first shard"
                    )));
                }
            }
            head = Some(pose);
            writer.part(part.points())?;
        }
        Ok(())
    })?;
    writer.finish()?;
    let shards = if pieces.len() == 1 { "shard" } else { "shards" };
    let holds = Some(format!("{frames} frames of {strands} strands, out of {} {shards}", pieces.len()));
    watch.told(Told::Wrote { file: output.to_owned(), holds });
    Ok(())
}

/// A shard's file.
struct OpenPiece {
    reader: Reader,
    piece: Piece,
}

impl OpenPiece {
    fn open(file: &Path) -> Result<Self> {
        let reader = Reader::open(file)?;
        let Some(piece) = reader.header().piece.clone() else {
            let line = "a full motion, not a shard; nabiki simulate --shard K/N writes shards";
            return Err(Error::refused(format!("{}: {line}", file.display())));
        };
        Ok(Self { reader, piece })
    }

    /// Why this is not a shard of the motion of `first`.
    fn differs_from(&self, first: &Self) -> Option<String> {
        let (mine, other) = (&self.piece, &first.piece);
        let (header, others) = (self.reader.header(), first.reader.header());
        let (frames, others_frames) = (self.reader.frame_count(), first.reader.frame_count());
        if mine.shard.of() != other.shard.of() {
            Some(format!("is shard {}, and {} is shard {}", mine.shard, first.reader.path().display(), other.shard))
        } else if mine.settings != other.settings || mine.groom != other.groom || mine.strands != other.strands {
            Some("was made from another scene, with other settings, or by another version".to_owned())
        } else if mine.reference != other.reference {
            Some("was made with the other --stepper".to_owned())
        } else if frames != others_frames || header.frame_rate != others.frame_rate {
            let [mine, others] = [(frames, header), (others_frames, others)]
                .map(|(frames, header)| format!("{frames} frames at {} a second", header.frame_rate));
            Some(format!("holds {mine} and not {others}"))
        } else if header.first_frame != others.first_frame {
            let (mine, others) = (header.first_frame, others.first_frame);
            Some(format!("begins at frame {mine} of the shot and not {others} (output.first_frame)"))
        } else {
            None
        }
    }
}

/// All shards of one motion, in their order.
fn sorted(files: &[PathBuf]) -> Result<Vec<OpenPiece>> {
    let (there, missing): (Vec<&PathBuf>, Vec<&PathBuf>) = files.iter().partition(|file| file.exists());
    let mut pieces = there.into_iter().map(|file| OpenPiece::open(file)).collect::<Result<Vec<_>>>()?;
    let Some(first) = pieces.first() else {
        let line = match missing.first() {
            Some(file) => format!("{}: there is no such file and no other shard", file.display()),
            None => "no shards given: name all files that nabiki simulate --shard wrote".to_owned(),
        };
        return Err(Error::refused(line));
    };
    for piece in &pieces[1..] {
        if let Some(why) = piece.differs_from(first) {
            return Err(Error::refused(format!(
                "{}: {why}, unlike {}; give the shards of one motion, each made in the same way",
                piece.reader.path().display(),
                first.reader.path().display()
            )));
        }
    }
    pieces.sort_by_key(|piece| piece.piece.shard.number());
    if let Some([a, b]) = pieces.windows(2).find(|pair| pair[0].piece.shard == pair[1].piece.shard) {
        return Err(Error::refused(format!(
            "{}: is shard {} as {} is; give each shard once",
            b.reader.path().display(),
            b.piece.shard,
            a.reader.path().display()
        )));
    }
    match first_missing(&pieces) {
        Some(shard) => Err(missing_shard(&pieces[0], shard, &missing)),
        None => match missing.first() {
            Some(file) => Err(Error::refused(format!(
                "{}: there is no such file, and all {} shards are there without it; leave it out",
                file.display(),
                pieces.len()
            ))),
            None => Ok(pieces),
        },
    }
}

/// The first number without a piece.
fn first_missing(pieces: &[OpenPiece]) -> Option<Shard> {
    let of = pieces[0].piece.shard.of();
    let have = |number: u32| pieces.binary_search_by_key(&number, |piece| piece.piece.shard.number()).is_ok();
    (1..=of).find(|&number| !have(number)).and_then(|number| Shard::new(number, of).ok())
}

/// The error for a missing shard, with the command that makes it. `files`: given files that do not exist.
fn missing_shard(first: &OpenPiece, shard: Shard, files: &[&PathBuf]) -> Error {
    let named = format!("{}_of_{}.nabiki", shard.number(), shard.of());
    let given = files.iter().find(|file| file.ends_with(&named)).or(files.first());
    let file = given.map_or_else(|| first.reader.path().with_file_name(named), |file| (*file).clone());
    // The command comes from a file of unknown origin, and the reader will paste it into a shell.
    let begins = match &first.piece.command {
        command if shell::is_command(command, &["nabiki", "simulate"]) => command.clone(),
        _ => "nabiki simulate SCENE".to_owned(),
    };
    let words = format!("{begins} --shard {shard} -o {}", shell::quoted(&shell::operand(&file.to_string_lossy())));
    Error::refused(format!("shard {shard} is missing: make it with {words}"))
}

/// The header of the whole.
fn whole(pieces: &[OpenPiece]) -> Result<Header> {
    let first = &pieces[0];
    let mut header = Header { piece: None, ..first.reader.header().clone() };
    let mut sum = first.piece.sum;
    for OpenPiece { reader, piece } in &pieces[1..] {
        let part = reader.header();
        let refuse = |what: &str| {
            Error::refused(format!("{}: {what}; make all shards again with the same scene", reader.path().display()))
        };
        let from = header.starts.last().copied().unwrap_or_default();
        for &start in &part.starts[1..] {
            let start = from.checked_add(start).ok_or_else(|| refuse("more than 2^32 points in all"))?;
            header.starts.push(start);
        }
        if part.origin != header.origin || !header.attributes.append(part.attributes.clone()) {
            return Err(refuse("has other attributes than the shards before it"));
        }
        sum = StrandSum::and(sum, piece.sum);
    }
    header.scene = SceneId::of(first.piece.settings, sum);
    Ok(header)
}
