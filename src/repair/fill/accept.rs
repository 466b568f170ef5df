//! Which of the proposed patches may stay: those that add no defect of their own and meet nothing.

use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3, are_collinear};
use crate::mesh::{EdgeGroups, edge_of, next_corner, prev_corner};
use crate::spatial::{self, Bvh, Search};
use rustc_hash::FxHashSet;

/// Contacts to look at in one round; patches that have none among them but come later are put off.
const CONTACTS_MAX: usize = 1 << 20;

/// The mesh around the holes, with one vertex at each place, and the patches it has got so far.
pub(super) struct Surface {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) groups: EdgeGroups,
    /// Over the triangles; built when the first patch is to be tested.
    bvh: Option<Bvh>,
    patches: Vec<[u32; 3]>,
    diagonals: FxHashSet<[u32; 2]>,
}

/// A patch for one region, its corners given as boundary half-edges.
pub(super) struct Proposal {
    pub(super) region: usize,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Surface {
    pub(super) fn new(
        positions: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let groups = EdgeGroups::build(&triangles, positions.len(), budget)?;
        Ok(Self {
            positions,
            triangles,
            groups,
            bvh: None,
            patches: Vec::new(),
            diagonals: FxHashSet::default(),
        })
    }

    /// The vertex of a boundary loop at half-edge `h`.
    pub(super) fn corner(&self, h: u32) -> u32 {
        edge_of(&self.triangles, h)[1]
    }

    /// The position of that vertex.
    pub(super) fn point(&self, h: u32) -> DVec3 {
        self.positions[self.corner(h) as usize]
    }

    /// The unit normal of the triangle at half-edge `h`; zero when it is too small to have one.
    pub(super) fn normal(&self, h: u32) -> DVec3 {
        let [a, b, c] = [h, next_corner(h), prev_corner(h)].map(|h| self.point(h));
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// True when no triangle has the edge between the vertices of two corners.
    pub(super) fn is_free(&self, g: u32, h: u32) -> bool {
        self.is_free_edge(undirected(self.corner(g), self.corner(h)))
    }

    fn is_free_edge(&self, edge: [u32; 2]) -> bool {
        !self.diagonals.contains(&edge) && self.groups.find(&self.triangles, edge).is_none()
    }

    /// Accepts the proposals that are sound; says of each whether it is.
    ///
    /// Sound is: no degenerate triangle; no diagonal in use already, by the mesh, by another patch or an earlier proposal;
    /// no triangle on the vertices of another one; and exactly no contact with the mesh, with other patches or in itself.
    pub(super) fn accept(&mut self, proposals: &[Proposal], budget: &Budget) -> Result<Vec<bool>, Stopped> {
        let patches: Vec<Vec<[u32; 3]>> = proposals
            .iter()
            .map(|proposal| proposal.triangles.iter().map(|t| t.map(|h| self.corner(h))).collect())
            .collect();
        let mut claimed = FxHashSet::default();
        let mut is_sound = Vec::with_capacity(proposals.len());
        for (proposal, patch) in proposals.iter().zip(&patches) {
            budget.spend(patch.len() as u64)?;
            is_sound.push(self.claim(proposal, patch, &mut claimed));
        }
        self.reject_contacts(&patches, &mut is_sound, budget)?;
        for (patch, _) in patches.into_iter().zip(&is_sound).filter(|&(_, &sound)| sound) {
            self.diagonals.extend(diagonals(&patch).unwrap_or_default());
            self.patches.extend(patch);
        }
        Ok(is_sound)
    }

    /// Judges a patch but for contacts, and claims its diagonals.
    fn claim(&self, proposal: &Proposal, patch: &[[u32; 3]], claimed: &mut FxHashSet<[u32; 2]>) -> bool {
        let is_degenerate = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.positions[v as usize]);
            are_collinear(a, b, c)
        };
        if patch.iter().any(is_degenerate) || self.is_double_of_neighbour(proposal) {
            return false;
        }
        let Some(diagonals) = diagonals(patch) else { return false };
        let is_free = diagonals.iter().all(|edge| self.is_free_edge(*edge) && !claimed.contains(edge));
        if is_free {
            claimed.extend(diagonals);
        }
        is_free
    }

