#!/usr/bin/env python3
"""Reads the snapshots of a run folder with meshio and compares them with its CSV files, bit for bit.

Usage: meshio_roundtrip.py FOLDER

Exit code 0: all the same; 1: a difference, named; 2: bad usage; 77: meshio is not installed.
"""

import csv
import math
import pathlib
import struct
import sys
import xml.etree.ElementTree

try:
    import meshio
except ImportError:
    print("meshio is not installed")
    sys.exit(77)


def bits(value):
    """The eight bytes of a double: == would call 0 and -0 the same."""
    return struct.pack("<d", float(value))


def read_csv(path):
    """Columns by time: {time: {name: [values]}}, in the order of the file."""
    times = {}
    with open(path, newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            columns = times.setdefault(float(row.pop("time")), {})
            for name, text in row.items():
                columns.setdefault(name, []).append(float(text))
    return times


def readable(value):
    """What a .vtu holds: 0 of its sign for a subnormal number."""
    return math.copysign(0.0, value) if abs(value) < sys.float_info.min else value


def same(where, found, expected):
    """The complaint about two lists of numbers, or nothing."""
    if len(found) != len(expected):
        return [f"{where}: {len(found)} values, not {len(expected)}"]
    return [f"{where}, particle {i}: {a!r}, not {b!r}"
            for i, (a, b) in enumerate(zip(found, expected)) if bits(a) != bits(readable(b))][:1]


def check_snapshot(path, time, particles, stress):
    """Complaints about one .vtu."""
    mesh = meshio.read(path)
    faults = same(f"{path}: TimeValue", list(mesh.field_data.get("TimeValue", [])), [time])
    for axis, expected in enumerate((particles["x"], [0.0] * len(particles["x"]), [0.0] * len(particles["x"]))):
        faults += same(f"{path}: coordinate {axis}", mesh.points[:, axis], expected)
    expected = {name: particles[name] for name in ("particle", "displacement", "velocity", "volume", "density")}
    expected.update({name: stress[name] for name in ("stress", "stretch")})
    if set(mesh.point_data) != set(expected):
        return faults + [f"{path}: point data {sorted(mesh.point_data)}, not {sorted(expected)}"]
    for name, values in expected.items():
        faults += same(f"{path}: {name}", mesh.point_data[name], values)
    cells = [(block.type, block.data.ravel().tolist()) for block in mesh.cells]
    if cells != [("vertex", list(range(len(mesh.points))))]:
        faults.append(f"{path}: the cells are not one vertex per particle")
    return faults


def check_folder(folder):
    """Complaints about all snapshots of a folder, and about the list of them."""
    particles = read_csv(folder / "particles.csv")
    stress = read_csv(folder / "stress.csv")
    collection = xml.etree.ElementTree.parse(folder / "run.pvd").getroot()
    listed = [(float(entry.attrib["timestep"]), entry.attrib["file"]) for entry in collection.iter("DataSet")]
    faults = same("run.pvd: times", [time for time, _ in listed], list(particles))
    present = sorted(f"vtk/{path.name}" for path in (folder / "vtk").glob("*.vtu"))
    if sorted(name for _, name in listed) != present:
        faults.append(f"run.pvd lists other files than there are in {folder / 'vtk'}")
    if faults:
        return faults
    for time, name in listed:
        faults += check_snapshot(folder / name, time, particles[time], stress[time])
    return faults


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    faults = check_folder(pathlib.Path(sys.argv[1]))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
