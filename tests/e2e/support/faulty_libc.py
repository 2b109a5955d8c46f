"""Faults of the machine in one process: jumps of its wall clock, a slow or full disk, a lost GL
context (faulty_libc.c), and no more memory."""
import mmap
import os
import pathlib
import resource
import struct
import subprocess
import tempfile

from support.missing import missing

SOURCE = pathlib.Path(__file__).with_suffix(".c")
LAYOUT = struct.Struct("<qqqq992s")  # of `struct Faults`
CLOCK_NS, WRITE_DELAY_US, DISK_FULL, GL_LOSSES = range(4)  # their positions
FURTHER_MB = 16


def build(folder):
    """Compiles the library into the folder. Returns its path."""
    library = os.path.join(folder, "faulty_libc.so")
    command = ["cc", "-O2", "-std=gnu11", "-shared", "-fPIC", "-o", library, str(SOURCE), "-ldl"]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True)
    except FileNotFoundError:
        missing("no C compiler is installed")
    os.chmod(library, 0o755)
    return library


class FaultyProcess:
    """The faults of one process and its children. They start with `environment`. The process can
    run as another user, so the file is readable for all users."""

    def __init__(self, library, folder, disk):
        """`folder` contains the file of the faults. `disk`: the folder whose disk can be slow or
        full."""
        self.library, self.disk = library, disk
        handle, self.path = tempfile.mkstemp(prefix="faults-", dir=folder)
        os.write(handle, LAYOUT.pack(0, 0, 0, 0, os.path.realpath(disk).encode()))
        os.fchmod(handle, 0o644)
        self.values = mmap.mmap(handle, LAYOUT.size)
        os.close(handle)

    @property
    def environment(self):
        return {"LD_PRELOAD": self.library, "STRATA_TEST_FAULTS": self.path}

    def _set(self, field, value):
        self.values[8 * field : 8 * (field + 1)] = struct.pack("<q", value)

    def jump_clock(self, seconds):
        """Sets the distance of the wall clock from the true time."""
        self._set(CLOCK_NS, int(seconds * 1e9))

    def slow_disk(self, delay_s):
        """Makes each write and sync in the folder take longer."""
        self._set(WRITE_DELAY_US, int(delay_s * 1e6))

    def fill_disk(self, folder=None):
        """No file in the folder can grow."""
        at = os.path.realpath(folder or self.disk).encode()
        self.values[32:] = at.ljust(LAYOUT.size - 32, b"\0")
        self._set(DISK_FULL, 1)

    def empty_disk(self):
        self._set(DISK_FULL, 0)

    def lose_gl(self):
        (losses,) = struct.unpack("<q", self.values[8 * GL_LOSSES : 8 * (GL_LOSSES + 1)])
        self._set(GL_LOSSES, losses + 1)


def limit_memory(pid, further_mb=FURTHER_MB):
    """The process gets at most this much more memory from the kernel."""
    with open(f"/proc/{pid}/statm", encoding="ascii") as file:
        now = int(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    most = now + (further_mb << 20)
    resource.prlimit(pid, resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))


def unlimit_memory(pid):
    resource.prlimit(pid, resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
