"""Tools that fill holes, run as they are: `python holes_tools.py NAME` answers lines `IN.npz<TAB>OUT.npz` with one line of JSON each; a tool that is not installed says so in its first answer.

Seconds are those of the call that fills, without reading, writing and building the tool's own mesh. Settings are the tools' recommended ones;
where a length of edges is asked for, it is the mean edge of the mesh. Left out, because they came out farther from what
was removed: MeshLib's `naturalSmooth`, which moves what is around the hole, and PyMeshLab's refinement, which takes seconds for a hole.
"""
import json, os, subprocess, sys, tempfile, time
import numpy as np

NAMES = ("meshlib", "meshlib_nicely", "pymeshlab", "meshfix", "cgal")
TITLES = {"meshlib": "MeshLib `fillHole`", "meshlib_nicely": "MeshLib `fillHoleNicely`",
          "pymeshlab": "PyMeshLab", "meshfix": "MeshFix", "cgal": "CGAL refine and fair"}


def write_off(path, v, f):
    with open(path, "w") as out:
        out.write(f"OFF\n{len(v)} {len(f)} 0\n" + "\n".join("%r %r %r" % tuple(p) for p in v.tolist()) + "\n" + "\n".join("3 %d %d %d" % tuple(t) for t in f.tolist()) + "\n")


def read_off(path):
    """An OFF file of triangles without colours."""
    with open(path) as file:
        words = file.readline().split()
        n, m, _ = map(int, words[1:4] if len(words) > 3 else file.readline().split())
        numbers = np.fromfile(file, sep=" ", count=3 * n + 4 * m)
    return numbers[:3 * n].reshape(n, 3), numbers[3 * n:].reshape(m, 4)[:, 1:].astype(np.int64)


def meshlib(nicely):
    import meshlib.mrmeshnumpy as mn, meshlib.mrmeshpy as mm
    def fill(v, f):
        mesh = mn.meshFromFacesVerts(np.ascontiguousarray(f, np.int32), v)
        edge, start = mesh.averageEdgeLength(), time.perf_counter()
        for hole in list(mesh.topology.findHoleRepresentiveEdges()):
            if not nicely:
                p = mm.FillHoleParams()
                p.metric = mm.getUniversalMetric(mesh)
                mm.fillHole(mesh, hole, p)
                continue
            s = mm.FillHoleNicelySettings()
            s.triangulateParams.metric = mm.getUniversalMetric(mesh)
            s.subdivideSettings.maxEdgeLen, s.subdivideSettings.maxEdgeSplits = edge, 1_000_000
            s.smoothCurvature = True
            mm.fillHoleNicely(mesh, hole, s)
        seconds = time.perf_counter() - start
        mesh.pack()
        return mn.getNumpyVerts(mesh), mn.getNumpyFaces(mesh.topology), seconds
    return fill


def pymeshlab():
    import pymeshlab as pm
    def fill(v, f):
        meshes = pm.MeshSet(verbose=False)
        meshes.add_mesh(pm.Mesh(v, f.astype(np.int32)))
        start = time.perf_counter()
        meshes.meshing_close_holes(maxholesize=1_000_000)
        seconds = time.perf_counter() - start
        mesh = meshes.current_mesh()
        return mesh.vertex_matrix(), mesh.face_matrix(), seconds
    return fill


def meshfix():
    import pymeshfix
    def fill(v, f):
        mesh = pymeshfix.PyTMesh()
        mesh.load_array(v, f.astype(np.int32))
        start = time.perf_counter()
        mesh.fill_small_boundaries(0, True)
        seconds = time.perf_counter() - start
        return *mesh.return_arrays(), seconds
    return fill


def cgal():
    """A program of your own around CGAL's `triangulate_refine_and_fair_hole` for each boundary cycle: `PROGRAM IN.off OUT.off` prints {"seconds": S}."""
    program = os.environ.get("CGAL_FILL", "cgal_fill")
    if subprocess.run(["sh", "-c", f"command -v '{program}'"], capture_output=True).returncode: raise ImportError("set CGAL_FILL to a program")
    def fill(v, f):
        with tempfile.TemporaryDirectory() as d:
            write_off(d + "/in.off", v, f)
            said = subprocess.run([program, d + "/in.off", d + "/out.off"], capture_output=True, check=True)
            return *read_off(d + "/out.off"), json.loads(said.stdout)["seconds"]
    return fill


def tool(name):
    return {"meshlib": lambda: meshlib(False), "meshlib_nicely": lambda: meshlib(True), "pymeshlab": pymeshlab, "meshfix": meshfix, "cgal": cgal}[name]()


class Worker:
    """A tool in a process of its own, so that a crash or an endless loop costs one hole."""

    def __init__(self, name, seconds=300):
        self.name, self.seconds, self.process = name, seconds, None

    def fill(self, v, f):
        """(vertices, triangles, seconds), or what went wrong in words."""
        import select
        with tempfile.TemporaryDirectory() as d:
            np.savez(d + "/in.npz", v=v, f=f)
            if not self.process:
                self.process = subprocess.Popen([sys.executable, os.path.abspath(__file__), self.name], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            try:
                self.process.stdin.write(f"{d}/in.npz\t{d}/out.npz\n")
                self.process.stdin.flush()
                if not select.select([self.process.stdout], [], [], self.seconds)[0]: raise TimeoutError
                said = json.loads(self.process.stdout.readline())
            except (OSError, ValueError, TimeoutError) as e:
                status = self.process.poll()
                self.stop()
                # An exception of this file would look like a failure of the tool.
                if status == 1: raise RuntimeError(f"the adapter of {self.name} failed") from e
                return f"longer than {self.seconds} s" if isinstance(e, TimeoutError) else "crash"
            if "error" in said: return said["error"]
            with np.load(d + "/out.npz") as out: return out["v"], out["f"], said["seconds"]

    def stop(self):
        if self.process: self.process.kill(); self.process.wait()
        self.process = None


def main():
    # What native libraries print must not get between the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    try: fill, missing = tool(sys.argv[1]), None
    except ImportError as e: missing = f"absent: {e}"
    for line in sys.stdin:
        source, target = line.rstrip("\n").split("\t")
        try:
            if missing: raise RuntimeError(missing)
            with np.load(source) as a: v, f, seconds = fill(a["v"], a["f"])
            np.savez(target, v=np.asarray(v, float), f=np.asarray(f, np.int64))
            said = {"seconds": seconds}
        except Exception as e: said = {"error": (str(e) or type(e).__name__)[:200]}
        print(json.dumps(said), file=answers, flush=True)


if __name__ == "__main__": main()
