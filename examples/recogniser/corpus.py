#!/usr/bin/env python3
"""Garments with seams, for `evidence` and `fit.py`: designs of GarmentCode, as drawn and as other makers would draw them.

usage: corpus.py SPEC_DIR OUT.jsonl [--variants N] [--seed N]

SPEC_DIR holds *_specification.json with stitches. Each design is written once as drawn, and N times varied: pieces joined
along a seam (sleeves in one piece, whole fronts), divided (yokes, side panels, princess seams), opened with a lap;
corners that hardly turn are lost, others are drawn by hand, seams are eased, notches stand on some seams, and facings and second layers lie beside.
Needs numpy.
"""
import math
import pathlib
import random
import re
import sys

import numpy as np

from garments import BACK, BAND, BODY, BOTH, COLLAR, CUFF, FRONT, LEFT, LEG, OTHER, Piece, RIGHT, SIDE, SKIRT, SLEEVE, YOKE, arcs, area, at_arc, crosses_itself, length, other_hand, read, written


def glued(g, key):
    """Joins two pieces along the whole run of stretches that they share around `key`. False where that cannot be drawn."""
    if g.partner[key] is None:
        return False
    a, b = g.of(key), g.of(g.partner[key])
    if a is b:
        return False
    run = [key]
    while len(run) < min(len(a.ring), len(b.ring)) - 1 and g.partner[g.beside(run[-1], 1)] == g.beside(g.partner[run[-1]], -1):
        run.append(g.beside(run[-1], 1))
    while len(run) < min(len(a.ring), len(b.ring)) - 1 and g.partner[g.beside(run[0], -1)] == g.beside(g.partner[run[0]], 1):
        run.insert(0, g.beside(run[0], -1))
    mine = np.vstack([g.line[k] for k in run])
    theirs = np.vstack([g.line[g.partner[k]] for k in reversed(run)])[::-1]
    t = np.linspace(0, 1, 20)
    mine, theirs = (np.stack([at_arc(l, s * length(l)) for s in t]) for l in (mine, theirs))
    u, v = mine[-1] - mine[0], theirs[-1] - theirs[0]
    if abs(np.hypot(*u) - np.hypot(*v)) > 0.01 * np.hypot(*u):
        return False
    turn = math.atan2(u[1], u[0]) - math.atan2(v[1], v[0])
    r = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    place = lambda p: (p - theirs.mean(0)) @ r.T + mine.mean(0)
    if np.hypot(*(place(theirs) - mine).T).max() > 2.0:
        return False
    moved = {k: place(g.line[k]) for k in b.ring}
    ia, ib = a.ring.index(run[-1]), b.ring.index(g.partner[run[0]])
    rest_a = [a.ring[(ia + 1 + k) % len(a.ring)] for k in range(len(a.ring) - len(run))]
    rest_b = [b.ring[(ib + 1 + k) % len(b.ring)] for k in range(len(b.ring) - len(run))]
    if not rest_a or not rest_b:
        return False
    ring = rest_a + rest_b
    lines = {k: (moved[k] if k in rest_b else g.line[k]).copy() for k in ring}
    for p, q in zip(ring, ring[1:] + ring[:1]):
        middle = 0.5 * (lines[p][-1] + lines[q][0])
        lines[p][-1] = lines[q][0] = middle
    outline = np.vstack([lines[k][:-1] for k in ring])
    if crosses_itself(outline) or area(outline) < 0.97 * (area(g.outline(a.ring)) + area(g.outline(b.ring))):
        return False
    g.line.update(lines)
    g.marked[rest_a[0]] = g.marked[rest_b[0]] = False
    a.ring = ring
    a.kind = [a.kind[0], *(x if x == y else 2 for x, y in zip(a.kind[1:], b.kind[1:]))]
    a.name = "joined_" + a.name
    g.pieces.remove(b)
    return True


