//! From faces as loops of vertices to half-edges.

use super::{FaceId, FaceLoops, HalfEdgeId, Polyhedron, VertexId};

/// Why loops are not the boundary of a solid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BuildFault {
    /// A face without an exterior loop, or a loop of fewer than three corners.
    #[error("face {face} has a loop of fewer than three corners")]
    ShortLoop {
        /// The face.
        face: u32,
    },
    /// A loop names a vertex that is not there.
    #[error("face {face} names vertex {vertex}, which is not there")]
    VertexOutOfRange {
        /// The face.
        face: u32,
        /// The number that it names.
        vertex: u32,
    },
    /// A face passes a vertex more than once.
    #[error("face {face} passes vertex {vertex} more than once")]
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// An edge with one face: a border.
    #[error("the edge of vertices {} and {} has one face only", ends[0], ends[1])]
    Border {
        /// Its ends.
        ends: [u32; 2],
    },
    /// An edge with more than two faces, or with two that run along it in the same direction.
    #[error("the edge of vertices {} and {} has three faces, or two that are oriented against each other", ends[0], ends[1])]
    SingularEdge {
        /// Its ends.
        ends: [u32; 2],
    },
    /// The faces around a vertex are more than one fan.
    #[error("the faces around vertex {vertex} are more than one fan")]
    SingularVertex {
        /// The vertex.
        vertex: u32,
    },
}

impl Polyhedron {
    /// The topology of faces given as loops of vertices, the exterior loop of each first. Vertices that no loop names are
    /// removed ones.
    ///
    /// # Errors
    /// When the loops are not those of a closed, coherently oriented manifold.
    pub fn from_loops(faces: &[Vec<Vec<u32>>], vertex_count: usize) -> Result<Self, BuildFault> {
        let mut mesh = Self {
            origin: Vec::new(),
            opposite: Vec::new(),
            next: Vec::new(),
            face: Vec::new(),
            leaving: vec![HalfEdgeId::NONE; vertex_count],
            loops: Vec::with_capacity(faces.len()),
        };
        let mut last_face = vec![u32::MAX; vertex_count];
        for (f, loops) in faces.iter().enumerate() {
            mesh.add_face(f as u32, loops, &mut last_face)?;
        }
        mesh.pair()?;
        mesh.require_one_fan_each()?;
        Ok(mesh)
    }

    fn add_face(&mut self, face: u32, loops: &[Vec<u32>], last_face: &mut [u32]) -> Result<(), BuildFault> {
        let mut starts = Vec::with_capacity(loops.len());
        for corners in loops {
            if corners.len() < 3 {
                return Err(BuildFault::ShortLoop { face });
            }
            let first = self.next.len();
            for (i, &vertex) in corners.iter().enumerate() {
                let Some(last) = last_face.get_mut(vertex as usize) else {
                    return Err(BuildFault::VertexOutOfRange { face, vertex });
                };
                if std::mem::replace(last, face) == face {
                    return Err(BuildFault::RepeatedVertex { face, vertex });
                }
                self.origin.push(VertexId::new(vertex as usize));
                self.opposite.push(HalfEdgeId::NONE);
                self.next.push(HalfEdgeId::new(first + (i + 1) % corners.len()));
                self.face.push(FaceId::new(face as usize));
                self.leaving[vertex as usize] = HalfEdgeId::new(first + i);
            }
            starts.push(HalfEdgeId::new(first));
        }
        let Some((&exterior, interior)) = starts.split_first() else {
            return Err(BuildFault::ShortLoop { face });
        };
        self.loops.push(FaceLoops { exterior, interior: interior.to_vec() });
        Ok(())
    }

    /// Finds the opposite of every half-edge by sorting them by their ends.
    fn pair(&mut self) -> Result<(), BuildFault> {
        let ends = |h: usize| {
            let (a, b) = (self.origin[h], self.origin[self.next[h].index()]);
            (a.min(b), a.max(b), a > b)
        };
        let mut order: Vec<(VertexId, VertexId, bool, u32)> = (0..self.next.len())
            .map(ends)
            .enumerate()
            .map(|(h, (a, b, turned))| (a, b, turned, h as u32))
            .collect();
        order.sort_unstable();
        for group in order.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let ends = [group[0].0, group[0].1].map(|v| v.index() as u32);
            match *group {
                [_] => return Err(BuildFault::Border { ends }),
                [(.., false, h), (.., true, g)] => {
                    self.opposite[h as usize] = HalfEdgeId::new(g as usize);
                    self.opposite[g as usize] = HalfEdgeId::new(h as usize);
                }
                _ => return Err(BuildFault::SingularEdge { ends }),
            }
        }
        Ok(())
    }

    fn require_one_fan_each(&self) -> Result<(), BuildFault> {
        let mut fans = vec![0u32; self.leaving.len()];
        for v in self.vertices() {
            fans[v.index()] = self.faces_around(v).count() as u32;
        }
        for v in &self.origin {
            fans[v.index()] = fans[v.index()].wrapping_sub(1);
        }
        match fans.iter().position(|&n| n != 0) {
            Some(vertex) => Err(BuildFault::SingularVertex { vertex: vertex as u32 }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build(faces: &[&[u32]]) -> Result<Polyhedron, BuildFault> {
        let faces: Vec<Vec<Vec<u32>>> = faces.iter().map(|f| vec![f.to_vec()]).collect();
        Polyhedron::from_loops(&faces, 8)
    }

    #[test]
    fn what_is_no_boundary_of_a_solid_is_refused_by_name() {
        let tetrahedron: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        assert!(build(&tetrahedron).is_ok());
        assert_eq!(build(&tetrahedron[..3]), Err(BuildFault::Border { ends: [0, 2] }));
        assert_eq!(build(&[&[0, 1]]), Err(BuildFault::ShortLoop { face: 0 }));
        assert_eq!(build(&[&[0, 1, 9]]), Err(BuildFault::VertexOutOfRange { face: 0, vertex: 9 }));
        assert_eq!(build(&[&[0, 1, 2, 1]]), Err(BuildFault::RepeatedVertex { face: 0, vertex: 1 }));
        let turned: [&[u32]; 4] = [&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        assert_eq!(build(&turned), Err(BuildFault::SingularEdge { ends: [0, 1] }));
        let tips: [&[u32]; 8] =
            [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3], &[0, 5, 4], &[0, 4, 6], &[4, 5, 6], &[5, 0, 6]];
        assert_eq!(build(&tips), Err(BuildFault::SingularVertex { vertex: 0 }));
    }
}
