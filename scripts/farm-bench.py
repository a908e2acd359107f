#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""Measures the farm with real processes on this machine, and prints one line a run.

farm-bench.py crowd          starts 400 workers at once against one ventilator: how long until the
                             last of them is registered (20 times; each must take less than 5 s)
farm-bench.py slow MESH      two workers, one of which is held to 33 % of a core by a control group:
                             time of the farmed phase over the ideal (3 times; at most 1.10), which
                             is the jobs' processor time over what there was of it: 1.33 cores, less
                             what others had while the first worker waited. Needs to be root, and a
                             machine that is not overloaded.
Exit code 1 if a bar was missed.
"""
import argparse
import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def trace_of(stage):
    """The lines of the newest trace, whole ones only."""
    folder = os.path.join(stage, "log")
    names = sorted(n for n in os.listdir(folder) if n.endswith(".trace")) if os.path.isdir(
        folder) else []
    if not names:
        return []
    with open(os.path.join(folder, names[-1]), encoding="utf-8") as file:
        return [json.loads(line) for line in file if line.endswith("\n")]


def wait_for(what, limit_s):
    end = time.time() + limit_s
    while time.time() < end:
        if found := what():
            return found
        time.sleep(0.02)
    return None


@contextlib.contextmanager
def running():
    """A list for processes, which are ended when it is left."""
    processes = []
    try:
        yield processes
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()


def start(words, **more):
    return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more)


def crowd_once(program, stage, workers):
    """Seconds from before the first start until all are registered, and of the starts alone."""
    shutil.rmtree(os.path.join(stage, "log"), ignore_errors=True)
    with running() as processes:
        processes.append(start([program, "ventilator", stage, "--ratio", "0.1", "--bind",
                                "127.0.0.1", "-q"]))
        if not wait_for(lambda: trace_of(stage), 20):
            raise SystemExit("farm-bench.py: the ventilator did not start")
        begin = time.time()
        for _ in range(workers):
            # As a worker would remember of its host; a benchmark each would be measured instead.
            processes.append(start([program, "worker", stage, "-q", "--speed", "1000000",
                                    "--memory", "1G"]))
        forked = time.time() - begin
        ours = {process.pid for process in processes}

        def registered():
            lines = trace_of(stage)
            joined = [line for line in lines if line["kind"] == "joined" and line["pid"] in ours]
            lost = sum(line["kind"] == "left" for line in lines)
            if len({line["pid"] for line in joined}) < workers:
                return None
            return lines[0]["unix_s"] + max(line["t"] for line in joined), lost

        found = wait_for(registered, 60)
    return (None if found is None else found[0] - begin), forked, found[1] if found else 0


def crowd(arguments):
    folder = tempfile.mkdtemp(prefix="meshfarm-crowd-")
    mesh, stage = os.path.join(folder, "mesh.ply"), os.path.join(folder, "stage")
    program = arguments.program
    subprocess.run([program, "generate", "-o", mesh, "--triangles", "20000", "-q"], check=True)
    subprocess.run([program, "cut", mesh, "--stage", stage, "--parts", "8", "-q"], check=True,
                   stdout=subprocess.DEVNULL)
    times = []
    for i in range(1, arguments.runs + 1):
        seconds, forked, lost = crowd_once(program, stage, arguments.workers)
        times.append(float("inf") if seconds is None else seconds)
        print(f"start {i}: {arguments.workers} workers forked in {forked:.2f} s, all registered "
              f"after {times[-1]:.2f} s, {lost} lost meanwhile", flush=True)
    shutil.rmtree(folder)
    good = sum(seconds < 5 for seconds in times)
    median = sorted(times)[len(times) // 2]
    print(f"{good} of {len(times)} starts in less than 5 s; median {median:.2f} s, "
          f"longest {max(times):.2f} s")
    return 0 if good == len(times) else 1


class CpuGroup:
    """A control group (version 1 or 2) whose processes get a share of one core."""

    PERIOD_US = 20_000

    def __init__(self, percent):
        quota = self.PERIOD_US * percent // 100
        old = "/sys/fs/cgroup/cpu"
        self.folder = os.path.join(old if os.path.isdir(old) else "/sys/fs/cgroup",
                                   f"meshfarm-bench-{os.getpid()}")
        os.mkdir(self.folder)
        if os.path.isdir(old):
            self.write("cpu.cfs_period_us", self.PERIOD_US)
            self.write("cpu.cfs_quota_us", quota)
        else:
            self.write("cpu.max", f"{quota} {self.PERIOD_US}")

    def write(self, name, value):
        with open(os.path.join(self.folder, name), "w", encoding="ascii") as file:
            file.write(str(value))

    def enter(self):
        self.write("cgroup.procs", os.getpid())

    def remove(self):
        wait_for(lambda: self.empty(), 5)
        os.rmdir(self.folder)

    def empty(self):
        with open(os.path.join(self.folder, "cgroup.procs"), encoding="ascii") as file:
            return not file.read()


def waited_for_cpu(pid):
    """Seconds in which a process's busiest thread could run and was not let."""
    waited = []
    with contextlib.suppress(OSError):
        for task in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{task}/schedstat", encoding="ascii") as file:
                on_cpu, on_queue, _ = map(int, file.read().split())
                waited.append((on_cpu, on_queue / 1e9))
    return max(waited)[1] if waited else 0


