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
        if service == "strata" or said.get("image", "").startswith("strata:"):
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
            is_postgres = said["image"].startswith("strata-postgres:")
            assert os.path.samefile(
                os.path.join(context, said["build"]["dockerfile"]),
                os.path.join(DOCKER, "cluster" if is_postgres else "", "Dockerfile"),
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


def check_cluster():
    """compose.cluster.yaml starts the same cluster as examples/cluster."""
    services = yaml.safe_load(read("docker", "compose.cluster.yaml"))["services"]
    members = {name: said for name, said in services.items() if name.startswith("postgres-")}
    nodes = {name: said for name, said in services.items() if name.startswith("node-")}
    assert len(members) == len(nodes) == 3
    for name, said in members.items():
        given = said["environment"]
        assert name == given["PATRONI_NAME"] == said["hostname"], name
        assert given["PATRONI_RESTAPI_CONNECT_ADDRESS"] == f"{name}:8008", name
        assert given["PATRONI_POSTGRESQL_CONNECT_ADDRESS"] == f"{name}:5432", name
        assert f"{name}:/data" in said["volumes"], name
    ports = [port.split(":")[1] for said in members.values() for port in said["ports"]]
    site = read("examples", "nodes", "nginx.conf")
    for name, said in nodes.items():
        given = said["environment"]
        assert f"port={','.join(ports)} target_session_attrs=read-write" in given["STRATA_DATABASE"]
        letter, listen = name[-1], given["STRATA_LISTEN"]
        assert given["STRATA_NODE_URL"].endswith(f"/node/{letter}"), name
        assert f"location /node/{letter}/ {{ proxy_pass http://{listen}/; }}" in site, name
        assert f"{name}:/data" in said["volumes"], name

    patroni = yaml.safe_load(read("docker", "cluster", "patroni.yaml"))
    sys.path.insert(0, os.path.join(ROOT, "examples", "cluster"))
    from cluster import DCS, INITDB  # pylint: disable=import-outside-toplevel

    dcs = patroni["bootstrap"]["dcs"]
    assert patroni["bootstrap"]["initdb"] == INITDB
    for name, value in DCS.items():
        if name != "postgresql":
            assert dcs[name] == value, name
    assert dcs["postgresql"]["parameters"].items() >= DCS["postgresql"]["parameters"].items()


def check_copies(dockerfile, kept):
    for line in re.findall(r"^COPY (?!--from)(.*)$", dockerfile, re.M):
        for source in line.split()[:-1]:
            assert os.path.exists(os.path.join(ROOT, source)), f"COPY {source}: not there"
            assert any(
                source == path or source.startswith(path + "/") or path.startswith(source + "/")
                for path in kept
            ), f".dockerignore leaves {source} out"


def check_image():
    dockerfile, ignored = read("docker", "Dockerfile"), read(".dockerignore")
    kept = re.findall(r"^!(.*)$", ignored, re.M)
    assert ignored.splitlines()[1] == "*", "what is sent to the builder is named one by one"
    check_copies(dockerfile, kept)
    check_copies(read("docker", "cluster", "Dockerfile"), kept)
    for path in kept:
        assert os.path.exists(os.path.join(ROOT, path)), f".dockerignore: {path} is not there"

    user = re.search(r"--uid (\d+)", dockerfile).group(1)
    for told in (
        read("docker", "README.md"),
        read("docker", "env.example"),
        read("docker", "compose.https.yaml"),
    ):
        assert user in told, f"the image's user is {user}"
    for script in (
        *("check", "bin/strata-health", "bin/packages_of", "postgres/make_database.sh"),
        *("cluster/member", "cluster/make_site"),
    ):
        assert os.access(os.path.join(DOCKER, script), os.X_OK), f"docker/{script} cannot be run"


def main():
    check_compose()
    check_cluster()
    check_image()
    print("the files of docker/ agree")


if __name__ == "__main__":
    sys.exit(main())
