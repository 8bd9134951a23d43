"""D8 flow routing in NumPy: areas, downstream paths, and the cells whose result the map determines."""

import heapq

import numpy

# The row and column offset of each ESRI direction.
STEPS = {1: (0, 1), 2: (1, 1), 4: (1, 0), 8: (1, -1), 16: (0, -1), 32: (-1, -1), 64: (-1, 0), 128: (-1, 1)}


def receivers(codes):
    """Returns the cell that each cell drains to by its ESRI direction, and its distance in cells; the cell itself where water leaves the map."""
    rows, columns = codes.shape
    index = numpy.arange(rows * columns).reshape(rows, columns)
    to, length = index.copy(), numpy.zeros(codes.shape)
    for code, (down, right) in STEPS.items():
        y, x = numpy.nonzero(codes == code)
        inside = (y + down >= 0) & (y + down < rows) & (x + right >= 0) & (x + right < columns)
        y, x = y[inside], x[inside]
        to[y, x] = index[y + down, x + right]
        length[y, x] = numpy.hypot(down, right)
    return to.ravel(), length.ravel()


def accumulated(codes):
    """Returns the number of cells that drain through each cell, itself included."""
    to, _ = receivers(codes)
    waiting = numpy.bincount(to[to != numpy.arange(to.size)], minlength=to.size).tolist()
    to, count = to.tolist(), [1] * to.size
    ready = [cell for cell, waits in enumerate(waiting) if waits == 0]
    while ready:
        cell = ready.pop()
        if to[cell] != cell:
            count[to[cell]] += count[cell]
            waiting[to[cell]] -= 1
            if waiting[to[cell]] == 0:
                ready.append(to[cell])
    return numpy.array(count).reshape(codes.shape)


def below_border(codes):
    """Returns the cells downstream of the map's outermost cells, which may receive water from outside the map."""
    to, _ = receivers(codes)
    reached = numpy.zeros(codes.shape, bool)
    reached[[0, -1]] = reached[:, [0, -1]] = True
    reached = reached.ravel()
    new = numpy.flatnonzero(reached)
    while new.size:
        new = numpy.unique(to[new])
        new = new[~reached[new]]
        reached[new] = True
    return reached.reshape(codes.shape)


def downstream(codes, streams):
    """Returns each cell's first stream cell downstream (-1 if none), its distance in cells, and whether the map determines the path.

    The path is not determined if a cell on it is no stream with the map's own water but may be one with water from outside.
    """
    to, length = receivers(codes)
    unknown = (below_border(codes) & ~streams).ravel()
    streams = streams.ravel()
    to[streams] = numpy.flatnonzero(streams)
    length[streams] = 0
    # Pointer doubling.
    while not (to[to] == to).all():
        length, unknown, to = length + length[to], unknown | unknown[to], to[to]
    unknown |= unknown[to]
    shape = codes.shape
    return numpy.where(streams[to], to, -1).reshape(shape), length.reshape(shape), ~unknown.reshape(shape)


def flooded(z, step=0.0, sea=0.0):
    """Returns the heights with depressions filled: Priority-Flood from the border and the sea with a minimum step per cell."""
    rows, columns = z.shape
    heights, level = z.tolist(), [[None] * columns for _ in range(rows)]
    border = [(y, x) for y in range(rows) for x in range(columns) if y in (0, rows - 1) or x in (0, columns - 1) or z[y, x] <= sea]
    queue = [(heights[y][x], y, x) for y, x in border]
    for height, y, x in queue:
        level[y][x] = height
    heapq.heapify(queue)
    while queue:
        height, y, x = heapq.heappop(queue)
        for down, right in STEPS.values():
            j, i = y + down, x + right
            if 0 <= j < rows and 0 <= i < columns and level[j][i] is None:
                level[j][i] = max(height + step, heights[j][i])
                heapq.heappush(queue, (level[j][i], j, i))
    return numpy.array(level)


def torn(z):
    """Returns the inner cells whose two steepest directions are (almost) equally steep, and the cells around them."""
    slopes = [
        (z[1:-1, 1:-1] - z[1 + down : z.shape[0] - 1 + down, 1 + right : z.shape[1] - 1 + right]) / numpy.hypot(down, right)
        for down, right in STEPS.values()
    ]
    second, first = numpy.sort(slopes, axis=0)[-2:]
    found = numpy.zeros(z.shape, bool)
    for down, right in ((0, 0), *STEPS.values()):
        found[1 + down : z.shape[0] - 1 + down, 1 + right : z.shape[1] - 1 + right] |= first - second <= 1e-6 * first
    return found


def to_border(shape):
    """Returns the distance of each cell from the nearest border cell, in cells."""
    rows, columns = (numpy.minimum(numpy.arange(size), size - 1 - numpy.arange(size)) for size in shape)
    return numpy.minimum(rows[:, None], columns[None, :])
