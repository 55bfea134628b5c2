"""Script and style of the page: bundled from scripts/page/src by npm and esbuild into build/page, when they are not there yet."""
import fcntl
import hashlib
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
BUILD = os.path.join(HERE, "..", "..", "build", "page")
SOURCES = (".npmrc", "package.json", "package-lock.json", "build.mjs")
NODE = 18  # oldest version that runs esbuild


def sources():
    return list(SOURCES) + sorted(os.path.join("src", name) for name in os.listdir(os.path.join(HERE, "src")))


def fingerprint(names):
    total = hashlib.sha256()
    for name in names:
        with open(os.path.join(HERE, name), "rb") as file:
            total.update(name.encode() + b"\0" + file.read() + b"\0")
    return total.hexdigest()


def run(command, folder):
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"report: {' '.join(command)} failed in {folder}:\n{done.stdout}")


def require_npm():
    if not (shutil.which("npm") and shutil.which("node")):
        sys.exit("report: needs Node.js and npm, which make the page's script (nothing else of elastogear does): install them by "
                 "scripts/setup, or by apt-get install nodejs npm")
    version = subprocess.run(["node", "--version"], stdout=subprocess.PIPE, text=True).stdout.strip()
    if not version.startswith("v") or int(version[1:].split(".")[0]) < NODE:
        sys.exit(f"report: node is {version}, must be v{NODE} or later")


def packages(folder):
    """Installs the packages of the lock file in build/page, with those of the tests."""
    require_npm()
    wanted = fingerprint(("package-lock.json",))
    stamp = os.path.join(folder, "node_modules", "stamp")
    if os.path.exists(stamp) and read(stamp) == wanted:
        return
    run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], folder)
    with open(stamp, "w", encoding="utf-8") as file:
        file.write(wanted)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def ready():
    """Folder of page.js and page.css, made when the sources are others than they were made of."""
    folder = os.path.abspath(BUILD)
    names = sources()
    wanted, stamp = fingerprint(names), os.path.join(folder, "stamp")
    if os.path.exists(stamp) and read(stamp) == wanted:  # perhaps installed, where nobody may write
        return folder
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if os.path.exists(stamp) and read(stamp) == wanted:
            return folder
        shutil.rmtree(os.path.join(folder, "src"), ignore_errors=True)
        os.makedirs(os.path.join(folder, "src"))
        for name in names:
            shutil.copyfile(os.path.join(HERE, name), os.path.join(folder, name))
        packages(folder)
        run(["node", "build.mjs", "."], folder)
        with open(stamp, "w", encoding="utf-8") as file:
            file.write(wanted)
    return folder


if __name__ == "__main__":
    print(ready())
