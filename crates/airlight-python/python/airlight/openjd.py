"""Job templates of Open Job Description for render farms, those of ``airlight sky --openjd`` and ``airlight fog --openjd``."""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Sequence
from typing import Any

from airlight import _native


def job(name: str, command: Sequence[str], tasks: int) -> dict[str, Any]:
    """A job that runs a command of the program ``airlight`` in parts, one task for each.

    Parameters
    ----------
    name : str
        Name of the job.
    command : sequence of str
        The command with its options and without ``--shard``: ``["airlight", "fog", "rgb/", "--depth", "depth/", ...]`` or
        ``["airlight", "sky", ...]``. Paths are those of the machines that run the tasks.
    tasks : int
        Number of tasks. Draws do not depend on it.

    Returns
    -------
    dict
        The template; ``write`` writes it to a file.

    Raises
    ------
    ValueError
        For a command without parts, and a number of tasks below 1.
    """
    return json.loads(_native.job_of_command(name, [str(word) for word in command], tasks))


def sky_job(scene: _native.Scene, tasks: int | None = None) -> dict[str, Any]:
    """A job that draws the pictures of a scene: a sequence by pictures, a single picture by bands of rows, which a last step joins.

    The scene is a part of the template. The job has the parameters ``OutputDir``, the folder of the pictures, and ``Program``; a
    relative folder of ``output.file`` is the default, from the folder of the template.

    Parameters
    ----------
    scene : airlight.Scene
        A scene with ``output.file``, which is an EXR file for a single picture.
    tasks : int or None
        Number of tasks; None: 16, or fewer for small jobs.

    Returns
    -------
    dict
        The template; ``write`` writes it to a file.

    Raises
    ------
    ValueError
        For a scene that cannot be split.
    """
    return json.loads(_native.job_of_scene(scene, tasks))


def fog_job(
    toml: str,
    tasks: int | None = None,
    *,
    vary: Sequence[str] = (),
    each: Sequence[str] = (),
    variants: int | None = None,
    seed: int = 0,
) -> dict[str, Any]:
    """A job that adds fog to the pictures of folders, each task to a part of them, with the pictures of ``airlight.fog_batch``.

    The description is a part of the template. The job has the parameters ``PicturesDir``, ``DepthDir`` (where depth maps are files
    of their own), ``OutputDir`` and ``Program``; folders that are relative are the defaults, from the folder of the template.

    Parameters
    ----------
    toml : str
        A scene file with a table ``[overlay]``, whose ``overlay.colour``, ``overlay.depth`` and ``output.file`` are folders or
        patterns.
    tasks : int or None
        Number of tasks; None: 16, or fewer for few pictures. Draws do not depend on it.
    vary, each : sequence of str
        As for ``airlight.fog_batch``.
    variants : int or None
        Pictures made of each input.
    seed : int
        Seed of the draws.

    Returns
    -------
    dict
        The template; ``write`` writes it to a file.

    Raises
    ------
    ValueError
        For settings that are refused, and for a single picture.
    OSError
        For folders that cannot be read.
    """
    settings = {"vary": list(vary), "each": list(each), "variants": variants, "seed": seed}
    return json.loads(_native.job_of_batch(toml, tasks, **settings))


def write(path: str | os.PathLike[str], template: dict[str, Any]) -> None:
    """Write a template to a file as JSON, which is YAML too.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    template : dict
        The template of ``job``, ``sky_job`` or ``fog_job``.
    """
    pathlib.Path(path).write_text(json.dumps(template, indent=2) + "\n", encoding="utf-8")
