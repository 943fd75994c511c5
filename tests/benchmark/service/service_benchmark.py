# SPDX-License-Identifier: Apache-2.0
"""The speed of the service: one command that measures all of it, prints a table and writes CSV.

usage: service_benchmark.py [--full] [--only PART] [--csv FILE] [--history N]

Without --full everything is done in small, for `ctest -L benchmark`: only what holds on any machine
decides: no event lost, every poll answered, the daemon's share of the processor time, lists of a long
history against those of a short one. With --full the speeds have goals too. TALUS_BUILD names the
build folder (TALUSD, TALUS_WORKER and TALUS_LOADGEN single programs)."""
import argparse
import csv
import os
import sys
import time

import service_cost
import service_events
import service_history
import service_polls
import service_submit
from service_load import Figure, shipped_scene
from talus_harness import Daemon

PARTS = ("polls", "events", "submit", "cost", "history")
# In the median, a list of a long history may take so many times as long as one of a short history,
# and this much more: what a page costs does not depend on what is not on it.
RATIO, SLACK_MS = 5, 5
START_GOAL = 0.5  # s


def daemon_of(parts, **options):
    daemon = Daemon(**options).start()
    parts.append(daemon)
    return daemon


def close_all(daemons):
    complaints = [daemon.close() for daemon in daemons]
    for complaint in filter(None, complaints):
        print(complaint, file=sys.stderr)
    return not any(complaints)


def measure_polls(daemons, full):
    daemon = daemon_of(daemons, workers=1, real=True, config={"connections": 12000})
    client = daemon.client()
    originals = service_history.make_originals(daemon, client, 10)
    ids, _ = service_history.make_history(daemon, originals, 100)
    return service_polls.measure(daemon, ids, full)


def measure_events(daemons, full):
    daemon = daemon_of(daemons, workers=1, real=True)
    scene = (shipped_scene("mast-7.4-column-impact") if full else
             shipped_scene("column-at-rest", duration=0.3))
    return service_events.measure(daemon, daemon.client(), {"scene": scene}, 1000 if full else 100)


def measure_submit(daemons, full):
    daemon = daemon_of(daemons, workers=1, real=True)
    body = {"scene": shipped_scene("column-at-rest")}
    return service_submit.measure(daemon, daemon.client(), body, 60 if full else 3)


def measure_cost(daemons, full):
    daemon = daemon_of(daemons, workers=1, real=True)
    name = "mast-7.4-column-impact" if full else "mast-7.2-sand-column-a2-case2-matsuoka-nakai"
    scene = shipped_scene(name)
    if not full:
        scene["output"] = dict(scene["output"], history={"every": 0.005})
    # Other programs on the machine only add to what is measured: the least of a few runs counts.
    for _ in range(1 if full else 3):
        figures = service_cost.measure(daemon, daemon.client(), {"scene": scene})
        if all(figure.verdict != "FAIL" for figure in figures):
            break
    return figures


def measure_history(daemons, full, count):
    few, many = 100, count or (100000 if full else 3000)
    seconds = 4 if full else 0.5
    daemon = daemon_of(daemons, workers=1, real=True)
    originals = service_history.make_originals(daemon, daemon.client(), 100 if full else 20)
    _, short = service_history.measure_lists(daemon, daemon.client(), few, seconds)
    ids, starts = service_history.make_history(daemon, originals, many)
    figures = [Figure(f"start of talusd with {many} jobs, {name}", seconds_of, "s",
                      None if "new" in name else START_GOAL)
               for name, seconds_of in starts.items()]
    lists, long = service_history.measure_lists(daemon, daemon.client(), many, seconds)
    slower = [name for name in long
              if name not in service_history.SCANS and long[name] > RATIO * short[name] + SLACK_MS]
    figures += lists + service_history.measure_single(daemon, daemon.client(), ids, seconds)
    figures += service_submit.measure(
        daemon, daemon.client(), {"scene": shipped_scene("column-at-rest")}, 20 if full else 2,
        f"with {many} jobs, submit")
    for name in slower:
        print("slow:", name)
    figures.append(Figure("lists that are slow because history is long", len(slower), "", 0, check=True))
    return figures


def measure(part, full, count):
    daemons = []
    begin = time.monotonic()
    try:
        function = globals()["measure_" + part]
        figures = function(daemons, full, count) if part == "history" else function(daemons, full)
    finally:
        good = close_all(daemons)
    figures.append(Figure(f"{part}: load average of the machine (1 minute)", os.getloadavg()[0], ""))
    figures.append(Figure(f"{part}: daemons that did not end well", not good, "", 0, check=True))
    for figure in figures:
        show(figure)
    print(f"{part}: {time.monotonic() - begin:.0f} s\n", flush=True)
    return figures


def show(figure):
    row = figure.row()
    print(f"{row['figure']:<72} {row['value']:>12} {row['unit']:<4} {row['goal']:<9} {row['verdict']}")


def write_csv(path, figures):
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, figures[0].row().keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(figure.row() for figure in figures)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--full", action="store_true", help="in full, with goals for speeds")
    parser.add_argument("--only", choices=PARTS, action="append", help="one part")
    parser.add_argument("--csv", help="where the figures go")
    parser.add_argument("--history", type=int, help="jobs in the long history (100,000)")
    options = parser.parse_args()
    figures = []
    for part in options.only or PARTS:
        figures += measure(part, options.full, options.history)
    if options.csv:
        write_csv(options.csv, figures)
    failed = [f for f in figures if f.verdict == "FAIL" and (f.check or options.full)]
    print(f"{len(figures)} figures, {len(failed)} beyond their goals")
    for figure in failed:
        show(figure)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
