"""taplo checks every recipe against the JSON Schema, as an editor would; recipes broken in known ways are refused."""

import subprocess

from orogen import NODE_BIN, ROOT, WORK, Checks, orogen

checks = Checks()
RECIPES = ROOT / "recipes"
SCHEMA = RECIPES / "orogen.schema.json"


def lint(paths, *options):
    """Whether taplo finds nothing wrong in any of them, and the gist of what it says. One start of it takes seconds."""
    line = [NODE_BIN / "taplo", "lint", "--no-auto-config", "--colors", "never", *options, *paths]
    done = subprocess.run(line, cwd=WORK, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    gist = dict.fromkeys(l for l in done.stderr.splitlines() if l.lower().startswith(("error", " warn")))
    return done.returncode == 0, "; ".join(list(gist)[:4])


def lint_by_schema(*paths):
    """The same, whatever schema the recipes name themselves."""
    return lint(paths, "--schema", SCHEMA.as_uri())


recipes = sorted(RECIPES.glob("*.toml"))
checks.that("there are recipes", len(recipes) >= 6, f"(found {len(recipes)})")
recipes += sorted((ROOT / "xtask/clients").glob("*.toml"))
for recipe in recipes:
    checks.that(f"{recipe.relative_to(ROOT)}: names the schema", "#:schema" in recipe.read_text().split("\n", 1)[0])
fine, said = lint(recipes)
checks.that("the recipes validate against the schema they name", fine, said)

# What a run writes is a recipe too.
orogen("generate", "alpine", "--size", 64, "-o", WORK / "run", "--quiet")
fine, said = lint_by_schema(WORK / "run/recipe.toml", *recipes)
checks.that("the recipes and the recipe.toml of a run validate", fine, said)

# Each of these must be refused, by name: a check that accepts everything would have passed all of the above.
sound = (RECIPES / "classic.toml").read_text()
broken = {
    "a version that does not exist": (sound.replace("orogen = 1", "orogen = 99"), "1 was expected"),
    "an unknown key": (sound.replace("orogen = 1", "orogen = 1\nwizard = 3"), "wizard"),
    "an unknown op": (sound + '\n[nodes.added]\nop = "no_such_op"\n', "no_such_op"),
    "an unknown parameter": (sound + '\n[nodes.added]\nop = "perlin"\nwavelenght = 100.0\n', "wavelenght"),
    "a value of the wrong type": (sound + '\n[nodes.added]\nop = "perlin"\nwavelength = "long"\n', "long"),
}
for what, (text, culprit) in broken.items():
    path = WORK / (what.replace(" ", "_") + ".toml")
    path.write_text(text)
    fine, said = lint_by_schema(path)
    checks.that(f"{what}: differs from the sound recipe", text != sound)
    checks.that(f"{what}: refused", not fine)
    checks.that(f"{what}: named", culprit in said, said)

checks.end()
