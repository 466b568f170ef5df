"""What a filled hole is worth: distance to the surface that was removed, jump of the normal at the rim, what became of the input, what meets what.

`measure` is given the hole of holes_cut.py and the filled mesh; lengths are shares of the hole's diameter.
"""
import json, os, subprocess, tempfile
import numpy as np
from scipy.spatial import cKDTree

SAMPLES = 2000


def places(*clouds):
    """Numbers the places of several lists of points: equal bits (and -0 as 0), equal number."""
    _, number = np.unique(np.vstack(clouds) + 0.0, axis=0, return_inverse=True)
    return np.split(number.ravel(), np.cumsum([len(c) for c in clouds])[:-1])


def turned(t):
    """Triangles with their smallest corner first, the direction kept."""
    k = t.argmin(1)
    return np.take_along_axis(t, (k[:, None] + np.arange(3)) % 3, axis=1)


def key(t, n):
    t = turned(t)
    return (t[:, 0] * n + t[:, 1]) * n + t[:, 2]


def samples(v, f, n, seed):
    """Random points of a surface, equally dense everywhere."""
    rng = np.random.default_rng(seed)
    t = v[f]
    weight = np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1)
    if not weight.sum() > 0: return t.mean(1)
    # One sample in each of n equal shares of the area: less noise than n independent ones.
    at = (np.arange(n) + rng.random(n)) / n * weight.sum()
    i = np.minimum(np.searchsorted(np.cumsum(weight), at), len(f) - 1)
    a, b = np.sqrt(rng.random((n, 1))), rng.random((n, 1))
    return (1 - a) * t[i, 0] + a * (1 - b) * t[i, 1] + a * b * t[i, 2]


def to_triangles(p, a, b, c):
    """Distances from points to triangles, row by row (after Ericson, Real-Time Collision Detection, 5.1.5: the regions of Voronoi)."""
    dot = lambda x, y: np.einsum("ij,ij->i", x, y)
    ab, ac, ap = b - a, c - a, p - a
    d1, d2 = dot(ab, ap), dot(ac, ap)
    d3, d4 = dot(ab, p - b), dot(ac, p - b)
    d5, d6 = dot(ab, p - c), dot(ac, p - c)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    with np.errstate(divide="ignore", invalid="ignore"):
        total = va + vb + vc
        v, w = vb / total, vc / total
        near = a + v[:, None] * ab + w[:, None] * ac
        def put(where, point): near[where] = point[where]
        put((va <= 0) & (d4 - d3 >= 0) & (d5 - d6 >= 0), b + ((d4 - d3) / ((d4 - d3) + (d5 - d6)))[:, None] * (c - b))
        put((vb <= 0) & (d2 >= 0) & (d6 <= 0), a + (d2 / (d2 - d6))[:, None] * ac)
        put((vc <= 0) & (d1 >= 0) & (d3 <= 0), a + (d1 / (d1 - d3))[:, None] * ab)
        put((d6 >= 0) & (d5 <= d6), c)
        put((d3 >= 0) & (d4 <= d3), b)
        put((d1 <= 0) & (d2 <= 0), a)
    # A triangle without area can leave no number: its corners are left.
    bad = ~np.isfinite(near).all(1)
    near[bad] = a[bad]
    return np.linalg.norm(p - near, axis=1)


def distances(p, v, f):
    """Exact distance of each point to the surface: the triangles of the nearest centres first, then, for points where another could still be nearer, all whose circles reach them."""
    t = v[f]
    centre = t.mean(1)
    reach = np.linalg.norm(t - centre[:, None], axis=2).max(1)
    tree, k = cKDTree(centre), min(4, len(f))
    best, open_ = np.full(len(p), np.inf), np.arange(len(p))
    while len(open_):
        gap, near = tree.query(p[open_], k=k)
        gap, near = gap.reshape(len(open_), k), near.reshape(len(open_), k)
        i, j = np.nonzero(gap - reach[near] < best[open_, None])
        j = near[i, j]
        np.minimum.at(best, open_[i], to_triangles(p[open_[i]], t[j, 0], t[j, 1], t[j, 2]))
        if k == len(f): break
        # No other triangle is nearer than its centre less the largest reach.
        open_ = open_[gap[:, -1] - reach.max() < best[open_]]
        k = min(4 * k, len(f))
    return best


def jump(v, f, is_patch):
    """Angle in degrees between the normals across the edges between patch and rest: mean weighted by length, and largest. None where an edge has other than two triangles."""
    e = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
    order = np.lexsort((e[:, 1], e[:, 0]))
    e, owner = e[order], np.tile(np.arange(len(f)), 3)[order]
    same = (e[1:] == e[:-1]).all(1)
    a, b = owner[:-1][same], owner[1:][same]
    ends = e[:-1][same]
    rim = is_patch[a] != is_patch[b]
    if not rim.any(): return None
    cross = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    normal = cross / np.maximum(np.linalg.norm(cross, axis=1), 1e-300)[:, None]
    angle = np.degrees(np.arccos(np.clip((normal[a[rim]] * normal[b[rim]]).sum(1), -1, 1)))
    length = np.linalg.norm(v[ends[rim, 0]] - v[ends[rim, 1]], axis=1)
    return float((angle * length).sum() / length.sum()), float(angle.max())


