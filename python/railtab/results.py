"""Results files of runs as arrays with units."""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any

import h5py
import numpy

from ._railtab import InputError

_DIRECTIONS = ("x", "y", "z", "roll", "pitch", "yaw")


def open_results(file: str | os.PathLike[str]) -> Results:
    """Opens the results of a run, also while it goes on. See Results."""
    return Results(file)


class Results(Mapping):
    """The results of a run: names of data to NumPy arrays, read when they are asked for.

    Names and shapes are those of docs/file_formats/results.md, "time", "wheels/Q", "bodies/acceleration" and so on; the
    first axis of a history is the record. Used in a with statement, or closed by close().

    >>> with railtab.open_results(results_file) as results:
    ...     Q = results["wheels/Q"]
    ...     unit = results.unit("wheels/Q")
    >>> Q.shape[1], unit
    (8, 'N')
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        name = os.fspath(file)
        try:
            self._file = h5py.File(name, "r", libver="latest", swmr=True)
        except OSError as error:
            raise InputError(f"{name}: found no readable HDF5 file ({error}), expected results of vsi run") from error
        if self._file.attrs.get("filetype") != b"railtab-results":
            self._file.close()
            raise InputError(f"{name}: found no results, expected those of vsi run")
        self._records = int(self._file["records"][0])

    def __getitem__(self, name: str) -> numpy.ndarray:
        data = self._dataset(name)
        rows = data[: self._records] if "rows" in data.attrs else data[()]
        return numpy.char.decode(rows, "utf-8") if data.dtype.kind == "S" else rows

    def __iter__(self) -> Iterator[str]:
        names: list[str] = []
        self._file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        return iter(names)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def unit(self, name: str) -> str:
        """Unit of an array, "1" where it has none; of motions "m, rad": of x, y, z and of the rotations."""
        return _text(self._dataset(name).attrs["unit"])

    def description(self, name: str) -> str:
        """What an array holds."""
        return _text(self._dataset(name).attrs["description"])

    @property
    def summary(self) -> dict[str, Any]:
        """How the run ended, its counts, extremes and times: the attributes of the file's summary."""
        return {name: _text(value) for name, value in self._file["summary"].attrs.items()}

    @property
    def scene_text(self) -> str:
        """The scene that was run."""
        return str(self["header/scene_text"][0])

    @property
    def wheel_names(self) -> list[str]:
        """Of the second axis of "wheels/…"."""
        return [f"wheelset {1 + w // 2} {('left', 'right')[w % 2]}" for w in range(self._wheels())]

    def to_pandas(self, name: str) -> Any:
        """A history as a pandas.DataFrame over time [s]; columns are wheels, or bodies or nodes with directions.

        >>> with railtab.open_results(results_file) as results:
        ...     results.to_pandas("wheels/Q").columns[0]
        'wheelset 1 left'
        """
        import pandas

        values = self[name]
        if "rows" not in self._dataset(name).attrs:
            raise InputError(f"{name}: found no history, expected data with a row per record, such as wheels/Q")
        index = pandas.Index(self["time"], name="time")
        if values.ndim == 1:
            return pandas.DataFrame({name: values}, index=index)
        part = name.split("/")[0]
        if part == "wheels":
            return pandas.DataFrame(values, index=index, columns=self.wheel_names)
        columns = pandas.MultiIndex.from_product([self[part + "/names"], _DIRECTIONS], names=[part, "direction"])
        return pandas.DataFrame(values.reshape(len(values), -1), index=index, columns=columns)

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if not self._file:
            return "<closed railtab.Results>"
        return f"<railtab.Results {self._file.filename}: {self._records} records>"

    def _dataset(self, name: str) -> h5py.Dataset:
        data = self._file.get(name)
        if not isinstance(data, h5py.Dataset):
            raise KeyError(name)
        return data

    def _wheels(self) -> int:
        return int(self._file["wheels/Q"].shape[1]) if "wheels/Q" in self._file else 0


def _text(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if isinstance(value, numpy.generic) else value
