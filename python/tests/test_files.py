"""Files larger than memory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import orogen
import pytest
from orogen import files, hydrology


@pytest.fixture(scope="module")
def land(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Heights of 77 MB."""
    world = orogen.World("hills", cache=False)
    return world.build(tmp_path_factory.mktemp("files") / "land.tif", cell=15360 / 4400, tile=256)


def test_files_larger_than_half_of_the_memory_are_read_in_parts(land: Path, tmp_path: Path) -> None:
    here = orogen.World(land, cache=False)
    found = files.accumulate(land, tmp_path / "area.tif", memory="140MiB", threads=2)
    assert found == tmp_path / "area.tif"
    area = orogen.World(found, cache=False)
    assert area.view() == here.view()
    padded = np.pad(here.window(), 2, mode="edge")
    # But for ties between directions.
    same = area.window() == hydrology.accumulate(padded, cell=here.view().cell)[2:-2, 2:-2]
    assert same.shape == (4400, 4400) and same.mean() > 0.999


def test_results_are_those_of_arrays(tmp_path: Path) -> None:
    world = orogen.World("badlands", cache=False)
    small = world.export(tmp_path / "small.tif", size=300)
    filled = orogen.World(files.fill(small, tmp_path / "filled.tif"), cache=False)
    heights = orogen.World(small, cache=False).window()
    expect = hydrology.fill(np.pad(heights, 2, mode="edge"))[2:-2, 2:-2]
    assert (expect > heights).any() and np.array_equal(filled.window(), expect)


def test_a_file_is_not_replaced_by_its_result(land: Path) -> None:
    before = land.stat()
    with pytest.raises(orogen.errors.FileError, match="reads that file"):
        files.fill(land, land, overwrite=True)
    assert land.stat() == before


def test_little_memory_is_refused_in_a_sentence(land: Path, tmp_path: Path) -> None:
    with pytest.raises(orogen.errors.MemoryLimitError, match="MiB"):
        files.accumulate(land, tmp_path / "area.tif", memory="20MiB")
    assert not list(tmp_path.iterdir())
