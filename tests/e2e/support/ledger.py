"""Records the changes that scripts request from a server, and its answers."""
import threading


class Change:
    """One message with a change, and the server's answers to it."""

    def __init__(self, annotator, kind, message, begin=None, by_http=False):
        self.user, self.kind, self.message, self.begin, self.by_http = (
            annotator.name,
            kind,
            message,
            begin,
            by_http,
        )
        self.id = message["id"]
        self.first_sent = self.applied_at = self.saved_at = None
        self.lines = []  # numbers of the connections on which it was sent, for each time
        self.answer = None  # (sequence, texels_changed, area_m2)
        self.promised = False  # a welcome reported that it was saved
        self.refused = None


class Ledger:
    """All changes and their answers. Any contradiction is a fault."""

    def __init__(self):
        self.lock = threading.RLock()
        self.changes = {}  # id -> change
        self.batches = {}  # (stroke, n) -> change
        self.claims = []  # (stroke, n): a welcome reported that all up to n is saved
        self.repeats = self.unsaved = self.put_off = 0
        self.dropped = []  # codes of connections that the server ended
        self.faults = []

    def add(self, change):
        with self.lock:
            self.changes[change.id] = change
            if change.begin:
                self.batches[change.message["stroke"], change.message["n"]] = change

    def named(self, message):
        return (
            self.batches.get((message["stroke"], message["n"]))
            if "stroke" in message
            else self.changes.get(message.get("id"))
        )

    def told(self, change, message, now, saved):
        """Returns True if the change became durable with this message."""
        answer = (message["sequence"], message["texels_changed"], message["area_m2"])
        with self.lock:
            if change.answer is None:
                change.answer = answer
            elif change.answer != answer:
                self.faults.append(
                    f"{change.kind} {change.id} of {change.user} was answered {change.answer}, then {answer}"
                )
            if not saved:
                change.applied_at = change.applied_at or now
                return False
            if change.saved_at:
                self.repeats += 1
                return False
            change.saved_at = now
            return True

    def fault(self, text):
        with self.lock:
            self.faults.append(text)

    def saved(self):
        with self.lock:
            return [
                change for change in self.changes.values() if change.saved_at or change.promised
            ]
