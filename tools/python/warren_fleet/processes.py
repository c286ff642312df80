# SPDX-License-Identifier: Apache-2.0
"""Child processes that end with whoever started them, whatever ends that."""
import ctypes
import signal
import subprocess
import sys

_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None, use_errno=True)


def _die_with_parent():
    _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def clean_up_on_signals():
    """SIGTERM, and the SIGHUP of a terminal that is gone, end this process by SystemExit: `finally`
    runs, and no more of them disturb it. Under nohup SIGHUP stays ignored."""
    ending = [each for each in (signal.SIGTERM, signal.SIGHUP)
              if signal.getsignal(each) != signal.SIG_IGN]

    def leave(number, _):
        for each in ending:
            signal.signal(each, signal.SIG_IGN)
        sys.exit(128 + number)

    for each in ending:
        signal.signal(each, leave)


def start(command, **options):
    """From the main thread alone: the kernel ends a child with the thread that started it."""
    return subprocess.Popen([str(word) for word in command], preexec_fn=_die_with_parent, **options)


def run(command, timeout_s=60.0):
    """What it prints. Raises what subprocess raises; the error has what it said."""
    return subprocess.run([str(word) for word in command], check=True, timeout=timeout_s,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True).stdout


def end(process, kill_after_s=10.0):
    """Its exit status, by SIGTERM, or after a while by SIGKILL."""
    if process.poll() is None:
        process.terminate()
    try:
        return process.wait(kill_after_s)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()
