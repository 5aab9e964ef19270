"""Simulated piles of more kinds than `sample` has, as photos with exact labels, for train.py.

    python3 piles.py FOLDER SEED COUNT [SIDE]

The pile is a height over the photo's plane: broken stones are the least of a few slanted planes, pebbles are
superellipsoids, blocks are turned cuboids with bevels, whose two or three faces one sees differently lit, as a photo aslant
into a muckpile does; each is laid on what lies there, and what is highest is seen. So sizes can span 1 to 50, small
stones lie on large blocks, stones lie deep in fines or, in an old gravel, in a lumpy matrix that meets them without
a gap, blasted faces are rough, and a photo takes two seconds. Light: a sun or lamp with
shadows cast over the height, and what comes from all around, less where it is narrow. What happens to surfaces
(joints, mud, dust) and what a camera does is left to train.py, which draws it anew each time.

Everything follows from the seed, photo by photo. Needs numpy, scipy and pillow.
"""
import pathlib
import sys

import numpy as np
from PIL import Image
from scipy import ndimage

HUES = np.array([[1.0, 1.0, 1.0], [1.0, 0.95, 0.87], [1.0, 0.82, 0.60], [1.0, 0.66, 0.42], [1.0, 0.86, 0.45], [0.86, 1.0, 0.88], [0.84, 0.92, 1.0]])
# Side of the tile that textures are cut from.
TILE = 1024


def fractal(rng, side, coarsest, roughness):
    """Noise with waves from `coarsest` pixels down to two, deviation 1, that repeats at its edges."""
    frequency = np.hypot(np.fft.fftfreq(side)[:, None], np.fft.rfftfreq(side)[None, :])
    spectrum = np.where(frequency * coarsest >= 1, np.maximum(frequency, 1e-9) ** -(1 + roughness), 0)
    noise = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(side, side))) * spectrum, (side, side))
    return (noise / noise.std()).astype(np.float32)


def tint(rng):
    hue = HUES[rng.integers(len(HUES))] * rng.random() + HUES[rng.integers(len(HUES))] * rng.random()
    return hue / hue.max()


def block(rng, half, xs, ys):
    """A cuboid turned any way, with unequal sides and a few bevels: the height of what looks up over its lower side."""
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    away = half * np.array([1.0, rng.uniform(0.5, 1.0), rng.uniform(0.35, 0.9)]) / 1.25
    planes = [(sign * axis + rng.normal(0, 0.12, 3), reach) for axis, reach in zip(axes, away) for sign in (-1, 1)]
    for _ in range(int(rng.integers(0, 6))):
        normal = rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        planes.append((normal, rng.uniform(0.75, 1.0) * float(np.abs(axes @ normal) @ away)))
    top, under = np.full(xs.shape, np.inf, np.float32), np.full(xs.shape, -np.inf, np.float32)
    for (a, b, c), reach in planes:
        plane = (reach - a * xs - b * ys) / (c if abs(c) > 0.02 else 0.02)
        if c > 0 or abs(c) <= 0.02:
            top = np.minimum(top, plane)
        else:
            under = np.maximum(under, plane)
    # As high as it lies deep: half of it stands out.
    return np.where(top > under, np.maximum(top + 0.5 * half, 0.02 * half), -1.0)


def body(rng, size, kind, xs, ys):
    """The height of a stone over its middle plane at these places from its middle, below 0 beside it."""
    turn = rng.uniform(0, 2 * np.pi)
    narrow = rng.uniform(0.5, 1.0)
    x = np.cos(turn) * xs + np.sin(turn) * ys
    y = (np.cos(turn) * ys - np.sin(turn) * xs) / narrow
    half = 0.5 * size
    thick = rng.uniform(0.3, 0.8) * narrow
    if kind == "pebble":
        power = rng.uniform(1.9, 3.2)
        inside = 1 - (np.abs(x / half) ** power + np.abs(y / half) ** power)
        return np.where(inside > 0, thick * half * np.sqrt(np.maximum(inside, 0)) + 0.02 * half, -1.0)
    if kind == "block":
        return block(rng, half, xs, ys)
    height = np.full(x.shape, np.inf, np.float32)
    sides = int(rng.integers(5, 12))
    for side in range(sides):
        angle = 2 * np.pi * (side + rng.uniform(-0.4, 0.4)) / sides
        away = half * rng.uniform(0.62, 1.0)
        slope = 10 ** rng.uniform(-0.5, 0.8)
        height = np.minimum(height, slope * (away - np.cos(angle) * x - np.sin(angle) * y))
    # Faces above.
    for _ in range(int(rng.integers(1, 5))):
        a, b = rng.normal(0, 0.35, 2)
        height = np.minimum(height, thick * half * rng.uniform(0.6, 1.3) - a * x - b * y)
    return height


