# SPDX-License-Identifier: Apache-2.0
"""Status polls: GET /v1/jobs/ID over 1, 100 and 10,000 keep-alive connections."""
from service_load import Figure, polls


def measure(daemon, jobs, full):
    """`jobs`: ids, asked for in turn. Figures: polls a second, latency, processor time a poll."""
    many = 10000 if full else 1000
    seconds = 8 if full else 1
    # name, connections, of these active, requests a second (0: as fast as they go)
    loads = (("1 connection", 1, 1, 0),
             ("100 connections", 100, 100, 0),
             (f"{many} connections, 100 of them active", many, 100, 0),
             (f"{many} connections, each as fast as it can", many, many, 0),
             (f"{many} connections, each once in 2 s", many, many, many / 2))
    paths = [f"/v1/jobs/{job}" for job in jobs]
    figures = []
    for name, connections, active, rate in loads:
        load = polls(daemon, paths, connections, active, seconds, rate)
        failed = load["failures"] + connections - load["open_at_end"]
        figures += [
            Figure(f"polls, {name}", load["per_second"], "1/s"),
            Figure(f"polls, {name}: p50", load["p50_ms"], "ms"),
            Figure(f"polls, {name}: p99", load["p99_ms"], "ms"),
            Figure(f"polls, {name}: processor time of talusd", load["processor_us"], "us"),
            Figure(f"polls, {name}: not answered", failed, "", 0, check=True)]
    figures.append(Figure(f"memory of talusd after {many} connections", daemon.memory() / 1e6, "MB"))
    return figures
