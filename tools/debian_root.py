#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a command in a Debian of its own, made from this machine's mirror, as root.

  debian_root.py FOLDER [--suite NAME] [--bind PATH[:PLACE]]... COMMAND [ARGUMENT...]

FOLDER is made by debootstrap unless it is there: of the named release, else of this machine's. The
command runs in this folder's place, sees the bound folders under their own names, or at PLACE, and
has CCACHE_* and proxies of the environment. It runs in mount and process namespaces of its own, so
that nothing stays mounted or runs on, whatever happens. The exit status is the command's, or 77 if
a Debian cannot be made here.
"""
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import urllib.error
import urllib.request

NAMESPACES = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "--propagation", "private"]


class Skip(Exception):
    pass


def output_of(*command):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                          check=True).stdout


def expect(condition, message):
    if not condition:
        raise AssertionError(message)


# ----- the empty Debian -------------------------------------------------------------------------

def check_machine():
    if os.geteuid() != 0:
        raise Skip("a Debian root can only be made as root")
    for tool in ("debootstrap", "unshare", "apt-get", "dpkg-deb"):
        if not shutil.which(tool):
            raise Skip(f"{tool} is not installed (scripts/install-packages package)")
    if subprocess.run([*NAMESPACES, "true"], stderr=subprocess.DEVNULL, check=False).returncode:
        raise Skip("this machine allows no mount namespaces (unshare)")


def suite_of_host():
    with open("/etc/os-release", encoding="utf-8") as file:
        found = re.search(r'(?m)^VERSION_CODENAME="?(\w+)', file.read())
    if not found:
        raise Skip("/etc/os-release names no release of Debian")
    return found.group(1)


def sources_of_host():
    """The host's (address, suite, component) of Debian itself."""
    lines = output_of("apt-get", "indextargets", "--format",
                      "$(REPO_URI)|$(RELEASE)|$(COMPONENT)|$(ORIGIN)", "Created-By: Packages")
    sources = []
    for line in lines.splitlines():
        address, suite, component, origin = line.split("|")
        if origin == "Debian" and (address, suite, component) not in sources:
            sources.append((address, suite, component))
    return sources


def check_mirror(mirror, suite):
    try:
        with urllib.request.urlopen(f"{mirror}/dists/{suite}/InRelease", timeout=60) as answer:
            answer.read(1)
    except urllib.error.HTTPError as error:
        expect(error.code != 404, f"{mirror} has no release {suite}")
        raise Skip("the mirror of this machine does not answer") from None
    except (urllib.error.URLError, OSError, ValueError):
        raise Skip("the mirror of this machine does not answer") from None


def mounted_under(folder):
    with open("/proc/self/mounts", encoding="utf-8") as file:
        return [line.split()[1] for line in file
                if line.split()[1].startswith(os.path.join(folder, ""))]


def remove(root):
    """Deletes a root; never what is mounted in it."""
    mounts = mounted_under(os.path.realpath(root))
    expect(not mounts, f"not deleted, for something is mounted in it: {mounts}")
    shutil.rmtree(root)


def source_of_host(wanted=None):
    """A release (None: the host's), its sources at the host's mirrors, and one that answers."""
    suite, sources = suite_of_host(), sources_of_host()
    if wanted:  # bookworm-security becomes trixie-security
        sources = [(address, re.sub(rf"^{suite}\b", wanted, of_suite), component)
                   for address, of_suite, component in sources]
        suite = wanted
    mirrors = [address for address, of_suite, _ in sources if of_suite == suite]
    if not mirrors:
        raise Skip("apt has no sources of Debian, or no lists of them (apt-get update)")
    check_mirror(mirrors[0].rstrip("/"), suite)
    return suite, sources, mirrors[0]


def install_debian(root, suite, mirror):
    """Makes an empty folder a Debian; removes it if that fails."""
    print("making an empty Debian with debootstrap", flush=True)
    result = subprocess.run([*NAMESPACES, "debootstrap", "--variant=minbase", suite, root, mirror],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False)
    if result.returncode:
        remove(root)
        raise AssertionError(f"debootstrap failed:\n{result.stdout[-2000:]}")