def pile(rng, side):
    """Heights and labels, and the slope of the surfaces' own relief."""
    typical = 10 ** rng.uniform(0.95, 2.15)
    least = max(5.0, typical * rng.uniform(0.15, 0.6))
    most = min(0.8 * side, max(typical * 10 ** rng.uniform(0.1, 0.9), 1.3 * least))
    # How many there are of a size: its power.
    steep = rng.uniform(1.2, 3.4)
    pebbles = rng.choice([0.0, 1.0, rng.random()], p=[0.5, 0.3, 0.2])
    blocks = rng.choice([0.0, 1.0, rng.random()], p=[0.4, 0.35, 0.25])
    cover = rng.uniform(0.8, 4.5)
    sizes, area = [], 0.0
    while area < cover * side * side and len(sizes) < 6000:
        u = rng.random()
        p = 1 - steep
        size = (least ** p + u * (most ** p - least ** p)) ** (1 / p)
        sizes.append(size)
        area += 0.6 * size * size
    sizes = np.array(sizes)
    if rng.random() < 0.5:
        # Large ones lie below.
        sizes = sizes[np.argsort(-sizes * np.exp(rng.normal(0, 0.5, sizes.size)))]
    ground = fractal(rng, TILE, rng.uniform(60, 400), 0.8)[:side, :side] * typical * rng.uniform(0.02, 0.3)
    height, label = ground.copy(), np.zeros((side, side), np.int32)
    relief = fractal(rng, TILE, rng.uniform(15, 120), rng.uniform(0.6, 1.2))
    rough = 0.03 * rng.random() ** 2
    # Blasted faces are as rough as a small stone is high, down to single pixels.
    harsh = fractal(rng, TILE, rng.uniform(4, 30), rng.uniform(0.2, 0.9)) * rng.choice([0.0, rng.uniform(0.1, 0.8)], p=[0.5, 0.5])
    cemented = rng.random() < 0.3
    for number, size in enumerate(sizes, 1):
        reach = int(0.72 * size) + 2
        cx, cy = rng.uniform(-0.1 * side, 1.1 * side, 2)
        x0, x1 = max(int(cx) - reach, 0), min(int(cx) + reach + 1, side)
        y0, y1 = max(int(cy) - reach, 0), min(int(cy) + reach + 1, side)
        if x1 <= x0 or y1 <= y0:
            continue
        ys, xs = np.mgrid[y0:y1, x0:x1].astype(np.float32)
        kind = "pebble" if rng.random() < pebbles else "block" if rng.random() < blocks else "broken"
        own = body(rng, size, kind, xs - cx, ys - cy)
        solid = own > 0
        if not solid.any():
            continue
        a, b = rng.integers(0, TILE - side, 2) if side < TILE else (0, 0)
        own = own + rough * size * relief[a:a + side, b:b + side][y0:y1, x0:x1]
        if kind != "pebble":
            own = own + min(1.0, size / 40) * harsh[a:a + side, b:b + side][y0:y1, x0:x1]
        below = height[y0:y1, x0:x1]
        # It lies on what is below it, deeper where that is soft or leaves room.
        rests = np.quantile(below[solid], rng.uniform(0.3, 0.95)) - rng.uniform(0.0, 0.25) * size
        a, b = rng.normal(0, 0.15, 2)
        top = rests + own + a * (xs - cx) + b * (ys - cy)
        seen = solid & (top > below)
        below[seen] = top[seen]
        label[y0:y1, x0:x1][seen] = number
    # Fines fill up to a level that comes and goes.
    level = np.quantile(height, rng.uniform(0.2, 0.7) if cemented else rng.uniform(0.0, 0.5) ** 1.5)
    level = level + fractal(rng, TILE, rng.uniform(80, 500), 0.9)[:side, :side] * typical * rng.uniform(0.02, 0.25)
    gritty = fractal(rng, TILE, rng.uniform(4, 30), rng.uniform(0.2, 0.9))[:side, :side] * rng.uniform(0.05, 0.6)
    if cemented:
        lumps = fractal(rng, TILE, rng.uniform(0.3, 1.5) * typical + 8, rng.uniform(0.3, 0.9))[:side, :side]
        gritty = 2 * gritty + lumps * rng.uniform(0.01, 0.06) * (typical + 10)
    if cemented or rng.random() < 0.65:
        fines = level + gritty
        covered = fines > height
        height[covered] = fines[covered]
        label[covered] = 0
    return height, label, typical


def shadows(height, towards, elevation, side):
    """How much of the light comes by: a little soft."""
    rise = np.tan(elevation)
    lit = np.full(height.shape, 1.0, np.float32)
    far = min(np.ptp(height) / max(rise, 0.05), 200.0)
    step = 1.0
    while step < far:
        dx, dy = (int(round(step * towards[0])), int(round(step * towards[1])))
        other = np.roll(height, (-dy, -dx), (0, 1))
        above = other - height - step * rise
        lit = np.minimum(lit, np.clip(1 - above / (0.4 + 0.03 * step), 0, 1))
        step *= 1.06 if step > 16 else 1.0
        step += 1.0 if step <= 16 else 0.0
    return lit


