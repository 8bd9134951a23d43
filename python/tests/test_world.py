"""Windows, points, layers and files of worlds."""

from __future__ import annotations

import json
import pickle
import signal
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import orogen
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

RECIPE = {
    "orogen": 1,
    "world": {"size": [4000, 2000], "cell": 20, "seed": 3},
    "nodes": {"a": {"op": "fbm", "wavelength": 900}, "b": {"op": "remap", "source": "a", "to": [0, 300]}},
    "outputs": {"height": "b"},
}


def test_a_window_is_an_array_of_heights(hills: orogen.World) -> None:
    height = hills.window(size=64)
    assert height.dtype == np.float32 and height.shape == (64, 64) and height.flags.c_contiguous
    assert np.isfinite(height).all() and np.ptp(height) > 10


def test_any_window_is_the_crop_of_the_whole(hills: orogen.World) -> None:
    whole = hills.window(window=(0, 0, 96, 80))
    assert np.array_equal(hills.window(window=(13, 40, 30, 25)), whole[40:65, 13:43])
    assert np.array_equal(hills.window(window=orogen.Window(13, 40, 30, 25, hills.cell)), whole[40:65, 13:43])


@settings(max_examples=20, deadline=None)
@given(x=st.integers(-50, 50), y=st.integers(-50, 50), width=st.integers(1, 40), height=st.integers(1, 40))
def test_windows_anywhere_agree(x: int, y: int, width: int, height: int) -> None:
    world = orogen.World({**RECIPE, "world": {"cell": 20, "seed": 3}}, cache=False)
    whole = world.window(window=(-50, -50, 140, 140))
    part = world.window(window=(x, y, width, height))
    assert np.array_equal(part, whole[y + 50 : y + 50 + height, x + 50 : x + 50 + width])


def test_points_have_the_bits_of_windows(hills: orogen.World) -> None:
    window = hills.view(window=(100, 50, 20, 10))
    samples = hills.window(window=window)
    points = hills.points(window.east, window.south[:, None])
    assert points.shape == (10, 20) and np.array_equal(points, samples)
    sampler = hills.sampler()
    assert np.array_equal(sampler(window.east, window.south[:, None]), samples)
    assert np.array_equal(sampler.window(window), samples)
    assert hills.points(window.east[3], window.south[2]).shape == ()


def test_tiles_make_up_the_whole(hills: orogen.World) -> None:
    whole = hills.window(window=(5, 6, 70, 50))
    made = np.full_like(whole, np.nan)
    for window, tile in hills.tiles(32, window=(5, 6, 70, 50)):
        rows = slice(window.y - 6, window.y - 6 + window.height)
        made[rows, window.x - 5 : window.x - 5 + window.width] = tile
    assert np.array_equal(made, whole)


def test_size_cell_and_bounds_choose_samples() -> None:
    world = orogen.World(RECIPE, cache=False)
    assert world.size == (4000, 2000) and world.cell == 20
    assert world.view() == (0, 0, 200, 100, 20)
    assert world.view(size=50) == world.view(size=(50, 25)) == (0, 0, 50, 25, 80)
    assert world.view(cell=10).shape == (200, 400)
    assert world.view(bounds=(1000, -1500, 2000, -500)) == (50, 25, 50, 50, 20)
    assert world.view(window="1km,500m,1km,1km") == (50, 25, 50, 50, 20)


def test_layers_come_by_name(hills: orogen.World) -> None:
    both = orogen.World("alpine", cache=False)
    assert both.layers["height"] == "m"
    part = both.view(cell=480)
    made = both.window(["height", "flow"], window=part)
    assert list(made) == ["height", "flow"] and made["flow"].shape == part.shape
    shade = hills.window("hillshade", size=64, azimuth=90)
    assert shade.shape == (64, 64) and not np.array_equal(shade, hills.window("hillshade", size=64))
    assert hills.window("normal", size=32).shape == (3, 32, 32)


def test_arrays_are_worlds(rough: np.ndarray) -> None:
    world = orogen.World(rough, cell=30.0, cache=False)
    assert world.size == (80 * 30, 60 * 30)
    assert np.array_equal(world.window(), rough)
    assert world.window("slope").shape == rough.shape


