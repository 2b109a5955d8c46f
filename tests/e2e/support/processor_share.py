"""Limits a process to a share of the processors, with a control group of Linux (cpu.max, or
cpu.cfs_quota_us in version 1). Needs the right to make control groups, which root has."""
import os
import uuid

from support.missing import missing

PERIOD_US = 10_000  # short, so a process that has used its share soon continues
GROUPS = "/sys/fs/cgroup"


def _write(folder, name, value):
    with open(os.path.join(folder, name), "w", encoding="ascii") as file:
        file.write(str(value))


class ProcessorShare:
    """The threads of a process together use at most `cores` processors, in a `with` block."""

    def __init__(self, pid, cores):
        self.pid, self.quota_us = pid, int(cores * PERIOD_US)
        version_1 = os.path.join(GROUPS, "cpu")
        self.root = version_1 if os.path.isdir(version_1) else GROUPS
        self.folder = os.path.join(self.root, f"strata-{uuid.uuid4()}")

    def __enter__(self):
        try:
            os.mkdir(self.folder)
            if self.root == GROUPS:
                _write(self.folder, "cpu.max", f"{self.quota_us} {PERIOD_US}")
            else:
                _write(self.folder, "cpu.cfs_period_us", PERIOD_US)
                _write(self.folder, "cpu.cfs_quota_us", self.quota_us)
            _write(self.folder, "cgroup.procs", self.pid)
        except OSError as error:
            missing(f"no right to limit the processors of a process: {error}")
        return self

    def __exit__(self, *_):
        """Ends the limit. The group of a process that has ended has no process left."""
        try:
            _write(self.root, "cgroup.procs", self.pid)
        except ProcessLookupError:
            pass
        os.rmdir(self.folder)
