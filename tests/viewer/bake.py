"""A baked scene, for the checks that read it with other programs, and how to read point caches."""
import json
import pathlib
import struct
import subprocess

FRAMES = 8
NAMES = ("grid", "patch", "box")  # what moves; a plane does not

SCENE = {
    "step": {"rate": 30},
    "cloths": [
        {"name": "grid", "grid": {"vertices": [6, 5], "size": [1, 0.8]}, "material": "silk",
         "transform": {"translate": [0, 0.9, 0], "rotate": [20, 30, 0]}, "pins": ["corner:0"]},
        {"name": "patch", "mesh": "patch.obj", "material": "silk", "transform": {"translate": [1, 1, 0]}},
    ],
    "colliders": [
        {"plane": {"y": 0}},
        {"box": {"min": [0, 0, 0], "max": [0.5, 0.5, 0.5]},
         "motion": {"velocity": [1, 0, 0], "spin": [0, 60, 0], "pivot": [0.25, 0, 0.25]}},
    ],
}
PATCH = """v 0 0 0\nv 0.5 0 0\nv 0.5 0 0.5\nv 0 0 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.25
f 1/1 4/4 3/3\nf 1/5 3/3 2/2\n"""


def bake(viewer, folder):
    """Writes start_NAME.obj, end_NAME.obj, run_NAME.pc2 and run.usda."""
    folder = pathlib.Path(folder)
    (folder / "scene.json").write_text(json.dumps(SCENE))
    (folder / "patch.obj").write_text(PATCH)
    for frames, files in ((0, ["start.obj"]), (FRAMES, ["end.obj", "run.pc2", "run.usda"])):
        command = [viewer, str(folder / "scene.json"), "--headless", "--size", "64x36", "--frames", str(frames),
                   "--export-colliders"]
        for file in files:
            command += ["--export", str(folder / file)]
        subprocess.run(command, check=True, capture_output=True)


def obj_positions(path):
    return [tuple(float(word) for word in line.split()[1:4])
            for line in pathlib.Path(path).read_text().splitlines() if line.startswith("v ")]


def samples(path):
    """The samples of a point cache, each a list of (x, y, z)."""
    data = pathlib.Path(path).read_bytes()
    magic, _, points, _, _, count = struct.unpack_from("<12siiffi", data)
    assert magic == b"POINTCACHE2\0" and len(data) == 32 + 12 * points * count
    values = struct.unpack_from("<%df" % (3 * points * count), data, 32)
    triples = [values[i:i + 3] for i in range(0, len(values), 3)]
    return [triples[i * points:(i + 1) * points] for i in range(count)]


def furthest(a, b):
    """The largest difference of a coordinate of two lists of points."""
    assert len(a) == len(b), "%d points and %d" % (len(a), len(b))
    return max(abs(x - y) for p, q in zip(a, b) for x, y in zip(p, q))
