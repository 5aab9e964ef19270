"""The peer of `delineate`'s engines: scikit-image's watershed, as its own examples do it.

    python3 -m venv v && v/bin/pip install scikit-image pillow
    v/bin/python benches/fragments_watershed.py ../shared/data/fragments

prints F1 at IoU 0.5 for each set of outlines that people drew, by the rules of `develop score` (the least area that counts,
finds on ground that nobody outlined). Two recipes: markers are the minima of a smoothed gradient that are deeper than H
(the photo's Sobel edges after a Gaussian of S pixels), and the maxima of the distance to the shadows (Otsu). The best S
and H of a coarse grid are chosen ON these sets, which is kinder than what fragscale's engines were given.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage as ndi
from skimage.feature import peak_local_max
from skimage.filters import gaussian, sobel, threshold_local
from skimage.morphology import h_minima
from skimage.segmentation import watershed

LEAST = {"gravel_fh": 28, "tbm_muck": 177}
PARTLY = {"belt", "muckpile_gray"}


def agreement(found, truth, least, complete):
    """Right, wrong, missed: as src/delineation/overlap.rs."""
    _, found = np.unique(found, return_inverse=True)
    _, truth = np.unique(truth, return_inverse=True)
    found, truth = found.ravel(), truth.ravel()
    shared = np.zeros((found.max() + 1, truth.max() + 1), np.int64)
    np.add.at(shared, (found, truth), 1)
    own, true = shared.sum(1), shared.sum(0)
    both = shared[1:, 1:]
    right = 2 * both > own[1:, None] + true[None, 1:] - both
    is_right, is_found = right.any(1), right.any(0)
    counts = ~is_right & (own[1:] >= least)
    if not complete:
        counts &= 2 * both.sum(1) > own[1:]
    return is_right.sum(), counts.sum(), (~is_found & (true[1:] >= least)).sum()


def by_gradient(gray, smooth, depth):
    edges = sobel(gaussian(gray, smooth))
    markers, _ = ndi.label(h_minima(edges, depth))
    return watershed(edges, markers)


def by_distance(gray, smooth, apart):
    light = gaussian(gray, smooth)
    side = max(31, int(min(gray.shape) / 8) | 1)
    rock = light > threshold_local(light, side, offset=0.02)
    distance = gaussian(ndi.distance_transform_edt(rock), 1)
    peaks = peak_local_max(distance, min_distance=apart, labels=ndi.label(rock)[0])
    markers = np.zeros(gray.shape, np.int32)
    markers[tuple(peaks.T)] = np.arange(1, len(peaks) + 1)
    return watershed(-distance, markers, mask=rock)


RECIPES = {
    "gradient": (by_gradient, [(s, h) for s in (1.5, 3, 6) for h in (0.005, 0.02, 0.06)]),
    "distance": (by_distance, [(s, d) for s in (1, 2.5) for d in (4, 8, 16)]),
}

data = Path(sys.argv[1])
photos = {}
for row in csv.DictReader((data / "index.csv").open()):
    path = data / row["set"] / row["file"]
    truth = path.with_suffix(".labels.png")
    if truth.exists():
        photos.setdefault(row["set"], []).append((path, truth))
for name, files in photos.items():
    least, complete = LEAST.get(name, 12), name not in PARTLY
    best = {}
    for recipe, (function, grid) in RECIPES.items():
        for settings in grid:
            right, wrong, missed = 0, 0, 0
            for path, truth in files:
                gray = np.asarray(Image.open(path).convert("L"), float) / 255
                labels = np.asarray(Image.open(truth)).astype(np.int64)
                counts = agreement(function(gray, *settings), labels, least, complete)
                right, wrong, missed = (a + b for a, b in zip((right, wrong, missed), counts))
            f1 = right / max(right + 0.5 * (wrong + missed), 1e-9)
            best[recipe] = max(best.get(recipe, (0,)), (f1, *settings))
    print(name, {recipe: tuple(round(float(v), 3) for v in of) for recipe, of in best.items()}, flush=True)