def divided(g, piece, axis, share, bow, names, kinds):
    """Divides a piece across: at a share of its extent along `axis`, by a cut that bows on either side by its own height."""
    outline = g.outline(piece.ring)
    low, high = outline.min(0), outline.max(0)
    at = low[axis] + share * (high[axis] - low[axis])
    hits = []
    for key in piece.ring:
        line = g.line[key]
        s = arcs(line)
        for k in range(len(line) - 1):
            p, q = line[k][axis] - at, line[k + 1][axis] - at
            if (p < 0) != (q < 0):
                hits.append((key, s[k] + (s[k + 1] - s[k]) * p / (p - q)))
    if len(hits) != 2 or hits[0][0] in (hits[1][0], g.partner[hits[1][0]]):
        return None
    if any(min(arc, length(g.line[key]) - arc) < 25 for key, arc in hits):
        return None
    starts = [g.divide(key, arc)[1] for key, arc in hits]
    i, j = (piece.ring.index(k) for k in starts)
    first = [piece.ring[(i + k) % len(piece.ring)] for k in range((j - i) % len(piece.ring))]
    second = [piece.ring[(j + k) % len(piece.ring)] for k in range((i - j) % len(piece.ring))]
    seams = []
    for ring, height in ((first, bow[0]), (second, bow[1])):
        start, end = g.line[ring[-1]][-1], g.line[ring[0]][0]
        across = np.array([-(end - start)[1], (end - start)[0]])
        t = np.linspace(0, 1, 24 if height else 2)[:, None]
        line = start + (end - start) * t - across * height * np.sin(math.pi * t) * (1 + 0.3 * np.cos(math.pi * t))
        key = g.add(line)
        g.marked[ring[0]] = True
        ring.append(key)
        seams.append(key)
    g.sew(*seams)
    rest = Piece(names[1], kinds[1], second)
    # Of the two, the first named lies lower along the axis.
    if g.outline(first)[:, axis].mean() > g.outline(second)[:, axis].mean():
        first, second = second, first
    piece.ring, piece.name, piece.kind = first, names[0], list(kinds[0])
    rest.ring = second
    g.pieces.append(rest)
    return rest


def lapped(g, key, width):
    """Opens a straight seam and lets the piece go on by `width` beyond it."""
    other = g.partner[key]
    line = g.line[key]
    if length(line) < 250 or np.hypot(*(line[-1] - line[0])) < 0.999 * length(line):
        return False
    for k in (key, other):
        line = g.line[k]
        out = line[-1] - line[0]
        out = np.array([out[1], -out[0]]) / np.hypot(*out) * width
        ring = g.of(k).ring
        before, behind = g.add(np.stack([line[0], line[0] + out]), False), g.add(np.stack([line[-1] + out, line[-1]]))
        g.line[k] = line + out
        i = ring.index(k)
        ring[i:i + 1] = [before, k, behind]
        g.marked[k] = True
        g.laps.update([before, k, behind])
        # The neck and the hem go on: what lay beyond the corner is no corner any more.
        g.marked[ring[(i + 3) % len(ring)]] = False
        g.partner[k] = None
    return True


def doubled(g, piece):
    """A second layer, in no seam."""
    g.pieces.append(Piece(piece.name, piece.kind, [g.add(g.line[k], g.marked[k]) for k in piece.ring]))


def faced(g, run, width):
    """A strip inside a run of stretches: congruent with it, in no seam."""
    outer = np.vstack([g.line[run[0]][:1], *(g.line[k][1:] for k in run)])
    s = np.linspace(0, length(outer), max(8, int(length(outer) / 10)))
    outer = np.stack([at_arc(outer, at) for at in s])
    along = np.gradient(outer, axis=0)
    inward = np.stack([-along[:, 1], along[:, 0]], 1) / np.hypot(*along.T)[:, None]
    inner = (outer + inward * width)[::-1]
    ring = [outer, np.stack([outer[-1], inner[0]]), inner, np.stack([inner[-1], outer[0]])]
    whole = np.vstack([l[:-1] for l in ring])
    if crosses_itself(whole) or area(whole) < 0.5 * width * s[-1]:
        return False
    g.pieces.append(Piece("facing", [OTHER, g.of(run[0]).kind[1], BOTH], [g.add(l) for l in ring]))
    return True


def openings(g):
    """Rings of free stretches, each in the order in which they follow over the seams."""
    left, rings = {k for p in g.pieces for k in p.ring if g.partner[k] is None}, []
    while left:
        ring = [min(left)]
        while True:
            n = g.beside(ring[-1], 1)
            while g.partner[n] is not None:
                n = g.beside(g.partner[n], 1)
            if n == ring[0] or n not in left:
                break
            ring.append(n)
        left -= set(ring)
        rings.append(ring)
    return rings


