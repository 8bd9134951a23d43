"""What an import loads: work is counted, not time."""

from __future__ import annotations

import json
import subprocess
import sys

import orogen


def loaded(code: str) -> set[str]:
    """The modules that a program loads."""
    told = "import sys, json; print(json.dumps(sorted(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", f"{code}\n{told}"], check=True, capture_output=True, text=True)
    return set(json.loads(found.stdout))


def test_an_import_loads_what_is_used() -> None:
    first = loaded("import orogen")
    assert {"orogen", "orogen._orogen"} <= first and not first & {"numpy", "orogen._world", "orogen.noise", "inspect"}
    code = "import orogen\norogen.World, orogen.noise, orogen.hydrology, orogen.erosion, orogen.analysis, orogen.errors"
    heavy = {"xarray", "dask", "matplotlib", "tqdm", "pandas", "orogen._options", "orogen._layer_options"}
    used = loaded(code)
    assert {"numpy", "orogen._world"} <= used and not used & (heavy | {"orogen._methods", "orogen._accessor"})


def test_every_name_is_found() -> None:
    for name in orogen.__all__:
        assert getattr(orogen, name) is not None and name in dir(orogen)
    assert orogen.noise.__name__ == "orogen.noise" and not hasattr(orogen, "nothing")
