"""Closed models with known surfaces, made here, and closed models from a folder; coordinates are float32 values, so that every tool can keep them.

A model is `(V, F)`: vertices as float64 (n, 3), triangles as int64 (m, 3), outward.
"""
import os
import numpy as np


def icosphere(levels):
    """Unit sphere of 20 * 4**levels triangles."""
    t = (1 + 5**0.5) / 2
    v = np.array([(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)], float)
    f = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                  (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    for _ in range(levels):
        e = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        e, number = np.unique(e, axis=0, return_inverse=True)
        m = v[e[:, 0]] + v[e[:, 1]]
        a, b, c = (len(v) + number.ravel()).reshape(3, -1)
        v = np.vstack([v, m / np.linalg.norm(m, axis=1, keepdims=True)])
        f = np.vstack([np.c_[f[:, 0], a, c], np.c_[f[:, 1], b, a], np.c_[f[:, 2], c, b], np.c_[a, b, c]])
    return v, f


def grid_torus(point, nu, nv):
    """Closed in both directions: `point(u, v)` with both in [0, 2 pi)."""
    u, v = np.meshgrid(2 * np.pi * np.arange(nu) / nu, 2 * np.pi * np.arange(nv) / nv, indexing="ij")
    i, j = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    at = lambda a, b: ((i + a) % nu * nv + (j + b) % nv).ravel()
    f = np.vstack([np.c_[at(0, 0), at(1, 0), at(1, 1)], np.c_[at(0, 0), at(1, 1), at(0, 1)]])
    return point(u.ravel(), v.ravel()), f


def tube(curve, radius, nu, nv):
    """A tube around a closed curve, framed by the curve's derivative and a turning normal."""
    def point(u, v):
        h = 1e-4
        c, t = curve(u), curve(u + h) - curve(u - h)
        t /= np.linalg.norm(t, axis=1, keepdims=True)
        n = curve(u + h) + curve(u - h) - 2 * c
        n -= (n * t).sum(1, keepdims=True) * t
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        return c + radius * (np.cos(v)[:, None] * n + np.sin(v)[:, None] * np.cross(t, n))
    return grid_torus(point, nu, nv)


def prism(outline, height, rings, layers):
    """A column over a star-shaped outline (k, 2) around the origin, its ends meshed in rings and its wall in layers."""
    k = len(outline)
    z = np.linspace(-height / 2, height / 2, layers + 1)
    wall = np.vstack([np.c_[outline, np.full(k, h)] for h in z])
    inner = [outline * (r / rings) for r in range(rings - 1, 0, -1)]
    ends = [np.vstack([np.c_[p, np.full(k, h)] for p in inner] + [[[0, 0, h]]]) for h in (z[0], z[-1])]
    v = np.vstack([wall, *ends])
    i = np.arange(k)
    j = (i + 1) % k
    strip = lambda low, high: np.vstack([np.c_[low + i, low + j, high + j], np.c_[low + i, high + j, high + i]])
    f = [strip(n * k, (n + 1) * k) for n in range(layers)]
    for side, (start, rim) in enumerate(((len(wall), 0), (len(wall) + len(ends[0]), layers * k))):
        rows = [rim] + [start + n * k for n in range(rings - 1)]
        end = np.vstack([strip(a, b) for a, b in zip(rows, rows[1:])] + [np.c_[rows[-1] + i, rows[-1] + j, np.full(k, start + (rings - 1) * k)]])
        f.append(end[:, ::-1] if side == 0 else end)
    return v, np.vstack(f)


def along(corners, step):
    """Points on a closed polygon, its corners among them, not farther than `step` from each other."""
    rows = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        n = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
        rows.append(a + (b - a) * (np.arange(n) / n)[:, None])
    return np.vstack(rows)


def gear_outline(teeth, inner, outer):
    turns = (np.arange(teeth)[:, None] + [0.0, 0.18, 0.32, 0.68, 0.82]) / teeth
    radius = np.tile([inner, inner, outer, outer, inner], teeth)
    angle = 2 * np.pi * turns.ravel()
    return np.c_[radius * np.cos(angle), radius * np.sin(angle)]


def round_outline(n, a=1.0, b=1.0):
    angle = 2 * np.pi * np.arange(n) / n
    return np.c_[a * np.cos(angle), b * np.sin(angle)]


def generated():
    """Name -> model. All have between 5,000 and 25,000 triangles."""
    s, f = icosphere(5)
    x, y, z = s.T
    bumps = 1 + 0.12 * np.sin(3 * x + 1) * np.sin(4 * y) + 0.08 * np.cos(5 * z + 2 * x)
    power = lambda p: s / (np.abs(s) ** p).sum(1, keepdims=True) ** (1 / p)
    knot = lambda u: np.c_[np.sin(u) + 2 * np.sin(2 * u), np.cos(u) - 2 * np.cos(2 * u), -np.sin(3 * u)]
    wave = lambda u, v: np.c_[(2 + (0.7 + 0.12 * np.cos(5 * u)) * np.cos(v)) * np.cos(u), (2 + (0.7 + 0.12 * np.cos(5 * u)) * np.cos(v)) * np.sin(u), 0.7 * np.sin(v) + 0.15 * np.sin(3 * u)]
    square = np.array([(-1, -0.7), (1, -0.7), (1, 0.7), (-1, 0.7)], float)
    cone, cone_f = prism(round_outline(96), 2.0, 16, 40)
    cone[:, :2] *= (0.95 - cone[:, 2:]) * 0.5 + 0.1
    plate, plate_f = prism(along(square, 0.05), 0.12, 18, 2)
    plate[:, 2] += 0.25 * np.sin(2.2 * plate[:, 0]) * np.cos(1.7 * plate[:, 1])
    models = dict(sphere=(s, f), ellipsoid=(s * [2.0, 1.2, 0.7], f), bumpy_ball=(s * bumps[:, None], f), rounded_cube=(power(6), f),
                  torus=grid_torus(lambda u, v: np.c_[(2 + 0.7 * np.cos(v)) * np.cos(u), (2 + 0.7 * np.cos(v)) * np.sin(u), 0.7 * np.sin(v)], 140, 48),
                  wavy_torus=grid_torus(wave, 160, 60), trefoil=tube(knot, 0.45, 320, 32), cylinder=prism(round_outline(96), 2.5, 16, 40),
                  cone=(cone, cone_f), gear=prism(along(gear_outline(16, 1.0, 1.25), 0.04), 0.6, 20, 14), box=prism(along(square, 0.05), 0.9, 16, 18), wavy_plate=(plate, plate_f))
    return {name: (v.astype(np.float32).astype(float), f if volume(v, f) > 0 else f[:, ::-1]) for name, (v, f) in models.items()}


def from_folder(folder, most=24, faces=(1_200, 62_000)):
    """Name -> model for files below `folder` whose largest shell is closed, oriented and manifold: those of most triangles, and of nearly equal shapes one.

    Edges longer than 3 % of the diagonal are halved until none is left, so that whole triangles make round holes in models of few triangles too."""
    import trimesh
    found, shapes, models = [], [], {}
    for path in sorted(os.path.join(at, name) for at, _, names in os.walk(folder) for name in names):
        if not path.lower().endswith((".stl", ".obj", ".off", ".ply")) or os.path.getsize(path) > 12e6: continue
        try: m = trimesh.load(path, force="mesh", process=False, skip_materials=True)
        except Exception: continue
        v, f = merged(np.asarray(m.vertices, float).astype(np.float32).astype(float), np.asarray(m.faces, np.int64))
        if not 200 < len(f) <= faces[1] or not np.isfinite(v).all(): continue
        v, f = largest_shell(v, f)
        if is_closed_shell(v, f): found.append((-len(f), os.path.splitext(os.path.basename(path))[0].lower(), v, f))
    for _, name, v, f in sorted(found, key=lambda row: row[:2]):
        size = np.linalg.norm(v.max(0) - v.min(0))
        shape = np.array([area(v, f) ** 0.5, abs(volume(v, f)) ** (1 / 3), np.sort(v.max(0) - v.min(0))[0]]) / size
        if any(np.abs(shape - other).max() < 0.01 for other in shapes): continue
        v, f = halved(v, f, 0.03 * size)
        if not faces[0] <= len(f) <= faces[1] or not is_closed_shell(v, f): continue
        shapes.append(shape)
        models[name] = (v, f)
        if len(models) == most: break
    return models


def largest_shell(v, f):
    """The connected component of most triangles."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    a, b = f.ravel(), np.roll(f, -1, axis=1).ravel()
    _, label = connected_components(coo_matrix((np.ones(len(a)), (a, b)), shape=(len(v), len(v))), directed=False)
    f = f[label[f[:, 0]] == np.bincount(label[f[:, 0]]).argmax()]
    return merged(v, f)


def halved(v, f, longest):
    """Splits edges longer than `longest` in their middle, in all their triangles."""
    for _ in range(12):
        e = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        e, number = np.unique(e, axis=0, return_inverse=True)
        long = np.linalg.norm(v[e[:, 0]] - v[e[:, 1]], axis=1) > longest
        if not long.any() or len(f) > 100_000: break
        middle = np.full(len(e), -1)
        middle[long] = len(v) + np.arange(long.sum())
        v = np.vstack([v, ((v[e[long, 0]] + v[e[long, 1]]) / 2).astype(np.float32)])
        m, rows = middle[number.ravel().reshape(3, -1).T], []
        for t, cut in zip(f.tolist(), m.tolist()):
            marked = sum(x >= 0 for x in cut)
            if marked == 0: rows.append(t); continue
            k = cut.index(-1) + 1 if marked == 2 else next(i for i, x in enumerate(cut) if x >= 0)
            (a, b, c), (p, q, r) = np.roll(t, -k).tolist(), np.roll(cut, -k).tolist()
            if marked == 1: rows += [[a, p, c], [p, b, c]]
            elif marked == 2: rows += [[p, b, q], [a, p, q], [a, q, c]]
            else: rows += [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
        f = np.array(rows)
    return v, f


def area(v, f):
    return np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1).sum() / 2


def volume(v, f):
    a, b, c = (v - v.mean(0))[f].swapaxes(0, 1)
    return (a * np.cross(b, c)).sum() / 6


def merged(v, f):
    """One vertex at each place, unused ones gone."""
    if not len(f): return v, f
    places, number = np.unique(v + 0.0, axis=0, return_inverse=True)
    f = number.ravel()[f]
    used, f = np.unique(f, return_inverse=True)
    return places[used], f.reshape(-1, 3)


def is_closed_shell(v, f):
    """One component; each edge in two triangles that run it both ways; each vertex in one fan; volume positive."""
    if not len(f) or (f[:, 0] == f[:, 1]).any() or (f[:, 1] == f[:, 2]).any() or (f[:, 0] == f[:, 2]).any(): return False
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    start, end = f.ravel(), np.roll(f, -1, axis=1).ravel()
    key, back = start * len(v) + end, end * len(v) + start
    if len(np.unique(key)) != len(key) or not np.array_equal(np.sort(key), np.sort(back)): return False
    graph = lambda a, b, n: connected_components(coo_matrix((np.ones(len(a)), (a, b)), shape=(n, n)), directed=False)[0]
    if graph(start, end, len(v)) != 1: return False
    # Corners of one vertex are joined across each edge: a vertex with two fans has two classes.
    order, other = np.argsort(key), np.argsort(back)
    corner, far = order, (other // 3) * 3 + (other % 3 + 1) % 3
    if graph(corner, far, len(key)) != len(v): return False
    return volume(v, f) > 0
