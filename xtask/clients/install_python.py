"""Lays the Python package out as its wheel does: install_python.py NATIVE SITE_PACKAGES, with the compiled native part."""

import shutil
import sys
import tomllib
from pathlib import Path


def main(native: str, site: str) -> None:
    root = Path(__file__).parents[2]
    project = tomllib.loads((root / "python/pyproject.toml").read_text())["project"]
    manifest = tomllib.loads((root / "Cargo.toml").read_text())
    version = manifest["workspace"]["package"]["version"]
    package = Path(site) / "orogen"
    left_out = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    # An older one is replaced.
    for old in Path(site).glob("orogen*"):
        shutil.rmtree(old)
    shutil.copytree(root / "python/src/orogen", package, ignore=left_out)
    shutil.copy(native, package / "_orogen.abi3.so")
    info = Path(site) / f"orogen-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.4\nName: {project['name']}\nVersion: {version}\n")
    groups = project["entry-points"]
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in entries.items()) for group, entries in groups.items()]
    (info / "entry_points.txt").write_text("\n".join(lines))


if __name__ == "__main__":
    main(*sys.argv[1:])
