//! Pictures as PNG, several as an animation in one file (APNG).

use super::canvas::Canvas;
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, EncodingError, Filter, Writer};
use std::cell::Cell;
use std::io::{self, Write};

/// The file of a picture.
pub fn picture(canvas: &Canvas) -> Vec<u8> {
    let mut bytes = Vec::new();
    let written = begin(&mut bytes, canvas, 1, 0).and_then(|mut writer| {
        writer.write_image_data(&canvas.bytes)?;
        writer.finish()
    });
    // A vector takes all that is written, and the picture has the size that is told.
    debug_assert!(written.is_ok(), "{written:?}");
    bytes
}

/// The file of `count` pictures of one size that follow each other every `delay_ms` milliseconds, again and again; empty
/// without any. `frame` makes each when it is its turn, so that only one is in memory: it is told its number and how many
/// bytes the file has. Programs that know no animation show the first.
///
/// # Errors
/// Those of `frame`.
pub fn animation<E>(
    count: u32,
    delay_ms: u16,
    mut frame: impl FnMut(u32, usize) -> Result<Canvas, E>,
) -> Result<Vec<u8>, E> {
    let mut bytes = Vec::new();
    if count == 0 {
        return Ok(bytes);
    }
    let first = frame(0, 0)?;
    let length = Cell::new(0);
    let written = begin(Counted { bytes: &mut bytes, length: &length }, &first, count, delay_ms).and_then(
        |mut writer| {
            writer.write_image_data(&first.bytes)?;
            drop(first);
            for number in 1..count {
                match frame(number, length.get()) {
                    Ok(canvas) => writer.write_image_data(&canvas.bytes)?,
                    Err(error) => return Ok(Err(error)),
                }
            }
            writer.finish().map(Ok)
        },
    );
    match written {
        Ok(result) => result.map(|()| bytes),
        // As of one picture.
        Err(error) => {
            debug_assert!(false, "{error}");
            Ok(bytes)
        }
    }
}

/// A file that begins, for `count` pictures as large as `first`.
fn begin<W: Write>(sink: W, first: &Canvas, count: u32, delay_ms: u16) -> Result<Writer<W>, EncodingError> {
    let mut encoder = Encoder::new(sink, first.width() as u32, first.height() as u32);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    if count > 1 {
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(delay_ms, 1000)?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
    }
    encoder.write_header()
}

/// Bytes whose number can be asked while they are written.
struct Counted<'c> {
    bytes: &'c mut Vec<u8>,
    length: &'c Cell<usize>,
}

impl Write for Counted<'_> {
    fn write(&mut self, more: &[u8]) -> io::Result<usize> {
        self.bytes.extend_from_slice(more);
        self.length.set(self.bytes.len());
        Ok(more.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