def test_parameters_and_seeds_change_the_world() -> None:
    recipe = """
        orogen = 1
        [world]
        cell = 10
        [parameters]
        high = { default = 100, range = [0, 500], unit = "m" }
        [nodes.a]
        op = "constant"
        value = "= high"
        [outputs]
        height = "a"
    """
    assert orogen.World(recipe, cache=False).window(size=2)[0, 0] == 100
    world = orogen.World(recipe, parameters={"high": 7}, cache=False)
    assert world.window(size=2)[0, 0] == 7
    assert world.parameters == [orogen.Parameter("high", 7, 0, 500, "m", "")]
    with pytest.raises(orogen.errors.RecipeError, match="500"):
        orogen.World(recipe, parameters={"high": 501})
    first = orogen.World("hills", seed=1, cache=False)
    assert first.seed == 1 and first.key() != orogen.World("hills", seed=2, cache=False).key()


def test_worlds_are_pickled(hills: orogen.World) -> None:
    for world in (hills, orogen.World(RECIPE, seed=9, cache=False)):
        again = pickle.loads(pickle.dumps(world))
        assert again.seed == world.seed and again.toml == world.toml
        assert np.array_equal(again.window(size=32), world.window(size=32))


def test_threads_share_a_world(hills: orogen.World) -> None:
    windows = [(x, y, 24, 24) for x in range(0, 96, 24) for y in range(0, 96, 24)]
    whole = hills.window(window=(0, 0, 96, 96))
    with ThreadPoolExecutor(8) as pool:
        for (x, y, *_), tile in zip(windows, pool.map(lambda part: hills.window(window=part), windows), strict=True):
            assert np.array_equal(tile, whole[y : y + 24, x : x + 24])


def test_files(hills: orogen.World, tmp_path: Path) -> None:
    samples = hills.window(size=64)
    path = hills.export(tmp_path / "heights.npy", size=64)
    assert np.array_equal(np.load(path), samples)
    deep = hills.export(tmp_path / "heights.png", size=64, bits=16)
    assert deep.read_bytes()[24] == 16
    hills.export(tmp_path / "light.png", "hillshade", size=64, azimuth=90.0)
    hills.export(tmp_path / "land.png", target="unreal", tiles=(2, 1))
    assert (tmp_path / "land_x1_y0.png").is_file()
    with pytest.raises(orogen.errors.RequestError, match="tiles needs target"):
        hills.export(tmp_path / "land.png", tiles=2)
    hills.map(tmp_path / "map.svg", contours=100, cell=240, title="Hills")
    assert "Hills" in (tmp_path / "map.svg").read_text()
    hills.render(tmp_path / "view.png", size=(160, 90), samples=1, cell=240)
    hills.blocks(tmp_path / "blocks.vox", size=32)
    hills.blocks(tmp_path / "save", size=32, format="minecraft")
    assert (tmp_path / "save" / "level.dat").exists() and (tmp_path / "save" / "region" / "r.0.0.mca").exists()
    hills.tilemap(tmp_path / "tiles", size=32)
    hills.build(tmp_path / "heights.tif", cell=120)
    for part in ["2/2", "1/2"]:
        hills.build(tmp_path / "parts.tif", cell=120, part=part)
    assert (tmp_path / "parts.tif").read_bytes() == (tmp_path / "heights.tif").read_bytes()
    assert (tmp_path / "tiles" / "map.tmx").exists() and (tmp_path / "heights.tif").stat().st_size > 1000


def test_existing_files_are_respected(hills: orogen.World, tmp_path: Path) -> None:
    path = tmp_path / "heights.npy"
    path.write_text("notes of a person")
    with pytest.raises(orogen.errors.FileError, match="heights.npy"):
        hills.export(path, size=16)
    hills.export(path, size=16, overwrite=True)
    hills.export(path, size=16)
    with pytest.raises(orogen.errors.Error):
        hills.export(path, size=16, overwrite=False)


def test_mistakes_are_sentences(hills: orogen.World, tmp_path: Path) -> None:
    with pytest.raises(orogen.errors.RequestError, match="did you mean `hills`"):
        orogen.World("hils")
    with pytest.raises(orogen.errors.RecipeError, match="octavs"):
        orogen.World({**RECIPE, "nodes": {"a": {"op": "fbm", "octavs": 3}}})
    with pytest.raises(orogen.errors.RequestError, match="did you mean `height`"):
        hills.window("hight")
    with pytest.raises(TypeError, match="did you mean `contours`"):
        hills.map(tmp_path / "map.png", contour=5)
    with pytest.raises(orogen.errors.RequestError, match="`contours`|contours"):
        hills.map(tmp_path / "map.png", contours="many")
    with pytest.raises(orogen.errors.RequestError, match="size"):
        hills.window(size=0)
    with pytest.raises(orogen.errors.RequestError, match="aspect ratio"):
        hills.window(size=(10, 1000))
    with pytest.raises(orogen.errors.RequestError, match="window"):
        hills.window(window=(0, 0, 0, 5))
    with pytest.raises(orogen.errors.RequestError, match="azimuth"):
        hills.window("height", azimuth=5)
    with pytest.raises(orogen.errors.RequestError, match="extension"):
        hills.render(tmp_path / "view.jpg")
    with pytest.raises(TypeError, match="cell"):
        orogen.World("hills", cell=5)
    assert not any(tmp_path.iterdir())