def between_laps(g, ring):
    """Runs of a ring between fronts that lap: the neck and the hem. None without laps."""
    if not any(k in g.laps for k in ring):
        return []
    start = next(i for i, k in enumerate(ring) if k in g.laps)
    runs = [[]]
    for k in ring[start:] + ring[:start]:
        if k in g.laps:
            runs.append([])
        else:
            runs[-1].append(k)
    return [run for run in runs if run]


def banded(g, run, kind, width, ratio, is_closed, underlap=0.0, bend=None):
    """A strip along a run of free stretches: a rib, a collar, a cuff, a waistband. Returns its piece."""
    run = [k for k in run if length(g.line[k]) > 1]
    xs, x = [], 0.0
    for k in reversed(run):
        xs.append((x, x + ratio * length(g.line[k])))
        x = xs[-1][1]
    total = x + underlap
    dense = lambda a, b: np.linspace(a, b, max(2, int(np.hypot(*np.subtract(b, a)) / 8)))

    def placed(line):
        if bend is None:
            return line[[0, -1]]
        angle, radius = line[:, 0] / bend, bend - line[:, 1]
        return np.stack([np.sin(angle) * radius, bend - np.cos(angle) * radius], 1)

    bottom = [g.add(placed(dense((a, 0), (b, 0))), i == 0) for i, (a, b) in enumerate(xs)]
    rest = [g.add(placed(dense((x, 0), (total, 0))), False)] if underlap else []
    right, top, left = (g.add(placed(dense(a, b))) for a, b in (((total, 0), (total, width)), ((total, width), (0, width)), ((0, width), (0, 0))))
    piece = Piece(f"band_{len(g.pieces)}", kind, bottom + rest + [right, top, left])
    if crosses_itself(g.outline(piece.ring)):
        return None
    g.pieces.append(piece)
    for mine, theirs in zip(bottom, reversed(run)):
        g.sew(mine, theirs)
    if is_closed:
        g.sew(right, left)
    return piece


def bent(rng, total):
    """Radius of a shaped band, `None` for a straight one."""
    return rng.choice([-1, 1]) * rng.uniform(0.35, 3) * total if rng.random() < 0.4 else None


def collared(g, run, rng):
    """A collar from front to front, and sometimes a fall on it that is a little shorter."""
    total = sum(length(g.line[k]) for k in run)
    stand = banded(g, run, [COLLAR, 2, BOTH], rng.uniform(25, 90), rng.choice([1, 1, rng.uniform(0.97, 1.02)]), False, 0.0, bent(rng, total))
    if stand is None or rng.random() < 0.5:
        return
    top = stand.ring[-2]
    rest = rng.choice([0, rng.uniform(8, 30)])
    if rest:
        top = g.divide(top, rest)[1]
        top = g.divide(top, length(g.line[top]) - rest)[0]
    fall = banded(g, [top], [COLLAR, 2, BOTH], rng.uniform(35, 90), 1.0, False, 0.0, bent(rng, total))
    if fall is not None and rng.random() < 0.7:
        point = rng.uniform(-10, 40)
        for key, end, sign in ((fall.ring[-3], -1, 1), (fall.ring[-1], 0, -1)):
            top_line, line = g.line[fall.ring[-2]], g.line[key].copy()
            along = top_line[0] - top_line[-1]
            line[end] = line[end] + along / np.hypot(*along) * point * sign
            g.line[key] = line[[0, -1]]
            moved = top_line.copy()
            moved[0 if sign > 0 else -1] = line[end]
            g.line[fall.ring[-2]] = moved


