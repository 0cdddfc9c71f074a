#!/usr/bin/env python3
"""Fits the network of the recogniser to garments whose makers say what is sewn to what.

usage: fit.py fit WEIGHTS CORPUS... [--epochs N] [--from WEIGHTS] [--check CORPUS...]
       fit.py measure WEIGHTS CORPUS...

A CORPUS is a name: NAME.jsonl holds the garments (as `evidence` reads them, with `"seams": [[piece, from, to, piece, from, to], ...]`,
arc lengths in mm along the outlines, both from the first vertex), NAME.bin what `evidence` wrote of them. Needs jax and numpy.
"""
import json
import pathlib
import sys
import time

import numpy as np

import jax
import jax.numpy as jnp

SHAPE, PLACE, SAID, PAIR = 36, 5, 14, 30
WIDTH, ROUNDS, RANK = 48, 3, 16
SIZES = [32, 48, 64, 80, 96, 128, 160, 200, 256, 320, 400]
EVIDENCE, JOINTS = 9, 13
# Answers about a piece: kinds, then front, back or neither, then right, left or both.
KINDS = (10, 3, 3)


# ------------------------------------------------------------------ garments

def load(name):
    raw = np.frombuffer(pathlib.Path(name + ".bin").read_bytes(), dtype=np.uint8)
    at, garments = 0, []

    def take(count, kind=np.float32):
        nonlocal at
        part = raw[at:at + 4 * count].view(kind)
        at += 4 * count
        return part

    for line in open(name + ".jsonl"):
        drawn = json.loads(line)
        n = int(take(1, np.int32)[0])
        g = {key: take(n, np.int32) for key in ("part", "next", "own", "twin", "kind")}
        g["start"], g["length"], g["angle"] = take(n), take(n), take(n)
        g["shape"], g["place"], g["said"] = take(n * SHAPE).reshape(n, SHAPE), take(n * PLACE).reshape(n, PLACE), take(n * SAID).reshape(n, SAID)
        g["pair"] = take(n * n * PAIR).reshape(n, n, PAIR).astype(np.float16)
        g["name"], g["n"], g["pieces"] = drawn.get("file", str(len(garments))), n, len(drawn["pieces"])
        g["true"] = truth(g, drawn["seams"])
        g["is"] = np.array([piece.get("is", [-1, -1, -1]) for piece in drawn["pieces"]])
        garments.append(g)
    return garments


def truth(g, seams):
    """Share of each stretch (row) that is sewn to each other one."""
    n = g["n"]
    sewn = np.zeros((n, n))
    of_piece = [np.nonzero(g["part"] == p)[0] for p in range(g["pieces"])]
    around = [g["length"][k].sum() for k in of_piece]

    def spans(piece, a, b):
        """Stretches along an interval, each with its share of the interval and the part of the stretch."""
        found = []
        for k in of_piece[piece]:
            for turn in (-1, 0, 1):
                s = g["start"][k] + turn * around[piece]
                low, high = max(a, s), min(b, s + g["length"][k])
                if high - low > 0.5:
                    found.append((k, (low - a) / (b - a), (high - a) / (b - a)))
        return found

    for p, a, b, q, c, d in seams:
        for i, low, high in spans(p, a, b):
            for j, start, end in spans(q, c, d):
                both = min(high, 1 - start) - max(low, 1 - end)
                if both > 1e-3:
                    sewn[i, j] += both * (b - a) / g["length"][i]
                    sewn[j, i] += both * (d - c) / g["length"][j]
    return np.minimum(sewn, 1.0).astype(np.float32)


