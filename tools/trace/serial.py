#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Where the time of a run went, by stage: serial.py TRACE.json [--json]

TRACE.json is what `csgmesh ... --trace TRACE.json` writes (docs/trace.md). For each stage, in the order of
the work and indented as the stages nest:

    wall     seconds from its first beginning to its end, all its runs added up
    cpu      processor time of all threads in it
    alone    the part of its wall time in which at most one thread was at work in a loop or outside of one: more
             threads cannot shorten it as the work is divided now
    outside  the part of its wall time outside of parallel loops: what stays when there are ever more threads
             (Amdahl's serial share; it can be read from a run with -j 1, and on a busy machine)

A thread is at work from the first item of a loop that it takes to its last, and waits otherwise. The jobs of a batch
are the items of one loop.
"""
import argparse
import json
import sys
from collections import namedtuple

# caller: the thread that a loop's stage is on.
Zone = namedtuple("Zone", "thread name begin end cpu is_loop caller")


class Stage:
    """All zones with one name below the same stages."""

    def __init__(self, path):
        self.path, self.runs = path, 0
        self.wall = self.cpu = self.alone = self.outside = 0.0

    def as_dict(self):
        return {"stage": "/".join(self.path), "runs": self.runs, "wall_s": self.wall, "cpu_s": self.cpu,
                "alone": share(self.alone, self.wall), "outside_loops": share(self.outside, self.wall)}


def share(part, whole):
    return part / whole if whole > 0 else 0.0


def zones_of(trace):
    """Zones, those that begin first first and those around others before them. Seconds."""
    zones = [Zone(e["tid"], e["name"], e["ts"] / 1e6, (e["ts"] + e["dur"]) / 1e6, e["tdur"] / 1e6,
                  e["cat"] == "loop", e.get("args", {}).get("caller", e["tid"])) for e in trace["traceEvents"] if e["ph"] == "X"]
    return sorted(zones, key=lambda z: (z.begin, -z.end, z.is_loop))


def covered(intervals, least):
    """Length of what at least `least` of the intervals cover."""
    ends = sorted([(begin, 1) for begin, _ in intervals] + [(end, -1) for _, end in intervals])
    depth, total, since = 0, 0.0, 0.0
    for at, step in ends:
        if depth >= least:
            total += at - since
        depth, since = depth + step, at
    return total


def overlap(zone, loops):
    return [(max(l.begin, zone.begin), min(l.end, zone.end)) for l in loops
            if l.caller == zone.thread and l.begin < zone.end and l.end > zone.begin]


def nest(stages):
    """(path, zone, zones directly in it) for each stage zone, by thread."""
    found = []
    for thread in sorted({z.thread for z in stages}):
        stack = []
        for zone in (z for z in stages if z.thread == thread):
            while stack and stack[-1][1].end < zone.end:
                stack.pop()
            path = (stack[-1][0] if stack else ()) + (zone.name,)
            entry = (path, zone, [])
            if stack:
                stack[-1][2].append(entry)
            stack.append(entry)
            found.append(entry)
    return found


def processor_time(entry, loops):
    """Of the thread that the stage is on (the language has a thread of its own, whose time counts in what it does
    alone), and of the others' loops in it."""
    _, zone, inner = entry

    def own(inner_entry):
        return max(inner_entry[1].cpu, sum(own(e) for e in inner_entry[2]))
    others = (l for l in loops if l.caller == zone.thread != l.thread and l.begin >= zone.begin and l.end <= zone.end)
    return own(entry) + sum(l.cpu for l in others)


def stages_of(trace):
    """The stages in the order of their first beginning."""
    zones = zones_of(trace)
    loops = [z for z in zones if z.is_loop]
    table = {}
    entries = nest([z for z in zones if not z.is_loop])
    first = min((z.thread for z in zones), default=0)
    jobs = [e for e in entries if len(e[0]) == 1 and e[1].thread != first]
    loops += [e[1]._replace(is_loop=True, caller=first, cpu=processor_time(e, loops)) for e in jobs]
    for entry in entries:
        path, zone, _ = entry
        stage = table.setdefault(path, Stage(path))
        inside = overlap(zone, loops)
        wall = zone.end - zone.begin
        stage.runs += 1
        stage.wall += wall
        stage.cpu += processor_time(entry, loops)
        stage.alone += wall - covered(inside, 2)
        stage.outside += wall - covered(inside, 1)
    return list(table.values())


def print_table(stages, out):
    width = max([len(s.path[-1]) + 2 * len(s.path) for s in stages] + [10])
    out.write(f"{'stage':{width}}  runs    wall s     cpu s   alone  outside\n")
    for s in stages:
        name = "  " * (len(s.path) - 1) + s.path[-1]
        out.write(f"{name:{width}} {s.runs:5d} {s.wall:9.4f} {s.cpu:9.4f} {100 * share(s.alone, s.wall):6.1f}% "
                  f"{100 * share(s.outside, s.wall):7.1f}%\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("trace")
    parser.add_argument("--json", action="store_true", help="one object per stage instead of the table")
    options = parser.parse_args()
    try:
        with open(options.trace, encoding="utf-8") as file:
            trace = json.load(file)
        stages = stages_of(trace)
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"serial.py: {options.trace}: {error!r}", file=sys.stderr)
        return 2
    if options.json:
        json.dump([s.as_dict() for s in stages], sys.stdout, indent=2)
        print()
    else:
        print_table(stages, sys.stdout)
    dropped = trace.get("otherData", {}).get("dropped_zones", 0)
    if dropped:
        print(f"serial.py: {dropped} zones found no room and are missing", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
