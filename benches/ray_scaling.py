#!/usr/bin/env python3
"""Measure foggy data sets on a local Ray cluster of one and of two processes; `benches/README.md` says how to install what it needs.

Prints a Markdown table: processor time and rates, medians of turns; then what a picture reads and writes, and what a task costs besides
its pictures.
"""

import os
import pathlib
import statistics
import tempfile
import time

import numpy as np
import ray
from airlight.ray import fog_dataset
from fog_throughput import make_inputs

PICTURES = 16
SHARDS = 8
TURNS = 3
#: Inputs of the measurement of planning, which is part of every task.
MANY = 20_000


def scene(inputs: pathlib.Path, output: pathlib.Path) -> str:
    """Fog over the pictures of a folder, as PNG."""
    return f"""
        fog.visibility_m = 120
        overlay = {{ colour = "{inputs}/png", depth = "{inputs}/depth", depth_scale = 0.001 }}
        output.file = "{output}/"
    """


def workers_cpu_s() -> float:
    """Processor time so far of the processes of Ray's tasks."""
    total = 0.0
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (folder / "cmdline").read_text().startswith("ray::"):
                fields = (folder / "stat").read_text().rsplit(")", 1)[1].split()
                total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        except OSError:
            continue
    return total


def bytes_in(folder: pathlib.Path) -> int:
    """Size of the files of a folder."""
    return sum(path.stat().st_size for path in folder.iterdir())


@ray.remote
def warm() -> None:
    """Starts a worker, and the modules that tasks import."""
    import airlight

    airlight.models()
    time.sleep(1.0)


@ray.remote
def nothing() -> None:
    """A task without work."""


def turn(folder: pathlib.Path, number: int, processes: int) -> tuple[float, float]:
    """Processor time and wall-clock time of a data set on a cluster of a number of processes."""
    ray.init(num_cpus=processes, include_dashboard=False, log_to_driver=False)
    ray.get([warm.remote() for _ in range(processes)])
    cpu, begun = workers_cpu_s(), time.perf_counter()
    report = fog_dataset(scene(folder, folder / f"out{processes}-{number}"), shards=SHARDS)
    wall, cpu = time.perf_counter() - begun, workers_cpu_s() - cpu
    assert (report.made, report.failures, report.lost) == (PICTURES, [], {})
    ray.shutdown()
    return cpu, wall


def task_s(count: int) -> float:
    """Wall-clock time of a task without work, of many that wait, s."""
    begun = time.perf_counter()
    waiting = [nothing.remote() for _ in range(count)]
    while waiting:
        _, waiting = ray.wait(waiting, num_returns=1)
    return (time.perf_counter() - begun) / count


def planning_s(folder: pathlib.Path) -> float:
    """Processor time of a task that finds that all its pictures exist, of many inputs, s."""
    import airlight

    names = ("png", "depth", "out")
    for name in names:
        (folder / name).mkdir(parents=True)
        for number in range(MANY):
            (folder / name / f"{number:06}.png").touch()
    begun = time.process_time()
    try:
        airlight.fog_batch(scene(folder, folder / "out"), shard=f"1/{MANY}", threads=1)
    except ValueError:
        # The manifest does not know the pictures.
        pass
    return time.process_time() - begun


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_inputs(folder, PICTURES, None)
        found: dict[int, list[tuple[float, float]]] = {1: [], 2: []}
        for number in range(TURNS):
            for processes in found:
                found[processes].append(turn(folder, number, processes))
        print("| processes | processor time of a picture | pictures/s for each processor second | pictures/s |")
        print("|---|---|---|---|")
        for processes, times in found.items():
            cpu, wall = (statistics.median(column) / PICTURES for column in np.transpose(times))
            print(f"| {processes} | {1000 * cpu:.0f} ms | {1 / cpu:.1f} | {1 / wall:.1f} |")
        sizes = {part: bytes_in(folder / part) / PICTURES / 1e6 for part in ("png", "depth", "out1-0")}
        print(f"\nMB of a picture: {', '.join(f'{part} {size:.2f}' for part, size in sizes.items())}")
        ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
        for count in (100, 4000):
            print(f"a task without work, {count} of them: {1000 * task_s(count):.2f} ms")
        ray.shutdown()
        print(f"planning of {MANY} inputs: {planning_s(folder / 'many'):.2f} s")


if __name__ == "__main__":
    main()
