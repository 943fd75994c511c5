# SPDX-License-Identifier: Apache-2.0
"""Threads that ask a daemon for one thing after the other while it is being killed."""
import http.client
import random
import threading
import time

from talus_harness import Client

BROKEN = (OSError, http.client.HTTPException, EOFError, ValueError)


class ClientThreads:
    """A thread a task; a task is called with (client, source of random numbers, a name of the call)."""

    rest = None  # the longest time between two calls, which are at random

    def __init__(self, daemon, seed, tasks):
        self.daemon, self.seed = daemon, seed
        self.failures = []
        self.stopping = threading.Event()
        self.threads = [threading.Thread(target=self.loop, args=(task, index), daemon=True)
                        for index, task in enumerate(tasks)]

    def start(self):
        for thread in self.threads:
            thread.start()

    def stop(self):
        self.stopping.set()
        for thread in self.threads:
            thread.join(60)
            if thread.is_alive():
                self.failures.append(f"client thread hangs: {thread}")

    def loop(self, task, index):
        source = random.Random(self.seed * 1000 + index)
        client = Client(self.daemon.port, 20)
        count = 0
        while not self.stopping.is_set():
            try:
                task(client, source, f"{index}-{count}")
            except BROKEN:
                client.close()
                time.sleep(0.02)
            except Exception as error:  # a defect of the test itself must show
                self.failures.append(f"{task.__name__}: {error!r}")
                time.sleep(0.2)
            count += 1
            if self.rest is not None:
                time.sleep(source.uniform(0, self.rest))
        client.close()
