"""The peer of benches/size_distributions.rs: SciPy fits the bundled reference curve.

    python benches/python_fits.py

prints milliseconds a fit, the median of 50, from one start and with SciPy's defaults.
"""

import csv
import pathlib
import statistics
import time

import numpy as np
from scipy.optimize import curve_fit

FILE = pathlib.Path(__file__).parent.parent / "assets/sample/reference.csv"
rows = list(csv.DictReader(FILE.open()))
size = np.array([float(row["size_mm"]) for row in rows])
passing = np.array([float(row["percent_passing"]) for row in rows])
median, largest = np.median(size), size.max()

MODELS = {
    "swebrec": (
        lambda x, xmax, x50, b: 100 / (1 + (np.log(xmax / x) / np.log(xmax / x50)) ** b),
        [1.5 * largest, median, 2.0],
        ([largest * (1 + 1e-9), 1e-3, 0.1], [1e3 * largest, largest, 50.0]),
    ),
    "rosin-rammler": (
        lambda x, x50, n: 100 * (1 - np.exp(-np.log(2) * (x / x50) ** n)),
        [median, 1.0],
        ([1e-3, 0.01], [1e3 * largest, 50.0]),
    ),
}

for name, (function, start, bounds) in MODELS.items():
    times = []
    for _ in range(50):
        begun = time.perf_counter()
        parameters, _ = curve_fit(function, size, passing, start, bounds=bounds)
        times.append(1e3 * (time.perf_counter() - begun))
    residuals = passing - function(size, *parameters)
    print(f"{name}: {statistics.median(times):.2f} ms, residual sum {residuals @ residuals:.6f}")
