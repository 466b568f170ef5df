//! Turns and drops closed shells so that nested ones alternate, by what their directions say (policy `as_oriented`).
//!
//! From outside inward, every shell is met in the void or in the solid, and points outward or inward:
//!
//! | met in | outward | inward |
//! |---|---|---|
//! | void | a body: stays | a body inside out, or a contradiction |
//! | solid | a hidden wall: dropped, the solid is the same without it | a cavity: stays |
//!
//! A shell in the void outside of everything, or in a cavity, that points inward says that everything in it is inside out,
//! itself included: it is turned with all that it contains. Around it the winding number is 0 then; where it is not, because the
//! void lies in several bodies, the shell contradicts the others, and its tree stays as it is. Nothing becomes a cavity that was
//! not one.
//!
//! Two other policies look at places alone: `alternate` makes every second shell a cavity, `fill` keeps the outermost.

use super::{Changes, Draft};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{Components, EdgeGroups, UnionFind, edge_of, triangle_of};
use crate::spatial::{self, Bvh, Search, ShellNesting};

/// What shells inside shells mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum NestingPolicy {
    /// What their directions say.
    #[default]
    AsOriented,
    /// Every second one from outside inward is a cavity.
    Alternate,
    /// Nothing: the outermost is solid throughout.
    Fill,
}

/// What becomes of a shell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ShellFate {
    /// It stays as it is.
    Stays,
    /// Its triangles are turned.
    Turns,
    /// It is dropped.
    Goes,
}

/// How shells are nested.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct NestOptions {
    /// What shells inside shells mean.
    pub policy: NestingPolicy,
    /// It is known that no two triangles meet beyond common vertices and edges, so that need not be tested.
    pub is_embedded: bool,
    /// Shells whose fate the caller chose, each by a triangle of the soup in it.
    pub chosen: Vec<(u32, ShellFate)>,
}

/// Turns inverted trees of shells and drops hidden walls. Needs a welded draft of closed, oriented shells that do not
/// meet; any other is left as it is, for the certificate to judge.
///
/// # Errors
/// When the budget stops the run.
pub fn nest(draft: &mut Draft, options: &NestOptions, budget: &Budget) -> Result<Changes, Stopped> {
    let Some(shells) = disjoint_closed_shells(draft, budget)? else {
        return Ok(left_alone("the surface is not one of closed shells apart from each other"));
    };
    let bvh = Bvh::build(&draft.positions, &draft.triangles, None, budget)?;
    let is_embedded = options.is_embedded
        || shells.count == 1
        || spatial::self_contacts(&draft.positions, &draft.triangles, &bvh, None, Search::First, budget)?
            .count
            == 0;
    if !is_embedded {
        return Ok(left_alone("triangles pass through each other or touch"));
    }
    let nesting =
        spatial::nest(&draft.positions, &draft.triangles, &shells.of, shells.count, Some(&bvh), budget)?;
    let mut fates = match options.policy {
        NestingPolicy::AsOriented => decide(&nesting, &two_sided_shells(draft, &shells)),
        NestingPolicy::Alternate | NestingPolicy::Fill => by_place(&nesting, options.policy),
    };
    for &(triangle, fate) in &options.chosen {
        let part_of = draft.triangle_origin.iter().zip(&shells.of).filter(|&(&origin, _)| origin == triangle);
        for (_, &shell) in part_of {
            fates[shell as usize] = fate;
        }
    }
    apply(&fates, options.policy, draft, &shells, budget)
}

/// What becomes of each shell where only places count.
fn by_place(nesting: &ShellNesting, policy: NestingPolicy) -> Vec<ShellFate> {
    let fate = |(&depth, &is_outward): (&u32, &bool)| {
        let is_cavity = depth % 2 == 1;
        if policy == NestingPolicy::Fill && depth > 0 {
            ShellFate::Goes
        } else if is_outward == is_cavity {
            ShellFate::Turns
        } else {
            ShellFate::Stays
        }
    };
    nesting.depth.iter().zip(&nesting.is_outward).map(fate).collect()
}

fn left_alone(why: &str) -> Changes {
    Changes { reason: format!("shells were not nested: {why}"), ..counted(0, 0) }
}

fn counted(turned: u64, dropped: u64) -> Changes {
    Changes::counted([("shells_turned", turned), ("hidden_shells_dropped", dropped)])
}

