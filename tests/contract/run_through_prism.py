# SPDX-License-Identifier: Apache-2.0
"""Runs a protocol test with its requests going through prism:
    run_through_prism.py DOCUMENT NOTES TEST.py
A violation in an answer fails; so does one in a request that the daemon did not refuse."""
import json
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))


def faults(notes):
    """What is wrong, one line each, and how many requests went through."""
    found, through = [], 0
    for entry in notes:
        through += entry["through"]
        text = entry["violations"] or "[]"
        if not text.startswith("["):  # prism cuts long lists
            part = "response" if '"location":["response"' in text else "request"
            text = json.dumps([{"location": [part], "severity": "Error", "message": text[:200]}])
        for violation in json.loads(text):
            place = ".".join(violation["location"])
            of_answer = violation["location"][0] == "response"
            if violation["severity"] == "Error" and (of_answer or entry["status"] < 400):
                path = re.sub(r"[0-9a-hjkmnp-tv-z]{26}", "ID", entry["path"])
                found.append(f"{entry['method']} {path} -> {entry['status']}: {place}: "
                             f"{violation['message']}")
    return found, through


def main(document, notes, test):
    if os.path.exists(notes):
        os.unlink(notes)
    proxy = subprocess.Popen(["node", os.path.join(HERE, "prism_proxy.mjs"), document],
                             stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    control = proxy.stdout.readline().strip()
    environment = dict(os.environ, TALUS_CONTRACT_CONTROL=control, TALUS_CONTRACT_NOTES=notes)
    code = subprocess.run([sys.executable, test], env=environment, check=False).returncode
    proxy.stdin.close()
    proxy.wait()
    with open(notes, encoding="utf-8") as file:
        found, through = faults([json.loads(line) for line in file])
    print(f"{through} requests went through prism, {len(found)} violations")
    for fault in sorted(set(found)):
        print(fault)
    return 1 if code or found or not through else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
