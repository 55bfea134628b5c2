#!/usr/bin/python3
"""Runs the misuses of misuse_cases.py. Each must end in a clear error and a non-zero exit code, or in a warning where the
program can go on; the folder, earlier outputs and all, must be as it was before but for what a case says it leaves.

    misuse.py PATH/TO/elastogear PATH/TO/libfaults.so [--only PART-OF-A-NAME] [--due] [--jobs N] [--verbose]

Cases that wait for a change of the program are due: they are run by --due alone, and reported when they pass.
"""
import argparse
import concurrent.futures
import os
import queue
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile

import misuse_case
import misuse_cases
import misuse_files

# Open MPI runs as root, does not wait for fast networks, and starts no daemon for a program of one rank; such programs need a
# folder each for its files.
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_ess_singleton_isolated": "1",
       "OMPI_MCA_pml": "ob1",
       "OPENBLAS_NUM_THREADS": "1"}
PATIENCE = 120  # s
KILLED = 124  # exit codes from here on are signals


def listing(folder):
    """{path: (inode, size, time of the last change)} of all files below a folder; folders have None."""
    found = {}
    for root, folders, names in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(root, name), folder)] = None
        for name in names:
            path = os.path.join(root, name)
            state = os.lstat(path)
            found[os.path.relpath(path, folder)] = state.st_ino, state.st_size, state.st_mtime_ns
    return found


def changes(before, after, leaves, killed):
    """What is different, in words; paths that match `leaves` may be. A lock that a killed run left is harmless."""
    harmless = lambda path: path.endswith(".lock") and (killed or path not in after)
    words = [("appeared: " if path not in before else "is gone: " if path not in after else "changed: ") + path
             for path in sorted(before.keys() | after.keys())
             if before.get(path, "none") != after.get(path, "none") and not (leaves and re.fullmatch(leaves, path))
             and not harmless(path)]
    return ", ".join(words)


def expand(command, places):
    """Words of a command; {names} of misuse_case.COMMANDS and of places are written out."""
    while re.search(r"\{\w+\}", command):
        command = re.sub(r"\{(\w+)\}", lambda match: places.get(match[1]) or misuse_case.COMMANDS[match[1]], command)
    return shlex.split(command)


class Bench:
    """A folder with inputs, in which commands run; `fault` are settings of tests/faults/faults.c."""

    def __init__(self, folder, program, faults):
        self.folder, self.program, self.faults = folder, program, faults
        self.started, self.limit = None, None

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, command, fault):
        environment = {**os.environ, **MPI, "OMPI_MCA_orte_tmpdir_base": tempfile.mkdtemp(dir=os.path.dirname(self.folder))}
        if fault:
            environment.update({f"FAULT{'_' if key else ''}{key}": value for key, value in fault.items()})
            environment.update(LD_PRELOAD=f"{self.faults}:{os.environ.get('LD_PRELOAD', '')}",
                               ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0")
        return subprocess.Popen(expand(command, {"elastogear": self.program}), cwd=self.folder, env=environment,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, command, fault=None):
        """Exit code and output."""
        process = self.start(command, fault)
        try:
            output = process.communicate(timeout=self.limit)[0]
        except subprocess.TimeoutExpired as hangs:
            process.kill()
            process.communicate()
            raise misuse_files.Failed(f"takes more than {self.limit} s") from hangs
        return process.returncode, output.decode(errors="replace")

    def good(self, command):
        """As run, of a command that must succeed."""
        status, output = self.run(command)
        if status != 0:
            raise misuse_files.Failed(f"exit code {status} of {command}: {output[-500:]}")
        return output


def complaint(case, status, output):
    """What is wrong with exit code and words, or nothing."""
    if case.kind == "killed":
        return "" if status == -signal.SIGKILL else f"was not killed, exit code {status}"
    if status < 0 or status >= KILLED:
        return f"ended by a signal ({status})"
    if case.kind != "good" and re.search(r"PETSC ERROR|\(\) at |#[0-9] ", output) or "HDF5-DIAG" in output or "terminate called" in output:
        return "shows a backtrace of a library"
    if case.kind == "error" and status == 0:
        return "exit code 0"
    if case.kind == "warning" and status != 0:
        return f"a warning is enough, exit code {status}"
    if case.kind == "good" and "nothing used the option" in output:
        return re.search(r"nothing used the option \S+", output)[0]
    if case.kind == "good" or (case.kind == "right or error" and status == 0):
        return f"exit code {status}" if status else ""
    if not re.search(rf"{case.kind.split()[-1]}\b.*{case.words}", " ".join(output.split())):
        return f"no {case.kind} matching '{case.words}'"
    return ""


class Sandboxes:
    """Copies of the folder of inputs, one for each case at a time; a copy that a case changed is made anew."""

    def __init__(self, inputs, number):
        self.inputs, self.free = inputs, queue.Queue()
        for i in range(number):
            self.free.put(self.made(f"{inputs}_{i}"))

    def made(self, folder):
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.inputs, folder, symlinks=True)
        return folder


