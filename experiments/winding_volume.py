"""Volume of the points with winding number 1 or more, by lines through the mesh in random directions; independent of Meshmend.

Along each line the crossings are summed with their signs, so that the length inside is that of all its points, not of samples.
"""
import numpy as np
GRID, TURNS, MORE, CHUNK = 52, 8, 128, 4_000_000

def cleaned(v, f):
    """Bit-equal positions joined, triangles with two corners at one position dropped."""
    v = np.asarray(v, float) + 0.0; places, number = np.unique(v, axis=0, return_inverse=True); f = number.ravel()[np.asarray(f)]
    return places, f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])]
def edges_of(f):
    """Every directed edge as (lower end, upper end, sign, face), sorted by its ends, and where each undirected edge begins."""
    e = np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]); sign = np.where(e[:, 0] < e[:, 1], 1, -1); e.sort(axis=1); face = np.tile(np.arange(len(f)), 3)
    order = np.lexsort((e[:, 1], e[:, 0])); e, sign, face = e[order], sign[order], face[order]; start = np.nonzero(np.r_[True, (e[1:] != e[:-1]).any(1)])[0]
    return sign, face, start, np.diff(np.r_[start, len(e)])
def signed_volume(v, f): t = v[f] - v[f].reshape(-1, 3).mean(0); return float(np.einsum("ij,ij->i", t[:, 0], np.cross(t[:, 1], t[:, 2])).sum() / 6)

def oriented(v, f):
    """The faces turned so that the two of an edge agree, each part by the majority of its area, closed parts outward unless another is around them; and the parts."""
    sign, face, start, count = edges_of(f); two = start[count == 2]; area = np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1)
    near = [[] for _ in f]
    for a, b, differ in zip(face[two].tolist(), face[two + 1].tolist(), (sign[two] == sign[two + 1]).tolist()): near[a].append((b, differ)); near[b].append((a, differ))
    part, turned = np.full(len(f), -1), np.zeros(len(f), bool); n = 0
    for seed in range(len(f)):
        if part[seed] >= 0: continue
        part[seed] = n; stack = [seed]
        while stack:
            a = stack.pop()
            for b, differ in near[a]:
                if part[b] < 0: part[b] = n; turned[b] = turned[a] ^ differ; stack.append(b)
        n += 1
    more = np.bincount(part, weights=np.where(turned, area, -area), minlength=n) > 0; turned ^= more[part]
    f = np.where(turned[:, None], f[:, ::-1], f); negative = [i for i in range(n) if n <= 500 and signed_volume(v, f[part == i]) < 0]
    for i in negative:
        _, inside, _ = lines(v, f[part != i], v[f[part == i]].mean(1)[:1], np.eye(3)) if n > 1 else (0, [0], 0)
        if inside[0] < 1: f[part == i] = f[part == i][:, ::-1]
    return f
def open_edges(f):
    """How many edges have one triangle, and how many have not as many triangles in one direction as in the other."""
    sign, _, start, count = edges_of(f); return int((count == 1).sum()), int((np.add.reduceat(sign, start) != 0).sum())

def lines(v, f, points, turn):
    """For lines along the third axis of `turn` through `points`: length with winding number 1 or more, winding number at the point, and whether the signs cancel."""
    w, p = v @ turn.T, points @ turn.T; t = w[f]; lo, hi = t[..., :2].min(1), t[..., :2].max(1); order = np.argsort(p[:, 0]); x = p[order, 0]
    first, last = np.searchsorted(x, lo[:, 0]), np.searchsorted(x, hi[:, 0], "right"); hits = []
    cut = np.searchsorted(np.cumsum(last - first), np.arange(0, (last - first).sum() + CHUNK, CHUNK)); cut[-1] = len(f)
    for a, b in zip(cut[:-1], cut[1:]):
        n = (last - first)[a:b]
        if n.sum() == 0: continue
        k = np.repeat(np.arange(a, b), n); line = order[np.arange(n.sum()) - np.repeat(np.cumsum(n) - n, n) + np.repeat(first[a:b], n)]
        ok = (p[line, 1] >= lo[k, 1]) & (p[line, 1] <= hi[k, 1]); k, line = k[ok], line[ok]; q, c = p[line, :2], t[k]
        cross = lambda i, j: (c[:, i, 0] - q[:, 0]) * (c[:, j, 1] - q[:, 1]) - (c[:, i, 1] - q[:, 1]) * (c[:, j, 0] - q[:, 0])
        e = np.stack([cross(1, 2), cross(2, 0), cross(0, 1)], 1); s = e.sum(1); ok = ((e > 0).all(1) | (e < 0).all(1)) & (s != 0)
        hits.append((line[ok], (e[ok] * c[ok, :, 2]).sum(1) / s[ok], np.where(s[ok] > 0, -1, 1)))
    line, z, step = (np.concatenate(x) for x in zip(*hits)) if hits else (np.zeros(0, int), np.zeros(0), np.zeros(0, int))
    at = np.bincount(line, weights=np.where(z < p[line, 2], step, 0), minlength=len(p)); total = np.bincount(line, weights=step, minlength=len(p))
    order = np.lexsort((z, line)); line, z, step = line[order], z[order], step[order]; run = np.cumsum(step); begin = np.r_[True, line[1:] != line[:-1]] if len(line) else np.zeros(0, bool)
    if len(line): base = (run - step)[begin]; run = run - base[np.cumsum(begin) - 1]
    inside = (run[:-1] >= 1) & (line[1:] == line[:-1]); length = np.bincount(line[:-1][inside], weights=np.diff(z)[inside], minlength=len(p)) if len(line) else np.zeros(len(p))
    return length, at, total == 0
def winding_volume(v, f, against=None, seed=1):
    """Volume and its standard error, from TURNS random directions of GRID * GRID lines, one in each cell, and more while the error is above 0.3 % or
    leaves open, at three times, whether `against` is within 2 %; and the share of lines left out because a crossing was lost in rounding."""
    rng = np.random.default_rng(seed); found, lost = [], 0
    def unsure():
        mean, error = abs(np.mean(found)), np.std(found, ddof=1) / np.sqrt(len(found)); return error > 0.003 * mean or (against is not None and abs(abs(against - np.mean(found)) - 0.02 * mean) < 3 * error)
    while len(found) < TURNS or (len(found) < MORE and unsure()):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3))); turn[2] *= np.sign(np.linalg.det(turn)); w = v[f.ravel()] @ turn.T; lo, size = w.min(0), np.ptp(w, axis=0)
        cell = np.stack(np.meshgrid(np.arange(GRID), np.arange(GRID), indexing="ij"), -1).reshape(-1, 2); xy = lo[:2] + (cell + rng.random(cell.shape)) / GRID * size[:2]
        length, _, whole = lines(v, f, np.c_[xy, np.full(len(xy), lo[2])] @ turn, turn); lost += int((~whole).sum()); found.append(length[whole].mean() * size[0] * size[1] if whole.any() else float("nan"))
    return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(len(found))), lost / (len(found) * GRID * GRID)
