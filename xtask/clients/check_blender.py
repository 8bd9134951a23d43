"""Imports meshes into Blender: bounding boxes with the size of the ground, the bump in the north-east, visible light."""

import contextlib
import os
import sys

import bpy
import numpy
from orogen import ROOT, WORK, Checks, export

checks = Checks()
BUMP = ROOT / "xtask/clients/bump.toml"


@contextlib.contextmanager
def quiet():
    """Suppresses stdout, to which Blender logs every file."""
    kept = os.dup(1)
    with open(os.devnull, "w") as nowhere:
        sys.stdout.flush()
        os.dup2(nowhere.fileno(), 1)
        try:
            yield
        finally:
            sys.stdout.flush()
            os.dup2(kept, 1)
            os.close(kept)


IMPORT = {
    ".glb": lambda path: bpy.ops.import_scene.gltf(filepath=path),
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_import(filepath=path),
    ".stl": lambda path: bpy.ops.wm.stl_import(filepath=path),
}


def load(path):
    """Returns the vertices of all meshes of a file in world coordinates: east, north, up."""
    with quiet():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        IMPORT[path.suffix](str(path))
    corners = [item.matrix_world @ vertex.co for item in bpy.data.objects if item.type == "MESH" for vertex in item.data.vertices]
    return numpy.array([list(corner) for corner in corners])


def render(path):
    """Renders a small picture from above on the CPU."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4
    scene.render.resolution_x = scene.render.resolution_y = 64
    places = load_bounds()
    middle, size = (places[0] + places[1]) / 2, (places[1] - places[0]).max()
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", size, 10 * size
    camera.location = (middle[0], middle[1], places[1][2] + size)
    light = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    light.data.energy, light.rotation_euler = 3.0, (0.9, 0.0, 0.8)
    for item in (camera, light):
        scene.collection.objects.link(item)
    scene.camera = camera
    scene.render.filepath = str(path)
    with quiet():
        bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    return numpy.array(image.pixels[:]).reshape(64, 64, 4)[:, :, :3]


def load_bounds():
    """Returns the minimum and maximum corners of the bounding box of all meshes."""
    corners = [item.matrix_world @ vertex.co for item in bpy.data.objects if item.type == "MESH" for vertex in item.data.vertices]
    places = numpy.array([list(corner) for corner in corners])
    return places.min(axis=0), places.max(axis=0)


heights = numpy.load(export(BUMP, "bump.npy", "-q"))
cell = 10.0
ground = numpy.array([(heights.shape[1] - 1) * cell, (heights.shape[0] - 1) * cell, float(heights.max() - heights.min())])
for name, options in [("full.glb", ()), ("few.glb", ("--max-error", "1")), ("bump.obj", ()), ("bump.ply", ())]:
    places = load(export(BUMP, name, "-q", *options))
    low, high = places.min(axis=0), places.max(axis=0)
    off = numpy.abs((high - low) - ground) / ground
    checks.that(f"{name}: as large as the ground", off.max() < (0.01 if options else 1e-5), f"({high - low}, not {ground})")
    summit = (places[places[:, 2].argmax()] - low) / (high - low)
    row, column = numpy.unravel_index(heights.argmax(), heights.shape)
    at = numpy.array([column / (heights.shape[1] - 1), 1 - row / (heights.shape[0] - 1)])
    checks.that(f"{name}: the summit is where it is", numpy.abs(summit[:2] - at).max() < 0.05, f"({summit[:2]}, not {at})")

picture = render(WORK / "picture.png") if load(WORK / "full.glb").size else numpy.zeros((64, 64, 3))
checks.that("light falls on it", picture.std() > 0.01, picture.std())

places = load(export(BUMP, "print.stl", "-q", "--print-size", "120", "--base", "3"))
size = places.max(axis=0) - places.min(axis=0)
checks.near("print.stl: the longer side in millimetres", max(size[:2]), 120, 0.01)
checks.near("print.stl: its shape", size[0] / size[1], ground[0] / ground[1], 1e-3)

half = WORK / "half.glb"
half.write_bytes((WORK / "full.glb").read_bytes()[:2000])
try:
    refused = load(half).size == 0
except RuntimeError:
    refused = True
checks.that("half a file is refused", refused)
checks.end()
