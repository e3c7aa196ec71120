# SPDX-License-Identifier: Apache-2.0
"""The two ways in which a scenario lets time pass; whatever has an event of its own is waited for by that."""
import time

LOOK_INTERVAL_S = 0.02


def comes_true(is_so, seconds):
    """Looks again and again until `is_so()`. False: it was not within that time."""
    deadline = time.monotonic() + seconds
    while not (holds := is_so()) and time.monotonic() < deadline:
        time.sleep(LOOK_INTERVAL_S)
    return holds


def let_pass(seconds):
    """Time in which others are watched, or before the next attempt."""
    time.sleep(seconds)
