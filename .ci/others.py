#!/usr/bin/env python3
"""Reads what the program writes with programs of others, and compares counts and values.

    others.py TOILE STUDY FOLDER PATTERNS

TOILE is the program. The database $TOILE_DB holds the results of the folder STUDY. Files go to FOLDER. PATTERNS holds
genuine pattern files, where it is there. Ends with 1 where a reader finds another value than the program says.
"""
import io
import json
import math
import os
import shutil
import sqlite3
import subprocess
import sys
from collections import Counter
from pathlib import Path

import ezdxf
import openpyxl
import pandas
import pyarrow.parquet
import pypdf
import trimesh

PROGRAM, STUDY, FOLDER, PATTERNS = sys.argv[1], sys.argv[2], Path(sys.argv[3]), Path(sys.argv[4])
DRAFT = FOLDER / "draft"
findings = []


def toile(*arguments):
    """Standard output of the program."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True)
    if done.returncode:
        findings.append(f"toile {' '.join(map(str, arguments))}: {done.returncode}: {done.stderr.decode()}")
    return done.stdout


def answer(*arguments):
    return json.loads(toile(*arguments, "--json"))


def same(what, found, wanted):
    if found != wanted:
        findings.append(f"{what}: found {found!r}, wanted {wanted!r}")


def near(what, found, wanted, within):
    if not abs(found - wanted) <= within:
        findings.append(f"{what}: found {found!r}, wanted {wanted!r} within {within}")


def scaled(value, by):
    """A value of a features file with its points scaled."""
    if isinstance(value, dict):
        return {key: scaled(inner, by) for key, inner in value.items()}
    if isinstance(value, list) and len(value) == 2 and all(isinstance(x, float) for x in value):
        return [x * by for x in value]
    return [scaled(inner, by) for inner in value] if isinstance(value, list) else value


def nest(drawn, sizes, renamed, file):
    """Writes features of all sizes of a drafted file, by scaling. Returns their perimeters by name and size."""
    features = json.loads(toile("pattern", "features", drawn))
    known = {piece["name"]: piece["perimeter_mm"] for piece in answer("pattern", "inspect", drawn)[0]["pieces"]}
    pieces, wanted = [], {}
    for k, size in enumerate(sizes):
        for piece in features["pieces"]:
            told, by = piece["information"], 0.8 + 0.05 * k
            name = renamed(told["name"])
            one = scaled({key: piece[key] for key in piece if key not in ("corners", "edges")}, by)
            pieces.append({**one, "information": {**told, "name": name, "block": name, "size": size}})
            wanted[name, size] = [by * known[told["name"]]]
    # The largest size comes first.
    file.write_text(json.dumps({**features, "pieces": pieces[::-1]}), "utf-8")
    return wanted


def perimeter(line):
    places = [vertex.dxf.location for vertex in line.vertices]
    return sum(a.distance(b) for a, b in zip(places, places[1:] + places[:1] * line.is_closed))


# What `pattern inspect` counts, by layer.
COUNTED = {"turn_points": "2", "curve_points": "3", "notches": "4", "mirror_lines": "6", "internal_lines": "8",
           "cut_outs": "11", "drill_holes": "13"}


def read_dxf(path, standard):
    """A file read by ezdxf and held against `pattern inspect`. Returns its perimeters by name and size."""
    drawing = ezdxf.readfile(path)
    audit = drawing.audit()
    same(f"{path.name}: audit", [error.message for error in audit.errors + audit.fixes], [])
    blocks = {block.name: block for block in drawing.blocks if not block.is_any_layout}
    inserted = Counter(insert.dxf.name for insert in drawing.modelspace().query("INSERT"))
    same(f"{path.name}: inserts", inserted, Counter(list(blocks)))
    said = [text.dxf.text for text in drawing.modelspace().query("TEXT")]
    same(f"{path.name}: standard", any("D 6673" in text for text in said), standard == "astm")
    same(f"{path.name}: unit", "Units: METRIC" in said, True)
    pieces = answer("pattern", "inspect", path)[0]["pieces"]
    same(f"{path.name}: blocks", len(blocks), len(pieces))
    found = {}
    for piece, (name, block) in zip(pieces, blocks.items()):
        what = f"{path.name}: {name}"
        own = [text.dxf.text for text in block.query("TEXT[layer=='1']") if not text.dxf.text.startswith("#")]
        for key, text in (("name", "Piece Name"), ("size", "Size")):
            same(f"{what}: {key}", [t for t in own if t.startswith(f"{text}: ")],
                 [f"{text}: {piece[key]}"] if piece[key] else [])
        outlines = block.query("POLYLINE[layer=='1']")
        same(f"{what}: outlines", len(outlines), 1)
        near(f"{what}: perimeter", perimeter(outlines[0]), piece["perimeter_mm"], 0.1)
        counts = Counter(entity.dxf.layer for entity in block if entity.dxftype() != "TEXT")
        same(f"{what}: counts", {key: counts[at] for key, at in COUNTED.items()}, {key: piece[key] for key in COUNTED})
        same(f"{what}: grain", counts["7"], int(piece["grain_mm"] is not None))
        found.setdefault((piece["name"], piece["size"]), []).append(perimeter(outlines[0]))
    return found


def converted(source, out, standard, wanted, *more):
    """Converts a pattern to DXF and compares its pieces with the wanted perimeters by name and size."""
    toile("pattern", "convert", source, "--standard", standard, "-o", out, *more)
    found = read_dxf(out, standard)
    same(f"{out.name}: pieces", sorted(map(str, found)), sorted(map(str, wanted)))
    for key in found.keys() & wanted.keys():
        for a, b in zip(sorted(found[key]), sorted(wanted[key])):
            near(f"{out.name}: {key}", a, b, 0.1)
    return sum(map(len, found.values()))


def read_rules(path, standard, sizes):
    """A grade rule table line by line: its head, its sizes in order, its rules and its name as the DXF has them."""
    lines = path.read_text("utf-8").splitlines()
    head = dict(line.split(": ", 1) for line in lines if ": " in line)
    heads = {"aama": "ANSI/AAMA VERSION: 1.0.0", "astm": "ASTM/D13Proposal 1 Version: D 6673-04"}
    same(f"{path.name}: head", lines[0], heads[standard])
    same(f"{path.name}: sizes", head["SIZE LIST"].split(), sizes)
    drawing = ezdxf.readfile(path.with_suffix(".dxf"))
    named = [text.dxf.text for text in drawing.modelspace().query("TEXT") if text.dxf.text.startswith("Grade Rule")]
    same(f"{path.name}: name in the DXF", named, [f"Grade Rule Table: {head['GRADE RULE TABLE']}"])
    used = {text.dxf.text[2:] for block in drawing.blocks for text in block.query("TEXT") if text.dxf.text[0] == "#"}
    rules = [rule.removesuffix("END").replace(",", " ").split() for rule in " ".join(lines).split("RULE: DELTA ")[1:]]
    same(f"{path.name}: rules", sorted(rule[0] for rule in rules), sorted(used))
    same(f"{path.name}: numbers", {len([float(x) for x in rule[1:]]) for rule in rules}, {2 * len(sizes)})


def patterns():
    for model in ("tshirt", "trousers"):
        toile("pattern", "draft", model, "-o", DRAFT)
    letters = ["3XS", "XXS", "XS", "S", "M", "L", "XL", "XXL", "3XL"]
    double = [f"{k}/{k + 2}" for k in range(30, 48, 2)]
    blocks = 0
    for drawn, sizes, prefix in (("tshirt-m", letters, ""), ("trousers-m", letters, ""), ("tshirt-s", double, ""),
                                 ("tshirt-l", letters, "Перёд "), ("trousers-l", double, "Żółty перед ")):
        file = FOLDER / f"{drawn}.nest.json"
        wanted = nest(DRAFT / f"{drawn}.dxf", sizes, lambda name: prefix + name, file)
        sample = {key: mm for key, mm in wanted.items() if key[1] == sizes[4]}
        for standard in ("aama", "astm"):
            out = [FOLDER / f"{drawn}-{standard}-{what}.dxf" for what in ("nest", "graded", "again")]
            blocks += converted(file, out[0], standard, wanted)
            blocks += converted(out[0], out[1], standard, sample, "--with-rul", "--size", sizes[4])
            read_rules(out[1].with_suffix(".rul"), standard, sizes)
            blocks += converted(out[1], out[2], standard, wanted, "--rul", out[1].with_suffix(".rul"))
    genuine = sorted((PATTERNS / "freesewing").glob("*.dxf"))
    for file in genuine:
        wanted, read = {}, answer("pattern", "inspect", file)[0]
        changed = ("cut away", "quality curve")
        mended = " ".join(warning for warning in read["warnings"] if any(said in warning for said in changed))
        for piece in read["pieces"]:
            # The length of an outline that was mended, or follows its quality curve, is that of the drawn one.
            known = wanted.setdefault((piece["name"], piece["size"]), [])
            known.extend([] if f"`{piece['block']}`" in mended else [piece["perimeter_mm"]])
        blocks += converted(file, FOLDER / file.name, "astm", wanted)
    files = len(list(FOLDER.glob("*.dxf")))
    print(f"  ezdxf: {files} DXF files, {len(genuine)} of them genuine patterns, {blocks} blocks")


def garmentcode():
    out = FOLDER / "tshirt-m.json"
    toile("pattern", "convert", DRAFT / "tshirt-m.dxf", "--seams", DRAFT / "tshirt.seams.toml", "-o", out)
    document = json.loads(out.read_text("utf-8"))
    panels, stitches = document["pattern"]["panels"], document["pattern"]["stitches"]
    known = {piece["block"]: piece["perimeter_mm"] for piece in answer("pattern", "inspect", out)[0]["pieces"]}
    same("GarmentCode: panels", (sorted(panels), document["properties"]["units_in_meter"]), (sorted(known), 100.0))
    for name, panel in panels.items():
        loop = [edge["endpoints"] for edge in panel["edges"]]
        same(f"GarmentCode: {name} closes", [a[1] for a in loop], [b[0] for b in loop[1:] + loop[:1]])
        chords = sum(math.dist(*(panel["vertices"][end] for end in ends)) for ends in loop) * 10
        same(f"GarmentCode: {name}: chords of the outline", 0.98 * known[name] < chords < known[name] + 0.1, True)
    sides = [(side["panel"], side["edge"]) for stitch in stitches for side in stitch if isinstance(side, dict)]
    same("GarmentCode: edges are sewn once", len(set(sides)), 2 * len(stitches))
    same("GarmentCode: edges are there", all(edge < len(panels[panel]["edges"]) for panel, edge in sides), True)
    print(f"  json: {len(panels)} panels of GarmentCode, {len(stitches)} stitches")


def sheets():
    """The specification sheet of nine sizes as XLSX, CSV and JSON."""
    asked = ["pattern", "pom", FOLDER / "tshirt-m.nest.json", "--seams", DRAFT / "tshirt.seams.toml"]
    for kind in ("xlsx", "csv"):
        toile(*asked, "-o", FOLDER / f"pom.{kind}")
    told, csv = answer(*asked), pandas.read_csv(FOLDER / "pom.csv")
    cells = list(openpyxl.load_workbook(FOLDER / "pom.xlsx").active.iter_rows(values_only=True))
    same("pom: columns", list(cells[0]), list(csv.columns))
    sizes = [name.removesuffix("_mm") for name in cells[0][1:-1] if not name.endswith("_step_mm")]
    same("pom: sizes", sizes, told["sizes"])
    same("pom: XLSX as CSV", [list(row) for row in cells[1:]], csv.values.tolist())
    for point in told["points"]:
        cell = csv.set_index("point").at[point["point"], f"{point['size']}_mm"]
        near(f"pom: {point['point']} of {point['size']}", cell, point["length_mm"], 0.0501)
    print(f"  openpyxl, pandas: {len(csv)} points of measure in {len(told['sizes'])} sizes")


HARD = """SELECT 1 AS number, 0.1 AS real, 'Größe ''Ж'' "漢字", ; =1+1' AS text, NULL AS none
    UNION ALL SELECT -9007199254740993, -1e-300, '', NULL UNION ALL SELECT NULL, NULL, NULL, NULL
    UNION ALL SELECT 0, 3, 'a' || char(10) || 'b', NULL"""
LONG = """WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n WHERE x < 230000)
    SELECT x, CASE WHEN x % 3 THEN x * 0.5 END AS half, CASE WHEN x % 2 THEN 'ä' || x END AS text FROM n"""


def is_same(cell, value):
    """Whether a cell, in text or not, holds a value. Sums in views differ by rounding from one SQLite to another."""
    if isinstance(value, float):
        return cell not in ("", None) and math.isclose(float(cell), value, rel_tol=1e-13)
    return cell == (str(value) if isinstance(cell, str) and value is not None else value)


def agree(what, found, wanted):
    """Compares two lists of rows; the first that differs is a finding."""
    same(f"{what}: rows", len(found), len(wanted))
    other = (k for k, (a, b) in enumerate(zip(found, wanted)) if len(a) != len(b) or not all(map(is_same, a, b)))
    for k in list(other)[:1]:
        findings.append(f"{what}: row {k}: found {found[k]}, wanted {wanted[k]}")


def tables():
    """Answers in SQL: by Python's own SQLite, as JSON, Parquet and CSV."""
    database = sqlite3.connect(f"file:{os.environ['TOILE_DB']}?mode=ro", uri=True)
    same("SQLite: integrity", database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
    views = database.execute("SELECT name FROM sqlite_schema WHERE type = 'view' AND name GLOB 'v_*'").fetchall()
    filled = cells = 0
    for name, query in [("hard", HARD), ("long", LONG)] + [(view, f"SELECT * FROM {view}") for view, in views]:
        cursor = database.execute(query)
        columns = [column[0] for column in cursor.description]
        wanted = [[f"<{len(v)} bytes>" if isinstance(v, bytes) else v for v in row] for row in cursor]
        told = json.loads(toile("sql", "--format", "json", query))
        agree(f"{name}: JSON", [[row[column] for column in columns] for row in told], wanted)
        toile("sql", "--format", "parquet", query, "-o", FOLDER / f"{name}.parquet")
        table = pyarrow.parquet.read_table(FOLDER / f"{name}.parquet")
        agree(f"{name}: Parquet", list(zip(*table.to_pydict().values())), wanted)
        csv = io.StringIO(toile("sql", "--format", "csv", query).decode())
        csv = pandas.read_csv(csv, dtype=str, keep_default_na=False)
        same(f"{name}: columns", [table.column_names, list(csv.columns)], [columns, columns])
        agree(f"{name}: CSV", csv.values.tolist(), [["" if v is None else v for v in row] for row in wanted])
        filled, cells = filled + bool(wanted), cells + len(wanted) * len(columns)
    types = [str(kind) for kind in pyarrow.parquet.read_schema(FOLDER / "hard.parquet").types]
    same("hard: types of Parquet", types, ["int64", "double", "string", "string"])
    print(f"  sqlite3, pyarrow, pandas: {cells} cells, {filled - 2} of {len(views)} views with rows")


def meshes():
    """A drape in four formats, and a body."""
    job = json.loads(toile("sql", "--format", "json", "SELECT job_id, vertices, faces FROM v_metrics LIMIT 1"))[0]
    read = {}
    for kind in ("obj", "glb", "ply", "stl"):
        toile("export", job["job_id"], "--format", kind, "--map", "stretch", "-o", FOLDER / f"drape.{kind}")
        read[kind] = trimesh.load(FOLDER / f"drape.{kind}", process=False)
    body, garment = (read["glb"].geometry[name] for name in ("body", "garment"))
    # Vertices that a seam joins lie in one place.
    sewn = set(map(tuple, garment.vertices))
    same("glb: garment", (len(sewn), len(garment.faces)), (job["vertices"], job["faces"]))
    same("glb: the body is closed", (body.is_watertight, body.volume > 0), (True, True))
    # In glTF y is up and the subject faces z.
    read["glb"] = trimesh.util.concatenate([body, garment])
    read["glb"].vertices = read["glb"].vertices[:, [0, 2, 1]] * [-1, 1, 1]
    for kind, mesh in read.items():
        apart = abs(mesh.triangles - read["obj"].triangles).max() if len(mesh.faces) == len(read["obj"].faces) else None
        same(f"{kind}: triangles as in OBJ, within a micrometre", apart is not None and apart < 1e-6, True)
    same("a man of metres", 1.5 < read["obj"].extents[2] < 2.1, True)
    toile("body", "build", "--sex", "m", "--stature-mm", 1760, "-o", FOLDER / "body")
    body = trimesh.load(FOLDER / "body" / "body.obj", process=False)
    same("body: closed", (body.is_watertight, body.is_winding_consistent, body.volume > 0), (True, True, True))
    near("body: stature", body.extents[2], 1.76, 0.002)
    print(f"  trimesh: {len(read)} formats of {len(read['obj'].faces)} triangles, a body of {1000 * body.volume:.0f} l")


def pages():
    """The fit report as PDF, where a Chromium is installed."""
    if not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"))):
        return print("  left out: no Chromium, no PDF")
    toile("report", STUDY, "--for", "fit", "--pdf", "-o", FOLDER / "report")
    sheets = pypdf.PdfReader(FOLDER / "report" / "index.pdf").pages
    same("PDF: A4", {tuple(round(float(mm) / 72 * 25.4) for mm in page.mediabox[2:]) for page in sheets}, {(210, 297)})
    same("PDF: sheets", 2 <= len(sheets) <= 12, True)
    print(f"  pypdf: a fit report of {len(sheets)} sheets")


for kind in (patterns, garmentcode, sheets, tables, meshes, pages):
    kind()
print(*findings[:40], sep="\n", file=sys.stderr)
sys.exit(f"{len(findings)} findings" if findings else 0)
