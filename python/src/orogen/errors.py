"""Exceptions. All are an `Error`, and also the built-in exception that fits."""

from __future__ import annotations

__all__ = ["Error", "FileError", "InternalError", "MemoryLimitError", "RecipeError", "RequestError"]


class Error(Exception):
    """Base class of all exceptions of the package. The message says what is wrong, where, and what to do instead."""


class RecipeError(Error, ValueError):
    """A recipe could not be read: its syntax, a key, a value, a name."""


class RequestError(Error, ValueError):
    """A request that the world or the array cannot fulfil: a window, a layer, a size, an option."""


class MemoryLimitError(Error, MemoryError):
    """The work needs more memory than `memory` allows; it was not started."""


class FileError(Error, OSError):
    """A file could not be read or written."""


class InternalError(Error, RuntimeError):
    """A bug of the library, whatever the request."""