/// The shells, if every edge has two triangles in opposite directions and no two shells share a vertex.
fn disjoint_closed_shells(draft: &Draft, budget: &Budget) -> Result<Option<Components>, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let mut shells = UnionFind::new(draft.triangles.len());
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        match *group {
            [g, h] if edge_of(&draft.triangles, g)[0] != edge_of(&draft.triangles, h)[0] => {
                shells.unite(triangle_of(g), triangle_of(h));
            }
            _ => return Ok(None),
        }
    }
    let shells = shells.into_components();
    let mut shell_at = vec![u32::MAX; draft.positions.len()];
    for (corners, &shell) in draft.triangles.iter().zip(&shells.of) {
        for &v in corners {
            let known = std::mem::replace(&mut shell_at[v as usize], shell);
            if known != u32::MAX && known != shell {
                return Ok(None);
            }
        }
    }
    Ok(Some(shells))
}

/// Shells all of whose triangles the file gives in both directions.
fn two_sided_shells(draft: &Draft, shells: &Components) -> Vec<bool> {
    let mut says_nothing = vec![!draft.two_sided.is_empty(); shells.count as usize];
    for (origin, &shell) in draft.triangle_origin.iter().zip(&shells.of) {
        says_nothing[shell as usize] &= draft.two_sided.binary_search(origin).is_ok();
    }
    says_nothing
}

/// The place just inside a shell, or outside of all.
#[derive(Debug, Clone, Copy, Default)]
struct Inside {
    is_solid: bool,
    /// What is in it is drawn inside out.
    is_inverted: bool,
    /// By the directions of the shells around it, once those that are inside out are turned.
    winding: i32,
}

/// What becomes of each shell.
fn decide(nesting: &ShellNesting, says_nothing: &[bool]) -> Vec<ShellFate> {
    let shell_count = nesting.parent.len();
    let mut from_outside_in: Vec<usize> = (0..shell_count).collect();
    from_outside_in.sort_by_key(|&s| nesting.depth[s]);
    let mut root: Vec<usize> = (0..shell_count).collect();
    let mut insides = vec![Inside::default(); shell_count];
    let mut is_contradictory = vec![false; shell_count];
    let mut fates = vec![ShellFate::Stays; shell_count];
    for s in from_outside_in {
        let around = nesting.parent[s].map_or(Inside::default(), |p| insides[p as usize]);
        root[s] = nesting.parent[s].map_or(s, |p| root[p as usize]);
        let is_met_in_solid = around.is_solid;
        let points_outward = says_nothing[s] || nesting.is_outward[s] != around.is_inverted;
        let is_inside_out = !points_outward && !is_met_in_solid && around.winding == 0;
        let is_outward = points_outward || is_inside_out;
        is_contradictory[root[s]] |= !is_outward && !is_met_in_solid;
        let step = match (says_nothing[s] && is_met_in_solid, is_outward) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => -1,
        };
        insides[s] = Inside {
            is_solid: is_outward,
            is_inverted: around.is_inverted != is_inside_out,
            winding: around.winding + step,
        };
        fates[s] = match (is_met_in_solid, is_outward) {
            (true, true) => ShellFate::Goes,
            _ if is_outward != nesting.is_outward[s] => ShellFate::Turns,
            _ => ShellFate::Stays,
        };
    }
    for s in 0..shell_count {
        if is_contradictory[root[s]] {
            fates[s] = ShellFate::Stays;
        }
    }
    fates
}

fn apply(
    fates: &[ShellFate],
    policy: NestingPolicy,
    draft: &mut Draft,
    shells: &Components,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let count = |fate: ShellFate| fates.iter().filter(|&&f| f == fate).count() as u64;
    let (turned, dropped) = (count(ShellFate::Turns), count(ShellFate::Goes));
    let fate_of = |t: usize| fates[shells.of[t] as usize];
    let mut removed_parts = Vec::new();
    let mut is_listed = vec![false; fates.len()];
    let mut is_kept = vec![true; draft.triangles.len()];
    for t in 0..draft.triangles.len() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        match fate_of(t) {
            ShellFate::Stays => {}
            ShellFate::Turns => draft.flip(t),
            ShellFate::Goes => {
                is_kept[t] = false;
                if !std::mem::replace(&mut is_listed[shells.of[t] as usize], true) {
                    removed_parts.push(draft.triangle_origin[t]);
                }
            }
        }
    }
    draft.retain_triangles(&is_kept);
    draft.drop_unused_vertices();
    Ok(Changes { reason: reason(policy, turned, dropped), removed_parts, ..counted(turned, dropped) })
}

