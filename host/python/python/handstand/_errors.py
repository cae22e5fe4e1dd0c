"""The exceptions: one root, and below it the built-in ones that they are as well."""

import os


class HandstandError(Exception):
    """The root of all errors of this package.

    Raised itself where nothing came of the work: no design follows, or the logs do not determine
    what was asked. The text says what was found, and on a line of its own the remedy.
    """


class UsageError(HandstandError, ValueError):
    """An argument that makes no sense, with the remedy."""


class DataError(HandstandError, ValueError):
    """A file or an array whose content is refused: the place, what was found, and the remedy."""


class AddressError(UsageError, KeyError):
    """An address that names no value of the model: ``model["link9.mass_kg"]``."""

    def __str__(self) -> str:
        # KeyError shows the representation of its argument.
        return str(self.args[0]) if self.args else ""


class FileError(HandstandError, OSError):
    """A file that the system refuses, with ``errno``, ``filename`` and the remedy.

    It is the built-in exception of that ``errno``, too: a file that is missing is a
    ``FileNotFoundError``.
    """

    def __str__(self) -> str:
        return str(self.strerror)


class MissingFileError(FileError, FileNotFoundError):
    """A file that is not there."""


class FileTakenError(FileError, FileExistsError):
    """A file that is there already."""


class FileForbiddenError(FileError, PermissionError):
    """A file that may not be read, or written."""


class FolderError(FileError, IsADirectoryError):
    """A folder in place of a file."""


_KINDS: tuple[type[FileError], ...] = (
    MissingFileError,
    FileTakenError,
    FileForbiddenError,
    FolderError,
)


def file_error(errno: int | None, said: str, filename: str) -> FileError:
    """The exception of a file: that of its ``errno``."""
    built_in = type(OSError(errno, os.strerror(errno))) if errno is not None else OSError
    kind = next((kind for kind in _KINDS if issubclass(kind, built_in)), FileError)
    if built_in is OSError:
        kind = FileError
    return kind(errno, said, filename)
