"""Garments as rings of stretches with partners: read from specifications of GarmentCode, written for `evidence` and `fit.py`."""
import json
import math
import pathlib
import re

import numpy as np

# As the recogniser numbers classes, faces and hands.
BODY, SIDE, LEG, SLEEVE, SKIRT, YOKE, BAND, CUFF, COLLAR, OTHER = range(10)
FRONT, BACK, RIGHT, LEFT, BOTH = 0, 1, 0, 1, 2
# Words that `toile` reads.
WORDS = ["bodice", "side panel", "leg", "sleeve", "skirt", "yoke", "waistband", "cuff", "collar", "facing"]


def kind(name):
    """Class, face and hand of a panel of GarmentCode; -1 or 2 where its name does not tell."""
    n = name.lower()
    rules = [("cuff", CUFF), ("sleeve", SLEEVE), ("collar", COLLAR), ("hood", COLLAR), ("wb", BAND), ("pant", LEG), ("skirt", SKIRT), ("torso", BODY)]
    of = next((c for word, c in rules if word in n), -1)
    face = FRONT if re.search(r"ftorso|front|_f(_|$)", n) else BACK if re.search(r"btorso|back|_b(_|$)", n) else 2
    hand = RIGHT if re.search(r"(^|_)(right|r)(_|$)", n) else LEFT if re.search(r"(^|_)(left|l)(_|$)", n) else BOTH
    return [of, face, BOTH if of == SKIRT else hand]


def other_hand(name):
    swap = {"left": "right", "right": "left", "l": "r", "r": "l"}
    return "_".join(swap.get(word, word) for word in name.split("_"))


# ------------------------------------------------------------------ drawings

def bezier(control, count):
    t = np.linspace(0, 1, count + 1)[:, None]
    points = [np.repeat(np.array(c, float)[None], count + 1, 0) for c in control]
    while len(points) > 1:
        points = [a * (1 - t) + b * t for a, b in zip(points, points[1:])]
    return points[0]


def edge_line(panel, edge, scale):
    """Points of an edge in mm: a chord, an arc, or a Bezier curve in coordinates relative to the chord."""
    start, end = (np.array(panel["vertices"][k], float) * scale for k in edge["endpoints"])
    curve, chord = edge.get("curvature"), end - start
    if not curve:
        return np.stack([start, end])
    form, params = (curve.get("type", "quadratic"), curve["params"]) if isinstance(curve, dict) else ("quadratic", [curve])
    across = np.array([-chord[1], chord[0]])
    length = np.hypot(*chord)
    if form == "circle":
        radius, is_large, is_right = params[0] * scale, params[1], params[2]
        angle = 2 * math.asin(min(1.0, length / 2 / radius))
        angle = 2 * math.pi - angle if is_large else angle
        sign = 1 if is_right else -1
        centre = (start + end) / 2 + across / length * (length / 2 / math.tan(angle / 2)) * sign
        first = math.atan2(*(start - centre)[::-1])
        t = np.linspace(0, 1, max(2, int(radius * angle / 5)) + 1) * angle * sign
        line = centre + radius * np.stack([np.cos(first + t), np.sin(first + t)], 1)
        line[0], line[-1] = start, end
        return line
    return bezier([start, *(start + chord * u + across * v for u, v in params), end], max(2, int(length / 5)))


