# SPDX-License-Identifier: Apache-2.0
"""All scenarios, in the order of docs/security.md."""
from scenarios import access, configure, connections, held, metrics, programs, shares

PARTS = [connections, configure, shares, programs, access, metrics, held]
ALL = [scenario for part in PARTS for scenario in part.SCENARIOS]
