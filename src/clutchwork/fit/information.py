"""What samples can tell apart: the derivatives of the residuals, taken apart."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array

# effect on the torque below which a parameter counts as without any, relative to the torque: of a formula, of a run
NO_EFFECT = {True: 1e-9, False: 1e-6}
# smallest singular value, relative to the largest, of directions that the samples tell apart
NO_RANK = {True: 1e-7, False: 1e-5}
FLOOR = 1e-12  # of singular values, which are 1 for one parameter alone


@dataclass(frozen=True)
class Information:
    """Singular values and directions of derivatives whose columns are scaled to size 1."""

    size: Array  # of the columns before [N m]
    singular: Array
    directions: Array  # rows
    silent: NDArray[np.bool_]  # columns without effect
    lost: NDArray[np.bool_]  # directions that the samples cannot tell

    def covariance(self, changes: Array) -> Array:
        """Covariance per variance of the samples of what changes with the codes by these derivatives, one row each.

        What is lost counts as hardly known. It is a product of roots, so that two large numbers are never subtracted.
        """
        root = (changes / self.size) @ self.directions.T / np.maximum(self.singular, FLOOR)
        return np.asarray(root @ root.T)


def information(jacobian: Array, size: float, exact: bool) -> Information:
    """Take derivatives apart.

    Parameters: jacobian, of the residuals [N m] by the codes; size of the torque [N m]; exact, whether the derivatives
    are those of a formula, not of a run with an error of its own.
    """
    columns = np.sqrt(np.mean(jacobian**2, axis=0))
    silent = columns <= NO_EFFECT[exact] * size
    norm = np.where(silent, 1.0, columns) * sqrt(len(jacobian))
    live = np.flatnonzero(~silent)
    # rows of zeros say nothing and give every column a direction
    scaled = np.vstack([jacobian / norm, np.zeros((max(len(norm) - len(jacobian), 0), len(norm)))])
    _, found, rows = np.linalg.svd(scaled[:, live], full_matrices=False)
    # silent columns are directions of their own
    singular, directions = np.zeros(len(norm)), np.zeros((len(norm), len(norm)))
    singular[: len(found)] = found
    directions[: len(live), live] = rows
    directions[range(len(live), len(norm)), np.flatnonzero(silent)] = 1.0
    lost = singular <= NO_RANK[exact] * float(np.max(singular, initial=0.0))
    return Information(norm, singular, directions, silent, lost)
