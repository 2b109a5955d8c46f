"""What a test needs and is not on this machine."""
import os

import pytest


def missing(what):
    """A failure in CI, and a skip by hand."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"missing: {what}")
    pytest.skip(what, allow_module_level=True)
