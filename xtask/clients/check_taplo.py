"""taplo checks every recipe against the JSON Schema, as an editor would; recipes broken in known ways are refused."""

import re
import subprocess
import sys

from orogen import NODE_BIN, ROOT, WORK, Checks, orogen

checks = Checks()
RECIPES = ROOT / "crates/orogen-engine/recipes"
SCHEMA = RECIPES / "orogen.schema.json"


def lint(paths, *options):
    """What taplo finds wrong, by path. One start of it takes seconds, so it is asked about many files at once."""
    line = [NODE_BIN / "taplo", "lint", "--no-auto-config", "--colors", "never", *options, *paths]
    done = subprocess.run(line, cwd=WORK, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    wrong, said = {}, []
    for text in done.stderr.splitlines():
        # The complaints about a file come first, then the line that names it.
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
    """The same, whatever schema the recipes name themselves."""
    return lint(paths, "--schema", SCHEMA.as_uri())


recipes = sorted(RECIPES.glob("*.toml"))
checks.that("there are recipes", len(recipes) >= 6, f"(found {len(recipes)})")
recipes += sorted((ROOT / "xtask/clients").glob("*.toml"))
for recipe in recipes:
    checks.that(f"{recipe.relative_to(ROOT)}: names the schema", "#:schema" in recipe.read_text().split("\n", 1)[0])
checks.equal("recipes that their own schema refuses", lint(recipes), {})

# What a run writes is a recipe too.
orogen("generate", "alpine", "--size", 64, "-o", WORK / "run", "--quiet")
checks.equal("recipes that the schema refuses", lint_by_schema(WORK / "run/recipe.toml", *recipes), {})

# Each of these must be refused, by name: a check that accepts everything would have passed all of the above.
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
