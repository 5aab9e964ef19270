#!/usr/bin/env python3
"""GeoTIFFs as GDAL writes them, and what rasterio reads out of them.

    python3 -m venv v && v/bin/pip install rasterio numpy
    v/bin/python tests/geotiff/make.py FOLDER COUNT SEED     a random matrix
    v/bin/python tests/geotiff/make.py --fixtures            the files in tests/fixtures/geotiff

Each NAME.tif has a NAME.txt beside it: a line `refused WORD` where it has to be refused with that word,
else `cells COLUMNS ROWS` and a line for each cell that has an elevation: column, row and the value, as a
Python float prints it, which reads back to the same number. What fragscale does beyond GDAL is done
here too: cells are missing where the value is GDAL_NODATA, NaN, infinite or beyond 1e30, where a mask
leaves them out, in tiles that are not stored, and, where no nodata value is declared, at -9999, -32767
and -32768.

`fragscale info` gives counts and bounds only; tests/geotiff.rs reads the cloud itself and compares every
cell. Written with rasterio 1.4 (GDAL 3.9 and later); the values of a seed are the same everywhere.
"""

import random
import sys
from pathlib import Path

import numpy as np
import rasterio
from rasterio.enums import MaskFlags
from rasterio.transform import from_origin

TYPES = ["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64"]
READ = ["NONE", "LZW", "DEFLATE", "ZSTD", "PACKBITS"]
REFUSED = {"LZMA": "LZMA", "LERC": "LERC", "LERC_DEFLATE": "LERC", "LERC_ZSTD": "LERC"}


def values(dtype, height, width, kind, rng):
    """A surface of `kind`, so that codes of all lengths and long runs come up."""
    y, x = np.mgrid[0:height, 0:width]
    info = np.iinfo(dtype) if dtype[0] != "f" else None
    if kind == "noise":
        if info is not None:
            return rng.integers(info.min, info.max, size=(height, width), dtype=dtype, endpoint=True)
        return (rng.standard_normal((height, width)) * 10.0 ** rng.integers(-5, 6)).astype(dtype)
    if kind == "flat":
        return np.full((height, width), 17, dtype=dtype)
    smooth = 60 + 30 * np.sin(x / 17.0) + 20 * np.cos(y / 11.0) + rng.standard_normal((height, width))
    if kind == "steps":
        smooth = np.floor(smooth / 16) * 16
    return smooth.astype(dtype)


def make(folder, name, rnd, **fixed):
    """One file and its answer; returns what was drawn."""
    draw = {
        "dtype": rnd.choice(TYPES),
        "compress": rnd.choice(READ * 4 + list(REFUSED)),
        "tiled": rnd.random() < 0.6,
        "predictor": rnd.choice([1, 2, 3]),
        "width": rnd.choice([1, 7, 33, 100, 257, 400]),
        "height": rnd.choice([1, 5, 64, 129, 300]),
        "bigtiff": rnd.random() < 0.4,
        "endian": rnd.choice(["LITTLE", "LITTLE", "BIG"]),
        "kind": rnd.choice(["noise", "smooth", "smooth", "steps", "flat"]),
        "bands": rnd.choice([1, 1, 1, 1, 1, 2, 3, 5]),
        "interleave": rnd.choice(["PIXEL", "BAND"]),
        "nodata": rnd.choice([None, None, "value", "odd"]),
        "sparse": rnd.random() < 0.15,
        "mask": rnd.random() < 0.1,
        "overviews": rnd.random() < 0.15,
        "block": rnd.choice([16, 32, 64, 128, 256]),
        "rows": rnd.choice([1, 3, 8, 1000]),
        "seed": rnd.randrange(1 << 30),
    }
    draw.update(fixed)
    d = draw
    dtype, is_float = d["dtype"], d["dtype"][0] == "f"
    if dtype in ("uint8", "int8"):
        # Several bands of bytes are a picture.
        d["bands"] = 1
    if d["compress"].startswith("LERC") and dtype in ("int64", "uint64", "int8"):
        d["compress"] = "LZMA"
    rng = np.random.default_rng(d["seed"])
    options = {
        "driver": "GTiff", "dtype": dtype, "width": d["width"], "height": d["height"], "count": d["bands"],
        "crs": "EPSG:32633", "transform": from_origin(500000.0, 5000000.0, 0.5, 0.5),
        "compress": d["compress"], "interleave": d["interleave"], "ENDIANNESS": d["endian"],
        "BIGTIFF": "YES" if d["bigtiff"] else "NO", "photometric": "MINISBLACK",
    }
    predictor = d["predictor"]
    if d["compress"] not in ("LZW", "DEFLATE", "ZSTD") or (predictor == 3 and not is_float):
        predictor = 1
    if predictor != 1:
        options["predictor"] = predictor
    if d["tiled"]:
        options.update(tiled=True, blockxsize=d["block"], blockysize=rnd.choice([16, d["block"]]))
    else:
        options["blockysize"] = min(d["rows"], d["height"])
    if d["sparse"]:
        options["SPARSE_OK"] = True
    cells = [values(dtype, d["height"], d["width"], d["kind"], rng) for _ in range(d["bands"])]
    nodata = None
    if d["nodata"] == "value":
        nodata = cells[0].flat[int(rng.integers(cells[0].size))].item()
    elif d["nodata"] == "odd":
        nodata = float("nan") if is_float else 3
        if is_float:
            cells[0].flat[:: 5] = np.nan
    if nodata is not None:
        options["nodata"] = nodata
    path = Path(folder) / f"{name}.tif"
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True):
        with rasterio.open(path, "w", **options) as file:
            written = np.ones((d["height"], d["width"]), dtype=bool)
            half = d["height"] // 2
            if d["sparse"] and half > 0:
                # Only the lower half is written; a tile or strip that it touches is stored whole.
                window = rasterio.windows.Window(0, half, d["width"], d["height"] - half)
                for band, data in enumerate(cells, 1):
                    file.write(data[half:], band, window=window)
            else:
                for band, data in enumerate(cells, 1):
                    file.write(data, band)
            if d["mask"]:
                valid = rng.random((d["height"], d["width"])) < 0.8
                file.write_mask((valid * 255).astype("uint8"))
        if d["overviews"] and min(d["width"], d["height"]) > 4:
            with rasterio.open(path, "r+") as file:
                file.build_overviews([2, 4])
    with rasterio.open(path) as file:
        data = file.read(1)
        block_height, block_width = file.block_shapes[0]
        present = np.ones(data.shape, dtype=bool)
        if d["sparse"]:
            for row in range(0, d["height"], block_height):
                for column in range(0, d["width"], block_width):
                    tag = f"BLOCK_OFFSET_{column // block_width}_{row // block_height}"
                    if file.get_tag_item(tag, "TIFF", bidx=1) is None:
                        present[row:row + block_height, column:column + block_width] = False
        if d["mask"] and MaskFlags.per_dataset in file.mask_flag_enums[0]:
            present &= file.dataset_mask() > 0
    numbers = data.astype("float64")
    with np.errstate(invalid="ignore", over="ignore"):
        present &= np.isfinite(numbers) & (np.abs(numbers) < 1e30)
        if nodata is None:
            for value in (-9999.0, -32767.0, -32768.0):
                present &= numbers != value
        else:
            present &= (numbers != float(nodata)) & (
                numbers.astype("float32") != np.float32(nodata))
    lines = []
    if d["compress"] in REFUSED:
        lines.append(f"refused {REFUSED[d['compress']]}")
    elif not present.any():
        lines.append("refused none of its cells")
    else:
        lines.append(f"cells {d['width']} {d['height']}")
        lines += [f"{x} {y} {float(numbers[y, x])!r}" for y, x in np.argwhere(present)]
    path.with_suffix(".txt").write_text("\n".join(lines) + "\n")
    return draw


