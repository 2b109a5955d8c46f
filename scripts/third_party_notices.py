#!/usr/bin/env python3
"""Writes the notices of the libraries that a built program contains: linked libraries, and
libraries whose headers are compiled into it.

  scripts/third_party_notices.py BUILD_FOLDER OUTPUT

Ninja lists the headers that the compiler read; Debian's packages name their owners and licenses.
Headers unpacked into build/deps belong to no installed package; their notices are in that folder.
Needs dpkg, and the build folder of a finished build."""
import os
import re
import subprocess
import sys

# The C and C++ libraries of the system and of the compiler do not count as parts of a program
# (runtime library exception of GCC, section 5 of the LGPL).
OF_THE_SYSTEM = re.compile(
    r"^(libc6|libc6-dev|linux-libc-dev|libstdc\+\+.*|libgcc.*|gcc-\d+-base|cpp.*)$"
)
PROGRAMS = ("strata", "strata-mesher")
HEAD = """Strata is distributed under the MIT licence (LICENSE). The program holds or links the libraries below; each stands under the licence that follows its name.

"""


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def headers_of(build):
    """Returns the headers outside the project that the program's own units read."""
    units = {
        line.split(":")[0]
        for line in run("ninja", "-C", build, "-t", "inputs", *PROGRAMS).splitlines()
        if line.split(":")[0].endswith(".o")
    }
    wanted, found = False, set()
    for line in run("ninja", "-C", build, "-t", "deps").splitlines():
        if line and not line.startswith(" "):
            wanted = line.split(":")[0] in units
        elif wanted:
            path = os.path.normpath(os.path.join(build, line.strip()))
            if path.startswith("/usr/") or "/build/deps/" in path:
                found.add(path)
    if not found:
        sys.exit(f"{build}: no unit of `strata` was compiled here: build it first")
    return found


def libraries_of(program):
    """Returns only the directly linked libraries. Debian's packages of these libraries have their
    own notices and dependencies."""
    needed = set(re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", program)))
    return {
        os.path.realpath(path)
        for name, path in re.findall(r"(\S+) => (/\S+)", run("ldd", program))
        if name in needed
    }


def packages_of(files):
    """Returns the Debian packages that own the files; /lib is a link to /usr/lib, and dpkg may list
    a file under either."""
    names = set()
    files = sorted(files)
    for begin in range(0, len(files), 500):
        piece = files[begin : begin + 500]
        piece += [name.removeprefix("/usr") for name in piece if name.startswith("/usr/lib/")]
        for line in run("dpkg-query", "-S", *piece).splitlines():
            names |= {name.split(":")[0].strip() for name in line.rpartition(": ")[0].split(",")}
    return {name for name in names if name and not OF_THE_SYSTEM.match(name)}


def notice_of(package, roots):
    for root in roots:
        file = os.path.join(root, "usr/share/doc", package, "copyright")
        if os.path.exists(file):
            with open(file, encoding="utf-8", errors="replace") as opened:
                return opened.read().strip()
    return None


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    build, output = os.path.realpath(sys.argv[1]), sys.argv[2]
    headers = headers_of(build)
    deps = os.path.join(os.path.dirname(build), "deps")
    unpacked = (
        sorted(os.listdir(os.path.join(deps, "usr/share/doc")))
        if any(path.startswith(deps + "/") for path in headers)
        else []
    )
    packages = sorted(
        packages_of(
            {path for path in headers if not path.startswith(deps)}
            | set().union(*(libraries_of(os.path.join(build, "bin", each)) for each in PROGRAMS))
        )
        | set(unpacked)
    )
    by_text, without = {}, []
    for package in packages:
        notice = notice_of(package, ["/", deps])
        if notice:
            by_text.setdefault(notice, []).append(package)
        else:
            without.append(package)
    if without:
        sys.exit("No notice was found of: " + ", ".join(without))
    with open(output, "w", encoding="utf-8") as file:
        file.write(HEAD)
        for notice, names in sorted(by_text.items(), key=lambda entry: entry[1]):
            file.write(
                "=" * 100 + "\n" + ", ".join(names) + "\n" + "=" * 100 + "\n\n" + notice + "\n\n"
            )
    print(f"{output}: the notices of {len(packages)} packages")


if __name__ == "__main__":
    main()