def band_openings(g, rng):
    """Ribs and bands on openings, those of both sides alike."""
    made = {}
    for ring in openings(g):
        for run in between_laps(g, ring):
            top = max(g.line[k][:, 1].max() for k in run)
            kinds = {g.of(k).kind[0] for k in run}
            if kinds <= {BODY, SIDE, YOKE} and top > max(g.line[k][:, 1].max() for p in of_class(g, BODY) for k in p.ring) - 150:
                if rng.random() < 0.7:
                    collared(g, run, rng)
        if any(k in g.laps for k in ring):
            continue
        kinds = {g.of(k).kind[0] for k in ring}
        total = sum(length(g.line[k]) for k in ring)
        if kinds & {COLLAR, CUFF, BAND, OTHER} or not 120 < total < 1600:
            continue
        signature = (round(total), len(ring))
        if signature not in made:
            is_done = rng.random() < 0.5
            kind = CUFF if kinds == {SLEEVE} or kinds == {LEG} and len(ring) <= 2 else COLLAR if kinds <= {BODY, YOKE, SIDE} and total < 900 else BAND
            ratio = rng.choice([1, 1, rng.uniform(0.65, 1)])
            is_closed = rng.random() < 0.75
            lap = 0.0 if is_closed or rng.random() < 0.5 else rng.uniform(15, 60)
            made[signature] = is_done and (kind, rng.uniform(12, 90), ratio, is_closed, lap, bent(rng, total) if rng.random() < 0.5 else None)
        if made[signature]:
            kind, *rest = made[signature]
            piece = banded(g, ring, [kind, 2, BOTH], *rest)
            if piece is not None and rng.random() < 0.15:
                divided(g, piece, 0, 0.5, [0, 0], (piece.name, piece.name + "_2"), (piece.kind, piece.kind))


def detailed(g, rng):
    """Pockets, flaps, tabs and loops: sewn on, not into seams."""
    for _ in range(rng.randint(1, 4)):
        w, h = rng.uniform(25, 220), rng.uniform(25, 260)
        corner = rng.choice([0, 0, rng.uniform(5, 40)])
        points = [(0, 0), (w, 0), (w, h), (0, h)] if not corner else [(0, corner), (min(corner, w / 3), 0), (w - min(corner, w / 3), 0), (w, corner), (w, h), (0, h)]
        if rng.random() < 0.3:
            points = [(0, h * 0.25), (w / 2, 0), (w, h * 0.25), (w, h), (0, h)]
        if rng.random() < 0.3:
            points = [(x + y * 0.2, y) for x, y in points]
        for _ in range(rng.choice([1, 2])):
            lines = [g.add(np.array([a, b], float)) for a, b in zip(points, points[1:] + points[:1])]
            g.pieces.append(Piece("detail", [OTHER, 2, BOTH], lines))


def of_class(g, *classes):
    return [p for p in g.pieces if p.kind[0] in classes]


def pairs(g):
    """Pieces with their mirror images, each pair once, and those without one."""
    by_name, done = {p.name: p for p in g.pieces}, set()
    for p in list(g.pieces):
        if id(p) in done:
            continue
        twin = by_name.get(other_hand(p.name))
        twin = twin if twin is not p else None
        done.update([id(p), id(twin)])
        yield p, twin


def seam_between(g, a, b):
    """The highest one."""
    shared = [k for k in a.ring if g.partner[k] is not None and g.partner[k] in b.ring]
    return max(shared, key=lambda k: g.line[k].mean(0)[1]) if shared else None


def join_pairs(g, rng):
    """Sleeves in one piece, whole fronts and backs, legs and skirts in one, cuffs and bands as strips."""
    by_name = lambda: {p.name: p for p in g.pieces}
    chance = {SLEEVE: 0.75, CUFF: 0.6, COLLAR: 0.5, BAND: 0.5, LEG: 0.12, BODY: 0.06, SKIRT: 0.06}
    roll = {c: rng.random() < share for c, share in chance.items()}
    for p in list(g.pieces):
        c, face, hand = p.kind
        if p not in g.pieces or face != FRONT or not roll.get(c):
            continue
        swapped = {"ftorso": "btorso", "sleeve_f": "sleeve_b", "collar_front": "collar_back", "wb_front": "wb_back", "skirt_front": "skirt_back"}
        name = p.name
        for a, b in swapped.items():
            name = name.replace(a, b)
        if name == p.name:
            name = re.sub(r"_f(_|$)", r"_b\1", name)
        q = by_name().get(name)
        if q is None:
            continue
        shared = [k for k in p.ring if g.partner[k] in q.ring]
        # Of a sleeve the upper seam, at the top of its cap.
        shared.sort(key=lambda k: -g.line[k].mean(0)[1])
        for k in shared[:2]:
            if glued(g, k):
                break
    # Whole fronts and backs.
    for face in (FRONT, BACK):
        if rng.random() < (0.45 if face == FRONT else 0.65):
            halves = [p for p in of_class(g, BODY, COLLAR) if p.kind[1] == face and p.kind[2] != BOTH]
            for c in (BODY, COLLAR):
                of = [p for p in halves if p.kind[0] == c]
                if len(of) == 2:
                    k = seam_between(g, *of)
                    if k is not None and glued(g, k):
                        of[0].name = f"joined_{c}_{face}"


