#!/usr/bin/env python3
"""Starts commands for the campaign, each with a budget of time and of memory, and reports what they took.

A process of its own without numpy and HDF5: Linux counts the memory of the parent at the start of a command into the
command's peak. One JSON object per line on stdin, {command, folder, seconds, kill_after}; one per line on stdout,
{code, signal, seconds, peak_bytes, out_of_time}. The output of the command goes to the files named on the command line.
"""

import json
import os
import resource
import select
import signal
import sys
import time


def wait_until(process, end):
    """Whether the process ends before the time `end`."""
    handle = os.pidfd_open(process)
    poll = select.poll()
    poll.register(handle, select.POLLIN)
    ended = bool(poll.poll(max(0.0, 1e3 * (end - time.monotonic()))))
    os.close(handle)
    return ended


def launch(order, out, err):
    begin = time.monotonic()
    os.chdir(order["folder"])
    for file in (out, err):
        os.ftruncate(file, 0)
        os.lseek(file, 0, os.SEEK_SET)
    empty = os.open("/dev/null", os.O_RDONLY)
    actions = [(os.POSIX_SPAWN_DUP2, empty, 0), (os.POSIX_SPAWN_DUP2, out, 1), (os.POSIX_SPAWN_DUP2, err, 2)]
    process = os.posix_spawn(order["command"][0], order["command"], os.environ, file_actions=actions, setpgroup=0)
    os.close(empty)
    out_of_time = False
    if order["kill_after"] is not None and not wait_until(process, begin + order["kill_after"]):
        os.kill(process, signal.SIGKILL)
    if not wait_until(process, begin + order["seconds"]):
        out_of_time = True
        os.killpg(process, signal.SIGKILL)
    _, status, usage = os.wait4(process, 0)
    return {"code": os.WEXITSTATUS(status) if os.WIFEXITED(status) else None,
            "signal": os.WTERMSIG(status) if os.WIFSIGNALED(status) else None,
            "seconds": time.monotonic() - begin, "peak_bytes": 1024 * usage.ru_maxrss, "out_of_time": out_of_time}


def main():
    address_space = int(sys.argv[3])
    resource.setrlimit(resource.RLIMIT_AS, (address_space, address_space))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    out, err = (os.open(name, os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o600) for name in sys.argv[1:3])
    for line in sys.stdin:
        print(json.dumps(launch(json.loads(line), out, err)), flush=True)


if __name__ == "__main__":
    main()
