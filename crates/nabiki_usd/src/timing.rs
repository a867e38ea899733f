//! When the frames of a layer are.

use std::collections::HashSet;

use nabiki_exchange::Frames;

use crate::Problem;
use crate::read::StageReader;
use crate::skin::Skin;
use crate::transform;

/// Steps of samples that differ by less than this, as a share of a frame, from a frame are frames: files round their times.
const SAME_FRAME: f64 = 1e-3;

impl StageReader {
    /// A number that the layer says of itself, if it does.
    pub(crate) fn positive(&mut self, name: &str, wanted: &str) -> Result<Option<f64>, Problem> {
        match self.layer.metadata_number(name)? {
            Some(x) if !(x.is_finite() && x > 0.0) => {
                Err(Problem(format!("{name} = {x}: must be a finite number above 0, {wanted}")))
            }
            number => Ok(number),
        }
    }

    /// Time codes a second.
    pub(crate) fn codes_a_second(&mut self) -> Result<f64, Problem> {
        let rate = self.positive("timeCodesPerSecond", "24, say")?;
        let rate = rate.or(self.positive("framesPerSecond", "24, say")?);
        Ok(rate.unwrap_or(24.0))
    }

    /// The frames of the curves with the most samples, or of what moves them whole, in time codes. Samples that are not a
    /// frame apart, such as those of a shutter, give way to the frames, between which there is interpolation.
    pub(crate) fn frames(&mut self) -> Result<&Frames, Problem> {
        if self.frames.is_none() {
            self.frames = Some(self.find_frames()?);
        }
        Ok(self.frames.as_ref().expect("found above"))
    }

    fn find_frames(&mut self) -> Result<Frames, Problem> {
        let codes = self.samples_of_curves()?;
        let a_frame = self.codes_a_frame()?;
        let step = a_frame.unwrap_or(1.0);
        if let [first, .., last] = codes[..]
            && last - first <= step * (1.0 + SAME_FRAME)
            && let Some(only) = self.only_frame()?.filter(|only| (first..=last).contains(only))
        {
            let between = codes.iter().filter(|&&code| code != only).count();
            return Ok(Frames { times: vec![only], step, between });
        }
        let are_frames = |step: f64| a_frame.is_none_or(|frame| (step - frame).abs() <= frame * SAME_FRAME);
        let as_sampled = Frames::as_sampled(&codes).filter(|frames| codes.len() < 2 || are_frames(frames.step));
        as_sampled.or_else(|| Frames::whole(&codes, step)).ok_or_else(|| {
            let [first, last] = [codes[0], codes[codes.len() - 1]];
            Problem(format!("its curves move from time code {first} to {last}, longer than nabiki reads"))
        })
    }

    /// The time codes at which the points of the curves with the most are sampled, or what moves curves whole is: their
    /// skeletons, or what stands above them.
    fn samples_of_curves(&mut self) -> Result<Vec<f64>, Problem> {
        let curves = self.layer.of_type("BasisCurves");
        let samples = |i: usize| self.layer.prims[i].attributes.get("points").map(|a| &a.samples[..]).unwrap_or(&[]);
        let most = curves.iter().copied().map(samples).max_by_key(|s| s.len());
        let codes: Vec<f64> = most.unwrap_or_default().iter().map(|&(time, _)| time).collect();
        if codes.len() > 1 {
            return Ok(codes);
        }
        let mut most: Vec<f64> = Vec::new();
        let mut carried: Option<usize> = None;
        let mut asked = HashSet::new();
        for prim in curves {
            match Skin::of(&mut self.layer, prim)? {
                // Many hang on one.
                Some(skin) if !asked.insert(skin.rig.skeleton) => {}
                Some(skin) => {
                    let moving = skin.rig.times(&self.layer);
                    if moving.len() > most.len() {
                        most = moving;
                    }
                }
                None => carried = carried.into_iter().chain([prim]).max_by_key(|&prim| self.layer.standing[prim].moves),
            }
        }
        if let Some(prim) = carried.filter(|&prim| self.layer.standing[prim].moves > most.len()) {
            most = transform::times(&self.layer, prim);
        }
        most.sort_by(f64::total_cmp);
        most.dedup();
        Ok(if most.len() > 1 { most } else { codes })
    }

    /// Time codes from one frame to the next; `None` where codes are too long for frames and nothing says how many frames
    /// make one, as where they are seconds: then samples are frames.
    fn codes_a_frame(&mut self) -> Result<Option<f64>, Problem> {
        // Codes so close, or so far apart, that they are no frames of any film.
        const MOST_A_SECOND: f64 = 240.0;
        const LEAST_A_SECOND: f64 = 8.0;
        let codes = self.codes_a_second()?;
        Ok(match self.positive("framesPerSecond", "24, say")? {
            Some(frames) => Some(codes / frames),
            None if codes > MOST_A_SECOND => Some(codes / 24.0),
            None if codes < LEAST_A_SECOND => None,
            None => Some(1.0),
        })
    }

    /// The one frame of a layer that says that it has no other.
    fn only_frame(&mut self) -> Result<Option<f64>, Problem> {
        let [start, end] = [self.layer.metadata_number("startTimeCode")?, self.layer.metadata_number("endTimeCode")?];
        Ok(start.filter(|start| end == Some(*start)))
    }

    /// The time code of a frame; that of the last after those there are.
    pub(crate) fn code_of(&mut self, frame: usize) -> Result<f64, Problem> {
        let codes = &self.frames()?.times;
        Ok(codes.get(frame).or(codes.last()).copied().unwrap_or(0.0))
    }
}
