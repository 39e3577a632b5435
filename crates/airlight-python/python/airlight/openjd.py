"""Job templates of Open Job Description for render farms."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any


def job(name: str, command: Sequence[str], shards: int) -> dict[str, Any]:
    """A job that runs a command of the program ``airlight`` in parts, one task for each.

    Parameters
    ----------
    name : str
        Name of the job.
    command : sequence of str
        The command with its options and without ``--shard``: ``["airlight", "fog", "rgb/", "--depth", "depth/", ...]`` or
        ``["airlight", "sky", ...]`` with a sequence. Paths are those of the machines that run the tasks.
    shards : int
        Number of tasks. Draws do not depend on it.

    Returns
    -------
    dict
        The template; ``write_job`` writes it to a file.

    Raises
    ------
    ValueError
        For a command without parts, and a number of tasks below 1.
    """
    words = [str(word) for word in command]
    if len(words) < 2 or words[1] not in ("fog", "sky"):
        raise ValueError(f"command: expected airlight fog or airlight sky with options, got {' '.join(words) or 'nothing'}")
    if "--shard" in words:
        raise ValueError("command: expected options without --shard, which each task sets, got --shard")
    if not 1 <= shards <= 1024:
        raise ValueError(f"shards: expected 1 to 1024, got {shards}")
    if any("{{" in word for word in words):
        raise ValueError("command: expected words without {{, which begins an expression of a template, got one")
    return {
        "specificationVersion": "jobtemplate-2023-09",
        "name": name,
        "steps": [
            {
                "name": words[1],
                "parameterSpace": {"taskParameterDefinitions": [{"name": "Shard", "type": "INT", "range": f"1-{shards}"}]},
                "script": {
                    "actions": {
                        "onRun": {"command": words[0], "args": [*words[1:], "--shard", f"{{{{Task.Param.Shard}}}}/{shards}"]}
                    }
                },
            }
        ],
    }


def write_job(path: Any, name: str, command: Sequence[str], shards: int) -> None:
    """Write the template of ``job`` to a file as JSON, which is YAML too.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    name, command, shards
        As for ``job``.
    """
    text = json.dumps(job(name, command, shards), indent=2)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + "\n")