def fixtures():
    """A few kB each: what was refused although it is whole, and one of each trait."""
    folder = Path(__file__).parent.parent / "fixtures" / "geotiff"
    plain = dict(width=19, height=17, bigtiff=False, endian="LITTLE", kind="smooth", bands=1, tiled=True,
                 interleave="PIXEL", nodata=None, sparse=False, mask=False, overviews=False, block=16,
                 predictor=1, compress="LZW", dtype="int16", rows=4, seed=12)
    files = {
        "int16_lzw_tiles": dict(),
        "int16_lzw_predictor2_tiles": dict(predictor=2, kind="noise"),
        "uint16_zstd_predictor2_big_endian": dict(dtype="uint16", compress="ZSTD", predictor=2, endian="BIG"),
        "float32_lzw_predictor3_bigtiff": dict(dtype="float32", predictor=3, bigtiff=True),
        "float64_deflate_predictor3_big_endian": dict(dtype="float64", compress="DEFLATE", predictor=3,
                                                      endian="BIG", tiled=False),
        "float32_zstd_predictor2_strips": dict(dtype="float32", compress="ZSTD", predictor=2, tiled=False),
        "int8_packbits_strips": dict(dtype="int8", compress="PACKBITS", tiled=False, kind="steps"),
        "uint8_lzw": dict(dtype="uint8", kind="steps"),
        "int64_deflate_predictor2": dict(dtype="int64", compress="DEFLATE", predictor=2, width=9, height=8),
        "uint32_planar_bands": dict(dtype="uint32", bands=2, interleave="BAND", compress="DEFLATE"),
        "int32_pixel_bands": dict(dtype="int32", bands=3, predictor=2, width=9, height=8),
        "float32_sparse_overviews": dict(dtype="float32", sparse=True, overviews=True, compress="ZSTD",
                                         height=40),
        "int16_mask": dict(mask=True, compress="DEFLATE"),
        "float32_lerc": dict(dtype="float32", compress="LERC"),
        "int16_lzma": dict(compress="LZMA"),
    }
    for name, traits in files.items():
        make(folder, name, random.Random(5), **{**plain, **traits})


if __name__ == "__main__":
    if sys.argv[1:] == ["--fixtures"]:
        fixtures()
    else:
        folder, count, seed = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
        folder.mkdir(parents=True, exist_ok=True)
        rnd = random.Random(seed)
        with open(folder / "drawn.txt", "w") as drawn:
            for index in range(count):
                name = f"{seed}_{index:03}"
                print(name, make(folder, name, rnd), file=drawn)
