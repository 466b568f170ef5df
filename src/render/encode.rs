//! Pictures as PNG, several as an animation in one file (APNG).

use super::canvas::Canvas;
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, Filter};

/// The file of a picture.
pub fn picture(canvas: &Canvas) -> Vec<u8> {
    animation(std::slice::from_ref(canvas), 0)
}

/// The file of pictures of one size that follow each other every `delay_ms` milliseconds, again and again; empty without
/// any. Programs that know no animation show the first.
pub fn animation(frames: &[Canvas], delay_ms: u16) -> Vec<u8> {
    let mut bytes = Vec::new();
    // A vector takes all that is written, and the pictures have the size that is told.
    let written = write(&mut bytes, frames, delay_ms);
    debug_assert!(written.is_ok(), "{written:?}");
    bytes
}

fn write(bytes: &mut Vec<u8>, frames: &[Canvas], delay_ms: u16) -> Result<(), png::EncodingError> {
    let Some(first) = frames.first() else { return Ok(()) };
    let mut encoder = Encoder::new(bytes, first.width() as u32, first.height() as u32);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    if frames.len() > 1 {
        encoder.set_animated(frames.len() as u32, 0)?;
        encoder.set_frame_delay(delay_ms, 1000)?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
    }
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(&frame.bytes)?;
    }
    writer.finish()
}