def divide_pieces(g, rng):
    """Yokes, side panels, princess and centre seams: with the mirror image alike."""
    for p, twin in list(pairs(g)):
        c, face, hand = p.kind
        if p.name.startswith("joined") and c == SLEEVE and rng.random() < 0.25:
            share, bow = rng.uniform(0.15, 0.85), [rng.uniform(-0.04, 0.04)] * 2
            for q, at in ((p, share), (twin, 1 - share)):
                if q is not None:
                    divided(g, q, 0, at, bow, (q.name, f"under_{q.name}"), (q.kind, q.kind))
            continue
        if c == BODY and rng.random() < 0.22 or c == SKIRT and rng.random() < 0.15 or c == LEG and rng.random() < 0.1:
            across = rng.random() < 0.4
            share = rng.uniform(0.72, 0.88) if across else rng.uniform(0.3, 0.7)
            bow = [0, 0] if across or rng.random() < 0.4 else [rng.uniform(-0.05, 0.05) for _ in range(2)]
            if abs(bow[0]) + abs(bow[1]) > 0 and rng.random() < 0.6:
                bow[1] = -bow[0]
            height = YOKE if across else c
            names = (p.name, f"{'yoke' if across else 'panel'}_{p.name}")
            rest = divided(g, p, int(across), share, bow, names, ([c, face, hand], [height, face, hand]))
            if rest is None or twin is None:
                continue
            # The mirror image counts its extent from the other end.
            names, kinds = [other_hand(n) for n in names], [[k, face, {RIGHT: LEFT, LEFT: RIGHT}.get(hand, BOTH)] for k in (c, height)]
            other = divided(g, twin, 1, share, bow, names, kinds) if across else divided(g, twin, 0, 1 - share, bow[::-1], names[::-1], kinds[::-1])
            if not across and other is not None:
                sides(g, c, [p, rest, twin, other])


def sides(g, c, parts):
    """Of a bodice, what does not meet its mirror image is a side panel."""
    meets = lambda p: any(g.partner[k] is not None and g.of(g.partner[k]) in parts[2 * (parts.index(p) < 2):][:2] for k in p.ring)
    if c == BODY and any(meets(p) for p in parts):
        for p in parts:
            p.kind[0] = BODY if meets(p) else SIDE


def open_fronts(g, rng):
    for p in list(of_class(g, BODY)):
        if p.kind[1] == FRONT and p.kind[2] == RIGHT:
            for k in list(p.ring):
                q = g.partner[k]
                if q is not None and g.of(q).kind[:2] == [BODY, FRONT] and g.of(q).kind[2] == LEFT:
                    lapped(g, k, rng.uniform(12, 40))
                    break


def lay_beside(g, rng):
    for p in list(g.pieces):
        if p.kind[0] in (BAND, COLLAR, CUFF, YOKE) and rng.random() < 0.3:
            doubled(g, p)
    if rng.random() < 0.3:
        for p in of_class(g, BODY, SKIRT):
            free = [k for k in p.ring if g.partner[k] is None and length(g.line[k]) > 90]
            if free and rng.random() < 0.7:
                k = max(free, key=lambda k: g.line[k].mean(0)[1])
                run = [k]
                while len(run) < len(p.ring) - 2 and g.partner[g.beside(run[-1], 1)] is None and not g.marked[g.beside(run[-1], 1)]:
                    run.append(g.beside(run[-1], 1))
                faced(g, run, rng.uniform(30, 70))


