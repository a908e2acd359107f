# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""MeshLab's quadric edge collapse, file to file: meshlab_file.py INPUT OUTPUT.ply RATIO

Each edge that collapses leaves one of its vertices, moved, with the colour that it had. MeshLab
wants a display: xvfb-run makes one.
"""
import json
import pathlib
import re
import resource
import subprocess
import sys
import time

# The filter's defaults, except for the number of triangles; all of them must be given.
SCRIPT = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Simplification: Quadric Edge Collapse Decimation">
  <Param type="RichInt" name="TargetFaceNum" value="{target}"/>
  <Param type="RichFloat" name="TargetPerc" value="0"/>
  <Param type="RichFloat" name="QualityThr" value="0.3"/>
  <Param type="RichBool" name="PreserveBoundary" value="false"/>
  <Param type="RichFloat" name="BoundaryWeight" value="1"/>
  <Param type="RichBool" name="PreserveNormal" value="false"/>
  <Param type="RichBool" name="PreserveTopology" value="false"/>
  <Param type="RichBool" name="OptimalPlacement" value="true"/>
  <Param type="RichBool" name="PlanarQuadric" value="false"/>
  <Param type="RichFloat" name="PlanarWeight" value="0.001"/>
  <Param type="RichBool" name="QualityWeight" value="false"/>
  <Param type="RichBool" name="AutoClean" value="true"/>
  <Param type="RichBool" name="Selected" value="false"/>
 </filter>
</FilterScript>
"""


def triangles_of(path):
    with open(path, "rb") as file:
        header = file.read(4096).split(b"end_header")[0].decode("latin-1")
    return int(re.search(r"^element face (\d+)", header, re.MULTILINE).group(1))


def version():
    """Of the Debian package: the program does not tell."""
    told = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "meshlab"],
                          capture_output=True, text=True, check=False).stdout
    return told.split("+")[0].split("-")[0] or "of unknown version"


def main():
    source, output, ratio = sys.argv[1:]
    target = round(float(ratio) * triangles_of(source))
    script = pathlib.Path(output + ".mlx")
    script.write_text(SCRIPT.format(target=target))
    pathlib.Path(output).unlink(missing_ok=True)
    start = time.monotonic()
    said = subprocess.run(["xvfb-run", "-a", "meshlabserver", "-i", source, "-o", output,
                           "-m", "vc", "-s", str(script)], capture_output=True, text=True,
                          check=False)
    wall = time.monotonic() - start
    script.unlink()
    if not pathlib.Path(output).exists():  # its exit code tells little
        lines = (said.stdout + said.stderr).strip().splitlines() or [f"exit {said.returncode}"]
        sys.exit(f"meshlabserver: {lines[-1]}")
    took = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(json.dumps({"tool": "MeshLab quadric", "version": version(),
                      "cpu_s": took.ru_utime + took.ru_stime, "wall_s": wall,
                      "triangles": triangles_of(output)}))


if __name__ == "__main__":
    main()