def pad(g, size, rng):
    n = g["n"]
    out = dict(mask=np.zeros(size, np.float32), x=np.zeros((size, SHAPE + PLACE + SAID), np.float32), pair=np.zeros((size, size, PAIR), np.float32), true=np.zeros((size, size), np.float32))
    out["mask"][:n] = 1
    place, said = g["place"], g["said"]
    if rng is not None:
        place, said = turned(place, g["part"], rng), called(said, g["part"], rng)
    out["x"][:n] = np.concatenate([g["shape"], place, said], 1)
    out["pair"][:n, :n] = g["pair"]
    out["true"][:n, :n] = g["true"]
    out["known"], out["open"] = np.zeros((size, size), np.float32), np.zeros(size, np.float32)
    if rng is not None:
        out["known"][:n, :n], out["open"][:n] = told(g["true"], rng)
    elif "known" in g:
        out["known"][:n, :n], out["open"][:n] = g["known"], g["open"]
    previous = np.zeros(n, np.int32)
    previous[g["next"]] = np.arange(n)
    for key, index in (("next", g["next"]), ("previous", previous), ("own", g["own"]), ("twin", g["twin"])):
        out[key] = np.full(size, size, np.int32)
        out[key][:n] = np.where(index < 0, size, index)
    walks = walked(g, previous, out["known"][:n, :n])
    for key, fill in (("angle_before", 0), ("angle_behind", 0), ("last_before", -1), ("last_behind", -2), ("joined", -1)):
        out[key] = np.full(size, fill, walks[key].dtype)
        out[key][:n] = walks[key]
    out["is"] = np.full((size, 3), -1, np.int32)
    out["is"][:g["pieces"]] = g["is"]
    out["part"] = np.full(size, size - 1, np.int32)
    out["part"][:n] = g["part"]
    out["weight"] = np.zeros(size, np.float32)
    out["weight"][:n] = np.sqrt(g["length"] / 100)
    return out


def walked(g, previous, known):
    """Round the ends of each stretch, over what is known to be sewn: the sum of the angles, and the stretch that is met."""
    n, partner = g["n"], np.where(known.any(1), known.argmax(1), -1)
    end_angle = g["angle"][g["next"]]
    out = {"angle_before": np.zeros(n, np.float32), "angle_behind": np.zeros(n, np.float32), "last_before": np.zeros(n, np.int32), "last_behind": np.zeros(n, np.int32)}
    for k in range(n):
        for side, angle, beside in (("before", g["angle"], previous), ("behind", end_angle, g["next"])):
            at, total = k, 0.0
            for _ in range(n):
                total += angle[at]
                met = beside[at]
                if met == k or partner[met] < 0:
                    break
                at = partner[met]
            out["angle_" + side][k], out["last_" + side][k] = total, met
    head = np.arange(g["pieces"])
    for i, j in zip(*np.nonzero(known)):
        a, b = head[g["part"][i]], head[g["part"][j]]
        head[head == max(a, b)] = min(a, b)
    out["joined"] = head[g["part"]].astype(np.int32)
    return out


def told(true, rng):
    """Seams that are known beforehand, and stretches that are known to be free: of one half of the garments, some."""
    n = len(true)
    known, free = np.zeros((n, n), np.float32), np.zeros(n, np.float32)
    if rng.random() < 0.5:
        share = rng.random()
        for i, j in zip(*np.nonzero(np.triu((true > 0.9) & (true.T > 0.9), 1))):
            if rng.random() < share:
                known[i, j] = known[j, i] = 1
        free = ((true.sum(1) < 0.1) & (rng.random(n) < share)).astype(np.float32)
    return known, free


def turned(place, part, rng):
    """The pieces as others might have drawn them: upright, on their heads, lying, or any way."""
    way = rng.random()
    if way < 0.5:
        return place
    count = part.max() + 1
    if way < 0.65:
        quarters = np.full(count, 2)
    elif way < 0.75:
        quarters = np.full(count, rng.integers(4))
    else:
        quarters = rng.integers(4, size=count)
    out = place.copy()
    for turn in range(1, 4):
        rows = quarters[part] >= turn
        x, y, u, v, tall = out[rows].T
        out[rows] = np.stack([-y, x, -v, u, -tall], 1)
    return out


