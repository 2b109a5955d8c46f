"""Facts about the machine for a measurement, and processor seconds from /proc."""
import collections
import os
import subprocess
import time

_TICKS = os.sysconf("SC_CLK_TCK")


def machine():
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
        cpu = next(
            (line.split(":", 1)[1].strip() for line in file if line.startswith("model name")),
            "unknown",
        )
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    return {"cpu": cpu, "cores": os.cpu_count(), "commit": commit}


def gl_renderer(binary):
    """Returns the name of the GL renderer that `strata doctor` prints."""
    said = subprocess.run([binary, "doctor"], capture_output=True, text=True, check=False).stdout
    return next(
        (
            line.split("Renderer:", 1)[1].strip()
            for line in said.splitlines()
            if "Renderer:" in line
        ),
        "unknown",
    )


def _stat(path):
    """Returns the name and the fields after it: state, parent, … (from the third field of
    proc(5))."""
    with open(path, encoding="utf-8", errors="replace") as file:
        head, _, rest = file.read().rpartition(")")
    return head.partition("(")[2], rest.split()


def processor_seconds(pid):
    """Returns the processor seconds of a process, including its ended threads."""
    _, fields = _stat(f"/proc/{pid}/stat")
    return (int(fields[11]) + int(fields[12])) / _TICKS


def thread_seconds(pid):
    """Returns the processor seconds of the current threads, by name."""
    found = collections.Counter()
    for thread in os.listdir(f"/proc/{pid}/task"):
        try:
            name, fields = _stat(f"/proc/{pid}/task/{thread}/stat")
        except (FileNotFoundError, ProcessLookupError):
            continue  # the thread has ended since the list was read
        found[name] += (int(fields[11]) + int(fields[12])) / _TICKS
    return found


def family_seconds(pid):
    """Returns the processor seconds of a process and of all processes that it started, including
    ended ones."""
    parents, seconds = {}, {}
    for each in filter(str.isdigit, os.listdir("/proc")):
        try:
            _, fields = _stat(f"/proc/{each}/stat")
        except (FileNotFoundError, ProcessLookupError):
            continue
        parents[int(each)] = int(fields[1])
        seconds[int(each)] = sum(map(int, fields[11:15])) / _TICKS
    of_family = lambda each: each == pid or (each in parents and of_family(parents[each]))
    return sum(used for each, used in seconds.items() if of_family(each))


def machine_seconds():
    """Returns the seconds of all processors, for any work."""
    with open("/proc/stat", encoding="ascii") as file:
        user, nice, system, _, _, irq, soft, *_ = map(int, file.readline().split()[1:])
    return (user + nice + system + irq + soft) / _TICKS


class Watch:
    """Measures processor seconds and the load over a period."""

    def __init__(self, server):
        self.pid, self.loads = server.process.pid, []
        self.postmaster = server.postmaster()
        self.began, self.at_start = time.monotonic(), self._now()

    def _now(self):
        return {
            "server": processor_seconds(self.pid),
            "postgresql": family_seconds(self.postmaster),
            "annotators": time.process_time(),
            "machine": machine_seconds(),
            "threads": thread_seconds(self.pid),
        }

    def sample(self):
        self.loads.append(os.getloadavg()[0])

    def end(self, people):
        """Returns the number of cores in use, and the cores that the server and its PostgreSQL use
        for each viewer."""
        used, seconds = self._now(), time.monotonic() - self.began
        spent = {
            name: used[name] - self.at_start[name]
            for name in ("server", "postgresql", "annotators", "machine")
        }
        spent["others_on_the_machine"] = max(
            0.0, spent["machine"] - spent["server"] - spent["postgresql"] - spent["annotators"]
        )
        threads = {
            name: round((now - self.at_start["threads"].get(name, 0)) / seconds / people, 4)
            for name, now in used["threads"].items()
        }
        self.loads.append(os.getloadavg()[0])
        loads = sorted(self.loads)
        return {
            "seconds": round(seconds, 1),
            "cores_used": {name: round(each / seconds, 3) for name, each in spent.items()},
            "cores_a_viewer": {
                "server": round(spent["server"] / seconds / people, 4),
                "postgresql": round(spent["postgresql"] / seconds / people, 4),
            },
            "cores_a_viewer_by_thread": dict(
                sorted(
                    ((n, t) for n, t in threads.items() if t >= 0.0005), key=lambda item: -item[1]
                )
            ),
            "load_average": {"min": loads[0], "median": loads[len(loads) // 2], "max": loads[-1]},
        }
