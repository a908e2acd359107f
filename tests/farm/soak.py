# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""See scripts/soak.sh, which calls this: soak.py PROGRAM RUNS FIRST_SEED here|farm"""
import filecmp
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

MOST_FAULTS = 8
LIMIT_S = 120  # a run that has not ended by then never will


class Kind:
    """Where input is cut and the result finished, and of what mesh."""

    def __init__(self, place):
        farm = place == "farm"
        self.triangles = "60000" if farm else "300000"
        self.parts = ["--parts", "8" if farm else "24"]
        self.blocks = ["--cut", "farm", "--blocks", "3"] if farm else []
        self.target = ["--ratio", "0.2" if farm else "0.02"]
        if farm:
            self.target += ["--finish", "farm", "--composition", "sink"]


class Run:
    """One run, its four processes, and what is done to them."""

    def __init__(self, program, kind, folder, mesh, seed):
        self.program = program
        self.kind = kind
        self.random = random.Random(seed)
        self.stage = os.path.join(folder, "stage")
        self.output = os.path.join(folder, "out.ply")
        self.log = open(os.path.join(folder, "log"), "w", encoding="utf-8")
        shutil.rmtree(self.stage, ignore_errors=True)
        if os.path.exists(self.output):
            os.remove(self.output)
        subprocess.run([program, "cut", mesh, "--stage", self.stage, "-q"] + kind.parts + kind.blocks,
                       check=True, stdout=subprocess.DEVNULL)
        self.stopped = []  # (pid, when it goes on)
        self.done = set()
        self.faults = 0
        self.processes = {}
        for name in ("ventilator", "sink", "worker 1", "worker 2"):
            self.start(name)

    def start(self, name):
        role = name.split()[0]
        words = [self.program, role, self.stage, "-q"]
        if role != "worker":
            words += self.kind.target + ["--bind", "127.0.0.1"]
        words += {"ventilator": ["--heartbeat-ms", "100", "--wait", "10"],
                  "sink": ["-o", self.output, "--wait", "30"],
                  "worker": ["--wait", "30"]}[role]
        self.processes[name] = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=self.log)

    def restart_dead(self):
        for name, process in list(self.processes.items()):
            code = process.poll()
            if code is None or name in self.done:
                continue
            # A worker may leave because a run was given up, and be needed again when the run is
            # resumed.
            done = code == 0 and not name.startswith("worker")
            if done or "sink" in self.done:
                self.done.add(name)
            else:
                self.start(name)

    def disturb(self, now):
        for pid, until in self.stopped[:]:
            if now >= until:
                self.signal(pid, signal.SIGCONT)
                self.stopped.remove((pid, until))
        if now < self.next_fault or self.faults >= MOST_FAULTS:
            return
        alive = [p for name, p in self.processes.items()
                 if name not in self.done and p.poll() is None]
        if alive:
            process = self.random.choice(alive)
            drawn = self.random.random()
            if drawn < 0.7:
                asked = drawn < 0.15
                self.signal(process.pid, signal.SIGTERM if asked else signal.SIGKILL)
            else:
                self.signal(process.pid, signal.SIGSTOP)
                self.stopped.append((process.pid, now + self.random.uniform(0.05, 1)))
            self.faults += 1
        self.next_fault = now + self.random.uniform(0.02, 0.25)

    @staticmethod
    def signal(pid, number):
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass

    def to_the_end(self):
        begin = time.time()
        self.next_fault = begin + self.random.uniform(0.02, 0.15)
        lonely_since = None
        while not {"ventilator", "sink"} <= self.done:
            now = time.time()
            if now - begin > LIMIT_S:
                return False
            self.restart_dead()
            # A ventilator may end just before a killed sink is back, which then needs another
            # ventilator.
            lonely = "ventilator" in self.done and "sink" not in self.done
            lonely_since = (lonely_since or now) if lonely else None
            if lonely and now - lonely_since > 3:
                self.done.discard("ventilator")
                self.start("ventilator")
            self.disturb(now)
            time.sleep(0.005)
        return True

    def leave(self):
        """Ends what still runs; False if something does not leave on SIGTERM."""
        willing = True
        for pid, _ in self.stopped:
            self.signal(pid, signal.SIGCONT)
        for process in self.processes.values():
            if process.poll() is None:
                process.terminate()
        for process in self.processes.values():
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                willing = False
                process.kill()
                process.wait()
        self.log.close()
        return willing


def main():
    program, runs, first = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    kind = Kind(sys.argv[4])
    folder = tempfile.mkdtemp(prefix="meshfarm-soak-")
    mesh = os.path.join(folder, "mesh.ply")
    expected = os.path.join(folder, "expected.ply")
    subprocess.run([program, "generate", "-o", mesh, "--triangles", kind.triangles, "-q"], check=True)
    subprocess.run([program, "simplify", mesh, "-o", expected, "-q"] + kind.parts + kind.target,
                   check=True, stdout=subprocess.DEVNULL)
    bad = faults = 0
    for seed in range(first, first + runs):
        run = Run(program, kind, folder, mesh, seed)
        begin = time.time()
        ended = run.to_the_end()
        willing = run.leave()
        faults += run.faults
        same = ended and filecmp.cmp(run.output, expected, shallow=False)
        if not (same and willing):
            bad += 1
            what = "did not end" if not ended else "does not leave" if same else "other bytes"
            print(f"seed {seed}: {what} after {time.time() - begin:.1f} s", flush=True)
            kept = os.path.join(folder, f"bad-{seed}")
            shutil.copytree(run.stage, kept, dirs_exist_ok=True)
            shutil.copy(run.log.name, os.path.join(kept, "messages"))
            if os.path.exists(run.output):
                shutil.copy(run.output, kept)
        if (seed - first + 1) % 50 == 0:
            print(f"{seed - first + 1} runs, {faults} faults, {bad} bad", flush=True)
    print(f"{runs} runs, {faults} faults, {bad} bad")
    if bad == 0:
        shutil.rmtree(folder)
    else:
        print(f"kept: {folder}")
    sys.exit(1 if bad else 0)


main()
