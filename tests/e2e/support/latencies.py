"""Times from sending a stroke's message to its visible effects, from the records of a `Ledger` and
of the annotators' connections."""
import bisect
import math


def percentile(values, share):
    """Returns a percentile by nearest rank."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def summary(seconds):
    """Returns percentiles by nearest rank, in milliseconds."""
    if not seconds:
        return {"count": 0}
    rank = lambda share: round(1000 * percentile(seconds, share), 1)
    return {
        "count": len(seconds),
        "ms_p50": rank(0.5),
        "ms_p95": rank(0.95),
        "ms_p99": rank(0.99),
        "ms_max": rank(1),
    }


def histogram(seconds, steps_a_doubling=4):
    """Counts seconds in steps that grow evenly. Returns the steps' upper ends in milliseconds, and
    their counts."""
    ends = [2 ** (step / steps_a_doubling) for step in range(15 * steps_a_doubling)]
    counts = [0] * len(ends)
    for each in seconds:
        counts[min(len(ends) - 1, bisect.bisect_left(ends, 1000 * each))] += 1
    first = next((i for i, count in enumerate(counts) if count), 0)
    last = max((i for i, count in enumerate(counts) if count), default=0)
    return [
        {"ms": round(end, 2), "count": count}
        for end, count in list(zip(ends, counts))[first : last + 1]
    ]


class Sight:
    """The frames of one annotator, by connection."""

    def __init__(self, annotator):
        self.turning = annotator.turning
        self.lines = [
            (
                line.frames[0][0],
                line.ended,
                [t for t, _ in line.frames],
                [s for _, s in line.frames],
            )
            for line in annotator.lines
            if line.frames
        ]
        self.starts = [line[0] for line in self.lines]

    def after(self, sent, sequence):
        """Returns the seconds from `sent` to the first whole frame that shows the edit. Returns
        None if there was no view at that time, or if the connection ended before the frame."""
        at = bisect.bisect_right(self.starts, sent) - 1
        if at < 0 or (self.lines[at][1] is not None and self.lines[at][1] < sent):
            return None
        _, _, times, sequences = self.lines[at]
        found = bisect.bisect_left(sequences, sequence)
        return times[found] - sent if found < len(times) else None


def latencies(ledger, annotators):
    """Measures batches of strokes that changed texels and were sent once, on a connection that was
    not cut off."""
    sights = {annotator.name: Sight(annotator) for annotator in annotators}
    found = {"applied": [], "saved": [], "still": [], "turning": [], "own": []}
    away = 0
    for change in ledger.changes.values():
        if (
            not change.begin
            or not change.answer
            or not change.saved_at
            or len(change.lines) != 1
            or change.answer[1] == 0
        ):
            continue
        if change.applied_at:
            found["applied"].append(change.applied_at - change.first_sent)
        found["saved"].append(change.saved_at - change.first_sent)
        for name, sight in sights.items():
            seconds = sight.after(change.first_sent, change.answer[0])
            if seconds is None:
                away += name != change.user
            else:
                found[
                    "own" if name == change.user else "turning" if sight.turning else "still"
                ].append(seconds)
    return found, away
