# SPDX-License-Identifier: Apache-2.0
"""All scenarios, in the order of docs/security.md."""
from scenarios import connections, held, metrics

PARTS = [connections, metrics, held]
ALL = [scenario for part in PARTS for scenario in part.SCENARIOS]
