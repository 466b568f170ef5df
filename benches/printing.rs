//! All measures for printing of a dented sphere of about a million triangles; most of the time is that of walls and gaps.

#[path = "support/dented_sphere.rs"]
mod dented_sphere;

use self::dented_sphere::dented_sphere;
use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::mesh::Soup;
use meshmend::printing::{Printing, PrintingPolicy, measure};
use std::hint::black_box;

/// The dented sphere with a radius of 50 mm.
fn sphere(columns: u32, rows: u32) -> Soup {
    let (positions, triangles) = dented_sphere(columns, rows);
    let positions = positions.into_iter().map(|p| p * 50.0).collect();
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

fn measured(soup: &Soup) -> Printing {
    let found = measure(soup, &PrintingPolicy::default(), true, 16, &Budget::unlimited());
    found.expect("no limit").expect("there are triangles")
}

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("printing");
    group.sample_size(10);
    for (name, columns, rows) in [("0.1 M triangles", 320, 160), ("1.04 M triangles", 1000, 520)] {
        let soup = sphere(columns, rows);
        group.bench_function(name, |b| b.iter(|| measured(black_box(&soup))));
    }
    group.finish();
}

criterion_group!(printing, benches);
criterion_main!(printing);
