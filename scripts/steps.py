"""Runs the steps of a chain of commands, each with its output in a file, and shows how far chain and step are."""
import os
import re
import subprocess
import sys
import time

COLUMNS = 79
POLL = 0.2  # s
ON_TERMINAL, ELSEWHERE = 1, 20  # s between two lines


def last_progress(log):
    """The last line of progress in a file, without runs of blanks, or nothing."""
    with open(log, "rb") as file:
        file.seek(max(0, os.path.getsize(log) - 4096))
        text = file.read().decode(errors="replace")
    lines = [line for line in re.split(r"[\r\n]+", text) if re.search(r"\d %  ", line)]
    return " ".join(lines[-1].split()) if lines else ""


def show(text, terminal):
    """A line that the next one takes the place of (on a terminal), or one for good."""
    print(f"\r\033[K{text[:COLUMNS]}" if terminal else text[:COLUMNS], end="" if terminal else "\n", flush=True)


def left(seconds):
    """A time that remains, in words: "about 25 min left"."""
    return f"about {max(round(seconds / 60), 1)} min left" if seconds < 3600 else f"about {seconds / 3600:.1f} h left"


class Steps:
    """`total`: of the steps of the chain; 0 when it is not known. `costs`: seconds that each step is expected to take, in their
    order; only their ratios count once a step has ended."""

    def __init__(self, total=0, costs=()):
        self.total, self.done, self.terminal = total or len(costs), 0, sys.stdout.isatty()
        self.costs, self.start = list(costs), time.monotonic()

    def remaining(self):
        """How long the steps that follow take, when costs are known and steps do follow."""
        if not sum(self.costs[self.done:]):
            return ""
        return ", " + left(sum(self.costs[self.done:]) * (time.monotonic() - self.start) / sum(self.costs[:self.done]))

    def run(self, name, command, log):
        """CPU time (s), wall-clock time (s) and largest memory (MB) of a command, printed. Exits with what it printed when it fails."""
        self.done += 1
        place = f"{self.done}/{self.total} {name}" if self.total else name
        start = shown = time.monotonic()
        with open(log, "w", encoding="utf-8") as file:
            process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        if self.terminal:
            show(place, True)
        status = None
        while status is None:
            pid, ended, usage = os.wait4(process.pid, os.WNOHANG)
            status = ended if pid else None
            if status is None:
                if time.monotonic() - shown > (ON_TERMINAL if self.terminal else ELSEWHERE):
                    shown = time.monotonic()
                    show(f"{place}: {last_progress(log) or f'{shown - start:.0f} s so far'}", self.terminal)
                time.sleep(POLL)
        process.returncode = os.waitstatus_to_exitcode(status)
        if self.terminal:
            show("", True)
        if status != 0:
            with open(log, encoding="utf-8", errors="replace") as file:
                sys.exit(f"{name}: {' '.join(command)}\n{file.read()[-2000:]}")
        figures = usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss / 1024
        print("{:<34} {:9.1f} s CPU {:9.1f} s wall {:8.0f} MB".format(place[:34], *figures) + self.remaining(), flush=True)
        return figures