def called(said, part, rng):
    """Names as given, in part, or not at all; sometimes a wrong one."""
    way = rng.random()
    if way < 0.35:
        return np.zeros_like(said)
    count = part.max() + 1
    keep = np.ones((count, 3)) if way < 0.75 else rng.random((count, 3)) < rng.choice([0.3, 0.6, 0.85])
    keep = np.repeat(keep, [2, 2, SAID - 4], axis=1)
    out = said * keep[part]
    for piece in np.nonzero(rng.random(count) < 0.02)[0]:
        rows = part == piece
        field = rng.integers(3)
        low, high = ((0, 2), (2, 4), (4, SAID))[field]
        out[rows, low:high] = 0
        out[rows, rng.integers(low, high)] = 1
    return out


# ------------------------------------------------------------------ network

def layers(key, *sizes):
    keys = jax.random.split(key, len(sizes) - 1)
    return [(jax.random.normal(k, (a, b)) * np.sqrt(2.0 / a), jnp.zeros(b)) for k, a, b in zip(keys, sizes, sizes[1:])]


def initial(seed=0):
    keys = iter(jax.random.split(jax.random.PRNGKey(seed), 40))
    net = {"enter": layers(next(keys), SHAPE + PLACE + SAID, 64, WIDTH), "around": [layers(next(keys), 7 * WIDTH, 64, WIDTH) for _ in range(2)], "kind": layers(next(keys), WIDTH, 32, sum(KINDS)), "rounds": []}
    for k in range(ROUNDS):
        net["rounds"].append({
            "rank": layers(next(keys), WIDTH, 2 * RANK),
            "self": layers(next(keys), WIDTH, 32),
            "score": layers(next(keys), PAIR + RANK + EVIDENCE + JOINTS, 32),
            "score2": layers(next(keys), 32, 16, 1),
            "free": layers(next(keys), WIDTH + 2, 16, 1),
            "message": layers(next(keys), WIDTH, WIDTH),
            "update": layers(next(keys), 8 * WIDTH + 1, 64, WIDTH),
        })
    # Every round adds little at first.
    for block in net["around"] + [r["update"] for r in net["rounds"]]:
        w, b = block[-1]
        block[-1] = (w * 0.1, b)
    return net


def dense(block, x, last=False):
    for k, (w, b) in enumerate(block):
        x = x @ w + b
        if last or k + 1 < len(block):
            x = jax.nn.relu(x)
    return x


def joined(g):
    """Of each pair: the vertices that its ends would make, inner ones of 360 degrees or boundary ones."""
    index = jnp.arange(len(g["mask"]))

    def end(before, behind, last):
        is_closed = (last[:, None] == index[None]).astype(jnp.float32)
        total = before[:, None] + (1 - is_closed) * behind[None]
        inner, outer = total - 360, total - 180
        near = lambda x, scale: jnp.exp(-jnp.abs(x) / scale)
        return [is_closed * near(inner, 10), is_closed * near(inner, 40), is_closed * jnp.clip(inner / 180, -2, 2), (1 - is_closed) * near(outer, 10), (1 - is_closed) * jnp.clip(outer / 180, -1, 2), (1 - is_closed) * (total > 370)]

    ends = end(g["angle_before"], g["angle_behind"], g["last_before"])
    same = (g["joined"][:, None] == g["joined"][None]).astype(jnp.float32)
    return jnp.stack([*ends, *(e.T for e in ends), same], 2)


