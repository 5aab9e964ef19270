#!/usr/bin/env python3
"""Photos in TIFF files as others write them, and what libtiff reads out of them.

    python3 -m venv v && v/bin/pip install rasterio numpy pillow imagecodecs
    v/bin/python tests/geotiff/make_photos.py FOLDER COUNT SEED     a random matrix
    v/bin/python tests/geotiff/make_photos.py --fixtures            the files in tests/fixtures/tiff_photos

Each NAME.tif has a NAME.png beside it, of the pixels that rasterio (GDAL, libtiff, libjpeg-turbo) reads,
brought to 8-bit RGB: 16 bits by (v + 128) / 257, further bands left out. NAME.txt has how far a pixel may
be off, or `refused WORD`. Lossless files are equal; where JPEG shares colours among pixels decoders differ.
"""

import random
import struct
import sys
import zlib
from pathlib import Path

import imagecodecs
import numpy as np
import rasterio
from PIL import Image

# Levels that a pixel may be off; rows of chunks are upsampled on their own.
JPEG = 2
SHARED_COLOUR_JPEG = 16
FIXED_POINT = 1
# With ReferenceBlackWhite libtiff cuts off the fractions of Y and Cb (Code2V in tif_color.c) before it
# multiplies Cb by 1.772: just under 1 + 1.772 levels.
FIXED_POINT_REFERENCES = 3


def picture(height, width, bands, dtype, rng):
    y, x = np.mgrid[0:height, 0:width]
    planes = []
    for band in range(bands):
        smooth = 128 + 70 * np.sin((x + 20 * band) / 19.0) + 40 * np.cos(y / (13.0 + band))
        smooth += rng.standard_normal((height, width)) * 3
        planes.append(np.clip(smooth, 0, 255))
    data = np.stack(planes)
    return (data * 257).astype("uint16") if dtype == "uint16" else data.astype("uint8")


