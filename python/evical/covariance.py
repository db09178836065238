"""The covariance of a result, with names for its rows."""

from __future__ import annotations

from typing import List, Sequence, Union

import numpy as np
import numpy.typing as npt

from .errors import InputError

__all__ = ["Covariance"]


class Covariance:
    """Joint covariance of all estimated quantities.

    Attributes:
        names: N names of rows with their units: "left.rotation.x [rad]", "left.time_offset [s]", ...
        matrix: (N, N), in products of these units; read-only, like the other arrays of a result.
    """

    def __init__(self, names: Sequence[str], matrix: npt.NDArray[np.float64]) -> None:
        self.names: List[str] = list(names)
        self.matrix = matrix
        self._index = {}
        for i, name in enumerate(self.names):
            self._index[name] = i
            self._index[name.split(" [")[0]] = i

    def index(self, name: str) -> int:
        """The row of a name; the unit may be omitted. Raises InputError that lists similar names."""
        if name not in self._index:
            alike = [each for each in self.names if name.split(".")[0] == each.split(".")[0]] or self.names
            raise InputError(f"covariance: '{name}' was not estimated. Use one of: {', '.join(alike)}",
                             "covariance", f"'{name}' was not estimated", f"Use one of: {', '.join(alike)}")
        return self._index[name]

    @property
    def std(self) -> npt.NDArray[np.float64]:
        """(N,): sigmas."""
        std: npt.NDArray[np.float64] = np.sqrt(np.diagonal(self.matrix))
        std.setflags(write=False)
        return std

    @property
    def correlation(self) -> npt.NDArray[np.float64]:
        """(N, N), -1 to 1; 0 for fixed quantities."""
        std = self.std
        scale = np.outer(std, std)
        correlation: npt.NDArray[np.float64] = np.zeros_like(self.matrix)
        np.divide(self.matrix, scale, out=correlation, where=scale > 0)
        correlation.setflags(write=False)
        return correlation

    def of(self, names: Sequence[str]) -> npt.NDArray[np.float64]:
        """(n, n): the rows and columns of these names, in their order."""
        rows = [self.index(name) for name in names]
        return self.matrix[np.ix_(rows, rows)]

    def __getitem__(self, name: Union[str, "tuple[str, str]"]) -> float:
        """covariance[a]: the variance of a; covariance[a, b]: the covariance of a and b."""
        first, second = name if isinstance(name, tuple) else (name, name)
        return float(self.matrix[self.index(first), self.index(second)])

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"<evical.Covariance of {len(self)} numbers>"
