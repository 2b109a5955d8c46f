#!/usr/bin/env python3
"""The drawing of the modules shows the links of CMake, and no headers include each other in a
cycle."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
OVERVIEW = ROOT / "docs/developer/architecture/overview.md"

Graph = dict[str, set[str]]


def linked() -> Graph:
    """Returns the modules with the links in their CMakeLists.txt."""
    links: Graph = {"protocol": {"domain", "core"}}
    for file in sorted((ROOT / "server").glob("*/CMakeLists.txt")):
        call = re.search(
            r"strata_module\((\w+)\s+SOURCES(.*?)\n?\s*\)", file.read_text(), re.DOTALL
        )
        if call:
            links[call.group(1)] = set(re.findall(r"\bstrata_(\w+)\b", call.group(2)))
    return {module: {to for to in links[module] if to in links} for module in links}


def reached(graph: Graph, start: str) -> set[str]:
    """Returns all that is linked from `start`, directly or indirectly."""
    found: set[str] = set()
    waiting = list(graph[start])
    while waiting:
        module = waiting.pop()
        if module not in found:
            found.add(module)
            waiting.extend(graph[module])
    return found


def reduced(graph: Graph) -> set[tuple[str, str]]:
    """Returns the links that do not follow from others."""
    return {
        (module, to)
        for module, links in graph.items()
        for to in links
        if not any(to in reached(graph, other) for other in links if other != to)
    }


def drawn() -> set[tuple[str, str]]:
    drawing = re.search(r"```mermaid\n(.*?)```", OVERVIEW.read_text(encoding="utf-8"), re.DOTALL)
    return set(re.findall(r"(\w+) --> (\w+)", drawing.group(1))) if drawing else set()


def circle(graph: Graph) -> list[str]:
    """Returns a cycle of the graph, or an empty list if the graph has no cycle."""
    done: set[str] = set()

    def walk(node: str, path: list[str]) -> list[str]:
        if node in path:
            return path[path.index(node) :] + [node]
        if node in done:
            return []
        for to in sorted(graph.get(node, set())):
            if found := walk(to, path + [node]):
                return found
        done.add(node)
        return []

    for node in sorted(graph):
        if found := walk(node, []):
            return found
    return []


def headers() -> Graph:
    server = ROOT / "server"
    return {
        str(file.relative_to(server)): set(
            re.findall(r'^#include "([^"]+)"', file.read_text(encoding="utf-8"), re.MULTILINE)
        )
        for file in server.rglob("*.h")
    }


def main() -> int:
    # Test the functions above: `circle` finds a cycle, and `reduced` omits a link that follows from
    # others.
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"a"}}) == ["a", "b", "c", "a"]
    assert reduced({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == {("a", "b"), ("b", "c")}

    faults = []
    links = linked()
    assert len(links) > 10, "The link lines were not found."
    if found := circle(links) or circle(headers()):
        faults.append("A circle: " + " → ".join(found))
    else:
        expected, shown = reduced(links), drawn()
        faults += [f"{OVERVIEW.name} lacks {a} --> {b}" for a, b in sorted(expected - shown)]
        faults += [f"{OVERVIEW.name} draws {a} --> {b}" for a, b in sorted(shown - expected)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
