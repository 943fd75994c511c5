# SPDX-License-Identifier: Apache-2.0
"""Daemons with a token file, for the tests of access."""
import json
import os
import signal

from talus_harness import Daemon, DaemonTest, sha256, wait_for

TOKENS = {"alice": "admin", "bob": "submit", "carol": "submit", "dave": "read"}


def token_of(name):
    return f"{name}-secret-0123456789~+/="


def token_lines(roles):
    return "".join(f"{name}:{role}:{sha256(token_of(name).encode())}\n"
                   for name, role in roles.items())


def write_tokens(path, content):
    """Replaces a token file at once, as its documentation says."""
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write(content)
    os.chmod(path + ".new", 0o600)
    os.rename(path + ".new", path)


def token_daemon(config=None, roles=None, **options):
    """A daemon (not started) with a token file beside its state: daemon.tokens."""
    daemon = Daemon(**options)
    daemon.tokens = os.path.join(daemon.folder, "tokens")
    write_tokens(daemon.tokens, token_lines(roles or TOKENS))
    with open(daemon.config, encoding="utf-8") as file:
        keys = json.load(file)
    keys.update(config or {}, tokens=daemon.tokens)
    with open(daemon.config, "w", encoding="utf-8") as file:
        json.dump(keys, file)
    return daemon


def reload(daemon):
    """SIGHUP; returns when the log says that the tokens were read."""
    before = daemon.tail(1 << 20).count(" in force\n")
    daemon.process.send_signal(signal.SIGHUP)
    wait_for(lambda: daemon.tail(1 << 20).count(" in force\n") > before, 20,
             "tokens read again")


def audit_lines(daemon, number=None):
    name = "audit.ndjson" if number is None else f"audit.ndjson.{number}"
    try:
        with open(os.path.join(daemon.state, name), encoding="utf-8") as file:
            return [json.loads(line) for line in file]
    except FileNotFoundError:
        return []


class TokenTest(DaemonTest):
    """A test class whose daemon has the tokens of TOKENS."""
    access = None

    @classmethod
    def setUpClass(cls):
        cls.daemon = token_daemon(cls.access)
        cls.addClassCleanup(cls.close_daemon)
        cls.daemon.start()

    def as_(self, name):
        return self.daemon.client(token=None if name is None else token_of(name))
