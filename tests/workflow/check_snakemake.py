#!/usr/bin/env python3
"""A study run by Snakemake gives the same tables as run by hompm-study itself.

    tests/workflow/check_snakemake.py build/release/bin

Exit code 77 where there is no Snakemake.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STUDY = """
case = "bar"
[set]
end_time = 0.2
cells = 8
[[sweep]]
scheme = ["tielen2017", "high-order"]
courant = [0.2, 2]
"""


def main():
    if not shutil.which("snakemake"):
        print("snakemake is not installed: nothing to test")
        return 77
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        (folder / "study.toml").write_text(STUDY)
        environment = dict(os.environ, HOME=work, XDG_CACHE_HOME=work, HOMPM_BIN=str(tools), HOMPM_REPEATS="1")

        def run(*command):
            done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")

        run(tools / "hompm-study", "--study", "study.toml", "--output", "local", "--jobs", "2", "--repeats", "0", "--quiet")
        run(ROOT / "cli/workflow/run.sh", "study.toml", "by-snakemake", "--cores", "2")
        for name in ("points.csv", "study.json", "answers.txt"):
            if (folder / "local" / name).read_bytes() != (folder / "by-snakemake" / name).read_bytes():
                sys.exit(f"{name} differs")
        if not (folder / "by-snakemake/times.csv").exists():
            sys.exit("no times were taken")
    print("the same tables")
    return 0


if __name__ == "__main__":
    sys.exit(main())
