"""Memory of a running server, in MB."""


def _of(process, name):
    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(name)) / 1024


class PeakGrowth:
    """How much more than at first was taken at any moment within: `mb`, known at the end."""

    def __init__(self, server):
        self.process, self.mb = server.process, 0.0

    def __enter__(self):
        with open(f"/proc/{self.process.pid}/clear_refs", "w", encoding="ascii") as file:
            file.write("5")  # the peak begins anew
        self.first = _of(self.process, "VmRSS")
        return self

    def __exit__(self, *failure):
        self.mb = _of(self.process, "VmHWM") - self.first
        self.after_mb = _of(self.process, "VmRSS") - self.first

    def checked(self, most_mb):
        """In words, once it was compared."""
        assert self.mb <= most_mb, f"{self.mb:.0f} MB more, {most_mb} may be"
        return f"server at most {_rounded(self.mb)} MB larger (held to {most_mb})"


def _rounded(mb):
    return max(0, round(mb / 10) * 10)