def smallest_angles(v, f):
    """The smallest angle of each triangle, in degrees."""
    t = v[f]
    u = np.roll(t, -1, axis=1) - t
    length = np.maximum(np.linalg.norm(u, axis=2), 1e-300)
    cosine = -(u * np.roll(u, 1, axis=1)).sum(2) / (length * np.roll(length, 1, axis=1))
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))).min(1)


def crossings(v, f, is_patch, judge):
    """Pairs of triangles that meet beyond what they share, as an exact judge counts them around the patch, and triangles without area. `judge`: function of (vertices, triangles)."""
    t = v[f]
    low, high = t.min(1), t.max(1)
    if not is_patch.any(): return 0, 0
    # What the patch can meet lies in its box; pairs of kept triangles were there before.
    near = ((low <= high[is_patch].max(0)) & (high >= low[is_patch].min(0))).all(1)
    used, g = np.unique(f[near], return_inverse=True)
    return judge(v[used], g.reshape(-1, 3))


def outside_judge(program):
    """The exact judge of `--judge`: reads its own binary format, answers JSON."""
    def judge(v, f):
        with tempfile.NamedTemporaryFile(suffix=".msh") as file:
            file.write(b"MSH1" + np.array([len(v), len(f)], "<i8").tobytes() + np.ascontiguousarray(v, "<f8").tobytes() + np.ascontiguousarray(f, "<i4").tobytes())
            file.flush()
            said = json.loads(subprocess.run([program, file.name, "--only"], capture_output=True, timeout=300).stdout)
        return said["si"], said["degen"]
    return judge


def measure(hole, v, f, judge):
    """All figures of one filled hole, as a dict that JSON can keep."""
    v, f = np.asarray(v, float), np.asarray(f, np.int64)
    if not len(f) or not np.isfinite(v).all(): return {"failed": "no mesh"}
    was, now = places(hole["V"], v)
    n_places = n = max(was.max(), now.max()) + 1
    before, after = key(was[hole["F"]], n), key(now[f], n)
    is_patch = ~np.isin(after, before)
    kept = float(np.isin(before, after).mean())
    # On the places of the points, so that a file of loose triangles counts as well.
    point = np.zeros((n, 3))
    point[now] = v
    g = now[f]
    whole = (g[:, 0] != g[:, 1]) & (g[:, 1] != g[:, 2]) & (g[:, 0] != g[:, 2])
    start, end = g[whole].ravel(), np.roll(g[whole], -1, axis=1).ravel()
    there, back = np.unique(start * n + end, return_counts=True), np.unique(end * n + start, return_counts=True)
    closed = bool(np.array_equal(there[0], back[0]))
    row = dict(kept=kept, closed=closed, manifold=closed and bool((there[1] == 1).all()), added=int(is_patch.sum()), identical_vertices=bool(np.isin(was, now).all()))
    if not is_patch.any(): return dict(row, failed="nothing added")
    used, patch = np.unique(g[is_patch], return_inverse=True)
    pv, pf = point[used], patch.reshape(-1, 3)
    d = hole["diameter"]
    to_patch = distances(np.vstack([samples(hole["RV"], hole["RF"], SAMPLES, 1), hole["RV"]]), pv, pf) / d
    p = np.vstack([samples(pv, pf, SAMPLES, 2), pv])
    to_removed = distances(p, hole["RV"], hole["RF"]) / d
    if kept < 1:
        # Triangles around the hole that a tool has divided or moved: what lies on or near their old place is no part of the filling.
        gone = ~np.isin(before, after)
        beyond = distances(p, hole["V"], hole["F"][gone]) / d
        inside = beyond >= to_removed
        to_removed, n = to_removed[inside], int(inside[:SAMPLES].sum())
    else: n = SAMPLES
    squares = lambda x, n: float((x[:n] ** 2).mean()) if n else 0.0
    row.update(rms=((squares(to_patch, SAMPLES) + squares(to_removed, n)) / 2) ** 0.5, largest=float(max(to_patch.max(), to_removed.max(initial=0))))
    at_patch = np.zeros(n_places, bool)
    at_patch[used] = True
    around = whole & at_patch[g].any(1)
    angle = jump(point, g[around], is_patch[around])
    if angle: row.update(jump=angle[0], jump_largest=angle[1])
    angles = smallest_angles(pv, pf)
    row.update(angle_median=float(np.median(angles)), angle_smallest=float(angles.min()))
    if judge: row["meet"], row["degenerate"] = crossings(point, g, is_patch, judge)
    return row


def rim_of_truth(hole):
    """The jump of the normal that the removed surface itself has at the rim."""
    v = np.vstack([hole["V"], hole["RV"]])
    a, b = places(hole["V"], hole["RV"])
    point = np.zeros((max(a.max(), b.max()) + 1, 3))
    point[np.concatenate([a, b])] = v
    f = np.vstack([a[hole["F"]], b[hole["RF"]]])
    return jump(point, f, np.arange(len(f)) >= len(hole["F"]))[0]
