"""Progress of long work: a callback, or a bar of tqdm."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

#: A function that is called with the share of the work that is done, from 0 to 1; or True for a bar of tqdm.
Progress: TypeAlias = Callable[[float], object] | bool | None


@contextmanager
def listener(progress: Progress) -> Iterator[Callable[[float], object] | None]:
    """The function that the native part calls."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        # Only who asks for a bar needs it.
        from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]

        with tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:

            def show(share: float) -> None:
                bar.update(round(100 * share) - bar.n)

            yield show
    else:
        yield progress
