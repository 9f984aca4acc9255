"""Loads a baked scene into Blender and compares vertices frame by frame with the point caches.

blender --background --factory-startup --python-exit-code 1 --python check_blender.py -- VIEWER
"""
import pathlib
import sys
import tempfile

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bake  # noqa: E402


def check(condition, text):
    if not condition:
        raise SystemExit("failed: " + text)


def shown(thing):
    """The vertices of an object as the scene shows it, in the axes of the scene file."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [tuple(evaluated.matrix_world @ vertex.co) for vertex in evaluated.data.vertices]


def check_cache(folder, name):
    bpy.ops.wm.obj_import(filepath=str(folder / ("start_%s.obj" % name)), forward_axis="Y", up_axis="Z")
    thing = bpy.context.selected_objects[0]
    if name == "grid":
        check({len(face.vertices) for face in thing.data.polygons} == {4}, "quads of the grid")
    check(len(thing.data.uv_layers) == (0 if name == "box" else 1) or name == "box", "texture coordinates of " + name)
    modifier = thing.modifiers.new("cache", "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = str(folder / ("run_%s.pc2" % name))
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"
    modifier.frame_start = 0
    caches = bake.samples(folder / ("run_%s.pc2" % name))
    worst = 0
    for frame, cache in enumerate(caches):
        bpy.context.scene.frame_set(frame)
        worst = max(worst, bake.furthest(shown(thing), cache))
    check(worst < 1e-6, "%s is %g m from its point cache" % (name, worst))
    check(bake.furthest(shown(thing), caches[0]) > 0.01, "%s moves" % name)
    print("%s: %d frames, at most %.2g m from the point cache" % (name, len(caches), worst))


def check_usd(folder):
    if not hasattr(bpy.ops.wm, "usd_import") or not bpy.app.build_options.usd:
        print("USD: skipped, this Blender was built without it")
        return
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(folder / "run.usda"))
    for name in bake.NAMES:
        worst = 0
        for frame, cache in enumerate(bake.samples(folder / ("run_%s.pc2" % name))):
            bpy.context.scene.frame_set(frame)
            # The import turns y up into z up.
            points = [(x, z, -y) for x, y, z in shown(bpy.data.objects[name])]
            worst = max(worst, bake.furthest(points, cache))
        check(worst < 1e-5, "%s of the USD file is %g m from its point cache" % (name, worst))
        print("USD %s: at most %.2g m from the point cache" % (name, worst))


with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    bake.bake(sys.argv[sys.argv.index("--") + 1], folder)
    for name in bake.NAMES:
        check_cache(folder, name)
    check_usd(folder)
