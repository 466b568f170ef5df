//! The nodes of a scene: which meshes stand where.

use super::part::{List, LocatedValue};
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::ReadError;
use crate::geom::DVec3;
use glam::{DAffine3, DMat3, DQuat};

/// A mesh where a node puts it.
pub(super) struct PlacedMesh<'a> {
    /// Its number.
    pub(super) mesh: usize,
    /// Where its points go; `None`: they stay.
    pub(super) transform: Option<DAffine3>,
    /// The name of the node; empty where it has none.
    pub(super) name: &'a str,
}

/// The meshes of the scene that the document shows, or of all nodes where it has none, in the order of a walk that visits a
/// node before its children; and how many nodes with a mesh are left out.
///
/// A document without nodes gives each of its meshes once.
pub(super) fn placed_meshes<'a>(
    root: &LocatedValue<'a>,
    budget: &Budget,
) -> Result<(Vec<PlacedMesh<'a>>, u64), ReadError> {
    let (nodes, meshes, scenes) = (root.list("nodes")?, root.list("meshes")?, root.list("scenes")?);
    if nodes.len() == 0 {
        return Ok((
            (0..meshes.len()).map(|mesh| PlacedMesh { mesh, transform: None, name: "" }).collect(),
            0,
        ));
    }
    let starts = match root.index("scene", &scenes)? {
        Some(scene) => starts_of(&scenes.item(scene), &nodes)?,
        None if scenes.len() > 0 => starts_of(&scenes.item(0), &nodes)?,
        None => Vec::new(),
    };
    let starts = if starts.is_empty() { roots(&nodes)? } else { starts };
    let mut walk = SceneWalk {
        nodes: &nodes,
        meshes: &meshes,
        is_visited: vec![false; nodes.len()],
        placed: Vec::new(),
    };
    // The last in the list is the next.
    let mut next: Vec<(usize, DAffine3)> =
        starts.into_iter().rev().map(|node| (node, DAffine3::IDENTITY)).collect();
    let mut steps = 0usize;
    while let Some((node, parent)) = next.pop() {
        steps += 1;
        if steps.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let (transform, children) = walk.visit(node, parent)?;
        next.extend(children.into_iter().rev().map(|child| (child, transform)));
    }
    let is_left = |&i: &usize| !walk.is_visited[i] && nodes.item(i).get("mesh").is_some();
    let left_out = (0..nodes.len()).filter(is_left).count() as u64;
    Ok((walk.placed, left_out))
}

fn starts_of(scene: &LocatedValue<'_>, nodes: &List<'_>) -> Result<Vec<usize>, ReadError> {
    scene.list("nodes")?.items().map(|node| node.as_index(nodes)).collect()
}

/// The nodes that are no children.
fn roots(nodes: &List<'_>) -> Result<Vec<usize>, ReadError> {
    let mut is_child = vec![false; nodes.len()];
    for node in nodes.items() {
        for child in node.list("children")?.items() {
            is_child[child.as_index(nodes)?] = true;
        }
    }
    Ok((0..nodes.len()).filter(|&i| !is_child[i]).collect())
}

struct SceneWalk<'w, 'a> {
    nodes: &'w List<'a>,
    meshes: &'w List<'a>,
    is_visited: Vec<bool>,
    placed: Vec<PlacedMesh<'a>>,
}

impl SceneWalk<'_, '_> {
    /// Notes the mesh of a node; gives where the node is and its children.
    fn visit(&mut self, number: usize, parent: DAffine3) -> Result<(DAffine3, Vec<usize>), ReadError> {
        let node = self.nodes.item(number);
        if std::mem::replace(&mut self.is_visited[number], true) {
            let expected = "nodes that are children of one node at most and not of themselves";
            return Err(node.wrong_with("a node that comes again", expected));
        }
        if let Some(extension) = node.get("extensions").and_then(|all| all.get("EXT_mesh_gpu_instancing")) {
            return Err(
                extension.wrong_with("instances by EXT_mesh_gpu_instancing", "a node for each instance")
            );
        }
        let transform = parent * transform_of(&node)?;
        if let Some(mesh) = node.index("mesh", self.meshes)? {
            // A mesh with a skin is placed by its joints alone.
            let is_still = node.get("skin").is_some() || transform == DAffine3::IDENTITY;
            let transform = (!is_still).then_some(transform);
            self.placed.push(PlacedMesh { mesh, transform, name: node.text("name").unwrap_or_default() });
        }
        let children = node
            .list("children")?
            .items()
            .map(|child| child.as_index(self.nodes))
            .collect::<Result<_, _>>()?;
        Ok((transform, children))
    }
}

/// The transform of a node in the frame of its parent.
fn transform_of(node: &LocatedValue<'_>) -> Result<DAffine3, ReadError> {
    if let Some(m) = node.numbers::<16>("matrix")? {
        let column = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
        let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
        return Ok(DAffine3 { matrix3, translation: column(3) });
    }
    let translation = node.numbers("translation")?.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = node.numbers("scale")?.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = match node.numbers::<4>("rotation")? {
        Some(q) => {
            // Float32 components are no unit to the last digit.
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let is_rotation = length.is_finite() && length > 0.0;
            is_rotation.then(|| DQuat::from_array(q.map(|x| x / length))).ok_or_else(|| {
                node.wrong_with("a rotation without a direction", "a unit quaternion as `rotation`")
            })?
        }
        None => DQuat::IDENTITY,
    };
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
}