def photo(rng, side):
    room = 64
    height, label, typical = pile(rng, side + 2 * room)
    full = side + 2 * room
    gy, gx = np.gradient(ndimage.gaussian_filter(height, 0.5))
    normal = np.stack([-gx, -gy, np.ones_like(gx)], 2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    azimuth, elevation = rng.uniform(0, 2 * np.pi), rng.uniform(0.2, 1.45)
    towards = np.array([np.cos(azimuth), np.sin(azimuth)])
    sun = np.array([towards[0] * np.cos(elevation), towards[1] * np.cos(elevation), np.sin(elevation)])
    direct = np.maximum(normal @ sun, 0) * shadows(height, towards, elevation, full)
    narrow = sum(np.maximum(ndimage.gaussian_filter(height, s) - height, 0) / s for s in (2, 5, 12)) / 3
    around = np.exp(-rng.uniform(0.8, 3.0) * narrow) * (0.6 + 0.4 * normal[..., 2])
    strength = rng.choice([0.0, 1.0, rng.random()], p=[0.2, 0.5, 0.3])
    sky = rng.uniform(0.12, 0.5)
    light = strength * direct + (sky + 0.5 * (1 - strength)) * around
    # Stones: of one quarry, or of a river that brings many.
    count = int(label.max()) + 1
    main, variety = tint(rng), rng.random() ** 2
    bright = 10 ** rng.uniform(-1.0, -0.35)
    spread = rng.uniform(0.03, 0.5)
    tints = np.stack([main * (1 - variety * u) + tint(rng) * variety * u for u in rng.random(min(count, 64))])
    tints = tints[rng.integers(len(tints), size=count)] * bright * np.exp(rng.normal(0, spread, count))[:, None]
    albedo = tints[label]
    # Mottle, speckles, veins: each stone from its own part of a tile.
    shift = rng.integers(0, TILE, (count, 2))
    ys, xs = np.mgrid[:full, :full]
    at = (ys + shift[label, 0]) % TILE, (xs + shift[label, 1]) % TILE
    mottle = fractal(rng, TILE, rng.uniform(10, 120), rng.uniform(-0.3, 0.9))[at]
    speckle = fractal(rng, TILE, rng.uniform(2.5, 8), -0.5)[at]
    texture = rng.uniform(0, 0.3) * mottle + rng.uniform(0, 0.2) * speckle
    if rng.random() < 0.4:
        vein = fractal(rng, TILE, rng.uniform(30, 150), 0.9)[at]
        texture = texture + rng.choice([-0.6, 0.6]) * np.exp(-(vein / rng.uniform(0.02, 0.08)) ** 2) * (rng.random(count) < 0.3)[label]
    albedo = albedo * np.exp(texture)[..., None]
    fines = label == 0
    own = main if rng.random() < 0.6 else tint(rng)
    pale = bright * np.exp(rng.uniform(-0.7, 0.9))
    sand = np.exp(rng.uniform(0.05, 0.4) * fractal(rng, TILE, rng.uniform(2.5, 20), -0.3)[:full, :full] + rng.uniform(0, 0.35) * fractal(rng, TILE, 200, 0.8)[:full, :full])
    albedo[fines] = (own * pale * sand[..., None])[fines]
    # Dust on what looks up.
    dust = rng.random() ** 2 * np.clip((normal[..., 2] - 0.6) / 0.4, 0, 1) * np.clip(0.6 + 0.5 * fractal(rng, TILE, 100, 0.7)[:full, :full], 0, 1)
    albedo = albedo * (1 - dust[..., None]) + dust[..., None] * own * pale
    if rng.random() < 0.3:
        view = np.array([0.0, 0.0, 1.0])
        half = (sun + view) / np.linalg.norm(sun + view)
        light = light + 0
        albedo = albedo + (rng.uniform(0.02, 0.25) * np.maximum(normal @ half, 0) ** rng.uniform(10, 60) * (direct > 0))[..., None]
    linear = albedo * light[..., None]
    inner = (slice(room, room + side),) * 2
    linear, label = linear[inner], label[inner]
    linear = linear * (rng.uniform(0.12, 0.35) / max(float(linear.mean()), 1e-4))
    image = np.clip(linear, 0, 1) ** (1 / 2.2)
    # Parts that hang together no more are fragments of their own no more: the largest stays.
    return (image * 255).round().astype(np.uint8), whole(label)


def whole(label):
    """Of every stone the largest visible part; smaller ones of it are what another stone left over, and stay with
    their number where they are a fifth of it or more, as people outline them."""
    parts, found = {}, np.zeros(label.shape, np.int32)
    for number, where in enumerate(ndimage.find_objects(label), 1):
        if where is None:
            continue
        own, many = ndimage.label(label[where] == number)
        for part in range(1, many + 1):
            if many == 1 or (own == part).sum() >= 12:
                parts[len(parts) + 1] = number
                found[where][own == part] = len(parts)
    return found


def main():
    folder, seed, count = pathlib.Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    side = int(sys.argv[4]) if len(sys.argv) > 4 else 512
    for kind in ("photos", "labels"):
        (folder / kind).mkdir(parents=True, exist_ok=True)
    for number in range(count):
        image, label = photo(np.random.default_rng([seed, number]), side)
        name = f"p{seed:04}_{number:05}.png"
        Image.fromarray(image).save(folder / "photos" / name)
        Image.fromarray(label.astype(np.uint16)).save(folder / "labels" / name)


if __name__ == "__main__":
    main()