def resize(g, rng):
    """Lengths that do not agree to the tenth of a millimetre: eased caps, redrawn and shrunk pieces. Mirror images alike."""
    whole = rng.uniform(0.8, 1.2)
    spread = rng.choice([0, 0, 0.001, 0.004, 0.01])
    cap = rng.uniform(1.0, 1.05) if rng.random() < 0.5 else 1.0
    rib = rng.uniform(0.7, 1.0) if rng.random() < 0.2 else 1.0
    for p, twin in pairs(g):
        scale = whole * np.array([1 + rng.gauss(0, spread), 1 + rng.gauss(0, spread)]) * (cap if p.kind[0] == SLEEVE else rib if p.kind[0] in (BAND, CUFF) else 1)
        for key in [k for q in (p, twin) if q is not None for k in q.ring]:
            g.line[key] = g.line[key] * scale


def redraw(g, rng):
    """Corners that stand where a hand put them: lengths that should agree differ by tenths of a millimetre."""
    spread = rng.choice([0, 0.1, 0.3, 0.8])
    for p in g.pieces:
        moved = {k: [rng.gauss(0, spread), rng.gauss(0, spread)] for k in p.ring}
        for k, after in zip(p.ring, p.ring[1:] + p.ring[:1]):
            t = (arcs(g.line[k]) / length(g.line[k]))[:, None]
            g.line[k] = g.line[k] + (1 - t) * moved[k] + t * moved[after]


def lose_marks(g, rng):
    """Divisions that nobody would see: what hardly turns is no corner, unless the maker marks it."""
    least = rng.choice([3, 8, 15, 25])
    mark_all = rng.random() < 0.3
    for p in g.pieces:
        for k in p.ring:
            before, line = g.line[g.beside(k, -1)], g.line[k]
            u = before[-1] - at_arc(before, max(0, length(before) - 4))
            v = at_arc(line, min(4, length(line))) - line[0]
            turn = abs(math.degrees(math.atan2(u[0] * v[1] - u[1] * v[0], u @ v)))
            g.marked[k] = turn > 25 or (turn > least if g.marked[k] else turn > max(least, 8)) or mark_all and g.marked[k]
        if sum(g.marked[k] for k in p.ring) < 2:
            turns = sorted(p.ring, key=lambda k: -length(g.line[k]))
            for k in turns[:2]:
                g.marked[k] = True


def notch(g, rng):
    """Notches at the same place of both sides of a seam, one of ten elsewhere."""
    share = rng.choice([0, 0, 0.3, 0.7])
    notches = {id(p): [] for p in g.pieces}
    mark_ends = rng.random() < 0.5
    for k, other in g.partner.items():
        owner = next((p for p in g.pieces if k in p.ring), None)
        if owner is None:
            continue
        # Where a seam ends without a corner, a notch often says so.
        if share and not g.marked[k] and mark_ends:
            notches[id(owner)].append(g.line[k][0])
        if other is None or other < k or rng.random() > share or length(g.line[k]) < 80:
            continue
        for _ in range(rng.choice([1, 1, 2])):
            at = rng.uniform(0.15, 0.85)
            notches[id(owner)].append(at_arc(g.line[k], at * length(g.line[k])))
            wrong = rng.uniform(0.15, 0.85) if rng.random() < 0.1 else 1 - at
            notches[id(g.of(other))].append(at_arc(g.line[other], wrong * length(g.line[other])))
    return notches


# In this order, each with its chance. What lies beside is drawn last: it has no mirror image to be resized with.
VARIATIONS = [(join_pairs, 0.8), (open_fronts, 0.3), (divide_pieces, 0.5), (band_openings, 0.6), (resize, 1), (redraw, 1), (lay_beside, 0.4), (detailed, 0.25), (lose_marks, 1)]


def varied(g, rng):
    for change, chance in VARIATIONS:
        if rng.random() < chance:
            change(g, rng)
    return notch(g, rng)


def main():
    folder, out = sys.argv[1:3]
    option = lambda name, default: int(sys.argv[sys.argv.index(name) + 1]) if name in sys.argv else default
    variants, rng = option("--variants", 0), random.Random(option("--seed", 0))
    with open(out, "w") as file:
        for path in sorted(pathlib.Path(folder).glob("*_specification.json")):
            print(written(read(path), path.name), file=file)
            for k in range(variants):
                g = read(path)
                notches = varied(g, rng)
                print(written(g, f"{path.name}#{k}", notches), file=file)


if __name__ == "__main__":
    main()
