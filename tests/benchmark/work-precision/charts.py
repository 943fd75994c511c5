# SPDX-License-Identifier: Apache-2.0
"""Charts of work-precision.csv: per problem the error against particle-steps and against seconds,
log-log, with the Pareto front. Needs Debian's python3-matplotlib."""
import csv
import pathlib

import matplotlib
matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "talus"  # the same file for the same figures
matplotlib.rcParams["svg.fonttype"] = "none"
import matplotlib.pyplot as plt

COLOURS = {"linear": "#1f77b4", "gimp": "#2ca02c", "gimp_scaled": "#98df8a", "cpdi": "#d62728",
           "cpdi_hybrid": "#ff9896", "bspline2": "#9467bd", "bspline3": "#8c564b",
           "quadratic": "#7f7f7f"}
MARKERS = ["o", "s", "^", "v", "D", "P", "X", "*", "<", ">"]


def read(folder):
    """{problem: {method: [(particle_steps, seconds, error)]}} of the runs that came to an end."""
    found = {}
    with open(folder / "work-precision.csv", newline="") as file:
        for row in csv.DictReader(file):
            methods = found.setdefault(row["problem"], {})
            if row["error"]:
                methods.setdefault(row["method"], []).append(
                    tuple(float(row[key]) for key in ("particle_steps", "seconds", "error")))
    return found


def pareto(points):
    """Those that no other point beats in both, by cost."""
    front, best = [], float("inf")
    for cost, error in sorted(points):
        if error < best:
            front.append((cost, error))
            best = error
    return front


def draw_one(axis, methods, cost_index, label):
    used = {}
    for method, points in methods.items():
        shape = method.split(",")[0]
        marker = MARKERS[used.setdefault(shape, 0) % len(MARKERS)]
        used[shape] += 1
        points = sorted((point[cost_index], point[2]) for point in points)
        axis.plot(*zip(*points), color=COLOURS[shape], marker=marker, markersize=4, linewidth=0.8,
                  label=method)
    everything = [(point[cost_index], point[2]) for points in methods.values() for point in points]
    axis.plot(*zip(*pareto(everything)), color="black", linewidth=2.5, alpha=0.35,
              label="Pareto front")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel(label)
    axis.grid(True, which="both", linewidth=0.3)


def draw_all(folder):
    folder = pathlib.Path(folder)
    for problem, methods in read(folder).items():
        figure, axes = plt.subplots(1, 2, figsize=(12, 5.5), sharey=True)
        draw_one(axes[0], methods, 0, "particle-steps")
        draw_one(axes[1], methods, 1, "seconds of one core")
        axes[0].set_ylabel("error")
        axes[1].legend(fontsize=6.5, loc="center left", bbox_to_anchor=(1.01, 0.5))
        figure.suptitle(problem)
        figure.tight_layout()
        path = folder / f"{problem.replace(' ', '-')}.svg"
        figure.savefig(path, metadata={"Date": None})
        plt.close(figure)
        # The repository has no white space at the end of a line.
        path.write_text("".join(line.rstrip() + "\n" for line in path.read_text().splitlines()))
