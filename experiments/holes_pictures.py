#!/usr/bin/env python3
"""Each method on the same hole: draws what was there, the hole and the patches into docs/pictures/holes-*.png. Needs numpy, scipy and pillow.

usage: holes_pictures.py [--binary PROGRAM] [--hole MODEL:HOLE ...]     holes as holes.py names them; without a corpus the models that the script makes
The colour of a patch says how far it is from what was there: green nothing, yellow 1 %, red 3 % of the hole's diameter or more.
"""
import argparse, os, subprocess, sys, tempfile, zlib
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
sys.path.insert(0, here)
import holes_cut, holes_measure, holes_models, holes_tools

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend"))
p.add_argument("--hole", nargs="*", default=["bumpy_ball:ball-02", "cylinder:ball-02"])
SIDE, FINE = 300, 3
GREY, INSIDE = np.array([0.80, 0.80, 0.82]), np.array([0.72, 0.55, 0.42])
SCALE = np.array([[0.22, 0.66, 0.36], [0.95, 0.80, 0.25], [0.82, 0.16, 0.16]])


def coloured(share):
    x = np.clip(share / 0.03, 0, 1)[:, None] ** 0.63
    return np.where(x < 0.5, SCALE[0] + (SCALE[1] - SCALE[0]) * 2 * x, SCALE[1] + (SCALE[2] - SCALE[1]) * (2 * x - 1))


def drawn(v, f, colours, is_patch, view, centre, reach):
    """An orthographic picture by z-buffer: light from the camera's upper left, edges of triangles thin, of patches darker."""
    n = SIDE * FINE
    side = np.cross([0.0, 0.0, 1.0] if abs(view[2]) < 0.9 else [0.0, 1.0, 0.0], view)
    side /= np.linalg.norm(side)
    up = np.cross(view, side)
    at = np.c_[(v - centre) @ side, (v - centre) @ up, (v - centre) @ view]
    pixel = np.c_[(at[:, 0] / reach + 1) * n / 2, (1 - at[:, 1] / reach) * n / 2]
    cross = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    normal = cross / np.maximum(np.linalg.norm(cross, axis=1), 1e-300)[:, None]
    light = 0.55 * view + 0.6 * up - 0.5 * side
    light /= np.linalg.norm(light)
    depth, image = np.full((n, n), -np.inf), np.ones((n, n, 3))
    for t in range(len(f)):
        (ax, ay), (bx, by), (cx, cy) = pixel[f[t]]
        x0, x1 = max(0, int(min(ax, bx, cx))), min(n - 1, int(max(ax, bx, cx)) + 1)
        y0, y1 = max(0, int(min(ay, by, cy))), min(n - 1, int(max(ay, by, cy)) + 1)
        double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if x0 > x1 or y0 > y1 or abs(double) < 1e-9: continue
        x, y = np.meshgrid(np.arange(x0, x1 + 1) + 0.5, np.arange(y0, y1 + 1) + 0.5)
        b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / double
        c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / double
        a = 1 - b - c
        z = a * at[f[t, 0], 2] + b * at[f[t, 1], 2] + c * at[f[t, 2], 2]
        window = (slice(y0, y1 + 1), slice(x0, x1 + 1))
        seen = (a >= 0) & (b >= 0) & (c >= 0) & (z > depth[window])
        if not seen.any(): continue
        front = normal[t] @ view > 0
        shade = 0.55 + 0.45 * max(0.0, (normal[t] if front else -normal[t]) @ light)
        colour = (colours[t] if front else INSIDE) * shade
        lengths = np.linalg.norm(pixel[f[t]] - np.roll(pixel[f[t]], -1, axis=0), axis=1)
        near = np.minimum(np.minimum(a * abs(double) / lengths[1], b * abs(double) / lengths[2]), c * abs(double) / lengths[0]) < (1.3 if is_patch[t] else 0.8)
        pixels = np.where(near[..., None], colour * (0.45 if is_patch[t] else 0.78), colour)
        image[window][seen] = pixels[seen]
        depth[window][seen] = z[seen]
    return image.reshape(SIDE, FINE, SIDE, FINE, 3).mean((1, 3))


def filled(hole, method):
    with tempfile.TemporaryDirectory() as d:
        holes_tools.write_off(d + "/in.off", hole["V"], hole["F"])
        subprocess.run([o.binary, "fill-holes", d + "/in.off", "-o", d + "/out.off", "--method", method], capture_output=True, timeout=300, check=True)
        return holes_tools.read_off(d + "/out.off")


def picture(model, name, hole):
    from PIL import Image, ImageDraw
    centre, d = hole["V"][hole["rim"]].mean(0), hole["diameter"]
    t = hole["RV"][hole["RF"]]
    view = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]).sum(0)
    view /= np.linalg.norm(view)
    axis = np.cross(view, [0.3, -0.5, 0.8])
    # From aside, so that a dome is seen from a disk.
    view = view + 1.1 * axis / np.linalg.norm(axis)
    view /= np.linalg.norm(view)
    whole = np.vstack([hole["V"], hole["RV"]]), np.vstack([hole["F"], hole["RF"] + len(hole["V"])])
    panels = [("what was there", whole), ("the hole", (hole["V"], hole["F"]))]
    for method in ("flat", "minimal", "smooth", "creased", "rbf", "auto"):
        panels.append((method, filled(hole, method)))
    sheet = Image.new("RGB", (4 * SIDE, 2 * (SIDE + 18)), "white")
    draw = ImageDraw.Draw(sheet)
    for i, (title, (v, f)) in enumerate(panels):
        was, now = holes_measure.places(hole["V"], v)
        n = max(was.max(), now.max()) + 1
        is_patch = ~np.isin(holes_measure.key(now[f], n), holes_measure.key(was[hole["F"]], n))
        colours = np.tile(GREY, (len(f), 1))
        if is_patch.any():
            away = holes_measure.distances(v[f[is_patch]].mean(1), hole["RV"], hole["RF"]) / d
            colours[is_patch] = coloured(away) if i > 1 else SCALE[0] * 0.6 + 0.4
        image = drawn(v, f, colours, is_patch, view, centre, 0.85 * d)
        at = (i % 4 * SIDE, i // 4 * (SIDE + 18))
        sheet.paste(Image.fromarray((np.clip(image, 0, 1) * 255).astype(np.uint8)), (at[0], at[1] + 18))
        draw.text((at[0] + 6, at[1] + 3), title, fill="black")
    path = os.path.join(root, f"docs/pictures/holes-{model.replace('_', '-')}.png")
    for colours in (96, 64, 40, 24):
        sheet.quantize(colours, dither=Image.Dither.NONE).save(path, optimize=True)
        if os.path.getsize(path) <= 150_000: break
    print(path, os.path.getsize(path), f"{hole['corners']} corners, {name}, {hole['shape']}")


if __name__ == "__main__":
    o = p.parse_args()
    made = holes_models.generated()
    for wish in o.hole:
        model, name = wish.split(":")
        found = holes_cut.holes_of(*made[model], zlib.crc32(model.encode()))
        picture(model, name, next(h for h in found if h["id"] == name))
