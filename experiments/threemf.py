#!/usr/bin/env python3
"""Every 3MF of shared/formats and of the corpus through the built binary, and what it wrote through lib3mf; prints Markdown.

usage: threemf.py [--binary PATH] > docs/campaigns/threemf.md     with a Python that has lib3mf (without it that column is empty)
A pass file must be read, a fail file refused or reported with the rule that it breaks; every disagreement is a row. Each file is repaired as well, the
result verified by another run, and compared: names, ids, build items and the bytes of every other entry.
"""
import argparse, glob, json, os, re, subprocess, sys, tempfile, zipfile
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
try:
    import lib3mf
    wrapper = lib3mf.get_wrapper()
except Exception: wrapper = None

def run(binary, *arguments):
    """Exit code, report as JSON or None, and the message of a refusal."""
    done = subprocess.run([binary, *arguments, "--json"], capture_output=True, text=True)
    try: report = json.loads(done.stdout)
    except ValueError: report = None
    if report is not None and "schema" not in report: said = report.get("detail") or report.get("title") or ""; report = None
    else: said = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else ""
    # The table names the file beside it; where it lies on this disk is nobody's business.
    for path in sorted(arguments, key=len, reverse=True): said = said.replace(f"{path}: ", "").replace(path, os.path.basename(path))
    return done.returncode, report, said.removeprefix("meshmend: ")
def by_lib3mf(path):
    """Objects and triangles as lib3mf reads them, or why it does not."""
    if wrapper is None: return None
    try:
        model = wrapper.CreateModel(); reader = model.QueryReader("3mf"); reader.SetStrictModeActive(False); reader.ReadFromFile(path)
        objects = model.GetMeshObjects(); found = []
        while objects.MoveNext():
            mesh = objects.GetCurrentMeshObject(); found.append((mesh.GetName(), mesh.GetTriangleCount(), mesh.IsManifoldAndOriented()))
        return found
    except Exception as error: return "refused: " + str(error)[:90]
def outline(path):
    """What must stay: every other entry, and of each model part all but its vertices and triangles."""
    strip = lambda text: re.sub(rb"<((?:\w+:)?)(vertices|triangles)\b.*?</\1\2>", rb"", text, flags=re.S)
    with zipfile.ZipFile(path) as z: return {n: strip(z.read(n)) if n.lower().endswith(".model") else z.read(n) for n in z.namelist()}
def text(s, n=110): return str(s).replace("|", "/").replace("\n", " ")[:n]

arguments = argparse.ArgumentParser(); arguments.add_argument("--binary", default=os.path.join(root, "target/debug/meshmend")); binary = arguments.parse_args().binary
folders = [("must_pass", "formats/must_pass"), ("must_fail", "formats/must_fail"), ("samples", "formats/3mf"), ("corpus", "corpus")]
files = [(kind, p) for kind, f in folders for p in sorted(glob.glob(os.path.join(shared, f, "**/*"), recursive=True)) if p.lower().endswith(".3mf")]
rows, disagreements, counts, seen = [], [], {}, set()
for kind, path in files:
    name = os.path.basename(path); code, report, problem = run(binary, "analyze", path)
    state, remarks = ("read" if report else "refused"), (report or {}).get("remarks", [])
    breaches = [r for r in remarks if "breaks a rule" in r]; c = counts.setdefault(kind, dict(files=0, read=0, refused=0, reported=0, repaired=0, valid=0, kept=0, lib3mf=0)); c["files"] += 1; c[state] += 1; c["reported"] += bool(report and breaches)
    if kind == "must_pass" and not report: disagreements.append((name, "must pass, and is refused: " + text(problem, 200)))
    if kind == "must_pass" and breaches: disagreements.append((name, "must pass, and is read with: " + text(breaches[0], 200)))
    if kind == "must_fail" and report and not breaches: disagreements.append((name, "must fail, and is read without a word"))
    outcome = other = kept = ""
    if report:
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out.3mf"); code, repair, problem = run(binary, "repair", path, "-o", out)
            outcome = (repair or {}).get("verdict", {}).get("outcome") or text(problem)
            if repair and outcome != "refused" and os.path.exists(out):
                c["repaired"] += 1; code, again, _ = run(binary, "verify", out); valid = bool(again and again["verdict"]["printable"]); c["valid"] += valid
                if not valid: disagreements.append((name, "the result is not verified"))
                extras = any("left out" in r for r in repair["remarks"]); kept = "same" if outline(path) == outline(out) else ("but for what is named" if extras else "DIFFERENT"); c["kept"] += kept != "DIFFERENT"
                if kept == "DIFFERENT": disagreements.append((name, "more than vertices and triangles changed"))
                before, after = by_lib3mf(path), by_lib3mf(out)
                if after is not None:
                    ok = not isinstance(after, str) and (isinstance(before, str) or [b[0] for b in before] == [a[0] for a in after]); c["lib3mf"] += ok
                    other = f"{len(after)} objects" if ok else text(after)
                    if not ok: disagreements.append((name, f"lib3mf on the result: {text(after)}; on the file: {text(before)}"))
            elif repair: outcome += ": " + text("; ".join(r["message"] for r in repair["verdict"]["reasons"]))
    parts = len((report or {}).get("parts", [])); triangles = ((report or {}).get("before") or {}).get("counts", {}).get("triangles", "")
    rows.append((kind, name, state, parts, triangles, outcome, kept, other, text("; ".join(breaches) or problem if not report or breaches else "", 160)))
print("# 3MF: every file, one by one\n\nMade by `experiments/threemf.py`. A pass file has to be read, a fail file to be refused or reported with the rule that it breaks. *Kept*: all but the\nvertices and triangles of the result is the same, byte for byte.\n")
print("| | files | read | refused | read with a breach told | repaired | verified again | rest kept | opened by lib3mf |\n|---|---|---|---|---|---|---|---|---|")
for kind, c in counts.items(): print(f"| {kind} | " + " | ".join(str(c[k]) for k in ("files", "read", "refused", "reported", "repaired", "valid", "kept")) + f" | {c['lib3mf'] if wrapper else '-'} |")
print(f"\n## Disagreements: {len(disagreements)}\n")
for name, why in disagreements: print(f"- `{name}`: {why}")
print("\n## All files\n\n| set | file | | parts | triangles | repair | rest | lib3mf | what is said |\n|---|---|---|---|---|---|---|---|---|")
for row in rows: print("| " + " | ".join(str(cell) for cell in row) + " |")
