#!/usr/bin/env python3
"""The files in docker/ agree with one another and with the program. This test only reads the files.
docker/check builds and runs the image, which takes half an hour."""
import os
import re
import sys

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DOCKER = os.path.join(ROOT, "docker")


def read(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


def variables_of_the_program():
    names = set()
    for name in os.listdir(os.path.join(ROOT, "server", "cli")):
        names |= set(re.findall(r'(?:envname|getenv)\("(\w+)"\)', read("server", "cli", name)))
    assert "STRATA_LISTEN" in names, names
    return names


def check_services(name, services, base, known):
    for service, said in services.items():
        where = f"{name}: {service}"
        assert (
            service in base or "image" in said
        ), f"{where} is neither in compose.yaml nor has an image"
        if service == "strata":
            strange = {
                key for key in said.get("environment", {}) if key.startswith("STRATA_")
            } - known
            assert not strange, f"{where} sets what the server does not know: {strange}"
        for volume in said.get("volumes", []):
            source = re.sub(r"\$\{\w+:-([^}]*)\}", r"\1", volume).split(":")[0]
            if source.startswith("."):
                assert os.path.exists(
                    os.path.join(DOCKER, source)
                ), f"{where} mounts {source}, which is not there"
        if "build" in said:
            context = os.path.join(DOCKER, said["build"]["context"])
            assert os.path.samefile(
                os.path.join(context, said["build"]["dockerfile"]),
                os.path.join(DOCKER, "Dockerfile"),
            ), where


def check_compose():
    known = variables_of_the_program()
    texts = {
        name: read("docker", name)
        for name in sorted(os.listdir(DOCKER))
        if re.fullmatch(r"compose\..*yaml", name)
    }
    files = {name: yaml.safe_load(text) for name, text in texts.items()}
    base = files["compose.yaml"]
    assert set(base["services"]) == {"strata", "database"}
    for name, file in files.items():
        check_services(name, file["services"], base["services"], known)

    # Every setting must be explained, and every explained setting must be used.
    explained = read("docker", "env.example")
    settings = set(re.findall(r"^#?([A-Z_]+)=", explained, re.M))
    used = set(re.findall(r"\$\{(\w+)", "".join(texts.values())))
    assert used == settings - {"COMPOSE_FILE"}, used ^ settings
    assert set(re.findall(r"^([A-Z_]+)=", explained, re.M)) == set(
        re.findall(r"\$\{(\w+):\?", texts["compose.yaml"])
    )
    for name in re.search(r"COMPOSE_FILE=(.*)", explained).group(1).split(":"):
        assert name in files, name

    # The programs of Strata's image make the backups, so the database must have their major
    # version.
    major = re.search(r"postgresql-(\d+)", read("scripts", "setup.sh")).group(1)
    assert base["services"]["database"]["image"].startswith(f"postgres:{major}-"), major


def check_image():
    dockerfile, ignored = read("docker", "Dockerfile"), read(".dockerignore")
    kept = re.findall(r"^!(.*)$", ignored, re.M)
    assert ignored.splitlines()[1] == "*", "what is sent to the builder is named one by one"
    for line in re.findall(r"^COPY (?!--from)(.*)$", dockerfile, re.M):
        for source in line.split()[:-1]:
            assert os.path.exists(os.path.join(ROOT, source)), f"COPY {source}: not there"
            assert any(
                source == path or source.startswith(path + "/") or path.startswith(source + "/")
                for path in kept
            ), f".dockerignore leaves {source} out"
    for path in kept:
        assert os.path.exists(os.path.join(ROOT, path)), f".dockerignore: {path} is not there"

    user = re.search(r"--uid (\d+)", dockerfile).group(1)
    for told in (
        read("docker", "README.md"),
        read("docker", "env.example"),
        read("docker", "compose.https.yaml"),
    ):
        assert user in told, f"the image's user is {user}"
    for script in ("check", "bin/strata-health", "bin/packages_of", "postgres/make_database.sh"):
        assert os.access(os.path.join(DOCKER, script), os.X_OK), f"docker/{script} cannot be run"


def main():
    check_compose()
    check_image()
    print("the files of docker/ agree")


if __name__ == "__main__":
    sys.exit(main())