fn reason(policy: NestingPolicy, turned: u64, dropped: u64) -> String {
    let (why_turned, why_dropped) = match policy {
        NestingPolicy::AsOriented => ("were inside out and turned", "were walls inside a solid and dropped"),
        NestingPolicy::Alternate => ("were turned, so that they alternate", "were dropped as chosen"),
        NestingPolicy::Fill => {
            ("were inside out and turned", "were inside others and dropped, so that these are filled")
        }
    };
    let turned = (turned > 0).then(|| format!("{turned} shells {why_turned}"));
    let dropped = (dropped > 0).then(|| format!("{dropped} shells {why_dropped}"));
    turned.into_iter().chain(dropped).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shells in a row, each inside the one before.
    fn nested(is_outward: &[bool]) -> ShellNesting {
        let n = is_outward.len() as u32;
        ShellNesting {
            is_outward: is_outward.to_vec(),
            parent: (0..n).map(|s| s.checked_sub(1)).collect(),
            depth: (0..n).collect(),
        }
    }

    fn fates(is_outward: &[bool]) -> Vec<ShellFate> {
        decide(&nested(is_outward), &vec![false; is_outward.len()])
    }

    #[test]
    fn a_body_with_a_cavity_and_a_body_in_it_stays() {
        assert_eq!(fates(&[true, false, true]), [ShellFate::Stays; 3]);
    }

    #[test]
    fn an_inverted_body_turns_together_with_its_cavity() {
        assert_eq!(fates(&[false, true]), [ShellFate::Turns; 2]);
    }

    #[test]
    fn an_outward_shell_inside_a_solid_is_dropped_and_its_cavity_stays() {
        assert_eq!(fates(&[true, true]), [ShellFate::Stays, ShellFate::Goes]);
        assert_eq!(fates(&[true, true, false]), [ShellFate::Stays, ShellFate::Goes, ShellFate::Stays]);
    }

    #[test]
    fn what_points_inward_in_a_cavity_is_inside_out_with_all_that_it_contains() {
        use ShellFate::{Stays, Turns};
        assert_eq!(fates(&[true, false, false]), [Stays, Stays, Turns]);
        assert_eq!(fates(&[true, false, false, true]), [Stays, Stays, Turns, Turns]);
        assert_eq!(fates(&[true, false, false, true, true]), [Stays, Stays, Turns, Turns, Stays]);
        assert_eq!(fates(&[false, true, true]), [Turns, Turns, Stays]);
    }

    #[test]
    fn what_points_inward_in_the_cavity_of_a_body_in_another_is_a_contradiction_and_left_alone() {
        assert_eq!(fates(&[true, true, false, false]), [ShellFate::Stays; 4]);
    }

    #[test]
    fn a_contradiction_in_one_tree_does_not_keep_another_from_turning() {
        let mut two_trees = nested(&[true, true, false, false, false]);
        two_trees.parent[4] = None;
        two_trees.depth[4] = 0;
        let mut fates = [ShellFate::Stays; 5];
        fates[4] = ShellFate::Turns;
        assert_eq!(decide(&two_trees, &[false; 5]), fates);
    }

    #[test]
    fn by_place_alone_every_second_shell_is_a_cavity_or_all_inner_ones_go() {
        let three = nested(&[true, true, false]);
        assert_eq!(
            by_place(&three, NestingPolicy::Alternate),
            [ShellFate::Stays, ShellFate::Turns, ShellFate::Turns]
        );
        assert_eq!(
            by_place(&three, NestingPolicy::Fill),
            [ShellFate::Stays, ShellFate::Goes, ShellFate::Goes]
        );
        assert_eq!(by_place(&nested(&[false]), NestingPolicy::Fill), [ShellFate::Turns]);
    }

    #[test]
    fn a_shell_given_in_both_directions_is_a_body_in_the_void_and_a_wall_in_the_solid() {
        assert_eq!(decide(&nested(&[false, false]), &[true, true]), [ShellFate::Turns, ShellFate::Goes]);
        assert_eq!(decide(&nested(&[true, false]), &[false, true]), [ShellFate::Stays, ShellFate::Goes]);
    }
}
