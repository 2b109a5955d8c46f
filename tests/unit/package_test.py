#!/usr/bin/env python3
"""The Debian package has all files that the server needs at run time, lists its dependencies, and
its scripts, settings, manual page and completion match the program. Arguments: the build folder,
the program. Exits with 77 if packages cannot be made here or the page is not built."""
import io
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHARE = "./usr/share/strata/"


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, **options).stdout


def read(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


def files_below(*path):
    """Returns the relative paths of the files in a folder of the project."""
    top = os.path.join(ROOT, *path)
    return [
        os.path.relpath(os.path.join(folder, name), ROOT)
        for folder, _, names in os.walk(top)
        for name in names
    ]


def check_control(package):
    fields = run("dpkg-deb", "--field", package, text=True)
    control = dict(re.findall(r"^([A-Z][\w-]*): (.*)$", fields, re.M))
    version = re.search(r"^project\(strata VERSION ([0-9.]+) ", read("CMakeLists.txt"), re.M)
    assert control["Package"] == "strata", control
    assert control["Version"] == version.group(1) + "-1", control
    assert control["Architecture"] == run("dpkg", "--print-architecture", text=True).strip()
    needed = {part.strip().split(" ")[0] for part in control["Depends"].split(",")}
    programs = re.search(r"^run_packages=\((.*)\)$", read("scripts", "setup.sh"), re.M)
    for name in [*programs.group(1).split(), "adduser", "libc6", "libpq5"]:
        assert name in needed or name == "curl", f"{name} is not named: {needed}"


def check_files(members):
    wanted = [SHARE + path for path in files_below("shaders") + files_below("templates")]
    wanted += [SHARE + path for path in files_below("db", "migrations")]
    wanted += [SHARE + path for path in files_below("web-client", "dist")]
    wanted += [
        SHARE + "protocol/generated/openapi.json",
        SHARE + "THIRD_PARTY_NOTICES.txt",
        "./usr/bin/strata",
        "./lib/systemd/system/strata.service",
        "./etc/default/strata",
        "./usr/share/man/man1/strata.1.gz",
        "./usr/share/bash-completion/completions/strata",
        "./usr/share/doc/strata/copyright",
        "./usr/share/doc/strata/changelog.gz",
        "./usr/share/doc/strata/changelog.Debian.gz",
    ]
    missing = [path for path in wanted if path not in members]
    assert not missing, missing
    for path, member in members.items():
        assert (member.uid, member.gid) == (0, 0), f"{path} is not root's"
        assert not member.mode & 0o022, f"{path} can be written by others: {member.mode:o}"
        assert member.mode & 0o444 == 0o444, f"{path} cannot be read: {member.mode:o}"
    assert members["./usr/bin/strata"].mode & 0o111 == 0o111
    beside = [
        path
        for path in members
        if not re.match(r"\./(usr(/|$)|lib(/systemd|$)|etc(/default|$)|$)", path)
    ]
    assert beside in ([], ["."]), beside


def check_scripts(package, folder):
    run("dpkg-deb", "--control", package, folder)
    for name in ("postinst", "prerm", "postrm"):
        path = os.path.join(folder, name)
        assert os.access(path, os.X_OK), name
        run("sh", "-n", path)
    with open(os.path.join(folder, "conffiles"), encoding="utf-8") as file:
        assert file.read() == "/etc/default/strata\n"


def check_texts(archive, program):
    def text(path):
        return archive.extractfile(archive.getmember(path)).read().decode()

    def commands_of(*path):
        listed = run(program, *path, "--help", text=True).partition("Subcommands:")[2]
        return set(re.findall(r"^  ([a-z]\S*)", listed, re.M))

    copyright_of = text("./usr/share/doc/strata/copyright")
    for words in ("Permission is hereby granted", "SIL OPEN FONT LICENSE", "The Inter Project"):
        assert words in copyright_of, f"{words} is not in the copyright file"

    service, settings = text("./lib/systemd/system/strata.service"), text("./etc/default/strata")
    assert "ExecStart=/usr/bin/strata serve\n" in service
    assert "User=strata\n" in service and "EnvironmentFile=-/etc/default/strata\n" in service
    manual = read("packaging", "debian", "strata.1.in").replace("\\-", "-")
    for command in commands_of():
        assert f".B {command}\n" in manual, f"the manual page does not name {command}"
    known = set()
    for name in os.listdir(os.path.join(ROOT, "server", "cli")):
        known |= set(re.findall(r'envname\("(\w+)"\)', read("server", "cli", name)))
    assert "STRATA_LISTEN" in known, known
    for variable in known:
        assert variable in manual, f"the manual page does not name {variable}"
    strange = set(re.findall(r"^#?(STRATA_\w+)=", settings, re.M)) - known
    assert not strange, f"/etc/default/strata names what the server does not know: {strange}"

    completion = os.path.join(ROOT, "packaging", "debian", "strata.bash")

    def completed(*words):
        line = " ".join(f"'{word}'" for word in words)
        script = f'. "{completion}"; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _strata; printf "%s\\n" "${{COMPREPLY[@]}}"'
        environment = {**os.environ, "PATH": os.path.dirname(program) + ":" + os.environ["PATH"]}
        return set(run("bash", "-c", script, text=True, env=environment).split())

    assert completed("strata", "") == commands_of(), completed("strata", "")
    assert completed("strata", "user", "") == commands_of("user")
    assert {"--listen", "--data"} <= completed("strata", "serve", "--")


def main():
    build, program = (os.path.realpath(path) for path in sys.argv[1:])
    if not shutil.which("dpkg-shlibdeps") or not shutil.which("cpack"):
        print("no package can be made here: dpkg-dev or cpack is missing")
        return 77
    if not os.path.exists(os.path.join(ROOT, "web-client", "dist", "index.html")):
        print("the page is not built")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        run("cpack", "--config", os.path.join(build, "CPackConfig.cmake"), "-B", folder, cwd=build)
        (package,) = [name for name in os.listdir(folder) if name.endswith(".deb")]
        package = os.path.join(folder, package)
        check_control(package)
        with tarfile.open(
            fileobj=io.BytesIO(run("dpkg-deb", "--fsys-tarfile", package))
        ) as archive:
            members = {member.name.rstrip("/"): member for member in archive.getmembers()}
            check_files(members)
            check_texts(archive, program)
        check_scripts(package, os.path.join(folder, "control"))
    print("the package is whole")
    return 0


if __name__ == "__main__":
    sys.exit(main())
