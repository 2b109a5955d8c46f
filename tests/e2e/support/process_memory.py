"""The memory of a running server, in MB, and its activity."""
import os
import time


def _of(process, name):
    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(name)) / 1024


def resident_mb(server):
    return _of(server.process, "VmRSS")


def _processor_s(server):
    with open(f"/proc/{server.process.pid}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def rests(server, over_s=1.0):
    """Returns whether the server uses less than a tenth of a processor over that time. It is then
    making no surface map."""
    first = _processor_s(server)
    time.sleep(over_s)
    return _processor_s(server) - first < over_s / 10


class PeakGrowth:
    """Measures the largest growth of the memory since the start. `mb` is set at the end of the
    `with` block."""

    def __init__(self, server):
        self.server, self.mb = server, 0.0

    def __enter__(self):
        with open(f"/proc/{self.server.process.pid}/clear_refs", "w", encoding="ascii") as file:
            file.write("5")  # resets the measurement of the peak
        self.first = resident_mb(self.server)
        return self

    def __exit__(self, *failure):
        self.mb = _of(self.server.process, "VmHWM") - self.first
        self.after_mb = resident_mb(self.server) - self.first

    def checked(self, most_mb):
        """Checks the limit, and returns the comparison as a text."""
        assert self.mb <= most_mb, f"{self.mb:.0f} MB more, {most_mb} may be"
        return f"server at most {_rounded(self.mb)} MB larger (limit {most_mb})"


def _rounded(mb):
    return max(0, round(mb / 10) * 10)
