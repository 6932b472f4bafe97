#!/usr/bin/env python3
"""Writes golden results in the formats of other codes, by code of its own, and lets hompm-diff read them: every bit must come
through, and what is cut or damaged must be refused.

    tests/golden/check_formats.py build/release/bin
"""
import base64
import csv
import gzip
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
GOLDEN = ROOT / "golden/bar-small-bspline"
FIELDS = ["X", "displacement", "velocity"]


def packed(values, order, kind="d"):
    return struct.pack(f"{order}{len(values)}{kind}", *values)


def encoded(data, order, header, compressor):
    """An inline or appended array: the header with the number of bytes, then these; or blocks by zlib. (header + data, as base64
    wants them: apart when compressed)"""
    if not compressor:
        return struct.pack(order + header, len(data)) + data, b""
    block = 1000  # bytes: several blocks, the last one shorter
    blocks = [data[i:i + block] for i in range(0, len(data), block)]
    small = [zlib.compress(b) for b in blocks]
    last = len(blocks[-1]) if len(blocks[-1]) < block else 0
    return packed([len(blocks), block, last, *map(len, small)], order, header), b"".join(small)


def vtu(rows, time, order, header, compressor, mode, tag="UnstructuredGrid"):
    arrays = {"points": [c for row in rows for c in (float(row["x"]), 0.0, 0.0)], **{f: [float(row[f]) for row in rows] for f in FIELDS}}
    appended = b""
    body = ""
    for name, values in arrays.items():
        head, rest = encoded(packed(values, order), order, header, compressor)
        label = "" if name == "points" else f' Name="{name}"'
        size = ' NumberOfComponents="3"' if name == "points" else ""
        if mode == "inline":
            content = f'format="binary">{(base64.b64encode(head) + base64.b64encode(rest) if rest else base64.b64encode(head)).decode()}</DataArray>'
        else:
            content = f'format="appended" offset="{len(appended)}"/>'
            appended += (head + rest) if mode == "raw" else base64.b64encode(head) + base64.b64encode(rest)
        array = f'<DataArray type="Float64"{label}{size} {content}'
        body += f"<Points>{array}</Points><PointData>" if name == "points" else array
    attributes = f'byte_order="{"LittleEndian" if order == "<" else "BigEndian"}" header_type="{"UInt64" if header == "Q" else "UInt32"}"'
    attributes += ' compressor="vtkZLibDataCompressor"' if compressor else ""
    text = f'<?xml version="1.0"?>\n<VTKFile type="{tag}" {attributes}><{tag}><FieldData><DataArray type="Float64" Name="TimeValue" ' \
           f'format="ascii">{time}</DataArray></FieldData><Piece NumberOfPoints="{len(rows)}">{body}</PointData></Piece></{tag}>'
    data = text.encode()
    if mode != "inline":
        data += f'<AppendedData encoding="{"raw" if mode == "raw" else "base64"}">_'.encode() + appended + b"</AppendedData>"
    return data + b"</VTKFile>\n"


def dump(blocks, counts):
    text = ""
    for time, rows in blocks.items():
        step = round(float(time) / 1e-4)
        text += f"ITEM: TIMESTEP\n{step}\n" if counts else f"ITEM: TIME\n{time}\n"
        text += f"ITEM: NUMBER OF ATOMS\n{len(rows)}\nITEM: BOX BOUNDS pp pp pp\n0 25\n0 1\n0 1\nITEM: ATOMS id x X displacement velocity\n"
        text += "".join(f"{row['particle']} {row['x']} {row['X']} {row['displacement']} {row['velocity']}\n" for row in rows)
    return text.encode()


def main():
    tool = pathlib.Path(sys.argv[1]).resolve() / "hompm-diff"
    with open(GOLDEN / "particles.csv", newline="", encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    blocks = {}
    for row in rows:
        blocks.setdefault(row["time"], []).append(row)
    last = list(blocks)[-1]
    wrong = []
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)

        def judge(name, data, *options, exit_code=0, says="in every bit"):
            path = work / name
            path.write_bytes(data)
            done = subprocess.run([tool, "--fields", "displacement,velocity", *options, path, GOLDEN], capture_output=True, text=True, check=False)
            said = done.stdout + done.stderr
            if done.returncode != exit_code or says not in said or ("Traceback" in said):
                wrong.append(f"{name} {' '.join(options)}: exit code {done.returncode}: {said[-600:]}")

        for order in "<>":
            for header in "IQ":
                for compressor in (False, True):
                    for mode in ("inline", "base64", "raw"):
                        name = f"{'little' if order == '<' else 'big'}-{header}-{'zlib' if compressor else 'plain'}-{mode}"
                        data = vtu(blocks[last], last, order, header, compressor, mode)
                        judge(name + ".vtu", data, "--time", last)
                        if order == "<" and header == "Q":
                            middle = data.index(b"_", data.index(b"<AppendedData")) + 400 if mode != "inline" else data.index(b'"binary">') + 100
                            if mode == "inline":
                                damaged = data[:middle] + data[data.index(b"</DataArray>", middle):]
                            else:
                                damaged = data[:middle] + b"</AppendedData></VTKFile>\n"
                            judge(name + "-cut.vtu", damaged, "--time", last, exit_code=5, says="hompm-diff: ")
        judge("poly.vtp", vtu(blocks[last], last, "<", "I", True, "raw", "PolyData"), "--time", last)
        series = "".join(f'<DataSet timestep="{time}" file="part{i}.vtu"/>' for i, time in enumerate(blocks))
        for i, (time, block) in enumerate(blocks.items()):
            (work / f"part{i}.vtu").write_bytes(vtu(block, time, "<", "Q", True, "base64"))
        judge("all.pvd", f'<VTKFile type="Collection"><Collection>{series}</Collection></VTKFile>'.encode())
        judge("time.dump", dump(blocks, False))
        judge("steps.dump", dump(blocks, True), "--time-step", "1e-4")
        judge("steps.dump", dump(blocks, True), exit_code=5, says="--time-step")
        judge("time.dump.gz", gzip.compress(dump(blocks, False)))
        judge("cut.dump.gz", gzip.compress(dump(blocks, False))[:2000], exit_code=5, says="hompm-diff: ")
        ragged = dump(blocks, False).replace(b"\n7 ", b"\n7 1 ", 1)
        judge("ragged.dump", ragged, exit_code=3, says="line")
        columns = ["time", "X", "displacement", "velocity"]
        spaces = "".join(" ".join(row[c].replace("e", "D") for c in columns) + "\n" for row in rows)
        numbers = [word for i, c in enumerate(columns, 1) for word in ("--column", f"{c}={i}")]
        judge("fortran.txt", spaces.encode(), *numbers)
        semicolons = ";".join(columns) + "\r\n" + "".join(";".join(row[c].replace(".", ",") for c in columns) + "\r\n" for row in rows)
        judge("commas.csv", semicolons.encode())
    for complaint in wrong:
        print(complaint, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
