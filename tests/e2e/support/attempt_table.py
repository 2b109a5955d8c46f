"""The attempts on a server and its responses as a table, which is printed and kept in
docs/reference/security.md between two marks.

A response must be the same on every machine. Measured values (seconds, megabytes, numbers of calls)
are listed but not compared."""
import os
import threading

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
PAGE = os.path.join(ROOT, "docs", "reference", "security.md")
BEGIN, END = (
    "<!-- attempts: written by tests/e2e/faults/security_attempts_test.py --update-docs -->",
    "<!-- end of attempts -->",
)
HEAD = "| attempt | answer | measured | protection |\n|---|---|---|---|\n"


def told(answer):
    """Returns a text such as "401", or "401, 429" for several statuses."""
    if isinstance(answer, (set, list, tuple)):
        return ", ".join(str(each) for each in sorted(set(answer)))
    return str(answer)


class Section:
    def __init__(self, title):
        self.title, self.rows = title, []

    def tried(self, attempt, answer, expected, keeps, measured=""):
        """Adds a row. Fails if the result differs from the expected one."""
        assert told(answer) == told(
            expected
        ), f"{self.title}: {attempt}: {told(answer)}, not {told(expected)} {measured}"
        self.rows.append((attempt, told(answer), measured, keeps))

    def markdown(self):
        return (
            f"### {self.title}\n\n"
            + HEAD
            + "".join(
                "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n"
                for row in self.rows
            )
        )


class AttemptTable:
    """Different threads may fill the sections, which keep the order in which they were
    requested."""

    def __init__(self):
        self.sections, self.lock = [], threading.Lock()

    def section(self, title):
        with self.lock:
            self.sections.append(Section(title))
            return self.sections[-1]

    def markdown(self):
        return "\n".join(section.markdown() for section in self.sections)

    def write(self):
        page = self._page()
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(page[0] + "\n" + self.markdown() + page[2])

    def check_page(self):
        """Checks that the page contains these results."""
        kept, now = _compared(self._page()[1]), _compared(self.markdown())
        differing = [f"- {row}" for row in kept if row not in now] + [
            f"+ {row}" for row in now if row not in kept
        ]
        assert kept == now, (
            "docs/reference/security.md tells something else; write it anew with --update-docs:\n"
            + "\n".join(differing or ["the order"])
        )

    @staticmethod
    def _page():
        with open(PAGE, encoding="utf-8") as file:
            before, begin, rest = file.read().partition(BEGIN)
        table, end, after = rest.partition(END)
        assert begin and end, f"{PAGE} has no place for the table"
        return before + begin + "\n", table, end + after


def _compared(markdown):
    """Returns the lines without the third column of tables."""
    lines = [line.replace("\\|", "\0").split(" | ") for line in markdown.strip().split("\n")]
    return [" | ".join(cells[:2] + cells[3:]) for cells in lines if cells != [""]]
