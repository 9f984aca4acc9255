#!/usr/bin/env python3
"""Reads a baked scene with Pixar's library (package usd-core): USD, OBJ and PC2 agree. check_usd.py VIEWER

Exit code 77 if the library is not installed.
"""
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bake  # noqa: E402

try:
    from pxr import Gf, Sdf, Usd, UsdGeom
except ImportError:
    print("skipped: this Python has no usd-core")
    sys.exit(77)


def check(condition, text):
    if not condition:
        sys.exit("failed: " + text)


def check_stage(stage):
    check(UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y, "up axis")
    check(UsdGeom.GetStageMetersPerUnit(stage) == 1, "meters per unit")
    check(stage.GetTimeCodesPerSecond() == 30, "time codes per second")
    check((stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, bake.FRAMES), "first and last time code")
    check(stage.GetDefaultPrim().GetPath() == Sdf.Path("/scene"), "default prim")
    names = {prim.GetName() for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)}
    check(names == {"grid", "patch", "plane", "box"}, "prims: %s" % sorted(names))


def check_mesh(stage, folder, name):
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/scene/" + name))
    counts, indices = mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get()
    valid, reason = UsdGeom.Mesh.ValidateTopology(indices, counts, len(mesh.GetPointsAttr().Get(0))), ""
    check(valid[0] if isinstance(valid, tuple) else valid, "topology of %s %s" % (name, reason))
    check(set(counts) == {4 if name == "grid" else 3}, "corners of %s" % name)
    st = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    if name != "box":
        check(len(st.ComputeFlattened()) == (len(indices) if name == "patch" else 30), "st of %s" % name)
    caches = bake.samples(folder / ("run_%s.pc2" % name))
    check(len(caches) == bake.FRAMES + 1, "samples of %s" % name)
    worst = 0
    for code, cache in enumerate(caches):
        points = mesh.GetPointsAttr().Get(code)
        extent = mesh.GetExtentAttr().Get(code)
        computed = UsdGeom.PointBased.ComputeExtent(points)
        check(bake.furthest(extent, computed) == 0, "extent of %s at %d" % (name, code))
        normals = mesh.GetNormalsAttr().Get(code)
        check(len(normals) == len(points), "normals of %s at %d" % (name, code))
        check(all(abs(Gf.Vec3f(n).GetLength() - 1) < 1e-5 for n in normals), "unit normals of %s at %d" % (name, code))
        world = UsdGeom.Xformable(mesh).ComputeLocalToWorldTransform(code)
        moved = [world.Transform(Gf.Vec3d(*p)) for p in points]
        worst = max(worst, bake.furthest(moved, cache))
    # What deforms is stored as it is, what moves rigidly is transformed in double precision here.
    check(worst <= (3e-7 if name == "box" else 0), "%s is %g m from its point cache" % (name, worst))
    for code, file in ((0, "start"), (bake.FRAMES, "end")):
        positions = bake.obj_positions(folder / ("%s_%s.obj" % (file, name)))
        apart = bake.furthest(positions, caches[code])
        check(apart < 1e-6, "%s_%s.obj is %g m from its point cache" % (file, name, apart))
    print("%s: %d time codes, at most %.2g m from the point cache" % (name, len(caches), worst))


with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    bake.bake(sys.argv[1], folder)
    stage = Usd.Stage.Open(str(folder / "run.usda"))
    check_stage(stage)
    for name in bake.NAMES:
        check_mesh(stage, folder, name)
