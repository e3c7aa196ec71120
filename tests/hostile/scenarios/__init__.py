# SPDX-License-Identifier: Apache-2.0
"""All scenarios, in the order of docs/security.md."""
from scenarios import connections, held

ALL = [*connections.SCENARIOS, *held.SCENARIOS]
