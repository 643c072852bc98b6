"""Runs of scenes in this process."""
from __future__ import annotations

import itertools
import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy

from . import _railtab
from ._railtab import ComputationError, StepRecord

PathLike = str | os.PathLike[str]


def run(
    scene: PathLike,
    output: PathLike | None = None,
    *,
    changes: Mapping[str, Any] | None = None,
    resume: bool = False,
    on_step: Callable[[StepRecord], object] | None = None,
    on_progress: Callable[[float], object] | None = None,
) -> dict[str, Any]:
    """Runs a scene as `vsi run` does, with the same results.

    output       results file; without one nothing is written
    changes      keys of the scene with other values, {"train.speed_kmh": 250, "contact.mode": "online"}; None takes a
                 key out of the scene. Of several [[bridge]], "bridge.2.length" is the second's. Files are relative to
                 the scene.
    resume       go on from the last checkpoint in output; complete results are left alone
    on_step      called with each StepRecord that is recorded (output.every). StopIteration ends the run there, other
                 exceptions too, and they are raised again; the results up to there are kept, with a checkpoint.
    on_progress  called with the share of the run that is done, 0 to 1, some times a second

    Returns the summary with the keys of `vsi run --json` (docs/guide/vsi.md) but `warnings`: those are issued by
    warnings.warn. Ctrl-C ends the run after its step. Other Python threads run meanwhile.

    Raises InputError where the scene is wrong, and ComputationError where the run cannot go on: its results up to there
    are in output.

    >>> summary = railtab.run(scene_file, changes={"integration.duration": 0.05})
    >>> summary["complete"], summary["steps"]
    (True, 50)
    """
    summary = _run(scene, output, changes, resume, on_step, on_progress)
    if not summary["complete"] and not summary["interrupted"]:
        kept = f"; everything up to there is in {summary['results']}" if "results" in summary else ""
        raise ComputationError(
            f"{os.fspath(scene)}: the run ended at t = {summary['simulated_time']:.6g} s: {summary['message']}{kept}"
        )
    return summary


def sweep(
    scene: PathLike,
    values: Mapping[str, Iterable[Any]],
    output: PathLike | None = None,
    *,
    changes: Mapping[str, Any] | None = None,
    threads: int = 1,
) -> list[dict[str, Any]]:
    """Runs a scene with every combination of values of some keys, the last key's changing first.

    values   {"train.speed_kmh": range(150, 260, 10), "irregularity.seed": [1, 2, 3]}
    output   folder of the results files, made where there is none; they are named run-0001.h5 and so on
    changes  of all runs, as of run()
    threads  runs at a time

    Returns one row per run, which pandas.DataFrame takes as they are: the keys with their values, then complete,
    message and the numbers of run()'s summary, those with a place and a time by their value. A run that cannot go on
    has complete = False.

    >>> rows = railtab.sweep(scene_file, {"train.speed_kmh": [180, 200]}, changes={"integration.duration": 0.05})
    >>> [(row["train.speed_kmh"], row["complete"]) for row in rows]
    [(180, True), (200, True)]
    """
    keys = list(values)
    combinations = list(itertools.product(*(list(values[key]) for key in keys)))
    if output is not None:
        Path(output).mkdir(parents=True, exist_ok=True)

    def row(number: int) -> dict[str, Any]:
        own = dict(zip(keys, combinations[number]))
        file = None if output is None else Path(output) / f"run-{number + 1:04}.h5"
        summary = _run(scene, file, {**(changes or {}), **own}, False, None, None)
        return {**own, **{name: _plain(value) for name, value in summary.items() if name != "seconds"}}

    if threads == 1:  # Ctrl-C reaches runs of the main thread
        return [row(number) for number in range(len(combinations))]
    with ThreadPoolExecutor(max_workers=threads) as pool:
        runs = [pool.submit(row, number) for number in range(len(combinations))]
        try:
            return [of.result() for of in runs]
        except BaseException:
            for of in runs:
                of.cancel()
            raise


def _run(scene, output, changes, resume, on_step, on_progress) -> dict[str, Any]:
    return json.loads(
        _railtab.run_scene(
            scene=os.fspath(scene),
            changes=[(key, _toml(key, value)) for key, value in (changes or {}).items()],
            output=None if output is None else os.fspath(output),
            resume=resume,
            on_step=on_step,
            on_progress=on_progress,
            on_warning=lambda text: warnings.warn(text, stacklevel=2),
        )
    )


def _plain(value: Any) -> Any:
    """The number of what the summary tells with place and time."""
    return value["value"] if isinstance(value, dict) and "value" in value else value


def _toml(key: str, value: Any) -> str:
    """A value as TOML writes it; empty for None, which takes the key out."""
    if value is None:
        return ""
    if isinstance(value, (numpy.generic, numpy.ndarray)):
        value = value.tolist()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(key, item) for item in value) + "]"
    raise _railtab.InputError(f"{key}: found {type(value).__name__}, expected a number, text, bool or list of these")
