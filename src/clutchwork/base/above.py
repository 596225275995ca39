"""What a thing is asked for and a room above the one that declares it works out.

Imports point down only. So the room names who does it, as `base/rich.py` names who draws; that is imported when asked.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# what is asked for -> the function that works it out, as module:function below clutchwork
DONE_BY = {
    "run.gradient": "gradients.run:gradient_of",
    "box.page": "page.gearbox:page_of_gearbox",
    "run.page": "page.page:page_of",
    "run.widget": "page.widget:widget_of",
    "calibration.plot": "calibration.picture:before_and_after",
    "calibration.front": "calibration.front:front",
    "calibration.verify": "calibration.verify:verify",
}


def above(asked: str, *given: Any) -> Any:
    """Call who works it out."""
    module, _, name = DONE_BY[asked].partition(":")
    return getattr(import_module(f"clutchwork.{module}"), name)(*given)
