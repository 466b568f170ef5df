//! Open parts that stand on a body without a bottom of their own, such as bosses and letters on a plate: the body closes them.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::repair::answer;
use crate::solids::cuboid;
use meshmend::formats::Encoding;
use meshmend::pipeline::{Fidelity, Options, Outcome};
use meshmend::winding::OpenShells;

const PLATE: [f64; 3] = [120.0, 60.0, 3.0];
const PLATE_VOLUME: f64 = 21_600.0;

/// A box without its bottom, with a corner at `at` on top of the plate.
fn boss(size: [f64; 3], [x, y]: [f64; 2]) -> RawSoup {
    let mut boss = cuboid(size);
    boss.triangles.retain(|corners| corners.iter().any(|&v| boss.positions[v as usize][2] > 0.0));
    boss.moved([x, y, PLATE[2]])
}

/// The plate with a row of such boxes on it.
fn row(count: u32, size: [f64; 3]) -> RawSoup {
    let at = |n: u32| [10.0 + 15.0 * f64::from(n), 10.0];
    (0..count).fold(cuboid(PLATE), |mesh, n| mesh.with(&boss(size, at(n))))
}

/// The mesh becomes one body without a cavity and with this volume, true to the file.
fn assert_one_body(mesh: &RawSoup, volume: f64, options: &Options, name: &str) {
    let report = answer(&encode(mesh, Encoding::Obj), options).report;
    assert_eq!(report.outcome, Some(Outcome::Repaired), "{name}");
    assert_eq!(report.certificate.as_ref().unwrap().shells.len(), 1, "{name}");
    let made = report.after.as_ref().unwrap().measures.volume.unwrap();
    assert!((made - volume).abs() < 1e-9 * volume, "{name}: {made} for {volume}");
    assert_eq!(report.fidelity.unwrap().word, Fidelity::Faithful, "{name}");
}

#[test]
fn bosses_without_a_bottom_are_no_sheets_however_many_there_are() {
    for size in [[7.0, 10.0, 2.0], [7.0, 10.0, 0.3], [3.0, 3.0, 8.0]] {
        for count in [1, 3, 7] {
            let volume = PLATE_VOLUME + f64::from(count) * size.iter().product::<f64>();
            let name = format!("{count} of {size:?}");
            assert_one_body(&row(count, size), volume, &Options::default(), &name);
            let turned = row(count, size).map(|[x, y, z]| [z, x, y]);
            assert_one_body(&turned, volume, &Options::default(), &format!("{name}, turned"));
        }
    }
}

#[test]
fn a_wall_that_is_thicker_than_its_letter_takes_nothing_out_of_the_plate() {
    // Narrower and lower than the wall, so that the copy behind turns inside out twice.
    let mut options = Options::default();
    options.wrap.open_shells = OpenShells::Thicken;
    options.wrap.wall = Some(1.25);
    let size = [2.0, 20.0, 0.25];
    assert_one_body(&row(2, size), PLATE_VOLUME + 2.0 * size.iter().product::<f64>(), &options, "letters");
}
