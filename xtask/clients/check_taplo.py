"""taplo checks every recipe against the JSON Schema, as an editor would; recipes broken in known ways are refused."""

import subprocess

from orogen import NODE_BIN, ROOT, WORK, Checks, orogen

checks = Checks()
RECIPES = ROOT / "recipes"
SCHEMA = RECIPES / "orogen.schema.json"


def lint(path, *options):
    """Whether taplo finds nothing wrong, and the gist of what it says."""
    line = [NODE_BIN / "taplo", "lint", "--no-auto-config", "--colors", "never", *options, path]
    done = subprocess.run(line, cwd=WORK, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    gist = dict.fromkeys(l for l in done.stderr.splitlines() if l.lower().startswith(("error", " warn")))
    return done.returncode == 0, "; ".join(list(gist)[:4])


def lint_by_schema(path):
    """The same, whatever schema the recipe names itself."""
    return lint(path, "--schema", SCHEMA.as_uri())


recipes = sorted(RECIPES.glob("*.toml"))
checks.that("there are recipes", len(recipes) >= 6, f"(found {len(recipes)})")
recipes += sorted((ROOT / "xtask/clients").glob("*.toml"))
for recipe in recipes:
    name = recipe.relative_to(ROOT)
    fine, said = lint_by_schema(recipe)
    checks.that(f"{name}: validates", fine, said)
    fine, said = lint(recipe)
    checks.that(f"{name}: validates against the schema it names", fine, said)
    checks.that(f"{name}: names the schema", "#:schema" in recipe.read_text().split("\n", 1)[0])

# What a run writes is a recipe too.
orogen("generate", "alpine", "--size", 64, "-o", WORK / "run", "--quiet")
fine, said = lint_by_schema(WORK / "run/recipe.toml")
checks.that("recipe.toml of a run: validates", fine, said)

# Each of these must be refused, by name: a check that accepts everything would have passed all of the above.
sound = (RECIPES / "classic.toml").read_text()
checks.that("classic.toml is what the broken ones start from", lint_by_schema(RECIPES / "classic.toml")[0])
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
