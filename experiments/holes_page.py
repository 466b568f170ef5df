"""The page of the benchmark of hole filling: medians by shape and by size, what became of the input, and how `auto` stands to its goals."""
import json, os, statistics
import numpy as np
from holes_tools import NAMES, TITLES

SHAPES = {"curved": "curved, smooth", "creased": "curved, over sharp edges", "planar": "planar"}
SIZES = {"small": "small", "medium": "medium", "large": "large", "cut": "plane cut"}
# Distances below this are rounding: coordinates are float32 values, and a hole is rarely smaller than a hundredth of its model.
ROUNDING = 1e-6


def read(path):
    """(model, hole, tool) -> row, the last of each."""
    if not os.path.exists(path): return {}
    return {(r["model"], r["hole"], r["tool"]): r for r in map(json.loads, open(path))}


def write(path, results):
    with open(path, "w") as out: out.writelines(json.dumps(r) + "\n" for r in results.values())


def title(tool):
    return f"**`{tool[5:]}`**" if tool.startswith("ours ") else TITLES[tool]


def rms(row):
    """What is not closed is as far away as can be."""
    return row["rms"] if row.get("closed") and "rms" in row else float("inf")


def figure(x, scale=100, form=".3f"):
    return "not closed" if x == float("inf") else "0" if scale * x < 5e-6 * 100 else format(scale * x, form)


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows: print("| " + " | ".join(map(str, row)) + " |")
    print()


def middle(values):
    values = [v for v in values if v is not None]
    return statistics.median(values) if values else float("nan")


def show(results, holes, commit):
    tools = [t for t in sorted({t for _, _, t in results}, key=lambda t: (not t.startswith("ours "), t != "ours auto", NAMES.index(t) if t in NAMES else 0, t))]
    # Only holes that every tool was given.
    all_of = {t: {(m, h) for m, h, tool in results if tool == t} & holes for t in tools}
    same = set.intersection(*all_of.values()) if all_of else set()
    if not same: return print("nothing measured")
    of = {t: [results[m, h, t] for m, h in sorted(same)] for t in tools}
    some = of[tools[0]]
    models = sorted({r["model"] for r in some})
    count = lambda **is_: sum(all(r[k] == v for k, v in is_.items()) for r in some)
    print(f"# Holes with known answers\n\n{len(same)} holes in {len(models)} closed models ({sum(m.startswith('corpus_') for m in models)} of a corpus of real files, the others made by the script), engine of commit {commit}; made by `experiments/holes.py`.\n")
    print("A ball at a seeded place takes whole triangles away (20 times a model, in three sizes), or a plane cuts the model and the flat face of the cut is missing (twice). "
          "What was taken is known, so that each patch is measured against it: RMS and largest distance, dense samples both ways, as percent of the hole's diameter. "
          "A hole that is not closed counts as infinitely far. All coordinates are float32 values, so that no tool has to round them.\n")
    table(["shape of what was removed", *SIZES.values(), "all"], [[SHAPES[s], *(count(shape=s, size=z) for z in SIZES), count(shape=s)] for s in SHAPES])
    print("## Distance to the removed surface, RMS in percent of the diameter, median\n")
    where = [*({"shape": s} for s in SHAPES), *({"shape": "curved", "size": z} for z in ("small", "medium", "large"))]
    head = [*SHAPES.values(), *(f"curved, {z}" for z in ("small", "medium", "large"))]
    chosen = lambda t, is_: [r for r in of[t] if all(r[k] == v for k, v in is_.items())]
    table(["tool", *head], [[title(t), *(figure(middle(map(rms, chosen(t, w)))) for w in where)] for t in tools])
    print("## Largest distance, percent of the diameter, median\n")
    far = lambda r: r["largest"] if rms(r) < float("inf") else float("inf")
    table(["tool", *head], [[title(t), *(figure(middle(map(far, chosen(t, w)))) for w in where)] for t in tools])
    print("## Everything else\n\nJump: angle between the normals across the rim, mean along it, median over the curved holes (the removed surface itself: "
          f"{middle(r['truth'] for r in some if r['shape'] == 'curved'):.1f} degrees). Rims: holes after which every vertex and triangle of the input is still there, bit for bit. "
          "Meeting: patches that meet themselves or the rest elsewhere than at the rim, by an exact judge. Seconds: ours the whole call with files, the others the call that fills; speed is compared elsewhere.\n")
    def line(t):
        rows = of[t]
        closed = [r for r in rows if rms(r) < float("inf")]
        meeting = sum(bool(r.get("meet")) for r in rows) if any("meet" in r for r in rows) else ""
        return [title(t), f"{len(closed)} of {len(rows)}", f"{sum(r.get('kept') == 1 and r.get('identical_vertices', False) for r in closed)}", sum(not r.get("manifold") for r in closed), meeting,
                sum(bool(r.get("degenerate")) for r in rows) if meeting != "" else "", *(f"{middle(r.get('jump') for r in closed if r['shape'] == s):.1f}" for s in ("curved", "planar")),
                f"{middle(r.get('angle_median') for r in closed):.0f}", f"{middle(r['added'] / r['removed'] for r in closed):.1f}", f"{middle(r.get('seconds') for r in closed):.3f}"]
    table(["tool", "closed", "rims kept", "not manifold", "meeting", "with triangles without area", "jump, curved", "jump, planar", "smallest angle of a triangle, median", "triangles added per removed", "seconds"], map(line, tools))
    goals(of, tools)


def goals(of, tools):
    others = [t for t in tools if not t.startswith("ours ")]
    if "ours auto" not in tools or not others: return
    print("## Goals\n")
    rows = []
    for s in SHAPES:
        mine = [rms(r) for r in of["ours auto"] if r["shape"] == s]
        theirs = {t: middle(rms(r) for r in of[t] if r["shape"] == s) for t in others}
        best = min(theirs, key=theirs.get)
        floor = lambda x: max(x, ROUNDING)
        ratios = [floor(a) / floor(min(b)) for a, b in zip(mine, zip(*([rms(r) for r in of[t] if r["shape"] == s] for t in others)))]
        rows.append([SHAPES[s], title(best), figure(middle(mine)), figure(theirs[best]), f"{floor(middle(mine)) / floor(theirs[best]):.2f}", f"{middle(ratios):.2f}", f"{np.mean(np.array(ratios) <= 1.1):.0%}"])
    table(["shape", "best other tool", "median RMS of `auto`", "of the best other", "ratio of the medians", "median ratio to the best other of each hole", "at most 10 % above the best of each hole"], rows)
    ours = [r for t in tools if t.startswith("ours ") for r in of[t] if r.get("closed")]
    table(["goal", "figure"], [["rims kept bit for bit, all methods", f"{sum(r['kept'] == 1 for r in ours)} of {len(ours)}"], ["patches that meet something", sum(bool(r.get("meet")) for r in ours)],
                               ["holes left open by `auto`", sum(rms(r) == float("inf") for r in of["ours auto"])]])
