"""What was tried against a server and how it answered, as a table: printed, and kept in docs/reference/security.md between two marks.

An answer is what must be the same on every machine; what is measured beside it (seconds, megabytes, how many calls there are) is told, and not compared."""
import os
import threading

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
PAGE = os.path.join(ROOT, "docs", "reference", "security.md")
BEGIN, END = (
    "<!-- attempts: written by tests/e2e/faults/security_attempts_test.py --update-docs -->",
    "<!-- end of attempts -->",
)
HEAD = "| attempt | answer | measured | what keeps it |\n|---|---|---|---|\n"


def told(answer):
    """401, or 401, 429 of several: each once."""
    if isinstance(answer, (set, list, tuple)):
        return ", ".join(str(each) for each in sorted(set(answer)))
    return str(answer)


class Section:
    def __init__(self, title):
        self.title, self.rows = title, []

    def tried(self, attempt, answer, expected, keeps, measured=""):
        """Fails where the answer is another one than expected."""
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
    """Sections may be filled by threads of their own; they stand in the order in which they were asked for."""

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
        """The page tells what was answered."""
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
    """Lines without the third column of tables."""
    lines = [line.replace("\\|", "\0").split(" | ") for line in markdown.strip().split("\n")]
    return [" | ".join(cells[:2] + cells[3:]) for cells in lines if cells != [""]]
