//! Real meshes, cut where they are no manifold, simplified in every mode: what comes out is a manifold of the same
//! shape, and certified where the input was and the mode promises it.

use crate::support::{corpus_files, on_all_cores};
use meshmend::budget::Budget;
use meshmend::certificate::{Depth, certify};
use meshmend::formats::{Encoding, Format, ReadOptions, read, sniff, write};
use meshmend::mesh::half_edge::{Claims, HalfEdgeMesh};
use meshmend::mesh::{Soup, UnionFind, cut_singular};
use meshmend::simplify::{Mode, Simplified, SimplifyInput, SimplifyOptions, Target, simplify};
use std::path::Path;

const MODES: [(Mode, &str); 3] = [(Mode::Strict, "strict"), (Mode::Fast, "fast"), (Mode::Guarded, "guarded")];

const RATIOS: [f64; 3] = [0.5, 0.1, 0.01];

/// Triangles of a file up to which it is looked at, but in a campaign.
const SMALL: usize = 2_000;

/// What a collapse must not change.
#[derive(Debug, PartialEq)]
struct Shape {
    euler: i64,
    boundary_loops: usize,
    components: u32,
}

impl Shape {
    /// Of triangles that must be a manifold, with a half-edge mesh that has no fault.
    fn of(triangles: &[[u32; 3]], vertex_count: usize) -> Result<Self, String> {
        let budget = Budget::unlimited();
        let mesh =
            HalfEdgeMesh::from_triangles(triangles, vertex_count, &budget).map_err(|e| e.to_string())?;
        let faults = mesh.check(&Claims { is_triangular: true, ..Claims::default() }, &budget).unwrap();
        if let Some(fault) = faults.first() {
            return Err(fault.to_string());
        }
        let mut parts = UnionFind::new(vertex_count);
        let mut is_used = vec![false; vertex_count];
        for &[a, b, c] in triangles {
            parts.unite(a, b);
            parts.unite(b, c);
            for v in [a, b, c] {
                is_used[v as usize] = true;
            }
        }
        let isolated = is_used.iter().filter(|used| !**used).count() as u32;
        let components = parts.into_components().count - isolated;
        let counts = mesh.counts();
        Ok(Self { euler: counts.euler(), boundary_loops: counts.boundary_loops, components })
    }
}

/// The mesh of a file, cut; and whether the file was a valid solid. `None` for what holds no triangle.
fn manifold(path: &Path) -> Option<(Soup, bool)> {
    let bytes = std::fs::read(path).unwrap();
    let (options, budget) = (ReadOptions::default(), Budget::unlimited());
    let encoding = sniff(&bytes, None).ok()?;
    let mut soup = read(&bytes, encoding, &options, &budget).ok()?;
    if std::env::var_os("MESHMEND_CAMPAIGN").is_none() && soup.triangles.len() > SMALL {
        return None;
    }
    let certificate = certify(&bytes, encoding, &options, Depth::FirstViolation, &budget).unwrap();
    soup.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let cut = cut_singular(&mut soup.triangles, soup.positions.len(), &budget).unwrap();
    let copies: Vec<_> = cut.copies.iter().map(|&v| soup.positions[v as usize]).collect();
    soup.positions.extend(copies);
    (!soup.triangles.is_empty()).then_some((soup, certificate.is_printable()))
}

fn is_certified(level: &Simplified) -> bool {
    let soup = Soup {
        positions: level.positions.clone(),
        triangles: level.triangles.clone(),
        face_count: level.triangles.len() as u32,
        ..Soup::default()
    };
    let budget = Budget::unlimited();
    let bytes = write(&soup, Encoding::Off, &budget).unwrap();
    certify(&bytes, Encoding::Off, &ReadOptions::default(), Depth::FirstViolation, &budget)
        .unwrap()
        .is_printable()
}

/// How many results there were, and how many of them stayed certified.
#[derive(Default, Clone, Copy)]
struct Tally {
    files: usize,
    results: usize,
    of_certified: usize,
    certified: usize,
}

/// What is wrong with the results of one file in one mode.
fn look_at(soup: &Soup, is_valid: bool, mode: Mode) -> Result<Tally, String> {
    let input = SimplifyInput::new(&soup.positions, &soup.triangles);
    let targets = RATIOS.map(Target::Ratio).to_vec();
    let options = SimplifyOptions { targets, ..SimplifyOptions::default() };
    let before = Shape::of(&soup.triangles, soup.positions.len())?;
    let levels = simplify(&input, mode, &options, &Budget::unlimited()).map_err(|e| e.to_string())?;
    let mut tally = Tally { files: 1, results: levels.len(), ..Tally::default() };
    for (ratio, level) in RATIOS.into_iter().zip(&levels) {
        let after = Shape::of(&level.triangles, level.positions.len())?;
        if after != before {
            return Err(format!("at {ratio}: {before:?} became {after:?}"));
        }
        if is_valid {
            let certified = is_certified(level);
            if mode == Mode::Guarded && !certified {
                return Err(format!("at {ratio}: no longer certified"));
            }
            tally.of_certified += 1;
            tally.certified += usize::from(certified);
        }
    }
    Ok(tally)
}

#[test]
fn real_files_keep_their_shape_in_every_mode_and_their_certificate_in_the_guarded_one() {
    let Some(files) = corpus_files(&Format::ALL.map(Format::name)) else { return };
    let outcomes = on_all_cores(files.len(), |i| {
        manifold(&files[i])
            .map(|(soup, is_valid)| MODES.map(|(mode, name)| (name, look_at(&soup, is_valid, mode))))
    });
    let mut tallies = [Tally::default(); 3];
    let mut problems = Vec::new();
    for (path, outcome) in files.iter().zip(outcomes) {
        for (sum, (name, outcome)) in tallies.iter_mut().zip(outcome.into_iter().flatten()) {
            match outcome {
                Ok(tally) => {
                    sum.files += tally.files;
                    sum.results += tally.results;
                    sum.of_certified += tally.of_certified;
                    sum.certified += tally.certified;
                }
                Err(problem) => problems.push(format!("{} {name}: {problem}", path.display())),
            }
        }
    }
    println!(
        "| mode | files | results, all of the same shape | results of certified files | of those certified |"
    );
    println!("| --- | --- | --- | --- | --- |");
    for ((_, name), tally) in MODES.iter().zip(&tallies) {
        println!(
            "| {name} | {} | {} | {} | {} |",
            tally.files, tally.results, tally.of_certified, tally.certified
        );
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
    assert!(tallies[2].of_certified > 100, "{} results of certified files", tallies[2].of_certified);
}
