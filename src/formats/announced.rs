//! How many triangles a file may hold, as its first bytes announce it.

use super::ply::header_triangles_at_most;
use super::stl::read_binary::{announced_length, announced_triangles};

/// The most triangles that a file of `file_bytes` bytes can hold that begins with `start`, where its start says so: the
/// count of a binary STL, and what the elements of a PLY leave room for. `None`: it says nothing.
pub fn triangles_at_most(start: &[u8], file_bytes: u64) -> Option<u64> {
    if announced_length(start) == Some(file_bytes) {
        return announced_triangles(start).map(u64::from);
    }
    header_triangles_at_most(start, file_bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_binary_stl_says_how_many_there_are() {
        let mut start = vec![0; 80];
        start.extend(1000_u32.to_le_bytes());
        assert_eq!(triangles_at_most(&start, 84 + 50 * 1000), Some(1000));
        assert_eq!(triangles_at_most(&start, 84 + 50 * 999), None);
    }

    #[test]
    fn a_ply_of_strips_may_hold_a_triangle_for_each_index() {
        let header = |list: &str, layout: &str| -> String {
            format!(
                "ply\nformat {layout} 1.0\nelement vertex 100\nproperty float x\nproperty float y\nproperty float z\n\
                 element {list}\nend_header\n"
            )
        };
        let at_most = |list: &str, layout: &str| {
            let header = header(list, layout);
            triangles_at_most(header.as_bytes(), header.len() as u64 + 1200 + 1_000_000)
        };
        let binary = "binary_little_endian";
        let strips = |kind: &str| format!("tristrips 1\nproperty list int {kind} vertex_indices");
        assert_eq!(at_most(&strips("uchar"), binary), Some(999_996));
        assert_eq!(at_most(&strips("int"), binary), Some(249_999));
        let faces = "face 76923\nproperty list uchar int vertex_indices";
        let found = at_most(faces, binary).unwrap();
        assert!((76_923..76_930).contains(&found), "{found}");
        assert_eq!(at_most("face 10\nproperty list uchar int vertex_indices", "ascii"), None);
        assert_eq!(triangles_at_most(b"v 0 0 0", 7), None);
    }
}
