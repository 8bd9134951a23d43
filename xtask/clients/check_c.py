"""Checks the library for C: the example is compiled as C and as C++, linked to both libraries, and reads the samples of an export."""

import re
import subprocess
from pathlib import Path

import numpy
from orogen import BINARY, ROOT, WORK, Checks, export

checks = Checks()
RELEASE = Path(BINARY).parent
SOURCE = ROOT / "crates/orogen-c/examples/world.c"
FLAGS = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-I", ROOT / "crates/orogen-c/include"]

heights = numpy.load(export("hills", "hills.npy", "--cell", 100))

outputs = []
for name, link in [
    ("shared", ["-L", RELEASE, "-lorogen", f"-Wl,-rpath,{RELEASE}"]),
    ("static", [RELEASE / "liborogen.a", "-lm", "-lpthread", "-ldl"]),
]:
    subprocess.run(["gcc", "-std=c11", *FLAGS, SOURCE, *link, "-o", WORK / name], check=True)
    done = subprocess.run([WORK / name, "hills"], capture_output=True, text=True, check=True)
    outputs.append(done.stdout.splitlines())
checks.equal("both libraries say the same", *outputs)
lines = outputs[0]
rows = [[float.fromhex(value) for value in line.split()] for line in lines[1:5]]
checks.that("a window has the samples of the export", numpy.array_equal(numpy.float32(rows), heights[20:24, 10:15]), rows)
points = [float.fromhex(value) for value in lines[5].split()[1:]]
checks.equal("points have the samples of the export", points, [float(heights[20, 10]), float(heights[23, 11])])
checks.that("chunks are made and dropped", all(int(word) > 0 for word in re.findall(r"\d+", lines[6])), lines[6])
checks.that("a wrong layer is named", "did you mean `height`?" in lines[-1], lines[-1])

# C++ takes the header.
(WORK / "head.cpp").write_text('#include "orogen.h"\nint main() { return orogen_version()[0] == 0; }\n')
subprocess.run(
    ["g++", "-std=c++20", *FLAGS, WORK / "head.cpp", "-L", RELEASE, "-lorogen", f"-Wl,-rpath,{RELEASE}", "-o", WORK / "head"], check=True
)
checks.equal("C++ calls it", subprocess.run([WORK / "head"]).returncode, 0)
checks.end()