def forward(net, g):
    """Logits of each round, [n, n + 1], the last column free, and of the kinds of pieces. What is known is not asked."""
    n = g["x"].shape[0]
    mask = g["mask"]
    both = mask[:, None] * mask[None] * (1 - jnp.eye(n))
    decided = jnp.clip(g["known"].sum(1) + g["open"], 0, 1)
    fixed = jnp.concatenate([g["known"], g["open"][:, None]], 1)
    possible = both * (1 - decided)[:, None] * (1 - decided)[None]

    def gather(h, index):
        return jnp.concatenate([h, jnp.zeros((1, h.shape[1]))])[index]

    sums = jax.ops.segment_sum(mask, g["part"], n)

    def context(h):
        h = h * mask[:, None]
        part = jax.ops.segment_sum(h, g["part"], n) / jnp.maximum(sums, 1)[:, None]
        whole = h.sum(0) / mask.sum()
        return [h, gather(h, g["next"]), gather(h, g["previous"]), gather(h, g["own"]), gather(h, g["twin"]), part[g["part"]], jnp.broadcast_to(whole, h.shape)]

    def handed(p, s):
        a = p[:, :n] * both
        wide = jnp.pad(jnp.sqrt(a * a.T + 1e-9) * both, ((0, 1), (0, 1)))
        pick = lambda x, y: wide[g[x]][:, g[y]]
        # The best rival of each pair, on either side.
        top = jnp.sort(a, 1)[:, -2:]
        rival = jnp.where(a >= top[:, 1:], top[:, :1], top[:, 1:])
        evidence = [wide[:n, :n], pick("previous", "next"), pick("next", "previous"), pick("twin", "twin"), pick("own", "own"), jnp.clip(s / 10, -2, 2), rival + rival.T, pick("own", "twin") + pick("twin", "own"), a * (1 - a.T) + a.T * (1 - a)]
        return a, jnp.stack(evidence, 2), jnp.stack([p[:, n], top[:, 1]], 1)

    h = dense(net["enter"], g["x"])
    for block in net["around"]:
        h = h + dense(block, jnp.concatenate(context(h), 1))
    _, evidence, free = handed(fixed, jnp.zeros((n, n)))
    joints = joined(g)
    out = []
    for r in net["rounds"]:
        rank = dense(r["rank"], h)
        q, k = rank[:, :RANK], rank[:, RANK:]
        product = q[:, None] * k[None] + k[:, None] * q[None]
        own = dense(r["self"], h)
        first = dense(r["score"], jnp.concatenate([g["pair"], product, evidence, joints], 2)) + own[:, None] + own[None]
        s = dense(r["score2"], jax.nn.relu(first))[:, :, 0]
        s = 0.5 * (s + s.T)
        f = dense(r["free"], jnp.concatenate([h, free], 1))
        logits = jnp.concatenate([jnp.where(possible > 0, s, -1e9), f], 1)
        out.append(logits)
        p = jnp.where(decided[:, None] > 0, fixed, jax.nn.softmax(logits, 1))
        a, evidence, free = handed(p, s)
        message = a @ dense(r["message"], h)
        h = h + dense(r["update"], jnp.concatenate([*context(h), message, p[:, n:]], 1))
    part = jax.ops.segment_sum(h * mask[:, None], g["part"], n) / jnp.maximum(sums, 1)[:, None]
    return out, dense(net["kind"], part)


def loss(net, batch):
    def one(g):
        free = jnp.maximum(1 - g["true"].sum(1), 0)
        target = jnp.concatenate([g["true"], free[:, None]], 1)
        target = target / jnp.maximum(target.sum(1, keepdims=True), 1e-6)
        weight = g["mask"] * g["weight"] * (1 - jnp.clip(g["known"].sum(1) + g["open"], 0, 1))
        total = 0
        out, kinds = forward(net, g)
        for k, logits in enumerate(out):
            cost = -(target * jax.nn.log_softmax(logits, 1)).sum(1)
            total += (0.3, 0.5, 1.0)[k] * (cost * weight).sum() / jnp.maximum(weight.sum(), 1)
        for k, low in enumerate(np.cumsum((0, *KINDS[:-1]))):
            logs = jax.nn.log_softmax(kinds[:, low:low + KINDS[k]], 1)
            is_known = g["is"][:, k] >= 0
            cost = -jnp.take_along_axis(logs, jnp.maximum(g["is"][:, k:k + 1], 0), 1)[:, 0]
            total += 0.1 * (cost * is_known).sum() / jnp.maximum(is_known.sum(), 1)
        return total

    return jax.vmap(one)(batch).mean()


