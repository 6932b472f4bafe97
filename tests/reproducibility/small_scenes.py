#!/usr/bin/env python3
"""Small scenes that together reach every scheme, degree, law, effect, choice and kind of reference, for cells that run slowly.

docs/scenes with fewer cells, and a bar and a column for every row of the table of schemes and every word of its keys. What does not go
together is refused, in the same words everywhere.
"""
import pathlib
import re
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BAR = """end_time = {end}
body.length = 1
material = {{ law = "{law}", density = 1000, youngs_modulus = 1e5 }}
{more}
output = {{ snapshots = 2, history = 5 }}
scheme = {{ name = "{scheme}", cells = 6, particles_per_cell = 4, step_fraction = 0.3{choice} }}
"""
MOVING = 'initial.velocity = { shape = "sine", amplitude = 1.0 }'
STARTED = {"sine": MOVING, "uniform": MOVING.replace("sine", "uniform"),
           "linear": 'initial.velocity = { shape = "linear", amplitude = 1.0, gradient = 2.0 }'}
FALLING = 'ends.right = "free"\neffect = [ { type = "gravity", acceleration = -9.81 } ]'
FREE = 'ends = { left = "free", right = "free" }'
# A reference solution that takes long natively would take minutes on an interpreter.
SHORTER = {"viscosity": "0.01", "flight": "1.0", "gravity-pulse": "0.25"}


def scenes(words):
    """{name: text} of all, from {key: its words}."""
    found = {}
    for path in sorted((ROOT / "docs/scenes").glob("*.toml")):
        text = re.sub(r"^cells = \d+", "cells = 8", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
        if path.stem in SHORTER:
            text = re.sub(r"^end_time = \S+", f"end_time = {SHORTER[path.stem]}", text, flags=re.MULTILINE)
        found[f"docs-{path.stem}"] = text
    for scheme in words["scheme.name"]:
        for degree in range(1, 6):
            choice = f", degree = {degree}"
            found[f"bar-{scheme}-{degree}"] = BAR.format(end=0.02, law="rate", more=MOVING, scheme=scheme, choice=choice)
            found[f"column-{scheme}-{degree}"] = BAR.format(end=0.02, law="rate", more=FALLING, scheme=scheme, choice=choice)
    for law in words["material.law"]:
        for scheme in ("bspline", "high-order"):
            found[f"law-{law}-{scheme}"] = BAR.format(end=0.02, law=law, more=FALLING, scheme=scheme, choice="")
    for shape in words["initial.velocity.shape"]:
        start = STARTED[shape]
        found[f"started-{shape}"] = BAR.format(end=0.02, law="linear", more=f"{start}\n{FREE}", scheme="tielen2017", choice="")
        start = start.replace("velocity", "displacement").replace(" = 1.0", " = 0.01").replace("2.0", "0.01")
        found[f"released-{shape}"] = BAR.format(end=0.02, law="hencky", more=f"{start}\n{FREE}", scheme="tielen2017", choice="")
    found["vibration"] = BAR.format(end=0.02, law="linear", more=MOVING, scheme="tielen2017", choice="")
    for key, choices in words.items():
        name = key.removeprefix("scheme.")
        if name == key or name == "name":
            continue
        for word in choices:
            for scheme in ("classical", "bspline", "tielen2017", "high-order"):
                for case, more in (("bar", MOVING), ("column", FALLING)):
                    found[f"{case}-{scheme}-{name}-{word}"] = BAR.format(end=0.01, law="rate", more=more, scheme=scheme,
                                                                        choice=f', {name} = "{word}"')
    return found


def missed(words, results):
    """Complaints about what no scene below the folder `results` reached."""
    used, references = set(), set()

    def collect(table, prefix):
        for key, value in table.items():
            if isinstance(value, dict):
                collect(value, f"{prefix}{key}.")
            elif isinstance(value, str):
                used.add((prefix + key, value))

    for scene in sorted(results.glob("*/scene.toml")):
        written = tomllib.loads(scene.read_text(encoding="utf-8"))
        used |= {("effect", effect["type"]) for effect in written.pop("effect", [])}
        bodies = written.pop("body")
        for part in (written, *(bodies if isinstance(bodies, list) else [])):
            collect(part, "")
        references |= set(re.findall(r'"reference": "(.*?)"', (scene.parent / "run.json").read_text(encoding="utf-8")))
    complaints = [f"no small scene has {key} {word}" for key, of_key in words.items() for word in of_key if (key, word) not in used]
    source = (ROOT / "lib/hompm/reference/reference.cpp").read_text(encoding="utf-8")
    kinds = set(re.findall(r'(?:exact|estimated)\(\s*"([^"]+)"', source))
    complaints += [f"no small scene is judged by: {kind}" for kind in sorted(kinds - references)]
    return complaints if kinds else [*complaints, "no kind of reference was found in lib/hompm/reference/reference.cpp"]
