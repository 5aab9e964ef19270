"""The usual Python pipeline, to compare with `fragscale scales`: the same flight, the same scales.

    pip install numpy scipy "laspy[lazrs]" trimesh embreex rtree triangle
    python3 benches/python_pipeline.py FLIGHT_FOLDER [scipy|triangle]

FLIGHT_FOLDER holds pile.laz and poses.csv as benches/pipeline.rs writes them (set
FRAGSCALE_BENCH_KEEP to a folder and run `cargo bench -- LAZ`). Time the whole process, for instance
with hyperfine or /usr/bin/time -v, alternating with `fragscale scales FLIGHT_FOLDER`.
"""

import csv
import sys

import laspy
import numpy as np
import trimesh

folder, triangulator = sys.argv[1], (sys.argv[2:] or ["scipy"])[0]

las = laspy.read(f"{folder}/pile.laz", laz_backend=laspy.LazBackend.LazrsParallel)
points = np.column_stack([las.x, las.y, las.z])
origin = np.round(points.mean(axis=0))
points -= origin

if triangulator == "scipy":
    from scipy.spatial import Delaunay

    faces = Delaunay(points[:, :2]).simplices
else:
    import triangle

    faces = triangle.triangulate({"vertices": points[:, :2]})["triangles"]

mesh = trimesh.Trimesh(points, faces, process=False)
caster = trimesh.ray.ray_pyembree.RayMeshIntersector(mesh)

width, height, f, cx, cy = 4000, 2250, 2222.2, 2000, 1125
corners = np.array([[0, 0], [width, 0], [width, height], [0, height]])
in_camera = np.column_stack([(corners[:, 0] - cx) / f, (corners[:, 1] - cy) / f, np.ones(4)])
print("photo,top,bottom")
for row in csv.DictReader(open(f"{folder}/poses.csv")):
    tilt, pan = np.radians(float(row["tilt"])), np.radians(float(row["pan"]))
    center = np.array([float(row[axis]) for axis in "xyz"]) - origin
    forward = np.array([np.sin(pan) * np.cos(tilt), np.cos(pan) * np.cos(tilt), -np.sin(tilt)])
    right = np.array([np.cos(pan), -np.sin(pan), 0.0])
    rotation = np.column_stack([right, np.cross(forward, right), forward])
    directions = in_camera @ rotation.T
    hits, rays, _ = caster.intersects_location(
        np.repeat(center[None], 4, axis=0), directions, multiple_hits=False
    )
    place = np.full((4, 3), np.nan)
    place[rays] = hits
    top = width / np.linalg.norm(place[1] - place[0])
    bottom = width / np.linalg.norm(place[2] - place[3])
    print(f"{row['photo']},{top:.6f},{bottom:.6f}")
