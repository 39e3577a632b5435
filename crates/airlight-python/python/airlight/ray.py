"""Foggy data sets on a Ray cluster; needs the package ray.

The inputs are split into shards, each of which is a task. A task adds fog as ``airlight.fog_batch`` does: it records each picture
in the manifest of its shard, keeps pictures that exist, and draws by the name of the picture. So the pictures are the same for any
number of workers, and a data set that was interrupted is resumed by the same call.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from airlight import _native


@dataclass
class DatasetReport:
    """What the tasks of a data set did.

    Attributes
    ----------
    made : int
        Pictures that were written.
    existing : int
        Pictures that existed.
    failures : list of str
        Pictures that failed, each with the reason.
    lost : dict of str to str
        Shards whose task failed, such as one on a node with a full disk, with the reason; a later call resumes them.
    """

    made: int = 0
    existing: int = 0
    failures: list[str] = field(default_factory=list)
    lost: dict[str, str] = field(default_factory=dict)


def _make(toml: str, shard: str, settings: dict[str, Any]) -> tuple[int, int, list[str]]:
    """The work of a task: one shard, on one thread."""
    return _native.fog_batch(toml, shard=shard, threads=1, **settings)


def fog_dataset(
    toml: str,
    *,
    shards: int = 16,
    max_retries: int = 3,
    num_cpus: float = 1.0,
    **settings: Any,
) -> DatasetReport:
    """Add fog to the pictures of a data set on all nodes of a Ray cluster, which share its folders.

    Parameters
    ----------
    toml : str
        A scene file with a table ``[overlay]``, as for ``airlight.fog_batch``.
    shards : int
        Number of tasks. Several for each processor even out pictures that take longer.
    max_retries : int
        How often a task is repeated whose worker died.
    num_cpus : float
        Processors that a task reserves.
    **settings
        Settings of ``airlight.fog_batch``: ``vary``, ``each``, ``variants``, ``seed``, ``overwrite``.

    Returns
    -------
    DatasetReport

    Raises
    ------
    ValueError
        For settings that ``airlight.fog_batch`` refuses.
    """
    import ray

    if shards < 1:
        raise ValueError(f"shards: expected 1 or more, got {shards}")
    task = ray.remote(num_cpus=num_cpus, max_retries=max_retries)(_make)
    names = [f"{number}/{shards}" for number in range(1, shards + 1)]
    running = {task.remote(toml, name, settings): name for name in names}
    report = DatasetReport()
    while running:
        done, _ = ray.wait(list(running), num_returns=1)
        name = running.pop(done[0])
        try:
            made, existing, failures = ray.get(done[0])
        except ray.exceptions.RayTaskError as error:
            if isinstance(error.cause, ValueError):
                raise error.cause from None
            report.lost[name] = str(error.cause)
        except ray.exceptions.WorkerCrashedError as error:
            report.lost[name] = str(error)
        else:
            report.made += made
            report.existing += existing
            report.failures += failures
    return report
