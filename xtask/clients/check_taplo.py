"""Checks the JSON Schema of recipes with taplo: it accepts every recipe and rejects recipes with known errors."""

import re
import subprocess
import sys

from orogen import NODE_BIN, ROOT, WORK, Checks, orogen

checks = Checks()
RECIPES = ROOT / "crates/orogen-engine/recipes"
SCHEMA = RECIPES / "orogen.schema.json"


def lint(paths, *options):
    """Returns taplo's errors by path. taplo takes seconds to start, so one call checks many files."""
    line = [NODE_BIN / "taplo", "lint", "--no-auto-config", "--colors", "never", *options, *paths]
    done = subprocess.run(line, cwd=WORK, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    wrong, said = {}, []
    for text in done.stderr.splitlines():
        # The errors of a file precede the line with its name.
        named = re.match(r'ERROR .*invalid file error=(.*) path="(.*)"', text)
        if named:
            wrong[named[2]] = "; ".join(dict.fromkeys(said + [named[1]]))
            said = []
        elif text.startswith("error"):
            said.append(text)
    if done.returncode != 0 and not wrong:
        sys.exit(f"taplo ended with {done.returncode}:\n{done.stderr}")
    return wrong


def lint_by_schema(*paths):
    """Returns the same, regardless of the schema that the recipes name."""
    return lint(paths, "--schema", SCHEMA.as_uri())


recipes = sorted(RECIPES.glob("*.toml"))
checks.that("there are recipes", len(recipes) >= 6, f"(found {len(recipes)})")
recipes += sorted((ROOT / "xtask/clients").glob("*.toml"))
for recipe in recipes:
    checks.that(f"{recipe.relative_to(ROOT)}: names the schema", "#:schema" in recipe.read_text().split("\n", 1)[0])
checks.equal("recipes that their own schema refuses", lint(recipes), {})

# The recipe in the output of a run is valid too.
orogen("generate", "alpine", "--size", 64, "-o", WORK / "run", "--quiet")
checks.equal("recipes that the schema refuses", lint_by_schema(WORK / "run/recipe.toml", *recipes), {})

# Each of these must be rejected by name; otherwise the checks above prove nothing.
sound = (RECIPES / "classic.toml").read_text()
broken = {
    "a version that does not exist": (sound.replace("orogen = 1", "orogen = 99"), "1 was expected"),
    "an unknown key": (sound.replace("orogen = 1", "orogen = 1\nwizard = 3"), "wizard"),
    "an unknown op": (sound + '\n[nodes.added]\nop = "no_such_op"\n', "no_such_op"),
    "an unknown parameter": (sound + '\n[nodes.added]\nop = "perlin"\nwavelenght = 100.0\n', "wavelenght"),
    "a value of the wrong type": (sound + '\n[nodes.added]\nop = "perlin"\nwavelength = "long"\n', "long"),
}
paths = {}
for what, (text, _) in broken.items():
    checks.that(f"{what}: differs from the sound recipe", text != sound)
    paths[what] = WORK / (what.replace(" ", "_") + ".toml")
    paths[what].write_text(text)
wrong = lint_by_schema(RECIPES / "classic.toml", *paths.values())
checks.equal("files refused", sorted(wrong), sorted(map(str, paths.values())))
for what, (_, culprit) in broken.items():
    said = wrong.get(str(paths[what]), "")
    checks.that(f"{what}: named", culprit in said, f"(taplo said: {said})")

checks.end()