    /// True for a single triangle that has the vertices of the one beyond its rim. A patch of several triangles has a new
    /// edge in each of them, so none can be the double of another triangle.
    fn is_double_of_neighbour(&self, proposal: &Proposal) -> bool {
        let &[[g, h, i]] = &proposal.triangles[..] else { return false };
        // Half-edge `g` goes to the corner at `g`; the third vertex of its triangle is where the next half-edge goes to.
        let beyond = self.corner(next_corner(g));
        [g, h, i].map(|h| self.corner(h)).contains(&beyond)
    }

    /// Rejects proposals that meet the mesh, an accepted patch, themselves, or an earlier proposal that stays.
    fn reject_contacts(
        &mut self,
        patches: &[Vec<[u32; 3]>],
        is_sound: &mut [bool],
        budget: &Budget,
    ) -> Result<(), Stopped> {
        // Triangles of proposals come first, so that contacts, which are sorted, begin with theirs.
        let mut owner = Vec::new();
        let mut triangles = Vec::new();
        for (i, patch) in patches.iter().enumerate().filter(|&(i, _)| is_sound[i]) {
            owner.extend(std::iter::repeat_n(i, patch.len()));
            triangles.extend(patch);
        }
        if triangles.is_empty() {
            return Ok(());
        }
        let near = self.triangles_near(&triangles, budget)?;
        triangles.extend(near);
        triangles.extend(&self.patches);
        let bvh = Bvh::build(&self.positions, &triangles, None, budget)?;
        let search = Search::All { keep: CONTACTS_MAX };
        let contacts = spatial::self_contacts(&self.positions, &triangles, &bvh, None, search, budget)?;
        let mut between = Vec::new();
        for contact in &contacts.list {
            match (owner.get(contact.a as usize), owner.get(contact.b as usize)) {
                (Some(&a), Some(&b)) if a != b => between.push((a.max(b), a.min(b))),
                (Some(&a), _) => is_sound[a] = false,
                (None, _) => break,
            }
        }
        between.sort_unstable();
        for (later, earlier) in between {
            is_sound[later] &= !is_sound[earlier];
        }
        if contacts.count > contacts.list.len() as u64 {
            let last = contacts.list.last().and_then(|contact| owner.get(contact.a as usize));
            is_sound[last.map_or(patches.len(), |&last| last)..].fill(false);
        }
        Ok(())
    }
}

impl Surface {
    /// The triangles of the mesh whose boxes may meet those of `patches`.
    fn triangles_near(&mut self, patches: &[[u32; 3]], budget: &Budget) -> Result<Vec<[u32; 3]>, Stopped> {
        let bvh = match self.bvh.take() {
            Some(bvh) => bvh,
            None => Bvh::build(&self.positions, &self.triangles, None, budget)?,
        };
        let mut is_near = vec![false; self.triangles.len()];
        for t in patches {
            budget.spend(1)?;
            let bounds = Aabb::of(t.map(|v| self.positions[v as usize]));
            bvh.visit_box(bounds, budget, |id| is_near[id as usize] = true)?;
        }
        self.bvh = Some(bvh);
        Ok(self.triangles.iter().zip(is_near).filter(|&(_, near)| near).map(|(&t, _)| t).collect())
    }
}

fn undirected(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The edges inside a patch; `None` when one of them has more than two triangles.
fn diagonals(patch: &[[u32; 3]]) -> Option<Vec<[u32; 2]>> {
    let mut edges: Vec<[u32; 2]> =
        patch.iter().flat_map(|&[a, b, c]| [undirected(a, b), undirected(b, c), undirected(c, a)]).collect();
    edges.sort_unstable();
    let groups: Vec<&[[u32; 2]]> = edges.chunk_by(|a, b| a == b).collect();
    groups
        .iter()
        .all(|group| group.len() <= 2)
        .then(|| groups.into_iter().filter(|group| group.len() == 2).map(|group| group[0]).collect())
}