def test_memory_is_limited() -> None:
    world = orogen.World({**RECIPE, "world": {"cell": 20}}, memory="64MiB", cache=False)
    with pytest.raises(orogen.errors.MemoryLimitError, match="MiB"):
        world.window(window=(0, 0, 20_000, 20_000))
    with pytest.raises(orogen.errors.RequestError, match="512MiB"):
        orogen.World("hills", memory="much")


def test_progress_is_told_and_can_end_the_work() -> None:
    world = orogen.World("alpine", seed=5, cache=False)
    told: list[float] = []
    world.window(cell=120, progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0

    def stop(share: float) -> None:
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        orogen.World("alpine", seed=6, cache=False).window(progress=stop)


def test_a_signal_interrupts_the_work() -> None:
    if threading.current_thread() is not threading.main_thread():
        pytest.skip("signals belong to the main thread")
    # A shell that starts the tests in the background has it ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    world = orogen.World("alpine", seed=8, cache=False)
    timer = threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        world.window(cell=15)
    timer.join()
    signal.signal(signal.SIGINT, before)


def test_pictures_of_notebooks(hills: orogen.World) -> None:
    assert hills._repr_png_().startswith(b"\x89PNG")
    assert repr(hills).startswith("<orogen.World hills: ")


def test_objects_are_columns() -> None:
    recipe = {**RECIPE, "scatter": [{"name": "tree", "spacing": 150}]}
    objects = orogen.World(json.loads(json.dumps(recipe)), cache=False).objects()
    assert objects.names == ["tree"] and len(objects.x) == len(objects.kind) > 10
    assert (objects.x >= 0).all() and (objects.x < 4000).all()


def test_statistics_and_fits_and_finer_land(tmp_path: Path) -> None:
    land = orogen.World("hills", cache=False).window(cell=60)
    place = orogen.World(land, cell=60.0, cache=False)
    figures = place.analyze(tmp_path / "page.png")
    assert figures["width"] == land.shape[1] and figures["figures"]["hack"]["real"]
    assert (tmp_path / "page.png").read_bytes().startswith(b"\x89PNG")
    finer = place.refined(30.0)
    assert finer.cell == 30 and finer.window().shape == (2 * land.shape[0], 2 * land.shape[1])
    assert np.array_equal(pickle.loads(pickle.dumps(finer)).window(size=64), finer.window(size=64))
    likely, draw = place.refined(30.0, detail="learned", noise=0), place.refined(30.0, detail="learned")
    assert not np.array_equal(likely.window(size=64), draw.window(size=64))
    assert np.array_equal(pickle.loads(pickle.dumps(draw)).window(size=64), draw.window(size=64))
    assert place.refined().cell == 7.5
    with pytest.raises(orogen.errors.RequestError, match="rivers or learned"):
        place.refined(30.0, detail="fractal")
    with pytest.raises(orogen.errors.RequestError, match="from 0 to 2"):
        place.refined(30.0, detail="learned", noise=5)
    with pytest.raises(orogen.errors.RequestError, match="applies to"):
        place.refined(30.0, noise=0)
    with pytest.raises(orogen.errors.RequestError, match="refined"):
        place.refined(45.0)
    with pytest.raises(orogen.errors.RequestError, match="only heights"):
        orogen.World("hills").refined(5.0)
    world, report = orogen.fit(land[:128, :128], cell=60.0, tries=12, judges=1)
    assert world.window(size=64).shape == (64, 64) and report["tried"] >= 12
    with pytest.raises(orogen.errors.MemoryLimitError, match="1.0 MiB is allowed"):
        orogen.fit(land[:128, :128], cell=60.0, tries=12, judges=1, memory="1MiB")


def test_presets_are_listed() -> None:
    assert orogen.presets()["alpine"]
    assert orogen.__version__
