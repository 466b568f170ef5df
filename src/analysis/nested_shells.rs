//! Inverted, badly nested and empty shells.
//!
//! The sign of a volume is exact for every shell. What lies inside what is exact too, but decided only among shells that
//! meet nothing; of a shell that meets another part, or perhaps lies in one that cannot be told inside from outside,
//! nothing is said, except that it is inverted where the boxes show that nothing can be around it.

use super::around::{Enclosure, around, part_boxes};
use super::shells::OrientedShell;
use super::{Context, DefectCode, Finding, Witness, double_skins};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::Sign;
use crate::spatial::{NO_SHELL, nest};

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let Ways { inverted, misnested, nested } = ways(cx)?;
    let flat: Vec<OrientedShell> = cx.shells.iter().copied().filter(|s| s.volume_sign.is_zero()).collect();
    let finding =
        |code, shells: &[OrientedShell]| Finding::of(code, shells, cx.samples, |shell| witness(cx, shell));
    Ok([
        finding(DefectCode::InvertedShell, &inverted),
        finding(DefectCode::MisnestedShell, &misnested),
        finding(DefectCode::ZeroVolumeShell, &flat),
        double_skins::find(cx, &nested)?,
    ]
    .concat())
}

fn witness(cx: &Context<'_>, shell: &OrientedShell) -> Witness {
    let mut witness = cx.part_witness(shell.part);
    witness.figures.push(("volume", shell.volume));
    witness
}

/// How the shells lie and point.
#[derive(Debug, Default)]
struct Ways {
    /// Shells that point inward with nothing around them.
    inverted: Vec<OrientedShell>,
    /// Shells that point as the one around them does.
    misnested: Vec<OrientedShell>,
    /// Shells and the next one inside each of them.
    nested: Vec<(OrientedShell, OrientedShell)>,
}

fn ways(cx: &Context<'_>) -> Result<Ways, Stopped> {
    let mut ways = Ways::default();
    if cx.shells.is_empty() {
        return Ok(ways);
    }
    let is_free = free_shells(cx)?;
    let around = match cx.mesh.parts.len() {
        1 => vec![Enclosure::Nothing],
        _ => around(&part_boxes(&cx.mesh, &cx.members, cx.budget)?, &is_free, cx.budget)?,
    };
    let is_nested =
        |s: &OrientedShell| is_free[s.part as usize] && around[s.part as usize] == Enclosure::Known;
    let free: Vec<OrientedShell> = cx.shells.iter().copied().filter(|s| is_free[s.part as usize]).collect();
    let parents = if free.iter().any(is_nested) { parents(cx, &free)? } else { vec![None; free.len()] };
    let mut parent_of = vec![None; cx.mesh.parts.len()];
    for (shell, parent) in free.iter().zip(parents) {
        parent_of[shell.part as usize] = parent;
    }
    for &shell in &cx.shells {
        let parent = parent_of[shell.part as usize].filter(|_| is_nested(&shell));
        let is_alone = around[shell.part as usize] == Enclosure::Nothing || is_nested(&shell);
        ways.nested.extend(parent.map(|parent| (free[parent as usize], shell)));
        match parent {
            Some(parent) if shell.volume_sign == free[parent as usize].volume_sign => {
                ways.misnested.push(shell);
            }
            None if is_alone && shell.volume_sign == Sign::Negative => ways.inverted.push(shell),
            _ => {}
        }
    }
    Ok(ways)
}

/// For each part, whether it is a shell that meets neither itself nor another part.
fn free_shells(cx: &Context<'_>) -> Result<Vec<bool>, Stopped> {
    let mesh = &cx.mesh;
    let mut is_free = vec![false; mesh.parts.len()];
    if !cx.contacts.are_all_listed() {
        // Which parts the pairs belong to that were not kept or not found is not known.
        return Ok(is_free);
    }
    for shell in &cx.shells {
        is_free[shell.part as usize] = true;
    }
    let mut bind = |t: u32| is_free[mesh.components.of[t as usize] as usize] = false;
    cx.collinear.iter().copied().for_each(&mut bind);
    cx.repeats.iter().map(|r| r.triangle).for_each(&mut bind);
    cx.contacts
        .list
        .iter()
        .flat_map(|c| [c.a, c.b])
        .filter_map(|t| mesh.triangle_of_source(t))
        .for_each(&mut bind);
    if !cx.singular.is_empty() {
        let mut is_singular = vec![false; mesh.soup.positions.len()];
        cx.singular.iter().for_each(|&v| is_singular[v as usize] = true);
        for (t, corners) in mesh.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                cx.budget.check()?;
            }
            if corners.iter().any(|&v| is_singular[v as usize]) {
                bind(t as u32);
            }
        }
    }
    Ok(is_free)
}

