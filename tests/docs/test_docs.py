#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""Runs the commands of README.md and docs/*.md as they are written: test_docs.py PROGRAM

All blocks fenced as ```sh of a page are one script, run in a folder like 'data' after
scripts/demo.sh. README.md has the real dragon; to the other pages any mesh will do. Also checks that the links between pages lead somewhere, and that no line of
README.md is over 120 characters.
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DRAGON = "dragon_vrip.ply.gz"
# What the other pages expect: some continue where README.md or the previous page ended.
BEFORE = """
meshfarm cut dragon_vrip.ply.gz --stage dragon.stage --quiet > cut.log
meshfarm simplify dragon_vrip.ply.gz -o small.ply --triangles 50000 --quiet > small.log
"""


def pages():
    return [os.path.join(ROOT, "README.md")] + sorted(glob.glob(os.path.join(ROOT, "docs", "*.md")))


def headings(text):
    """The anchors that GitHub gives to the headings."""
    titles = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def check_links(page, text):
    wrong = []
    for target in re.findall(r"\]\(([^)]+)\)", text):
        if target.startswith(("http:", "https:")):
            continue
        name, _, anchor = target.partition("#")
        path = os.path.join(os.path.dirname(page), name) if name else page
        if not os.path.exists(path):
            wrong.append(f"{page}: no {target}")
        elif anchor:
            with open(path, encoding="utf-8") as file:
                if anchor not in headings(file.read()):
                    wrong.append(f"{page}: no heading for {target}")
    return wrong


def make_folder(program, is_readme):
    """A checkout as it is after scripts/demo.sh, as far as the pages need it."""
    folder = tempfile.mkdtemp(prefix="meshfarm-docs-")
    for name in ("build", "data"):
        os.mkdir(os.path.join(folder, name))
    os.symlink(os.path.abspath(program), os.path.join(folder, "build", "meshfarm"))
    os.symlink(os.path.join(ROOT, "scripts"), os.path.join(folder, "data", "scripts"))
    mesh = os.path.join(folder, "data", DRAGON)
    if is_readme and os.path.exists(os.path.join(ROOT, "data", DRAGON)):
        os.symlink(os.path.join(ROOT, "data", DRAGON), mesh)
    else:  # the format is told by content
        subprocess.run([program, "generate", "-o", mesh + ".ply", "--triangles", "200000", "--quiet"],
                       check=True)
        os.rename(mesh + ".ply", mesh)
    return folder


def run_page(page, script, program):
    is_readme = os.path.basename(page) == "README.md"
    folder = make_folder(program, is_readme)
    environment = dict(os.environ)
    if not is_readme:
        environment["PATH"] = os.path.join(folder, "build") + ":" + environment["PATH"]
        script = BEFORE + script
    ran = subprocess.run(["bash", "-exc", script], env=environment, text=True,
                         cwd=folder if is_readme else os.path.join(folder, "data"),
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    shutil.rmtree(folder, ignore_errors=True)
    if ran.returncode == 0:
        return []
    return [f"{page}: exit code {ran.returncode}\n{ran.stdout}"]


def main():
    wrong = []
    for page in pages():
        with open(page, encoding="utf-8") as file:
            text = file.read()
        wrong += check_links(page, text)
        if page.endswith("README.md"):
            wrong += [f"{page}:{number}: over 120 characters" for number, line
                      in enumerate(text.splitlines(), 1) if len(line) > 120]
        blocks = re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S)
        if blocks:
            wrong += run_page(page, "".join(blocks) + "\nwait\n", sys.argv[1])
            print(f"ran {len(blocks)} blocks of {os.path.relpath(page, ROOT)}", flush=True)
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
