//! Colours of vertices, faces and materials.

/// A colour as a file gives it; absent channels are not invented.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Color {
    /// Red, green, blue and, if given, alpha, each 0 to 255.
    Bytes([u8; 3], Option<u8>),
    /// Red, green, blue and, if given, alpha, each 0 to 1 in most files.
    Floats([f32; 3], Option<f32>),
    /// Red, green, blue and, if given, alpha, each 0 to 1, in proportion to light as glTF gives them; the other ways are
    /// those of sRGB.
    Linear([f32; 3], Option<f32>),
    /// An index into a colour map of the reader's choice (OFF with one number).
    Index(i32),
}

impl Color {
    /// The colour between `colors`, which have shares with the sum 1. `None` when one of them is missing, or they are given
    /// in different ways; of indices the one with the largest share, and of those the first.
    pub fn blend(colors: &[(Option<Self>, f64)]) -> Option<Self> {
        let floats = |f: fn(&Self) -> Option<[Option<f64>; 4]>| {
            let mut sums = [Some(0.0); 4];
            for (color, share) in colors {
                for (sum, channel) in sums.iter_mut().zip(f(color.as_ref()?)?) {
                    *sum = sum.zip(channel).map(|(sum, channel): (f64, f64)| sum + share * channel);
                }
            }
            Some(sums)
        };
        match colors.first()?.0? {
            Self::Bytes(..) => {
                let [r, g, b, a] = floats(|color| match color {
                    Self::Bytes([r, g, b], a) => {
                        Some([Some(*r), Some(*g), Some(*b), *a].map(|x| x.map(f64::from)))
                    }
                    _ => None,
                })?;
                let byte = |x: f64| x.round() as u8;
                Some(Self::Bytes([byte(r?), byte(g?), byte(b?)], a.map(byte)))
            }
            Self::Floats(..) => {
                let [r, g, b, a] = floats(|color| match color {
                    Self::Floats([r, g, b], a) => {
                        Some([Some(*r), Some(*g), Some(*b), *a].map(|x| x.map(f64::from)))
                    }
                    _ => None,
                })?;
                Some(Self::Floats([r? as f32, g? as f32, b? as f32], a.map(|a| a as f32)))
            }
            Self::Linear(..) => {
                let [r, g, b, a] = floats(|color| match color {
                    Self::Linear([r, g, b], a) => {
                        Some([Some(*r), Some(*g), Some(*b), *a].map(|x| x.map(f64::from)))
                    }
                    _ => None,
                })?;
                Some(Self::Linear([r? as f32, g? as f32, b? as f32], a.map(|a| a as f32)))
            }
            Self::Index(_) => {
                let largest = colors.iter().fold(0.0, |most: f64, &(_, share)| most.max(share));
                colors.iter().find(|&&(_, share)| share == largest)?.0
            }
        }
    }
}
