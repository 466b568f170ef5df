//! Numbers of half-edges: half-edge `3 t + k` goes from corner `k` of triangle `t` to the next one.

/// The triangle of half-edge `h`.
pub fn triangle_of(h: u32) -> u32 {
    h / 3
}

/// The half-edge after `h` in its triangle.
pub fn next_corner(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
pub fn prev_corner(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// The ends of half-edge `h`: where it starts and where it goes.
#[inline]
pub fn edge_of(triangles: &[[u32; 3]], h: u32) -> [u32; 2] {
    let [from, to, _] = corners_from(triangles, h);
    [from, to]
}

/// The corners of the triangle of half-edge `h`, in order: where it starts, where it goes, and the one across from it.
#[inline]
pub fn corners_from(triangles: &[[u32; 3]], h: u32) -> [u32; 3] {
    let corners = triangles[triangle_of(h) as usize];
    // The steps of `next_corner` within a triangle: those of half-edges would be divided by three again.
    let after = |k: usize| if k == 2 { 0 } else { k + 1 };
    let first = (h % 3) as usize;
    let second = after(first);
    [corners[first], corners[second], corners[after(second)]]
}
