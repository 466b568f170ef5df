//! Random operators on the zoo: the whole solid is judged after each, and each is undone.

use super::oracle::Model;
use super::zoo::zoo;
use crate::random::Random;
use meshmend::budget::Budget;
use meshmend::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use meshmend::modeller::{
    Applied, EventPolicy, IntervalSide, Operator, OperatorRefusal, Rational, Solid, apply, check,
    distance_of_growth, offset_growth, range, rational,
};
use std::collections::BTreeMap;

fn budget() -> Budget {
    Budget::unlimited()
}

#[test]
fn the_zoo_is_valid() {
    for (name, shape) in zoo() {
        let solid = shape.solid();
        assert_eq!(Model::of(&solid).unwrap().fault(), None, "{name}");
        let validity = check(&solid, &budget()).unwrap();
        assert!(validity.is_valid(), "{name}: {validity:?}");
    }
}

fn some<T: Copy>(random: &mut Random, items: &[T]) -> T {
    items[random.below(items.len())]
}

/// A growth inside the side's interval, or now and then beyond it.
fn growth(random: &mut Random, solid: &Solid, face: FaceId, side: &IntervalSide, sign: f64) -> Rational {
    let reach = match side {
        IntervalSide::Unbounded => 30.0,
        IntervalSide::Limit { limits, .. } => distance_of_growth(solid, face, &limits[0].1).abs(),
        IntervalSide::Blocked { .. } => 1.0,
    };
    let share = (1 + random.below(20)) as f64 / 16.0;
    offset_growth(solid, face, sign * (reach * share).min(60.0))
}

fn random_operator(random: &mut Random, solid: &Solid) -> Operator {
    let topology = solid.topology();
    let faces: Vec<FaceId> = topology.faces().collect();
    let edges: Vec<HalfEdgeId> = topology.edges().collect();
    let face = some(random, &faces);
    let sign = if random.below(2) == 0 { -1.0 } else { 1.0 };
    let edge = some(random, &edges);
    let near: Vec<FaceId> = topology
        .faces_around(topology.origin(edge))
        .chain(topology.faces_around(topology.destination(edge)))
        .collect();
    match random.below(10) {
        0..=3 => {
            let sides = range(solid, &[(face, rational(1.0))], &budget()).unwrap();
            let by = growth(random, solid, face, &sides[usize::from(sign > 0.0)], sign);
            let events = if random.below(3) == 0 { EventPolicy::Pass } else { EventPolicy::Refuse };
            Operator::Shift { faces: vec![(face, by)], events }
        }
        4 => {
            let other = some(random, &faces);
            let by = |f| offset_growth(solid, f, sign * 0.5);
            Operator::Shift { faces: vec![(face, by(face)), (other, by(other))], events: EventPolicy::Refuse }
        }
        5 | 6 => {
            let high: Vec<VertexId> =
                topology.vertices().filter(|&v| topology.faces_around(v).count() > 3).collect();
            let vertices = if high.is_empty() { topology.vertices().collect() } else { high };
            let vertex = some(random, &vertices);
            let around: Vec<FaceId> = topology.faces_around(vertex).collect();
            let face = some(random, &around);
            let sides = range(solid, &[(face, rational(1.0))], &budget()).unwrap();
            let by = growth(random, solid, face, &sides[usize::from(sign > 0.0)], sign);
            Operator::Split { vertex, face, by }
        }
        7 => Operator::Merge { edge, face: some(random, &near) },
        _ => Operator::Flip { edge, face: some(random, &near), by: None },
    }
}

fn name(operator: &Operator) -> &'static str {
    match operator {
        Operator::Shift { events: EventPolicy::Refuse, .. } => "shift",
        Operator::Shift { .. } => "shift past events",
        Operator::Split { .. } => "split",
        Operator::Merge { .. } => "merge",
        Operator::Flip { .. } => "flip",
    }
}

fn reason(refusal: &OperatorRefusal) -> String {
    let text = format!("{refusal:?}");
    text.split([' ', '(']).next().unwrap().to_owned()
}

/// Judges a state by the oracle.
fn assert_valid(solid: &Solid, what: &dyn std::fmt::Debug) {
    let fault = match Model::of(solid) {
        Ok(model) => model.fault(),
        Err(fault) => Some(fault),
    };
    assert_eq!(fault, None, "{what:?}");
}

fn assert_undone(solid: &Solid, applied: Applied, before: &Solid, operator: &Operator) -> bool {
    let mut back = solid.clone();
    let inverse = applied.inverse(solid, &budget()).unwrap();
    if let Some(inverse) = &inverse {
        let mut again = solid.clone();
        apply(&mut again, inverse, &budget()).unwrap().unwrap();
        assert!(again.is_same_as(before), "{operator:?} is not undone by {inverse:?}");
    }
    applied.undo(&mut back);
    assert!(back.is_same_as(before), "{operator:?} is not taken back");
    inverse.is_some()
}

/// Edits of one shape from one seed; how many of each kind were done and refused, and for which reasons.
fn edit(shape: usize, seed: u64, count: usize, tally: &mut BTreeMap<String, usize>) {
    let mut random = Random::new(seed);
    let (_, first) = &zoo()[shape];
    let mut solid = first.solid();
    for k in 0..count {
        if k % 24 == 0 {
            solid = first.solid();
        }
        let operator = random_operator(&mut random, &solid);
        let before = solid.clone();
        match apply(&mut solid, &operator, &budget()).unwrap() {
            Ok(applied) => {
                assert_valid(&solid, &(shape, seed, k, &operator));
                let has_inverse = assert_undone(&solid, applied, &before, &operator);
                *tally.entry(format!("{}: done", name(&operator))).or_default() += 1;
                if !has_inverse {
                    *tally.entry(format!("{}: no inverse operator", name(&operator))).or_default() += 1;
                }
            }
            Err(refusal) => {
                assert!(solid.is_same_as(&before), "a refused operator has changed something: {operator:?}");
                let key = format!("{}: {}", name(&operator), reason(&refusal));
                *tally.entry(key).or_default() += 1;
                assert!(
                    !matches!(refusal, OperatorRefusal::Invalid(_)),
                    "{shape} {seed} {k} {operator:?}: {refusal:?}"
                );
            }
        }
    }
}

#[test]
#[allow(clippy::print_stdout, reason = "the campaign's table")]
fn modeller_random_operators_on_the_zoo_keep_every_solid_valid() {
    // Runs of each shape, and operators of each run.
    let (runs, operators) = (crate::support::cases(1, 40), crate::support::cases(24, 1200));
    let shapes = zoo().len();
    let tallies = crate::support::on_all_cores(shapes * runs, |run| {
        let mut tally = BTreeMap::new();
        edit(run % shapes, 1000 + run as u64, operators, &mut tally);
        tally
    });
    let mut all: BTreeMap<String, usize> = BTreeMap::new();
    for (key, n) in tallies.into_iter().flatten() {
        *all.entry(key).or_default() += n;
    }
    println!("| operator and outcome | count |");
    println!("|---|---|");
    for (key, n) in all {
        println!("| {key} | {n} |");
    }
}