def set_up_apt(root, sources):
    with open(f"{root}/etc/apt/sources.list", "w", encoding="utf-8") as file:
        file.writelines(f"deb {address} {suite} {component}\n"
                        for address, suite, component in sources)
    # How this machine reaches its mirror.
    dump = output_of("apt-config", "dump", "Acquire")
    with open(f"{root}/etc/apt/apt.conf.d/90host", "w", encoding="utf-8") as file:
        file.writelines(line + "\n" for line in dump.splitlines()
                        if re.match(r"Acquire::(https?::Proxy|Check-|ForceIPv)", line))
    with open(f"{root}/etc/dpkg/dpkg.cfg.d/fast", "w", encoding="utf-8") as file:
        file.write("force-unsafe-io\n")
    for name in ("resolv.conf", "hosts"):
        if os.path.exists(f"/etc/{name}"):
            shutil.copyfile(f"/etc/{name}", f"{root}/etc/{name}")


# ----- commands in it ---------------------------------------------------------------------------

class Root:
    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        return os.path.join(self.folder, name.lstrip("/"))

    def run(self, *command, status=0):
        """Runs a command in the root, and gives stdout and stderr."""
        result = subprocess.run(
            self.command(*command), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, check=False, env=self.environment())
        expect(result.returncode == status,
               f"{' '.join(command)}: exit status {result.returncode}, not {status}\n"
               f"{result.stdout[-3000:]}")
        return result.stdout

    def command(self, *command, binds=(), folder="/"):
        """What runs a command in a folder of the root, with /proc, /sys and bound folders."""
        script = ['mount -t proc proc "$0/proc"', 'mount -t sysfs -o ro sysfs "$0/sys"',
                  'mkdir -p "$0/dev/pts"',
                  'mount -t devpts -o newinstance,ptmxmode=0666 devpts "$0/dev/pts"']
        for path, place in binds:
            os.makedirs(self.path(place), exist_ok=True)
            script.append(f"mount --bind {shlex.quote(path)} \"$0\"{shlex.quote(place)}")
        inside = f'cd {shlex.quote(folder)} && exec "$@"'
        script.append(f'exec chroot "$0" sh -c {shlex.quote(inside)} sh "$@"')
        return [*NAMESPACES, "sh", "-c", " && ".join(script), self.folder, *command]

    def environment(self):
        return {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root",
                "DEBIAN_FRONTEND": "noninteractive", "LANG": "C.UTF-8",
                **{name: value for name, value in os.environ.items()
                   if name.lower().endswith("_proxy") or name.startswith("CCACHE_")}}

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def files(self):
        """The paths of all files and folders on disk."""
        found = set()
        for folder, folders, files in os.walk(self.folder):
            where = os.path.relpath(folder, self.folder)
            if where in ("proc", "sys", "dev", "tmp"):
                folders.clear()
                continue
            found.update(os.path.normpath(os.path.join(where, name)) for name in folders + files)
        return found


# ----- the program ------------------------------------------------------------------------------

def parse(arguments):
    if not arguments or arguments[0].startswith("-"):
        raise SystemExit(__doc__)
    folder, suite, binds, rest = os.path.realpath(arguments[0]), None, [], arguments[1:]
    while rest and rest[0] in ("--bind", "--suite") and len(rest) > 1:
        if rest[0] == "--bind":
            path, _, place = rest[1].partition(":")
            binds.append((os.path.realpath(path), os.path.realpath(place or path)))
        else:
            suite = rest[1]
        rest = rest[2:]
    if not rest:
        raise SystemExit(__doc__)
    return folder, suite, binds, rest


def main():
    folder, wanted, binds, command = parse(sys.argv[1:])
    check_machine()
    if not os.path.exists(folder):
        suite, sources, mirror = source_of_host(wanted)
        begun = folder + ".begun"
        if os.path.exists(begun):  # by a run that was killed
            remove(begun)
        os.makedirs(begun)
        install_debian(begun, suite, mirror)
        set_up_apt(begun, sources)
        os.replace(begun, folder)
    root = Root(folder)
    sys.exit(subprocess.run(root.command(*command, binds=binds, folder=os.getcwd()),
                            stdin=subprocess.DEVNULL, check=False,
                            env=root.environment()).returncode)


def stop(number, _frame):
    sys.exit(128 + number)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, stop)
    try:
        main()
    except Skip as reason:
        print(f"skipped: {reason}")
        sys.exit(77)
