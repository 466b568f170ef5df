"""Holes of known content: a ball takes whole triangles out of a closed model, or a plane cuts the model and the flat face of the cut is what is missing.

A hole is a dict: `V`, `F` what is left (all vertices that it uses), `rim` its one loop of vertex numbers, `RV`, `RF` the removed surface, `kind`, `size`.
"""
import numpy as np
from holes_models import is_closed_shell, merged

# Radius of the ball: a share of the model's diagonal, and at least this many mean edge lengths.
SIZES = {"small": (0.015, 2.5), "medium": (0.04, 5.0), "large": (0.10, 10.0)}
CREASE = 40.0
FLAT = 1e-5


class Model:
    def __init__(self, v, f):
        self.v, self.f = v, f
        self.centres = v[f].mean(1)
        cross = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
        length = np.linalg.norm(cross, axis=1)
        self.areas, self.normals = length / 2, cross / np.maximum(length, 1e-300)[:, None]
        self.size = np.linalg.norm(v.max(0) - v.min(0))
        self.edge = np.linalg.norm(v[f] - v[np.roll(f, -1, axis=1)], axis=2).mean()
        # The triangle across the edge from corner k to k + 1.
        key = f * len(v) + np.roll(f, -1, axis=1)
        back = np.roll(f, -1, axis=1) * len(v) + f
        order = np.argsort(key.ravel())
        self.across = (order[np.searchsorted(key.ravel()[order], back.ravel())] // 3).reshape(-1, 3)


def loops_of(f):
    """The boundary loops of triangles, in the direction of the triangles; None where a vertex has two ways on."""
    start, end = f.ravel(), np.roll(f, -1, axis=1).ravel()
    n = int(f.max()) + 1
    alone = ~np.isin(start * n + end, end * n + start)
    after = {}
    for a, b in zip(start[alone].tolist(), end[alone].tolist()):
        if a in after: return None
        after[a] = b
    loops = []
    while after:
        first, b = next(iter(after.items()))
        loop = [first]
        del after[first]
        while b != first:
            loop.append(b)
            b = after.pop(b, None)
            if b is None: return None
        loops.append(loop)
    return loops


def ball_hole(model, radius, rng):
    """Takes the triangles whose centre is in a ball around a random place of the surface, as far as they hang together; None when that leaves more than one simple loop."""
    seed = rng.choice(len(model.f), p=model.areas / model.areas.sum())
    weights = rng.dirichlet((1, 1, 1))
    inside = np.linalg.norm(model.centres - weights @ model.v[model.f[seed]], axis=1) < radius
    inside[seed] = True
    taken, front = {int(seed)}, [int(seed)]
    while front:
        front = [int(t) for t in np.unique(model.across[front]) if inside[t] and int(t) not in taken]
        taken.update(front)
    taken = np.array(sorted(taken))
    removed = model.f[taken]
    if len(taken) < 6 or model.areas[taken].sum() > 0.3 * model.areas.sum(): return None
    loops = loops_of(removed)
    corners, edges = len(np.unique(removed)), (3 * len(taken) + sum(map(len, loops or []))) // 2
    if loops is None or len(loops) != 1 or corners - edges + len(taken) != 1: return None
    left = np.ones(len(model.f), bool)
    left[taken] = False
    return make_hole(model.v, model.f[left], model.v, removed, loops[0])


def plane_cut(model, rng):
    """Cuts a model by a random plane through its middle and leaves away the face of the cut; None when the cut is not one simple polygon."""
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    at = model.v @ normal
    d = at - np.quantile(at, rng.uniform(0.25, 0.75))
    v = model.v.copy()
    # Vertices near the plane are moved onto it: slivers would say more about the cut than about the filling.
    near = np.abs(d) < 0.2 * model.edge
    v[near] -= d[near, None] * normal
    d[near] = 0
    v, f, d, rows = v.tolist(), model.f, d.tolist(), []
    middle = {}
    def crossing(a, b):
        k = (min(a, b), max(a, b))
        if k not in middle:
            a, b = k
            t = d[a] / (d[a] - d[b])
            middle[k] = len(v)
            v.append([p + t * (q - p) for p, q in zip(v[a], v[b])])
            d.append(0.0)
        return middle[k]
    sign = np.sign(np.array(d))[f]
    rows += f[(sign >= 0).all(1) & (sign > 0).any(1)].tolist()
    for t in f[(sign > 0).any(1) & (sign < 0).any(1)].tolist():
        polygon = []
        for a, b in zip(t, t[1:] + t[:1]):
            if d[a] >= 0: polygon.append(a)
            if d[a] * d[b] < 0: polygon.append(crossing(a, b))
        rows += [[polygon[0], p, q] for p, q in zip(polygon[1:], polygon[2:])]
    if not rows: return None
    v, f = merged(np.array(v).astype(np.float32).astype(float), np.array(rows))
    f = f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 0] != f[:, 2])]
    loops = loops_of(f)
    if not loops or len(loops) != 1 or len(loops[0]) > 1500: return None
    rim = loops[0][::-1]
    axis = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    axis /= np.linalg.norm(axis)
    cap = ears(np.c_[v[rim] @ axis, v[rim] @ np.cross(-normal, axis)])
    if cap is None: return None
    cap = np.array(rim)[cap]
    return make_hole(v, f, v, cap, rim) if is_closed_shell(v, np.vstack([f, cap])) else None


