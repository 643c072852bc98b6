import numpy as np
from numpy.typing import ArrayLike, NDArray

def rolling_contact(
    ratio: float, ux: ArrayLike, uy: ArrayLike, phi: ArrayLike, *, nu: float = 0.28, elements: int = 40
) -> NDArray[np.float64]: ...
