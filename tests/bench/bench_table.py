# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""Prints what scripts/bench.sh measured as one markdown table: bench_table.py FOLDER NAME ...

FOLDER holds for each NAME and round NAME.ROUND.tree (of measure_tree) and NAME.ROUND.peer (the
line that a peer's program prints), and NAME.compare (of `meshfarm compare --json`).
"""
import json
import pathlib
import statistics
import sys

WHOLE_RUN = "_file"
HEAD = ["tool", "CPU s", "wall s", "peak RSS MB", "triangles", "RMS 1e-6", "max 1e-6",
        "non-manifold edges", "degenerate", "duplicate", "components", "Euler", "colour PSNR dB"]


def millionths(value):
    scaled = value * 1e6
    return f"{scaled:,.0f}" if scaled >= 1000 else f"{scaled:.1f}"


class Row:
    """One tool: medians over the rounds, and the quality of its last result."""

    def __init__(self, folder, name):
        self.name = name
        self.whole = name.endswith(WHOLE_RUN)
        self.failed = (folder / f"{name}.failed").exists()
        self.title = name
        if self.failed:
            return
        trees = [json.loads(path.read_text()) for path in sorted(folder.glob(f"{name}.*.tree"))]
        lines = [path.read_text() for path in sorted(folder.glob(f"{name}.*.peer"))]
        said = [] if name == "meshfarm_file" else [json.loads(line) for line in lines]
        timed = trees if self.whole else said
        self.cpu_all = [run["cpu_s"] for run in timed]
        self.cpu = statistics.median(self.cpu_all)
        self.wall = statistics.median(run["wall_s"] for run in timed)
        # A peak between two samples is missed, so the largest one seen is the closest.
        self.rss = max(tree["peak_anon_mb"] for tree in trees)
        self.title = f"{said[0]['tool']} {said[0]['version']}" if said else "meshfarm simplify"
        if self.whole:
            self.title += ", file to file"
        comparison = json.loads((folder / f"{name}.compare").read_text())
        both_ways = (comparison["a_to_b"], comparison["b_to_a"])
        self.rms = max(way["rms"] for way in both_ways)
        self.max = max(way["max"] for way in both_ways)
        self.topology = comparison["topology_b"]
        # Colours without any difference have no PSNR.
        noise = [way["psnr"] for channel in comparison["channels"]
                 for way in (channel["a_to_b"], channel["b_to_a"]) if way.get("psnr") is not None]
        self.psnr = min(noise, default=None)

    def cells(self):
        if self.failed:
            return [self.title, "failed"] + ["" for _ in HEAD[2:]]
        t = self.topology
        return [self.title, f"{self.cpu:.2f}", f"{self.wall:.2f}", f"{self.rss:.0f}",
                f"{t['triangles']:,}", millionths(self.rms), millionths(self.max),
                f"{t['nonmanifold_edges']:,}", f"{t['degenerate'] + t['zero_area']:,}",
                f"{t['duplicate']:,}", f"{t['components']:,}", f"{t['euler']:,}",
                "" if self.psnr is None else f"{self.psnr:.2f}"]

    def ratios_to(self, other):
        texts = [f"CPU {self.cpu / other.cpu:.2f}", f"wall {self.wall / other.wall:.2f}"]
        if self.whole:
            texts.append(f"RSS {self.rss / other.rss:.2f}")
        texts += [f"RMS {self.rms / other.rms:.2f}", f"max {self.max / other.max:.2f}"]
        return ", ".join(texts)


def print_table(rows):
    table = [HEAD] + [row.cells() for row in rows]
    if all(line[-1] == "" for line in table[1:]):  # no colours
        table = [line[:-1] for line in table]
    head = table[0]
    widths = [max(len(line[column]) for line in table) for column in range(len(head))]
    rule = ["-" * widths[0]] + ["-" * (width - 1) + ":" for width in widths[1:]]
    for line in [table[0], rule] + table[1:]:
        padded = [line[0].ljust(widths[0])]
        padded += [cell.rjust(width) for cell, width in zip(line[1:], widths[1:])]
        print("| " + " | ".join(padded) + " |")


def print_ratios(rows):
    measured = [row for row in rows if not row.failed]
    by_name = {row.name: row for row in measured}
    print("\nRatios to meshoptimizer, in the same kind of run (below 1 is better):\n")
    for row in measured:
        reference = by_name.get("meshoptimizer" + (WHOLE_RUN if row.whole else ""))
        if reference is not None and reference is not row:
            print(f"- {row.title}: {row.ratios_to(reference)}")


def main():
    folder = pathlib.Path(sys.argv[1])
    rows = [Row(folder, name) for name in sys.argv[2:]]
    rows.sort(key=lambda row: row.whole)
    print_table(rows)
    measured = [row for row in rows if not row.failed]
    print("\nRMS and max: the greater of both directions, in millionths of the input's diagonal. "
          "Degenerate includes triangles of zero area.\nPeak RSS: anonymous memory of all the "
          "processes of a program together, reading and cleaning included; the most seen.")
    spreads = [max(row.cpu_all) / min(row.cpu_all) - 1 for row in measured if len(row.cpu_all) > 1]
    if spreads:
        print(f"CPU time varied by up to {max(spreads):.0%} between the rounds of a tool.")
    if any(row.psnr is not None for row in measured):
        print("Colour PSNR: the lesser of both directions, at points of the surfaces.")
    if any(row.name == "meshoptimizer" for row in measured):
        print_ratios(rows)
    return 1 if len(measured) < len(rows) else 0


if __name__ == "__main__":
    sys.exit(main())