def arcs(line):
    return np.concatenate([[0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def length(line):
    return arcs(line)[-1]


def cut(line, at):
    """Both parts of a line that is divided at an arc length."""
    s = arcs(line)
    k = int(np.searchsorted(s, at, "right"))
    k = min(max(k, 1), len(line) - 1)
    point = line[k - 1] + (line[k] - line[k - 1]) * (at - s[k - 1]) / max(s[k] - s[k - 1], 1e-9)
    first, second = np.vstack([line[:k], point]), np.vstack([point, line[k:]])
    tidy = lambda l: l[np.concatenate([[True], np.hypot(*np.diff(l, axis=0).T) > 1e-6])]
    return tidy(first), tidy(second)


def at_arc(line, at):
    s = arcs(line)
    return np.array([np.interp(at, s, line[:, 0]), np.interp(at, s, line[:, 1])])


def area(points):
    x, y = points.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def crosses_itself(points):
    a, b = points, np.roll(points, -1, 0)
    n = len(a)
    side = lambda p, q, r: (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])
    A, B, C, D = a[:, None], b[:, None], a[None], b[None]
    hit = (side(A, B, C) * side(A, B, D) < -1e-6) & (side(C, D, A) * side(C, D, B) < -1e-6)
    k = np.arange(n)
    apart = np.abs(k[:, None] - k[None])
    return bool((hit & (apart > 1) & (apart < n - 1)).any())


# ------------------------------------------------------------------ garments

class Piece:
    def __init__(self, name, kind, ring):
        self.name, self.kind, self.ring = name, list(kind), ring


class Garment:
    """Pieces as rings of stretches. A stretch is a line, counter-clockwise, with at most one partner, run backwards."""

    def __init__(self):
        self.pieces, self.line, self.partner, self.marked, self.laps = [], {}, {}, {}, set()

    def add(self, line, marked=True):
        key = len(self.line)
        self.line[key], self.partner[key], self.marked[key] = np.asarray(line, float), None, marked
        return key

    def sew(self, a, b):
        self.partner[a], self.partner[b] = b, a

    def of(self, key):
        return next(p for p in self.pieces if key in p.ring)

    def beside(self, key, step):
        ring = self.of(key).ring
        return ring[(ring.index(key) + step) % len(ring)]

    def outline(self, ring):
        return np.vstack([self.line[k][:-1] for k in ring])

    def divide(self, key, at):
        """Divides a stretch, and its partner likewise. Returns the two keys."""
        whole = length(self.line[key])
        keys = self.divide_one(key, at)
        other = self.partner[key]
        if other is not None:
            others = self.divide_one(other, length(self.line[other]) * (1 - at / whole))
            self.sew(keys[0], others[1])
            self.sew(keys[1], others[0])
        return keys

    def divide_one(self, key, at):
        piece = self.of(key)
        first, second = (self.add(line, marked) for line, marked in zip(cut(self.line[key], at), (self.marked[key], False)))
        k = piece.ring.index(key)
        piece.ring[k:k + 1] = [first, second]
        return first, second


def read(path):
    spec = json.loads(pathlib.Path(path).read_text())
    scale = 1000 / spec["properties"].get("units_in_meter", 100)
    g, where = Garment(), {}
    for name, panel in spec["pattern"]["panels"].items():
        edges = panel["edges"]
        by_start, order, k = {e["endpoints"][0]: k for k, e in enumerate(edges)}, [], 0
        for _ in edges:
            order.append(k)
            k = by_start.get(edges[k]["endpoints"][1], (k + 1) % len(edges))
        lines = {k: edge_line(panel, edges[k], scale) for k in order}
        if area(np.vstack([lines[k][:-1] for k in order])) < 0:
            # Drawn from inside: seen from outside it is the mirror image.
            lines = {k: (line * [-1, 1]) for k, line in lines.items()}
        keys = {k: g.add(line) for k, line in lines.items()}
        where.update({(name, k): key for k, key in keys.items()})
        g.pieces.append(Piece(name, kind(name), [keys[k] for k in order]))
    for a, b, *_ in spec["pattern"]["stitches"]:
        g.sew(*(where[(s["panel"], s["edge"])] for s in (a, b)))
    return g


# ------------------------------------------------------------------ output

def called(p, is_varied):
    if not is_varied:
        return p.name
    c, face, hand = p.kind
    words = [("front", "back", "")[face], WORDS[c] if c >= 0 else "", ("right", "left", "")[hand]]
    return " ".join(w for w in words if w) or "piece"


def written(g, name, notches=None):
    where, pieces = {}, []
    for index, p in enumerate(g.pieces):
        at, count, corners = 0.0, 0, []
        for k in p.ring:
            where[k] = (index, at, at + length(g.line[k]))
            if g.marked[k]:
                corners.append(count)
            at, count = at + length(g.line[k]), count + len(g.line[k]) - 1
        metres = lambda points: [[round(float(x), 7) for x in q] for q in np.asarray(points) / 1000]
        marks = metres(notches[id(p)]) if notches and notches[id(p)] else []
        pieces.append({"name": called(p, notches is not None), "outline": metres(g.outline(p.ring)), "corners": corners, "notches": marks, "is": p.kind})
    seams = [[*where[a], *where[b]] for a, b in g.partner.items() if b is not None and a < b and a in where and b in where]
    return json.dumps({"file": name, "pieces": pieces, "seams": seams})
