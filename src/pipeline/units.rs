//! The unit of a result: a file in inches becomes an STL in millimetres or a GLB in metres.
//!
//! The mesh takes the unit of the result before anything is done to it, so that what is certified is what was made, and
//! not a rounding of it.

use super::input::{FileCoordinates, Input};
use super::{
    CutStitchChoices, FidelityLimits, FillHolesChoices, Operation, Options, SimplifyChoices, Units,
    WrapChoices,
};
use crate::figures::figure;
use crate::formats::{Encoding, Format, Place, ReadError, ReadErrorKind};
use crate::implicit::RbfOptions;
use crate::repair::fill::FillOptions;
use crate::simplify::Target;

/// The unit of what `operation` returns of a file of `input_format` in `units`, laid out as `encoding`.
fn units_of_result(
    operation: Operation,
    options: &Options,
    (input_format, units): (Format, Units),
    encoding: Encoding,
) -> Units {
    let default = match encoding.format() {
        Format::Stl => Units::Millimetre,
        format if format.is_in_metres() && !input_format.is_in_metres() => Units::Metre,
        _ => units,
    };
    if operation.only_reports() { units } else { options.output_units.unwrap_or(default) }
}

impl Input {
    /// The options with lengths in the unit of the file, where that or its format states one and the caller does not: lengths
    /// are millimetres then.
    pub(super) fn take_lengths(&mut self, options: &Options) -> Option<Options> {
        if options.units.is_some() || self.facts.units == Units::Millimetre {
            return None;
        }
        let factor = 1.0 / self.facts.units.millimetres();
        self.scale_near(factor);
        Some(options.scaled(factor))
    }

    /// Gives the mesh the unit of the result; the options in that unit, if it is another one than the file's.
    ///
    /// # Errors
    /// A coordinate that is beyond float64 in that unit.
    pub(super) fn take_units_of_result(
        &mut self,
        operation: Operation,
        options: &Options,
    ) -> Result<Option<Options>, ReadError> {
        let units = self.facts.units;
        let of_input = (self.facts.encoding.format(), units);
        let result_units = units_of_result(operation, options, of_input, self.output_encoding(options));
        if result_units == units {
            return Ok(None);
        }
        let factor = units.millimetres() / result_units.millimetres();
        let finite = self.soup.positions.iter().filter(|position| position.is_finite());
        let largest = finite.map(|position| position.abs().max_element()).fold(0.0, f64::max);
        if !(largest * factor).is_finite() {
            let kind = ReadErrorKind::Unparseable { found: format!("the coordinate {}", figure(largest)) };
            let expected = "coordinates that have a number in the unit of the result".to_owned();
            return Err(ReadError { kind, place: Place::Whole, expected });
        }
        if operation == Operation::Modeller {
            let positions = self.soup.positions.clone();
            self.of_file = Some(FileCoordinates { positions, factor });
        }
        for position in &mut self.soup.positions {
            *position *= factor;
        }
        self.soup.is_f32_exact = self.soup.positions.iter().all(|p| p.as_vec3().as_dvec3() == *p);
        self.facts.result_units = result_units;
        self.scale_near(factor);
        let mut scaled = options.scaled(factor);
        // The modeller finds faces on the coordinates of the file.
        scaled.modeller.tolerance = options.modeller.tolerance;
        Ok(Some(scaled))
    }
}

impl Options {
    /// The same with lengths that are so many times as large.
    fn scaled(&self, factor: f64) -> Self {
        let scaled = |length: Option<f64>| length.map(|length| length * factor);
        let target = |target: &Target| match *target {
            Target::Error(error) => Target::Error(error * factor),
            other => other,
        };
        Self {
            limits: FidelityLimits { deviation_max: scaled(self.limits.deviation_max), ..self.limits },
            wrap: WrapChoices { wall: scaled(self.wrap.wall), ..self.wrap },
            simplify: SimplifyChoices {
                targets: self.simplify.targets.iter().map(target).collect(),
                ..self.simplify.clone()
            },
            cut_stitch: CutStitchChoices {
                epsilon: scaled(self.cut_stitch.epsilon),
                ..self.cut_stitch.clone()
            },
            filling: FillHolesChoices {
                fill: FillOptions {
                    rbf: RbfOptions { lambda: scaled(self.filling.fill.rbf.lambda), ..self.filling.fill.rbf },
                    ..self.filling.fill.clone()
                },
                ..self.filling.clone()
            },
            modeller: self.modeller.scaled(factor),
            near: scaled(self.near),
            policy: self.policy.map(|policy| policy.scaled(factor)),
            ..self.clone()
        }
    }
}
