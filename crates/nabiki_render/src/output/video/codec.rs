//! H.264 by OpenH264.

use openh264::OpenH264API;
use openh264::encoder::{
    Complexity, Encoder, EncoderConfig, FrameRate, IntraFramePeriod, QpRange, RateControlMode, SpsPpsStrategy,
    UsageType, VuiConfig,
};
use openh264::formats::YUVSlices;

use super::Planes;

/// Whether there is a codec.
pub const IS_BUILT_IN: bool = true;

/// Longest run of frames that depend on one another: seeking lands at most this far away. Nearer is a pulse: a frame that is coded by
/// itself differs from the one before by four times as much as calm hair does from frame to frame.
const INTRA_PERIOD: u32 = 240;

pub struct Codec(Encoder);

impl Codec {
    /// For frames of one quality, 12 (near lossless) to 51, at `frame_rate` frames a second.
    pub fn new(quantiser: u8, frame_rate: f64) -> Result<Self, String> {
        let config = EncoderConfig::new()
            .usage_type(UsageType::CameraVideoRealTime)
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(quantiser, quantiser))
            .complexity(Complexity::Medium)
            .skip_frames(false)
            .scene_change_detect(false)
            .adaptive_quantization(false)
            .background_detection(false)
            .sps_pps_strategy(SpsPpsStrategy::ConstantId)
            .intra_frame_period(IntraFramePeriod::from_num_frames(INTRA_PERIOD))
            .max_frame_rate(FrameRate::from_hz(frame_rate as f32))
            // More threads would slice the picture differently, and so change the file's bits.
            .num_threads(1)
            .vui(VuiConfig::bt709());
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config);
        encoder.map(Self).map_err(|e| e.to_string())
    }

    /// Appends the bits of the next frame.
    pub fn code(&mut self, [width, height]: [usize; 2], planes: &Planes, bits: &mut Vec<u8>) -> Result<(), String> {
        let strides = (width, width / 2, width / 2);
        let source = YUVSlices::new((&planes[0], &planes[1], &planes[2]), (width, height), strides);
        self.0.encode(&source).map_err(|e| e.to_string())?.write_vec(bits);
        Ok(())
    }
}
