# SPDX-License-Identifier: Apache-2.0
"""Saves the OpenAPI document of a daemon with the real worker:   save_document.py FILE"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "protocol"))
from talus_harness import Daemon  # noqa: E402  (the folder is known only now)

if __name__ == "__main__":
    daemon = Daemon(real=True).start()
    reply = daemon.client().get("/openapi.json")
    complaints = daemon.close()
    if reply.status != 200 or complaints:
        sys.exit(f"{reply} {complaints}")
    with open(sys.argv[1], "wb") as file:
        file.write(reply.body)
    print(f"{len(reply.json()['paths'])} paths, {len(reply.body)} bytes")
