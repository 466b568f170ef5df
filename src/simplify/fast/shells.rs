//! Whether closed shells still lie in each other as they did, and none is inside out.

use super::check::{RoundCheck, rounded, with_area};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::UnionFind;
use crate::simplify::result::SimplifyInput;
use crate::spatial::{Bvh, NO_SHELL, ShellNesting, nest};

/// The closed components of the input that meet nothing.
pub(super) struct ClosedShells {
    /// The component of each triangle of the input.
    component: Vec<u32>,
    /// For each component, whether it is closed and meets nothing.
    is_sound: Vec<bool>,
    /// How the sound components lie in the input, in each reading; none before it is asked for.
    reference: Option<Vec<ShellNesting>>,
}

/// Sound components that do not lie as they did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Moved {
    /// Component that is inside out or has others around it than before.
    component: u32,
    /// The innermost components around it, before and now.
    around: [Option<u32>; 2],
    is_inside_out: bool,
}

impl ClosedShells {
    /// The components of the input; those of the triangles `open` are not closed.
    pub(super) fn of(input: &SimplifyInput<'_>, open: &[u32], budget: &Budget) -> Result<Self, Stopped> {
        let mut parts = UnionFind::new(input.positions.len());
        for block in input.triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            for &[a, b, c] in block {
                parts.unite(a, b);
                parts.unite(b, c);
            }
        }
        let parts = parts.into_components();
        let component = input.triangles.iter().map(|t| parts.of[t[0] as usize]).collect();
        let mut shells = Self { component, is_sound: vec![false; parts.count as usize], reference: None };
        for &component in &shells.component {
            shells.is_sound[component as usize] = true;
        }
        shells.exclude(open);
        Ok(shells)
    }

    /// Leaves out the components of some triangles of the input.
    pub(super) fn exclude(&mut self, triangles: &[u32]) {
        for &t in triangles {
            let is_sound = &mut self.is_sound[self.component[t as usize] as usize];
            if std::mem::take(is_sound) {
                self.reference = None;
            }
        }
    }

    /// The shell of each triangle by its number in the input, and the component of each shell.
    fn shell_of(&self, numbers: impl Iterator<Item = u32>) -> (Vec<u32>, Vec<u32>) {
        let mut shell_of_component = vec![NO_SHELL; self.is_sound.len()];
        let mut components = Vec::new();
        for (component, _) in self.is_sound.iter().enumerate().filter(|(_, is_sound)| **is_sound) {
            shell_of_component[component] = components.len() as u32;
            components.push(component as u32);
        }
        let shell = |number: u32| shell_of_component[self.component[number as usize] as usize];
        (numbers.map(shell).collect(), components)
    }

    /// The components that do not lie as in the input.
    pub(super) fn moved(
        &mut self,
        input: &SimplifyInput<'_>,
        check: &RoundCheck<'_>,
        roundings: &[bool],
        budget: &Budget,
    ) -> Result<Vec<Moved>, Stopped> {
        let reference = match self.reference.take() {
            Some(reference) => reference,
            None => self.lie_in_input(input, roundings, budget)?,
        };
        let (triangles, numbers) = check.triangles();
        let (shell_of, components) = self.shell_of(numbers.into_iter());
        let mut moved = Vec::new();
        for (r, before) in reference.iter().enumerate() {
            let positions = &check.readings[r].positions;
            let built = match check.first_bvh(r) {
                Some(_) => None,
                None => {
                    let ids = with_area(positions, &triangles, budget)?;
                    Some(Bvh::build(positions, &triangles, Some(&ids), budget)?)
                }
            };
            let Some(bvh) = built.as_ref().or_else(|| check.first_bvh(r)) else { continue };
            let now = nest(positions, &triangles, &shell_of, components.len() as u32, Some(bvh), budget)?;
            moved.extend(differences(before, &now, &components));
        }
        self.reference = Some(reference);
        Ok(moved)
    }

    fn lie_in_input(
        &self,
        input: &SimplifyInput<'_>,
        roundings: &[bool],
        budget: &Budget,
    ) -> Result<Vec<ShellNesting>, Stopped> {
        let (shell_of, components) = self.shell_of(0..input.triangles.len() as u32);
        let lie = |&is_rounded: &bool| {
            let own;
            let positions = if is_rounded {
                own = rounded(input.positions);
                &own
            } else {
                input.positions
            };
            // One shell alone lies in nothing, whatever is in the hierarchy.
            let ids = if components.len() > 1 {
                with_area(positions, input.triangles, budget)?
            } else {
                Vec::new()
            };
            let bvh = Bvh::build(positions, input.triangles, Some(&ids), budget)?;
            nest(positions, input.triangles, &shell_of, components.len() as u32, Some(&bvh), budget)
        };
        roundings.iter().map(lie).collect()
    }

    /// The merged vertices, by place, that may have moved components where they are: of a component that is inside out
    /// all; of the others those near the one that has others around it, or all of them, or all that there are.
    pub(super) fn offenders(&self, moved: &[Moved], check: &RoundCheck<'_>) -> Vec<u32> {
        let (triangles, numbers) = check.triangles();
        let component: Vec<u32> = numbers.into_iter().map(|number| self.component[number as usize]).collect();
        let positions = &check.readings[0].positions;
        let corners = |t: usize| triangles[t].map(|v| positions[v as usize]);
        let mut offenders = Vec::new();
        for Moved { component: own, around, is_inside_out } in moved {
            let is_own = |&t: &usize| component[t] == *own;
            let near = grown(Aabb::of((0..triangles.len()).filter(is_own).flat_map(corners)));
            let is_around = |t: &usize| around.contains(&Some(component[*t])) && !is_inside_out;
            let is_near = |t: &usize| is_own(t) || (is_around(t) && meets(near, Aabb::of(corners(*t))));
            let merged = |is_meant: &dyn Fn(&usize) -> bool| {
                let meant = (0..triangles.len()).filter(is_meant).flat_map(|t| triangles[t]);
                meant.filter(|&v| check.first.is_merged[v as usize]).collect::<Vec<_>>()
            };
            let closest = merged(&is_near);
            offenders.extend(if closest.is_empty() {
                merged(&|t| is_own(t) || is_around(t))
            } else {
                closest
            });
        }
        if offenders.is_empty() {
            let all = 0..check.first.is_merged.len() as u32;
            offenders.extend(all.filter(|&v| check.first.is_merged[v as usize]));
        }
        offenders.sort_unstable();
        offenders.dedup();
        offenders
    }
}

fn differences<'d>(
    before: &'d ShellNesting,
    now: &'d ShellNesting,
    components: &'d [u32],
) -> impl Iterator<Item = Moved> + 'd {
    let component = |shell: Option<u32>| shell.map(|s| components[s as usize]);
    (0..components.len()).filter_map(move |s| {
        let is_inside_out = before.is_outward[s] != now.is_outward[s];
        let around = [before.parent[s], now.parent[s]];
        let is_moved = is_inside_out || around[0] != around[1] || before.depth[s] != now.depth[s];
        is_moved.then(|| Moved { component: components[s], around: around.map(component), is_inside_out })
    })
}

/// The box with its size added on each side.
fn grown(bounds: Aabb) -> Aabb {
    let size = DVec3::splat((bounds.max - bounds.min).max_element());
    Aabb { min: bounds.min - size, max: bounds.max + size }
}

fn meets(a: Aabb, b: Aabb) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
