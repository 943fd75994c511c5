# SPDX-License-Identifier: Apache-2.0
"""Runs protocol tests, one after the other, with their requests going through prism:
    run_through_prism.py DOCUMENT NOTES TEST.py[:CLASS,...]...
A violation in an answer fails, and so do a status or a path that the document does not have and a
violation in a request that the daemon did not refuse."""
import json
import os
import re
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))


def is_fault(entry, violation):
    """Statuses of no operation are but a warning to prism."""
    if violation["location"][0] == "response":
        return (violation["severity"] == "Error"
                or violation["message"].startswith("Unable to match the returned status"))
    return violation["severity"] == "Error" and entry["status"] < 400


def faults(notes):
    """What is wrong, one line each."""
    found = set()
    for entry in notes:
        path = re.sub(r"[0-9a-hjkmnp-tv-z]{26}", "ID", entry["path"])
        told = f"{entry['method']} {path[:200]} -> {entry['status']}"
        # The only answer that no operation makes and that is no refusal is that to a page's browser.
        if not entry["routed"] and entry["status"] < 400 and entry["method"] != "OPTIONS":
            found.add(f"{told}: the document has no such operation")
        for violation in entry["violations"]:
            if is_fault(entry, violation):
                found.add(f"{told}: {'.'.join(violation['location'])}: {violation['message']}")
    return sorted(found)


def run(test, environment):
    file, _, names = test.partition(":")
    began = time.monotonic()
    code = subprocess.run([sys.executable, file, *filter(None, names.split(","))], env=environment,
                          check=False).returncode
    print(f"{os.path.basename(file)} ended with {code} after {time.monotonic() - began:.1f} s",
          flush=True)
    return code


def main(document, notes, *tests):
    if os.path.exists(notes):
        os.unlink(notes)
    proxy = subprocess.Popen(["node", os.path.join(HERE, "prism_proxy.mjs"), document],
                             stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    control = proxy.stdout.readline().strip()
    protocol = os.path.join(os.path.dirname(HERE), "protocol")
    environment = dict(os.environ, TALUS_CONTRACT_CONTROL=control, TALUS_CONTRACT_NOTES=notes,
                       PYTHONPATH=protocol)
    failed = [test for test in tests if run(test, environment)]
    proxy.stdin.close()
    proxy.wait()
    with open(notes, encoding="utf-8") as file:
        entries = [json.loads(line) for line in file]
    found = faults(entries)
    through = sum(entry["through"] for entry in entries)
    print(f"{through} requests went through prism, {len(entries) - through} answers beside it, "
          f"{len(found)} violations")
    for fault in found:
        print(fault)
    return 1 if failed or found or not through else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