# ------------------------------------------------------------------ fitting

def fit(net, garments, epochs, seed=0, rate=2e-3, log=None):
    rng = np.random.default_rng(seed)
    step = jax.jit(lambda net, m, v, batch, t, lr: adam(net, m, v, jax.grad(loss)(net, batch), t, lr))
    zeros = jax.tree.map(jnp.zeros_like, net)
    m, v, t, mean = zeros, zeros, 0, net
    by_size = {}
    for k, g in enumerate(garments):
        by_size.setdefault(next(s for s in SIZES if s >= g["n"]), []).append(k)
    per = {s: max(1, min(8, 20000 // (s * s))) for s in by_size}
    steps = epochs * sum(-(-len(ks) // per[s]) for s, ks in by_size.items())
    started = time.time()
    for epoch in range(epochs):
        batches = []
        for s, ks in by_size.items():
            order = rng.permutation(ks)
            order = np.concatenate([order, rng.choice(ks, -len(order) % per[s])]) if len(order) % per[s] else order
            batches += [(s, order[i:i + per[s]]) for i in range(0, len(order), per[s])]
        rng.shuffle(batches)
        for s, ks in batches:
            padded = [pad(garments[int(k)], s, rng) for k in ks]
            batch = {key: np.stack([p[key] for p in padded]) for key in padded[0]}
            t += 1
            lr = rate * min(1, t / 100) * 0.5 * (1 + np.cos(np.pi * min(1, t / steps)))
            net, m, v = step(net, m, v, batch, t, lr)
        if log:
            log(epoch, net, time.time() - started)
    return net


def adam(net, m, v, grad, t, lr):
    norm = jnp.sqrt(sum((g ** 2).sum() for g in jax.tree.leaves(grad)))
    grad = jax.tree.map(lambda g: g * jnp.minimum(1, 1 / norm), grad)
    m = jax.tree.map(lambda a, g: 0.9 * a + 0.1 * g, m, grad)
    v = jax.tree.map(lambda a, g: 0.999 * a + 0.001 * g * g, v, grad)
    up = jax.tree.map(lambda w, a, b: w - lr * (a / (1 - 0.9 ** t) / (jnp.sqrt(b / (1 - 0.999 ** t)) + 1e-8) + 1e-5 * w), net, m, v)
    return up, m, v


def probabilities(net, g, apply=jax.jit(lambda net, g: forward(net, g)[0][-1])):
    s = next(s for s in SIZES if s >= g["n"])
    logits = np.array(apply(net, pad(g, s, None)))
    n = g["n"]
    logits = np.concatenate([logits[:n, :n], logits[:n, -1:]], 1)
    p = np.exp(logits - logits.max(1, keepdims=True))
    return p / p.sum(1, keepdims=True)


def sewn(net, g, nameless):
    """Seams, the surest first: what is found is told to the network, until nothing more is likelier than not."""
    n = g["n"]
    g = dict(g, known=np.zeros((n, n)), open=np.zeros(n))
    if nameless:
        g["said"] = np.zeros_like(g["said"])
    out, least = [], 0.95
    for _ in range(40):
        p = probabilities(net, g)
        left = np.clip(1 - g["known"].sum(1) - g["open"], 0, 1)
        both = np.triu(np.sqrt(p[:, :n] * p[:, :n].T), 1) * left[:, None] * left
        free = p[:, n] * left
        best = max(both.max(), free.max())
        if best <= 0:
            break
        least = min(least, 0.8 * best)
        i, j = np.nonzero(both > least)
        for k in np.argsort(-both[i, j], kind="stable"):
            a, b = int(i[k]), int(j[k])
            if left[a] and left[b]:
                left[a] = left[b] = 0
                g["known"][a, b] = g["known"][b, a] = 1
                out.append((a, b, both[a, b]))
        g["open"][(free > least) & (left > 0)] = 1
    return out


def score(g, seams):
    """Sewn length in common, of the maker, and as found, mm, for each pair of kinds of pieces."""
    kind = g["kind"]
    key = lambda i, j: tuple(sorted((int(kind[i]), int(kind[j]))))
    true, found = {}, {}
    for i, j in zip(*np.nonzero(np.triu(np.maximum(g["true"], g["true"].T), 1))):
        length = min(g["true"][i, j] * g["length"][i], g["true"][j, i] * g["length"][j])
        true[key(i, j)] = true.get(key(i, j), 0) + length
    for i, j, *_ in seams:
        found[key(i, j)] = found.get(key(i, j), 0) + min(g["length"][i], g["length"][j])
    return sum(min(v, found.get(k, 0)) for k, v in true.items()), sum(true.values()), sum(found.values())


def measured(net, garments):
    said = []
    for nameless in (False, True):
        total, right = np.zeros(3), 0
        for g in garments:
            s = np.array(score(g, sewn(net, g, nameless)))
            total += s
            right += s[0] > 0.97 * s[1] and s[0] > 0.97 * s[2]
        said.append(f"{'nameless' if nameless else 'named'} R {total[0] / total[1]:.3f} P {total[0] / total[2]:.3f} right {right}/{len(garments)}")
    return "; ".join(said)


# ------------------------------------------------------------------ weights

def flat(net):
    leaves = []

    def walk(node, path):
        if isinstance(node, dict):
            for key in sorted(node):
                walk(node[key], path + [key])
        elif isinstance(node, (list, tuple)):
            for k, item in enumerate(node):
                walk(item, path + [str(k)])
        else:
            leaves.append((".".join(path), np.asarray(node, np.float32)))

    walk(net, [])
    return leaves


def save(net, path):
    """Little-endian half floats, in the order of `flat`."""
    pathlib.Path(path).write_bytes(b"".join(leaf.astype("<f2").tobytes() for _, leaf in flat(net)))


def restore(path):
    raw, at = np.frombuffer(pathlib.Path(path).read_bytes(), "<f2").astype(np.float32), 0
    net = initial()
    shapes = flat(net)
    values = {}
    for name, leaf in shapes:
        values[name] = raw[at:at + leaf.size].reshape(leaf.shape)
        at += leaf.size

    def fill(node, path):
        if isinstance(node, dict):
            return {key: fill(node[key], path + [key]) for key in node}
        if isinstance(node, (list, tuple)):
            return type(node)(fill(item, path + [str(k)]) for k, item in enumerate(node))
        return jnp.array(values[".".join(path)])

    return fill(net, [])


def main():
    command, weights, *rest = sys.argv[1:]
    options, names, key = {}, [], None
    for word in rest:
        if word.startswith("--"):
            key = word[2:]
            options[key] = []
        elif key is None:
            names.append(word)
        else:
            options[key].append(word)
    garments = [g for name in names for g in load(name) if g["n"] <= SIZES[-1]]
    checked = [g for name in options.get("check", []) for g in load(name) if g["n"] <= SIZES[-1]]
    if command == "measure":
        print(measured(restore(weights), garments))
        return
    net = restore(options["from"][0]) if "from" in options else initial()
    epochs = int(options.get("epochs", ["30"])[0])

    def log(epoch, net, seconds):
        if checked and (epoch % 5 == 4 or epoch + 1 == epochs):
            print(f"epoch {epoch + 1}, {seconds:.0f} s: {measured(net, checked)}", flush=True)
            save(net, weights)
        else:
            print(f"epoch {epoch + 1}, {seconds:.0f} s", flush=True)

    net = fit(net, garments, epochs, rate=float(options.get("rate", ["0.002"])[0]), log=log)
    save(net, weights)


if __name__ == "__main__":
    main()
