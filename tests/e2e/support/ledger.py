"""Records the changes that scripts request from a server, and its responses."""
import threading


class Change:
    """A message with a change, and the server's responses to it."""

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
        self.lines = []  # the number of the connection for each time the message was sent
        self.answer = None  # (sequence, texels_changed, area_m2)
        self.promised = False  # whether a welcome message reported the change as saved
        self.refused = None


class Ledger:
    """All changes and their responses. Every contradiction is a fault."""

    def __init__(self):
        self.lock = threading.RLock()
        self.changes = {}  # change id -> change
        self.batches = {}  # (stroke, n) -> change
        # (stroke, n): a welcome message reported that all batches up to n are saved
        self.claims = []
        self.repeats = self.unsaved = self.put_off = 0
        self.dropped = []  # codes of connections that the server closed
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
