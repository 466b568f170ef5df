//! The meshes that the tests send.

/// A tetrahedron, valid.
pub(crate) const SOLID: &str = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
/// The same without its last face.
pub(crate) const OPEN: &str = "OFF\n4 3 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n";
/// A Möbius band of five triangles: no step makes a solid of it, so it is rebuilt.
pub(crate) const MOEBIUS: &str = "OFF\n5 5 0\n3 0 0\n1 2 1\n-2 1 -1\n-2 -2 2\n1 -2 0\n\
    3 0 1 2\n3 1 2 3\n3 2 3 4\n3 3 4 0\n3 4 0 1\n";
/// Two tetrahedra, one pierced by the other.
pub(crate) const CROSSING: &str = "OFF\n8 8 12\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n1 1 -1\n2 1 -1\n1 2 -1\n1 1 9\n\
    3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n";
/// A triangle whose corners are on a line: nothing to repair.
pub(crate) const LINE: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
/// A file that breaks off the rules of its format in its third line.
pub(crate) const BROKEN: &str = "OFF\n4 4 6\n0 0 zero\n";

/// A binary STL whose judgement takes seconds in a test build: a wavy sheet of `2 * side^2` triangles.
pub(crate) fn long_job(side: u32) -> Vec<u8> {
    let height = |x: u32, y: u32| (x as f32 * 0.3).sin() * (y as f32 * 0.2).cos();
    let point = |x: u32, y: u32| [x as f32, y as f32, height(x, y)];
    let mut bytes = vec![0; 80];
    bytes.extend_from_slice(&(2 * side * side).to_le_bytes());
    for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
        let corners = [point(x, y), point(x + 1, y), point(x + 1, y + 1), point(x, y + 1)];
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            bytes.extend_from_slice(&[0; 12]);
            bytes.extend(triangle.iter().flat_map(|&c: &usize| corners[c]).flat_map(f32::to_le_bytes));
            bytes.extend_from_slice(&[0; 2]);
        }
    }
    bytes
}