def slow_once(program, stage, output, group, percent):
    for name in ("log", "journal", "results"):
        for file in os.scandir(os.path.join(stage, name)) if os.path.isdir(
                os.path.join(stage, name)) else []:
            os.remove(file.path)
    common = ["--ratio", "0.01", "--bind", "127.0.0.1", "-q"]
    with running() as processes:
        ventilator = start([program, "ventilator", stage, *common])
        sink = start([program, "sink", stage, "-o", output, *common])
        fast = start([program, "worker", stage, "-q"])
        held = start([program, "worker", stage, "-q"], preexec_fn=group.enter)
        processes += [ventilator, sink, fast, held]
        waited = 0.0
        while fast.poll() is None and ventilator.poll() is None:
            waited = max(waited, waited_for_cpu(fast.pid))
            time.sleep(0.02)
        if ventilator.wait(60) != 0 or sink.wait(60) != 0:
            raise SystemExit("farm-bench.py: the run failed")
    done = [line for line in trace_of(stage) if line["kind"] == "done"]
    work_s = sum(line["cpu_us"] for line in done) / 1e6
    takes = ("read_ms", "wait_ms", "compute_ms", "write_ms")
    begin = min(line["t"] - sum(line[key] for key in takes) / 1e3 for line in done)
    took = max(line["t"] for line in done) - begin
    ideal = work_s / (1 + percent / 100)
    # Others on this machine take processor time that no farm could have used.
    available = 1 - min(0.9, waited / took) + percent / 100
    return took, ideal, work_s / available


def slow(arguments):
    folder = tempfile.mkdtemp(prefix="meshfarm-slow-", dir=arguments.folder)
    stage, output = os.path.join(folder, "stage"), os.path.join(folder, "out.ply")
    program = arguments.program
    subprocess.run([program, "cut", arguments.mesh, "--stage", stage, "--parts",
                    str(arguments.parts), "-q"], check=True, stdout=subprocess.DEVNULL)
    group = CpuGroup(arguments.percent)
    good = 0
    try:
        for i in range(1, arguments.runs + 1):
            took, ideal, ideal_here = slow_once(program, stage, output, group, arguments.percent)
            good += took / ideal_here <= 1.10
            print(f"run {i}: {took:.2f} s, {took / ideal_here:.3f} of the ideal {ideal_here:.2f} s "
                  f"(of {ideal:.2f} s if nothing else ran here: {took / ideal:.3f})", flush=True)
    finally:
        group.remove()
        shutil.rmtree(folder)
    print(f"{good} of {arguments.runs} runs within 1.10 of the ideal")
    return 0 if good == arguments.runs else 1


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build"), help="build folder")
    what = parser.add_subparsers(dest="what", required=True)
    of_crowd = what.add_parser("crowd")
    of_crowd.add_argument("--runs", type=int, default=20)
    of_crowd.add_argument("--workers", type=int, default=400)
    of_slow = what.add_parser("slow")
    of_slow.add_argument("mesh")
    of_slow.add_argument("--runs", type=int, default=3)
    of_slow.add_argument("--percent", type=int, default=33)
    of_slow.add_argument("--parts", type=int, default=512)
    of_slow.add_argument("--folder", help="for the stage; default: the system's temporary folder")
    arguments = parser.parse_args()
    arguments.program = os.path.join(arguments.build, "meshfarm")
    if not os.access(arguments.program, os.X_OK):
        parser.error(f"{arguments.program} is missing; build with scripts/build.sh")
    return crowd(arguments) if arguments.what == "crowd" else slow(arguments)


if __name__ == "__main__":
    sys.exit(main())