/// The innermost shell around each of the `free` ones, as an index into them.
fn parents(cx: &Context<'_>, free: &[OrientedShell]) -> Result<Vec<Option<u32>>, Stopped> {
    let (positions, triangles) = (&cx.mesh.soup.positions, &cx.mesh.triangles);
    let mut shell_of = vec![NO_SHELL; triangles.len()];
    for (shell, free) in (0..).zip(free) {
        cx.members.part(free.part).iter().for_each(|&t| shell_of[t as usize] = shell);
    }
    cx.budget.check()?;
    Ok(nest(positions, triangles, &shell_of, free.len() as u32, None, cx.budget)?.parent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, joined, searched, tetrahedron, turned};
    use crate::geom::DVec3;
    use crate::mesh::Soup;

    /// How many shells are inverted, badly nested, without volume.
    fn counts(mesh: &Soup) -> [u64; 3] {
        let findings = searched(mesh).findings;
        [DefectCode::InvertedShell, DefectCode::MisnestedShell, DefectCode::ZeroVolumeShell]
            .map(|code| findings.iter().find(|f| f.code == code).map_or(0, |f| f.count))
    }

    /// A tetrahedron around the point (1, 1, 1) of the given size.
    fn around_one(size: f64) -> Soup {
        tetrahedron(DVec3::splat(1.0 - size / 5.0), size)
    }

    #[test]
    fn a_solid_a_cavity_and_a_solid_in_the_cavity_are_in_order() {
        let nested = joined(&[around_one(20.0), turned(around_one(8.0)), around_one(2.0)]);
        assert_eq!(counts(&nested), [0, 0, 0]);
    }

    #[test]
    fn a_shell_inside_out_is_inverted_and_told_with_its_volume() {
        let inverted = turned(tetrahedron(DVec3::ZERO, 6.0));
        assert_eq!(counts(&inverted), [1, 0, 0]);
        let witness = &found(&inverted, DefectCode::InvertedShell).unwrap().witnesses[0];
        assert_eq!(witness.figures, [("triangles", 4.0), ("volume", -36.0)]);
    }

    #[test]
    fn a_shell_that_points_as_the_one_around_it_is_badly_nested() {
        assert_eq!(counts(&joined(&[around_one(20.0), around_one(8.0)])), [0, 1, 0]);
        assert_eq!(counts(&joined(&[turned(around_one(20.0)), turned(around_one(8.0))])), [1, 1, 0]);
        assert_eq!(counts(&joined(&[turned(around_one(20.0)), around_one(8.0)])), [1, 0, 0]);
    }

    #[test]
    fn nothing_is_said_of_a_shell_inside_one_that_meets_another_part() {
        let crossing = tetrahedron(DVec3::splat(-4.0), 9.0);
        let mesh = joined(&[around_one(20.0), crossing.clone(), turned(tetrahedron(DVec3::splat(2.0), 1.0))]);
        assert_eq!(counts(&mesh), [0, 0, 0], "a cavity of the outer one as far as one can tell");
        let apart = joined(&[around_one(20.0), crossing, turned(tetrahedron(DVec3::splat(40.0), 1.0))]);
        assert_eq!(counts(&apart), [1, 0, 0], "nothing can be around it");
    }

    #[test]
    fn a_pillow_has_no_volume() {
        let mut pillow = tetrahedron(DVec3::ZERO, 1.0);
        pillow.triangles = vec![[0, 1, 2], [0, 2, 1]];
        pillow.face_count = 2;
        assert_eq!(counts(&pillow), [0, 0, 1]);
    }
}
