# SPDX-License-Identifier: Apache-2.0
"""Fills the table: the order here is that of the page."""

import solids  # noqa: F401  isort: skip
import water  # noqa: F401  isort: skip
import ground  # noqa: F401  isort: skip
import reference  # noqa: F401  isort: skip
import experiments  # noqa: F401  isort: skip
import fish  # noqa: F401  isort: skip
import programs  # noqa: F401  isort: skip
