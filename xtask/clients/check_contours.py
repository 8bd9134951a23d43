"""Checks contours: GDAL reads them and computes its own from the same heights; both sets have the same lines in the same places."""

import json
import subprocess

import numpy
from orogen import ROOT, WORK, Checks, export

checks = Checks()
CELL = 40
WINDOW = (37, 11, 311, 203)
INTERVAL = 50


def lines_of(path):
    """Returns the lines of a GeoJSON file as pairs of height and points."""
    found = []
    for feature in json.loads(path.read_text())["features"]:
        geometry = feature["geometry"]
        parts = geometry["coordinates"] if geometry["type"] == "MultiLineString" else [geometry["coordinates"]]
        found += [(feature["properties"]["elevation"], numpy.array(part)[:, :2]) for part in parts]
    return found


def within(lines, box):
    """Returns the segments with both ends in a box."""
    west, south, east, north = box
    found = {}
    for height, points in lines:
        inside = (points[:, 0] >= west) & (points[:, 0] <= east) & (points[:, 1] >= south) & (points[:, 1] <= north)
        both = inside[:-1] & inside[1:]
        lengths = numpy.hypot(*numpy.diff(points, axis=0).T)[both].sum()
        length, all_points = found.get(height, (0.0, []))
        found[height] = (length + lengths, all_points + [points[inside]])
    return {height: (length, numpy.concatenate(points)) for height, (length, points) in found.items()}


def share_near(points, others, tolerance):
    """Returns the share of points that another set contains within a tolerance in each coordinate."""
    grid = {}
    for x, y in others:
        grid.setdefault((round(x / tolerance / 4), round(y / tolerance / 4)), []).append((x, y))
    near = 0
    for x, y in points:
        i, j = round(x / tolerance / 4), round(y / tolerance / 4)
        around = (p for u in (i - 1, i, i + 1) for v in (j - 1, j, j + 1) for p in grid.get((u, v), ()))
        near += any(abs(p[0] - x) <= tolerance and abs(p[1] - y) <= tolerance for p in around)
    return near / len(points)


def compare(ours, theirs):
    """Returns the largest relative difference of lengths, and the smallest share of common points."""
    if ours.keys() != theirs.keys():
        return 1.0, 0.0
    lengths = max(abs(ours[height][0] / max(theirs[height][0], 1e-9) - 1.0) for height in ours)
    points = min(share_near(ours[height][1], theirs[height][1], CELL / 100) for height in ours)
    return lengths, points


def summary(path):
    """Returns the output of ogrinfo for a file, and whether it opened the file."""
    done = subprocess.run(["ogrinfo", "-al", "-so", path], capture_output=True, text=True)
    return done.returncode == 0 and "Feature Count" in done.stdout, done.stdout


for name, recipe in [("alpine", "alpine"), ("plane", ROOT / "xtask/clients/plane.toml")]:
    options = ("--window", ",".join(map(str, WINDOW)), "--cell", CELL) if name == "alpine" else ()
    tiff = export(recipe, f"{name}.tif", *options)
    interval = INTERVAL if name == "alpine" else 30
    # An offset from round numbers: on a plane of whole metres every sample would be exactly on a level.
    levels = [str(0.37 + interval * k) for k in range(-10, 100)]
    path = export(recipe, f"{name}.geojson", *options, f"--levels={','.join(levels)}")
    own = WORK / f"{name}_gdal.geojson"
    subprocess.run(
        ["gdal_contour", "-q", "-a", "elevation", "-fl", *levels, "-f", "GeoJSON", tiff, own], check=True, capture_output=True
    )
    # GDAL continues lines from the outermost samples to the edges of their pixels. Only the area between samples is compared.
    told = json.loads(subprocess.run(["gdalinfo", "-json", tiff], check=True, capture_output=True, text=True).stdout)
    (x, dx, _, y, _, dy), (width, height) = told["geoTransform"], told["size"]
    slack = abs(dx) / 1000
    box = (x + dx / 2 - slack, y + dy * (height - 0.5) - slack, x + dx * (width - 0.5) + slack, y + dy / 2 + slack)
    ours, theirs = within(lines_of(path), box), within(lines_of(own), box)
    lengths, points = compare(ours, theirs)
    checks.that(f"{name}: lengths of all heights within 0.2 % of gdal_contour's", lengths <= 0.002, f"(off by {lengths:.5f})")
    checks.that(f"{name}: 99.5 % of the points where gdal_contour has them, to a hundredth of a cell", points >= 0.995, f"({points:.5f})")
    print(f"{name}: {len(ours)} heights, lengths off by {lengths:.6f} at most, {points:.5f} of the points at least")
    middle = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2]
    for what, turn in [
        ("mirrored east to west", lambda p: numpy.column_stack([2 * middle[0] - p[:, 0], p[:, 1]])),
        ("mirrored north to south", lambda p: numpy.column_stack([p[:, 0], 2 * middle[1] - p[:, 1]])),
        ("moved by half a cell", lambda p: p + abs(dx) / 2),
    ]:
        turned = {height: (length, turn(points)) for height, (length, points) in ours.items()}
        checks.that(f"{name}: {what} it is another", compare(turned, theirs)[1] < 0.5)
    opened, text = summary(path)
    count = sum(1 for _ in json.loads(path.read_text())["features"])
    checks.that(f"{name}: ogrinfo opens it", opened)
    checks.that(f"{name}: with all its lines", f"Feature Count: {count}" in text)
    checks.that(f"{name}: in metres that lie nowhere on Earth", "local metres" in text and "WGS" not in text)
    damaged = WORK / f"{name}_damaged.geojson"
    damaged.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    checks.that(f"{name}: half of the file is refused", not summary(damaged)[0])
    # The comparison must detect a file with one wrong height.
    wrong = {height: (length * 1.02, points) for height, (length, points) in ours.items()}
    checks.that(f"{name}: lines 2 % longer are found out", compare(wrong, theirs)[0] > 0.002)

checks.end()
