"""Checks the library for Godot without Godot: a stand-in for the engine loads it, as the GDExtension interface describes, and gets its classes and methods. gdtoolkit reads the scripts of the example project, godot_parser its scene."""

import ctypes
import os
import re
import subprocess
import sys
from pathlib import Path

import godot_parser
from orogen import ROOT, Checks

checks = Checks()
PROJECT = ROOT / "engines" / "godot" / "project"
POINTER = ctypes.c_void_p
# What `get_godot_version` tells: the oldest version that the library supports.
VERSION = (4, 2, 0)

texts = [""]
keep = []
classes = {}
errors = []


def function(result, *arguments):
    """A decorator: a Python function as a C function, which stays alive."""

    def wrap(body):
        made = ctypes.CFUNCTYPE(result, *arguments)(body)
        keep.append(made)
        return made

    return wrap


def address(made):
    """The address of a C function."""
    return ctypes.cast(made, POINTER).value


def put(at, text):
    """Stores a string in the eight bytes of a String or a StringName: the number of a text."""
    if text not in texts:
        texts.append(text)
    ctypes.c_int64.from_address(at).value = texts.index(text)


def text_at(at):
    """The string in the eight bytes of a String or a StringName."""
    return texts[ctypes.c_int64.from_address(at).value]


@function(POINTER)
def nothing():
    """What the library may call and what does nothing here. Where a function is asked for, it returns one."""
    return address(nothing)


@function(None, POINTER)
def get_godot_version(at):
    for k, number in enumerate(VERSION):
        ctypes.c_uint32.from_address(at + 4 * k).value = number
    ctypes.c_void_p.from_address(at + 16).value = ctypes.cast(version_text, POINTER).value


version_text = ctypes.create_string_buffer(b"Godot Engine v4.2.0 (stand-in)")


@function(None, POINTER, ctypes.c_char_p, ctypes.c_uint8)
def string_name_new_with_latin1_chars(at, text, _is_static):
    put(at, text.decode("latin-1"))


@function(None, POINTER, ctypes.c_char_p)
def with_utf8_chars(at, text):
    put(at, text.decode())


@function(None, POINTER, POINTER, ctypes.c_int64)
def with_utf8_chars_and_len(at, text, length):
    put(at, ctypes.string_at(text, length).decode())


@function(ctypes.c_int64, POINTER, POINTER, ctypes.c_int64)
def with_utf8_chars_and_len2(at, text, length):
    put(at, ctypes.string_at(text, length).decode())
    return 0


@function(None, POINTER, ctypes.POINTER(POINTER))
def copy(at, arguments):
    """A constructor of a String or a StringName: from the other, from the same, or an empty one."""
    ctypes.c_int64.from_address(at).value = ctypes.c_int64.from_address(arguments[0]).value if arguments and arguments[0] else 0


@function(POINTER, ctypes.c_int32, ctypes.c_int32)
def variant_get_ptr_constructor(kind, number):
    # 4 is String, 21 StringName; constructor 0 makes an empty one.
    return address(copy) if kind in (4, 21) and number > 0 else address(clear)


@function(None, POINTER, POINTER)
def clear(at, _arguments):
    ctypes.c_int64.from_address(at).value = 0


@function(None, POINTER, POINTER, POINTER, POINTER)
def register_class(_library, name, parent, _info):
    classes[text_at(name)] = (text_at(parent), [])


@function(None, POINTER, POINTER, POINTER)
def register_method(_library, name, method):
    # The first member of the description is the pointer to the name of the method.
    classes[text_at(name)][1].append(text_at(ctypes.c_void_p.from_address(method).value))


@function(POINTER, POINTER, POINTER, ctypes.c_int64)
def classdb_get_method_bind(_kind, method, _hash):
    """A method of Godot's own classes, as the number of its name."""
    return 1 + ctypes.c_int64.from_address(method).value


@function(None, POINTER, POINTER, ctypes.POINTER(POINTER), POINTER)
def object_method_bind_ptrcall(method, _object, arguments, result):
    # The only call at the start: `OS.has_feature`, which tells the precision that Godot was built for.
    if texts[method - 1] == "has_feature":
        ctypes.c_uint8.from_address(result).value = text_at(arguments[0]) == "single"


@function(None, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_int32, ctypes.c_uint8)
def print_error(text, *_rest):
    errors.append(text.decode())