def attempt(case, bench):
    """What is wrong, or nothing, and the output."""
    if case.before:
        case.before(bench)
    before = listing(bench.folder)
    status, output = bench.run(case.command, case.fault)
    wrong = complaint(case, status, output) or changes(before, listing(bench.folder), case.leaves, case.kind == "killed")
    if not wrong and case.after:
        wrong = case.after(bench) or ""
    return wrong, output


def judge(case, sandboxes, program, faults):
    folder = sandboxes.free.get()
    pristine = listing(folder)
    bench = Bench(folder, program, faults)
    bench.limit = PATIENCE if case.due else None  # what is due may hang
    try:
        return attempt(case, bench)
    except misuse_files.Failed as failure:
        return str(failure), ""
    finally:
        if bench.started and bench.started.returncode is None:
            bench.started.kill()
            bench.started.communicate()
        sandboxes.free.put(folder if listing(folder) == pristine else sandboxes.made(folder))


def fails(case, sandboxes, program, faults, verbose):
    """Tries a case and prints what came of it."""
    wrong, output = judge(case, sandboxes, program, faults)
    verdict = ("due " if case.due else "FAIL") if wrong else "GOOD" if case.due else "ok  "
    said = re.search(r"(error|warning)\b.*", output)
    text = f"{verdict} {case.name}: {wrong or (said[0][:160] if said else '')}" + (f" [{case.due}]" if case.due else "")
    if wrong and (verbose or not case.due):
        text += "\n     | " + "\n     | ".join(output.splitlines()[-6:])
    print(text, flush=True)
    return bool(wrong) and not case.due


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("elastogear")
    parser.add_argument("faults")
    parser.add_argument("--only", default="")
    parser.add_argument("--due", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--verbose", action="store_true")
    return parser.parse_args()


def main():
    options = parse()
    program, faults = os.path.realpath(options.elastogear), os.path.realpath(options.faults)
    cases = [case for case in misuse_cases.CASES if options.only in case.name and (options.due or not case.due)]
    names = [case.name for case in misuse_cases.CASES]
    assert len(set(names)) == len(names), "two cases have one name"
    with tempfile.TemporaryDirectory() as work:
        inputs = os.path.join(work, "inputs")
        os.makedirs(inputs)
        misuse_files.make(Bench(inputs, program, faults))
        sandboxes = Sandboxes(inputs, options.jobs)
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            failed = sum(pool.map(lambda case: fails(case, sandboxes, program, faults, options.verbose), cases))
    print(f"{len(cases)} misuses, {failed} failed, {sum(bool(case.due) for case in misuse_cases.CASES)} due")
    sys.exit(failed > 0 or (not options.only and len(cases) < 60))


if __name__ == "__main__":
    main()
