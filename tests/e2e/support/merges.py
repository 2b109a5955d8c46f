"""Merges of strokes in the journal (docs/developer/architecture/storage.md)."""

# A server waits a minute between this mark and its first merge, for nodes that start at the same
# time. Tests make the mark themselves, before the server starts to merge.
_MARK = (
    "UPDATE schema_migrations SET readable_from = NULL, "
    "unreadable_since = clock_timestamp() - interval '1 hour' WHERE version = "
)
MARKED_LONG_AGO = _MARK + "'000047'"
# The same before `strata journal thin`.
THINNING_MARKED_LONG_AGO = _MARK + "'000050'"
