"""Memory of a running server, in MB."""


def _of(process, name):
    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(name)) / 1024


def resident_mb(server):
    return _of(server.process, "VmRSS")


class PeakGrowth:
    """How much more than at first was taken at any moment within: `mb`, known at the end."""

    def __init__(self, server):
        self.server, self.mb = server, 0.0

    def __enter__(self):
        with open(f"/proc/{self.server.process.pid}/clear_refs", "w", encoding="ascii") as file:
            file.write("5")  # the peak begins anew
        self.first = resident_mb(self.server)
        return self

    def __exit__(self, *failure):
        self.mb = _of(self.server.process, "VmHWM") - self.first
        self.after_mb = resident_mb(self.server) - self.first

    def checked(self, most_mb):
        """In words, once it was compared."""
        assert self.mb <= most_mb, f"{self.mb:.0f} MB more, {most_mb} may be"
        return f"server at most {_rounded(self.mb)} MB larger (held to {most_mb})"


def _rounded(mb):
    return max(0, round(mb / 10) * 10)
