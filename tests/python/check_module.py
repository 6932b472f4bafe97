#!/usr/bin/env python3
"""The Python module: bits are those of hompm-run, messages those of scenes, and what is written into a field counts.

    check_module.py MODULE_DIR BIN_DIR
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import threading

SKIPPED = 77
sys.path.insert(0, sys.argv[1])
try:
    import numpy as np
    import hompm
except ModuleNotFoundError as missing:
    print(missing)
    sys.exit(SKIPPED)
TOOLS = pathlib.Path(sys.argv[2])
SMALL = {"case": "column", "scheme": "bspline", "cells": 8, "end_time": 0.05}
SCENE = {"end_time": 0.1, "body": {"length": 1.0}, "material": {"law": "linear", "density": 1000.0, "youngs_modulus": 1e5},
         "ends": {"right": "free"}, "effect": [{"type": "gravity", "acceleration": -1.0}],
         "scheme": {"name": "high-order", "cells": 8, "particles_per_cell": 2, "step_fraction": 0.5}}


def demand(truth, what):
    if not truth:
        sys.exit(f"check_module: {what}")


def refused(kind, call, words):
    try:
        call()
    except kind as error:
        return demand(words in str(error), f"{error}: does not say {words}")
    return sys.exit(f"check_module: nothing says {words}")


def same_as_tool(folder):
    subprocess.run([TOOLS / "hompm-run", "--case", "column", "--scheme", "bspline", "--cells", "8", "--end-time", "0.05", "--no-vtk", "--quiet",
                    "--output", folder], check=True)
    run = hompm.run(**SMALL)
    for name, columns in (("particles", ("X", "x", "displacement", "velocity", "volume", "density")), ("stress", ("stress", "stretch"))):
        with open(folder / f"{name}.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for column in columns:
            values = np.array([float(row[column]) for row in rows])
            demand(np.array_equal(values, run["fields"][column].ravel()), f"other bits of {column} than hompm-run")
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    demand(all(np.array_equal([float(row[name]) for row in rows], values) for name, values in run["history"].items()), "other bits of the history")
    demand(run["report"]["errors"]["displacement"]["relative_l2"] < 0.1, "no error is reported")
    demand((folder / "scene.toml").read_text(encoding="utf-8") == run["scene"], "another scene")
    demand(hompm.compare(str(folder), str(folder))["verdict"] == "identical", "a folder is not identical to itself")


def scenes():
    run = hompm.run(scene=SCENE)
    demand(hompm.run(scene=SCENE, cells=4)["fields"]["X"].shape[1] * 2 == run["fields"]["X"].shape[1], "a keyword does not replace the key")
    refused(hompm.SceneError, lambda: hompm.run(scene={**SCENE, "end_tim": 1.0}), "did you mean `end_time`?")
    refused(hompm.SceneError, lambda: hompm.run(case="colum"), "column")
    refused(hompm.SceneError, lambda: hompm.run(case="column", celsl=3), "unknown key `celsl`")
    refused(hompm.SceneError, lambda: hompm.run(scene={**SCENE, "end_time": None}), "end_time")
    refused(hompm.FileError, lambda: hompm.run(scene="no such file.toml"), "no such file.toml")
    refused(ValueError, hompm.run, "name a case")
    refused(hompm.Error, lambda: hompm.compare("no such folder", "nor this"), "no such folder")


def exact():
    solution = hompm.exact(case="column")
    X = np.array([[1.0, 0.25], [0.5, 0.0]])
    later, earlier = solution(X, 0.1), solution(X, 0.05)
    demand(later["stress"].shape == X.shape, "another shape than that of the points")
    demand(np.array_equal(later["displacement"], solution(X, 0.1)["displacement"]), "times out of order give other bits")
    demand(not np.array_equal(later["displacement"], earlier["displacement"]), "nothing moves")
    demand(abs(later["displacement"][1, 1]) < 1e-12, "the fixed end moves")  # its own error
    demand(solution(1.0, 0.1)["stress"].shape == (), "a number gives no number")
    demand(np.array_equal(solution(1.0, [0.1, 0.05])["velocity"], [later["velocity"][0, 0], earlier["velocity"][0, 0]]), "t does not broadcast")
    demand(later["error"]["stress"].shape == X.shape and later["error"]["stress"].max() < 1.0, "no error of its own")
    refused(ValueError, lambda: solution([1.5], 0.1), "1.5")
    refused(ValueError, lambda: solution([np.nan], 0.1), "nan")
    refused(ValueError, lambda: solution([0.5], 99.0), "99")


def steps():
    by_hand = hompm.Simulation(**SMALL)
    start = by_hand.copy()
    demand(by_hand == start, "a copy is not equal")
    by_hand.step(by_hand.steps)
    whole = hompm.run(**SMALL)["fields"]
    demand(np.array_equal(by_hand.snapshot()["stress"][0], whole["stress"][-1]), "steps by hand give other bits than a run")
    demand(by_hand != start, "the copy went on, too")
    velocity = start.field("velocity")
    velocity[:] = 0.5
    demand((start.field("velocity") == 0.5).all(), "what is written into a field is lost")
    refused(KeyError, lambda: start.field("velocty"), "did you mean velocity?")
    refused(IndexError, lambda: start.field("velocity", 1), "no body 1")
    velocity[:] = 1e6
    refused(hompm.InvalidRun, lambda: start.step(10000), "step")


def threads():
    alone, found = hompm.run(**SMALL)["fields"], []
    workers = [threading.Thread(target=lambda: found.append(hompm.run(**SMALL)["fields"])) for _ in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    demand(len(found) == 2 and all(np.array_equal(alone[name], one[name]) for one in found for name in alone), "threads change bits")


with tempfile.TemporaryDirectory() as scratch:
    same_as_tool(pathlib.Path(scratch) / "run")
scenes()
exact()
steps()
threads()