def ears(p):
    """Triangles of a simple counter-clockwise polygon (n, 2) by cutting ears off; None when it is not simple."""
    left, rows = list(range(len(p))), []
    cross = lambda a, b, c: (p[b][..., 0] - p[a][..., 0]) * (p[c][..., 1] - p[a][..., 1]) - (p[b][..., 1] - p[a][..., 1]) * (p[c][..., 0] - p[a][..., 0])
    k = 0
    while len(left) > 3:
        for _ in range(len(left)):
            k %= len(left)
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            others = np.array([x for x in left if x not in (a, b, c)])
            if cross(a, b, c) > 0 and not ((cross(a, b, others) >= 0) & (cross(b, c, others) >= 0) & (cross(c, a, others) >= 0)).any():
                rows.append((a, b, c))
                del left[k]
                k += 1
                break
            k += 1
        else: return None
    if cross(*left) <= 0: return None
    return np.array(rows + [tuple(left)])


def make_hole(v, f, rv, rf, rim):
    """`rim` runs as the removed triangles do."""
    used, g = np.unique(f, return_inverse=True)
    number = np.full(len(v), -1)
    number[used] = np.arange(len(used))
    ru, rg = np.unique(rf, return_inverse=True)
    rim_points = v[rim]
    diameter = np.linalg.norm(rim_points[:, None] - rim_points[None], axis=2).max()
    hole = dict(V=v[used], F=g.reshape(-1, 3), rim=number[rim], RV=rv[ru], RF=rg.reshape(-1, 3), diameter=float(diameter), corners=len(rim), removed=len(rf))
    hole["shape"] = shape_of(hole)
    return hole


def shape_of(hole):
    """`planar` when removed surface and rim lie in one plane (1e-5 of the diameter, as float32 rounds), `creased` when edges over which the removed surface or its rim bends by more than 40 degrees are together at least half as long as the diameter, else `curved`."""
    v, f = hole["RV"], hole["RF"]
    centre = v.mean(0)
    normal = np.linalg.svd(v - centre)[2][2]
    if np.abs((v - centre) @ normal).max() < FLAT * hole["diameter"]: return "planar"
    both = np.vstack([hole["V"], v])
    w, g = merged(both, np.vstack([hole["F"], f + len(hole["V"])]))
    cross = np.cross(w[g[:, 1]] - w[g[:, 0]], w[g[:, 2]] - w[g[:, 0]])
    normals = cross / np.maximum(np.linalg.norm(cross, axis=1), 1e-300)[:, None]
    across = Model(w, g).across
    removed = slice(len(hole["F"]), None)
    bend = np.einsum("ij,ikj->ik", normals[removed], normals[across[removed]])
    length = np.linalg.norm(w[g[removed]] - w[np.roll(g[removed], -1, axis=1)], axis=2)
    # An edge inside counts from both sides.
    inside = across[removed] >= len(hole["F"])
    sharp = (length * np.where(inside, 0.5, 1.0))[bend < np.cos(np.radians(CREASE))].sum()
    return "creased" if sharp >= hole["diameter"] / 2 else "curved"


def holes_of(v, f, seed, balls=20, cuts=2):
    """The seeded holes of a model: `balls` by a ball, sizes in turn, and up to `cuts` by a plane."""
    model, found = Model(v, f), []
    sizes = list(SIZES.items())
    for i in range(balls):
        name, (share, edges) = sizes[i % len(sizes)]
        rng = np.random.default_rng((seed, i))
        for attempt in range(60):
            # A model that has no place for a ball of this size gets a somewhat smaller one.
            hole = ball_hole(model, max(share * model.size, edges * model.edge) * 0.97**attempt, rng)
            if hole: found.append(dict(hole, kind="ball", size=name, id=f"ball-{i:02}")); break
    for i in range(cuts):
        rng = np.random.default_rng((seed, 1000 + i))
        for _ in range(25):
            hole = plane_cut(model, rng)
            if hole: found.append(dict(hole, kind="cut", size="cut", id=f"cut-{i}")); break
    return found