FUNCTIONS = {
    "get_godot_version": get_godot_version,
    "string_name_new_with_latin1_chars": string_name_new_with_latin1_chars,
    "string_name_new_with_utf8_chars": with_utf8_chars,
    "string_name_new_with_utf8_chars_and_len": with_utf8_chars_and_len,
    "string_new_with_utf8_chars": with_utf8_chars,
    "string_new_with_utf8_chars_and_len": with_utf8_chars_and_len,
    "string_new_with_utf8_chars_and_len2": with_utf8_chars_and_len2,
    "variant_get_ptr_constructor": variant_get_ptr_constructor,
    "classdb_get_method_bind": classdb_get_method_bind,
    "object_method_bind_ptrcall": object_method_bind_ptrcall,
    "print_error": print_error,
    "print_script_error": print_error,
}


@function(POINTER, ctypes.c_char_p)
def get_proc_address(name):
    name = name.decode()
    if re.fullmatch(r"classdb_register_extension_class\d*", name):
        return address(register_class)
    if name == "classdb_register_extension_class_method":
        return address(register_method)
    return address(FUNCTIONS.get(name, nothing))


class Initialization(ctypes.Structure):
    """GDExtensionInitialization."""

    _fields_ = [
        ("minimum_level", ctypes.c_int32),
        ("userdata", POINTER),
        ("initialize", ctypes.CFUNCTYPE(None, POINTER, ctypes.c_int32)),
        ("deinitialize", ctypes.CFUNCTYPE(None, POINTER, ctypes.c_int32)),
    ]


def settings(path):
    """The entries of a configuration file of Godot."""
    return dict(re.findall(r"^([\w./]+)\s*=\s*(.*)$", path.read_text(), re.M))


def load():
    """Loads the library, and takes it through the levels of initialization."""
    library = ctypes.CDLL(os.environ["OROGEN_GODOT"])
    entry = settings(PROJECT / "orogen.gdextension")["entry_symbol"].strip('"')
    start = getattr(library, entry)
    start.restype = ctypes.c_uint8
    start.argtypes = [POINTER, POINTER, POINTER]
    made = Initialization()
    own = ctypes.create_string_buffer(64)
    checks.equal("the library starts", start(address(get_proc_address), ctypes.addressof(own), ctypes.addressof(made)), 1)
    for level in range(made.minimum_level, 3):
        made.initialize(made.userdata, level)


def methods_of(source):
    """The methods that a Rust file gives to Godot."""
    return re.findall(r"#\[func\]\n\s+fn (\w+)\(", (ROOT / "engines/godot/src" / source).read_text())


load()
checks.equal("errors that the library reports", errors, [])
checks.equal("classes", {name: parent for name, (parent, _) in classes.items()}, {"OrogenWorld": "RefCounted", "OrogenChunks": "RefCounted"})
for name, source in (("OrogenWorld", "world.rs"), ("OrogenChunks", "chunks.rs")):
    expect = methods_of(source)
    checks.that(f"{name}: methods", len(expect) > 5 and sorted(classes[name][1]) == sorted(expect), classes[name][1])

scripts = sorted(PROJECT.glob("*.gd"))
for tool in ("gdparse", "gdlint"):
    done = subprocess.run([Path(sys.executable).parent / tool, *scripts], capture_output=True, stdin=subprocess.DEVNULL)
    checks.equal(f"{tool}: {done.stdout.decode()}{done.stderr.decode()}", done.returncode, 0)
called = set(re.findall(r"(?:world|_chunks)\.(\w+)\(", "".join(script.read_text() for script in scripts)))
known = {method for _, methods in classes.values() for method in methods}
checks.that("scripts call methods that there are", len(called) > 5 and called <= known, called - known)
scene = godot_parser.load(str(PROJECT / "main.tscn"))
resources = {section.properties.get("path") or section.header.attributes.get("path") for section in scene.get_ext_resources()}
checks.equal("scene: its scripts", resources, {f"res://{script.name}" for script in scripts})
with scene.use_tree() as tree:
    terrain, ball = tree.get_node("Terrain"), tree.get_node("Ball")
    checks.equal("scene: its nodes", (terrain.type, ball.type, tree.get_node("Ball/Shape").type), ("Node3D", "RigidBody3D", "CollisionShape3D"))
exported = set(re.findall(r"@export var (\w+)", "".join(script.read_text() for script in scripts)))
given = set(terrain.properties) | set(ball.properties)
checks.that("scene: its nodes have exported variables", {"viewer", "terrain", "camera"} <= given & exported, given)
checks.equal("project: its scene", settings(PROJECT / "project.godot")["run/main_scene"], '"res://main.tscn"')
checks.end()
