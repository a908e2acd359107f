#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""The two schemes side by side, in the form of Tables 1 and 2 of Xiong et al. 2008.

    scripts/schemes.py [--program FILE] [--workers N] [--runs N] MESH.ply:RATIO ...

Runs 'meshfarm simplify' by either scheme, with all workers and with one, in turns so that a busy
machine is busy for all, and prints a Markdown table of medians.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def simplify(program, mesh, ratio, scheme, workers, folder):
    output = os.path.join(folder, "out.ply")
    words = [program, "simplify", mesh, "-o", output, "--ratio", ratio, "--scheme", scheme,
             "--workers", str(workers), "--json", "--quiet"]
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)


def seconds(runs, *phases):
    return statistics.median(sum(run["seconds"][phase] for phase in phases) for run in runs)


def column(scheme, mesh, ratio, many, one):
    last = many[-1]
    phases = ("cut", "farm", "stitch", "finish", "measure", "write")
    total = seconds(many, *phases)
    single = seconds(one, *phases)
    return [
        scheme, os.path.basename(mesh), f'{last["input"]["triangles"]:,}',
        f'{last["output"]["triangles"]:,}', f"{100 * float(ratio):g} %", str(last["parts"]),
        f'{seconds(many, "cut"):.2f} s', f'{seconds(many, "farm"):.2f} s',
        f'{seconds(many, "stitch", "finish", "measure", "write"):.2f} s', f"{total:.2f} s",
        f"{single:.2f} s", f"{single / total:.1f}", f'{1e6 * last["error"]["rms"]:.2f}']


ROWS = ["scheme", "mesh", "triangles in", "triangles out", "percentage", "parts or streams",
        "partition or generation", "simplification", "stitching or composition, finish, error",
        "total", "total, one worker", "speed-up", "RMS, 1e-6 of the diagonal"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "meshfarm"))
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("meshes", nargs="+", metavar="MESH.ply:RATIO")
    options = parser.parse_args()
    columns = []
    with tempfile.TemporaryDirectory(prefix="meshfarm-schemes-") as folder:
        for mesh, ratio in (word.rsplit(":", 1) for word in options.meshes):
            done = {}
            for _ in range(options.runs):
                for scheme in ("cut", "stream"):
                    for workers in (options.workers, 1):
                        run = simplify(options.program, mesh, ratio, scheme, workers, folder)
                        done.setdefault((scheme, workers), []).append(run)
            for scheme in ("cut", "stream"):
                columns.append(column(scheme, mesh, ratio, done[scheme, options.workers],
                                      done[scheme, 1]))
    for number, row in enumerate(ROWS):
        print("| " + " | ".join([row] + [c[number] for c in columns]) + " |")
        if number == 0:
            print("| --- |" + " ---: |" * len(columns))
    print(f"\nMedians of {options.runs}; speed-up of {options.workers} workers over one.",
          file=sys.stderr)


if __name__ == "__main__":
    main()
