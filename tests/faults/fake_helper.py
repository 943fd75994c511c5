# SPDX-License-Identifier: Apache-2.0
"""The fake worker's `helper`: answers what the daemon asks about scenes and pictures, one JSON line
in, one out. Files in SIDE switch misbehaviour on: helper-exit, helper-die, helper-hang,
helper-half, helper-nonsense, helper-endless, helper-render-hang. A scene titled
`fake {"helper": "die"}` kills the helper that reads it, {"helper": "hang"} holds it, {"disk_bytes": N}
is forecast to take so many, {"refuse": [A, B]} is invalid with a duration between."""
import hashlib
import json
import os
import struct
import sys
import time
import zlib

KEYS = ("title", "dimension", "duration", "grid", "solver", "materials", "bodies", "gravity",
        "boundaries", "probes", "references", "output")
REQUIRED = ("dimension", "duration", "grid", "materials", "bodies")


def build(side):
    """Of the solver: "fake", or what the file helper-build says."""
    try:
        with open(os.path.join(side, "helper-build"), encoding="utf-8") as file:
            return file.read()
    except FileNotFoundError:
        return "fake"


def directive(scene):
    """What the title of a scene tells the fake worker."""
    title = scene.get("title", "") if isinstance(scene, dict) else ""
    return json.loads(title[5:]) if title.startswith("fake ") else {}


def check(question, side):
    scene = question["scene"]
    if not isinstance(scene, dict):
        return refuse("", "type", "a scene is an object")
    errors = []
    for key in REQUIRED:
        if key not in scene:
            errors.append({"pointer": "/" + key, "code": "required", "detail": f"{key} is missing"})
    for key in scene:
        if key not in KEYS:
            errors.append({"pointer": "/" + key.replace("~", "~0").replace("/", "~1"),
                           "code": "unknown_key", "detail": f"no such key: {key}"})
    if isinstance(scene.get("duration"), (int, float)) and scene["duration"] <= 0:
        errors.append({"pointer": "/duration", "code": "range", "detail": "not above 0"})
    low, high = directive(scene).get("refuse", (0, 0))
    if isinstance(scene.get("duration"), (int, float)) and low < scene["duration"] < high:
        errors.append({"pointer": "/duration", "code": "range", "detail": "in the gap"})
    if errors:
        return {"ok": False, "errors": errors}
    effective = dict(scene, solver={"kind": "explicit", "time_step": "auto"})
    hashed = json.dumps({k: v for k, v in effective.items() if k != "title"}, sort_keys=True)
    # 1 and 1.0 are the same scene.
    hashed = json.dumps(json.loads(hashed, parse_int=float), sort_keys=True)
    forecast = {"particles": 64, "active_cells": 16, "critical_time_step": 0.001, "steps": 1000,
                "time_step": 0.0004, "memory_bytes": 100000, "bytes_per_particle": 200,
                "disk_bytes": directive(scene).get("disk_bytes", 100000),
                "wall_seconds": {"low": 0.1, "expected": 0.2, "high": 0.4}}
    return {"ok": True, "build": build(side), "effective": effective, "forecast": forecast,
            "advice": [], "warnings": [],
            "hash": hashlib.sha256(hashed.encode()).hexdigest()}


def check_many(question, side):
    """What the daemon asks about the rows of a study."""
    answers = []
    for scene in question["scenes"]:
        answer = check({"scene": scene}, side)
        answers.append({key: answer[key] for key in ("ok", "errors", "forecast", "hash", "build")
                        if key in answer})
    return {"ok": True, "answers": answers}


def refuse(pointer, code, detail):
    return {"ok": False, "errors": [{"pointer": pointer, "code": code, "detail": detail}]}


def chart(question):
    """Says what it was asked to draw; a study called "no chart" gets none."""
    if question["title"] == "no chart":
        return refuse("/chart", "range", "nothing to draw")
    if not question["rows"][0]["metrics"]:
        return refuse("/rows", "required", "no metrics")
    shown = json.dumps({key: question[key] for key in ("chart", "kind", "title", "units")}, sort_keys=True)
    return {"ok": True, "svg": f"<svg xmlns='http://www.w3.org/2000/svg'><!-- {shown} "
                               f"{len(question['rows'])} rows --></svg>"}


def picture(width, height):
    """A grey PNG."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = (b"\0" + b"\x80" * width) * height
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def render(question, side):
    if os.path.exists(os.path.join(side, "helper-render-hang")):
        time.sleep(60)
    frame = os.path.join(question["folder"], "frames", f"frame_{question.get('frame', 0):06d}.hdf")
    if not os.path.exists(frame):
        return refuse("/frame", "not_found", "no such frame")
    width = question.get("width", 1000)
    if not 16 <= width <= 4096:
        return refuse("/width", "range", "too wide or too narrow")
    if question.get("style", "points") not in ("points", "voxels"):
        return refuse("/style", "unknown_value", "points or voxels")
    with open(question["output"], "wb") as file:
        file.write(picture(width, width // 2))
    return {"ok": True}


def misbehave(side, question):
    def on(name):
        return os.path.exists(os.path.join(side, "helper-" + name))
    wish = None
    for scene in [question.get("scene"), *question.get("scenes", [])]:
        wish = wish or directive(scene).get("helper")
    if on("exit"):
        sys.exit(3)
    if on("die") or wish == "die":
        os.abort()
    if on("hang") or wish == "hang":
        time.sleep(60)
    if on("nonsense"):
        sys.stdout.write("this is no JSON\n")
    elif on("half"):
        sys.stdout.write('{"ok": tr')
    elif on("endless"):
        while True:
            sys.stdout.write("x" * 65536)
    else:
        return False
    sys.stdout.flush()
    return True


def serve(side):
    if os.path.exists(os.path.join(side, "helper-exit")):
        sys.exit(3)
    for line in sys.stdin:
        question = json.loads(line)
        if misbehave(side, question):
            continue
        operation = question["op"]
        if operation == "check":
            answer = check(question, side)
        elif operation == "check_many":
            answer = check_many(question, side)
        elif operation == "chart":
            answer = chart(question)
        elif operation == "render":
            answer = render(question, side)
        elif operation == "schema":
            answer = {"ok": True, "schema": {"type": "object", "required": list(REQUIRED)}}
        elif operation == "describe":
            answer = {"ok": True, "describe": {"materials": ["linear_elastic"]}}
        else:
            answer = refuse("/op", "unknown_value", "no such operation")
        sys.stdout.write(json.dumps(answer) + "\n")
        sys.stdout.flush()
