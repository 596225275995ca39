"""Steps of one length: their order, their events, their energy, what they cost, and what they refuse.

docs/theory/fixed-steps.md
"""

from __future__ import annotations
