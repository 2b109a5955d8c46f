"""Merges of strokes in the journal (docs/developer/architecture/storage.md)."""

# A server waits a minute between this mark and its first merge, for nodes that start at the same
# time. Tests make the mark themselves, before the server starts to merge.
MARKED_LONG_AGO = (
    "UPDATE schema_migrations SET readable_from = NULL, "
    "unreadable_since = clock_timestamp() - interval '1 hour' WHERE version = '000047'"
)