def to_rgb(data):
    if data.dtype == np.uint16:
        data = ((data.astype("uint32") + 128) // 257).astype("uint8")
    planes = data[:3] if len(data) >= 3 else np.repeat(data[:1], 3, axis=0)
    return np.moveaxis(planes, 0, 2)


def finish(path, off):
    with rasterio.open(path) as file:
        data = file.read()
    Image.fromarray(np.ascontiguousarray(to_rgb(data))).save(path.with_suffix(".png"))
    path.with_suffix(".txt").write_text(f"{off}\n")


def by_gdal(path, rnd, **fixed):
    d = {
        "dtype": rnd.choice(["uint8", "uint8", "uint16"]), "bands": rnd.choice([1, 3, 3, 4, 2]),
        "compress": rnd.choice(["NONE", "LZW", "DEFLATE", "ZSTD", "PACKBITS", "JPEG", "JPEG", "WEBP", "LERC"]),
        "predictor": rnd.choice([1, 2]), "tiled": rnd.random() < 0.6, "block": rnd.choice([16, 64, 128]),
        "rows": rnd.choice([8, 16, 1000]), "interleave": rnd.choice(["PIXEL", "BAND"]),
        "endian": rnd.choice(["LITTLE", "BIG"]), "bigtiff": rnd.choice(["YES", "NO"]),
        "ycbcr": rnd.random() < 0.6, "width": rnd.choice([33, 100, 250]), "height": rnd.choice([21, 64, 190]),
        "overviews": rnd.random() < 0.2, "seed": rnd.randrange(1 << 30),
    }
    d.update(fixed)
    if d["compress"] in ("JPEG", "WEBP"):
        d["dtype"] = "uint8"
    if d["compress"] == "WEBP":
        d["bands"], d["interleave"] = 3, "PIXEL"
    rng = np.random.default_rng(d["seed"])
    data = picture(d["height"], d["width"], d["bands"], d["dtype"], rng)
    options = {
        "driver": "GTiff", "dtype": d["dtype"], "width": d["width"], "height": d["height"],
        "count": d["bands"], "compress": d["compress"], "interleave": d["interleave"],
        "ENDIANNESS": d["endian"], "BIGTIFF": d["bigtiff"],
        "photometric": "RGB" if d["bands"] >= 3 else "MINISBLACK",
    }
    off = 0
    if d["compress"] == "JPEG":
        off = JPEG
        options["JPEG_QUALITY"] = rnd.choice([50, 90])
        if d["ycbcr"] and d["bands"] == 3 and d["interleave"] == "PIXEL":
            options["photometric"] = "YCBCR"
            off = SHARED_COLOUR_JPEG
    if d["predictor"] == 2 and d["compress"] in ("LZW", "DEFLATE", "ZSTD"):
        options["predictor"] = 2
    if d["tiled"]:
        options.update(tiled=True, blockxsize=d["block"], blockysize=d["block"])
    else:
        options["blockysize"] = min(d["rows"], d["height"])
    with rasterio.open(path, "w", **options) as file:
        file.write(data)
    if d["overviews"]:
        with rasterio.open(path, "r+") as file:
            file.build_overviews([2, 4])
    refused = {"WEBP": "WebP", "LERC": "LERC"}
    if d["bands"] == 2 and d["interleave"] == "PIXEL":
        # No decoder of JPEG that fragscale has knows two components.
        refused["JPEG"] = "two colours"
    if word := refused.get(d["compress"]):
        path.with_suffix(".txt").write_text(f"refused {word}\n")
    else:
        finish(path, off)
    return d


def by_hand(path, rnd, **fixed):
    """YCbCr that is not JPEG, which GDAL reads and does not write."""
    d = {
        "sampling": rnd.choice([(1, 1), (2, 1), (2, 2), (4, 1), (4, 2), (1, 2), (4, 4)]),
        "compress": rnd.choice([1, 5, 8, 32773]), "width": rnd.choice([16, 37, 64]),
        "height": rnd.choice([16, 29, 40]), "rows": rnd.choice([8, 16, 64]), "seed": rnd.randrange(1 << 30),
        "order": rnd.choice("<>"), "references": rnd.random() < 0.3,
    }
    d.update(fixed)
    across, down = d["sampling"]
    width, height, order = d["width"], d["height"], d["order"]
    rng = np.random.default_rng(d["seed"])
    # Blocks: luminances, Cb, Cr.
    wide, high = -(-width // across), -(-height // down)
    full = picture(high * down, wide * across, 3, "uint8", rng)
    strips = []
    for top in range(0, height, d["rows"]):
        rows = min(d["rows"], height - top)
        blocks = bytearray()
        for y in range(top, top + -(-rows // down) * down, down):
            for x in range(0, wide * across, across):
                blocks += full[0, y:y + down, x:x + across].tobytes()
                blocks += bytes([full[1, y, x], full[2, y, x]])
        encode = {1: bytes, 5: imagecodecs.lzw_encode, 8: zlib.compress,
                  32773: imagecodecs.packbits_encode}[d["compress"]]
        strips.append(encode(bytes(blocks)))
    entries = [
        (256, 4, [width]), (257, 4, [height]), (258, 3, [8, 8, 8]), (259, 3, [d["compress"]]),
        (262, 3, [6]), (273, 4, None), (277, 3, [3]), (278, 4, [d["rows"]]),
        (279, 4, [len(strip) for strip in strips]), (284, 3, [1]), (530, 3, list(d["sampling"])),
        (531, 3, [1]),
    ]
    if d["references"]:
        entries.append((532, 5, [16, 1, 235, 1, 128, 1, 240, 1, 128, 1, 240, 1]))
    out = bytearray(struct.pack(order + "2sHI", b"II" if order == "<" else b"MM", 42, 0))
    begins = []
    for strip in strips:
        begins.append(len(out))
        out += strip + b"\0" * (len(strip) % 2)
    packed = []
    for tag, kind, numbers in entries:
        numbers = begins if numbers is None else numbers
        code = {3: "H", 4: "I", 5: "I"}[kind]
        data = struct.pack(f"{order}{len(numbers)}{code}", *numbers)
        count = len(numbers) // 2 if kind == 5 else len(numbers)
        if len(data) > 4:
            place = struct.pack(order + "I", len(out))
            out += data
            data = place
        packed.append(struct.pack(order + "HHI", tag, kind, count) + data.ljust(4, b"\0"))
    struct.pack_into(order + "I", out, 4, len(out))
    out += struct.pack(order + "H", len(packed)) + b"".join(packed) + b"\0" * 4
    path.write_bytes(out)
    finish(path, FIXED_POINT_REFERENCES if d["references"] else FIXED_POINT)
    return d


def fixtures():
    folder = Path(__file__).parent.parent / "fixtures" / "tiff_photos"
    folder.mkdir(parents=True, exist_ok=True)
    plain = dict(dtype="uint8", bands=3, compress="LZW", predictor=1, tiled=True, block=16, rows=8,
                 interleave="PIXEL", endian="LITTLE", bigtiff="NO", ycbcr=False, width=37, height=29,
                 overviews=False, seed=3)
    files = {
        "rgb_lzw_tiles": dict(),
        "rgb16_zstd_predictor2_big_endian": dict(dtype="uint16", compress="ZSTD", predictor=2, endian="BIG"),
        "rgb_planar_deflate_strips": dict(compress="DEFLATE", interleave="BAND", tiled=False, predictor=2),
        "rgba_packbits_bigtiff": dict(bands=4, compress="PACKBITS", bigtiff="YES"),
        "grey_jpeg": dict(bands=1, compress="JPEG"),
        "rgb_jpeg": dict(compress="JPEG", tiled=False),
        "ycbcr_jpeg_tiles_overviews": dict(compress="JPEG", ycbcr=True, overviews=True),
        "rgb_webp": dict(compress="WEBP"),
    }
    for name, traits in files.items():
        by_gdal(folder / f"{name}.tif", random.Random(5), **{**plain, **traits})
    by_hand(folder / "ycbcr_2x2_lzw.tif", random.Random(5), sampling=(2, 2), compress=5, width=37, height=29,
            rows=8, references=False, order=">")
    by_hand(folder / "ycbcr_4x1_none.tif", random.Random(6), sampling=(4, 1), compress=1, width=37, height=29,
            rows=8, references=True, order="<")


if __name__ == "__main__":
    if sys.argv[1:] == ["--fixtures"]:
        fixtures()
    else:
        folder, count, seed = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
        folder.mkdir(parents=True, exist_ok=True)
        rnd = random.Random(seed)
        with open(folder / "drawn.txt", "a") as drawn:
            for index in range(count):
                path = folder / f"{seed}_{index:03}.tif"
                make = by_hand if rnd.random() < 0.25 else by_gdal
                print(path.stem, make(path, rnd), file=drawn)
