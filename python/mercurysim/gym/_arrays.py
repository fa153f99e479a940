# SPDX-License-Identifier: Apache-2.0
"""NumPy or torch, so that an environment is written once for both. Only names and arguments that both have are used."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np


class Arrays:
    """`xp` is the module numpy or torch. Arrays are made on the device of a batch ("cpu", "cuda:0")."""

    def __init__(self, torch: bool, device: str) -> None:
        self.is_torch = torch
        self.device = device
        self.xp: Any = np
        if torch:
            import torch as xp

            self.xp = xp

    def view(self, array: Any) -> Any:
        """The memory of an Array of a batch."""
        if not self.is_torch:
            return np.asarray(array)
        try:
            return self.xp.from_dlpack(array)
        except RuntimeError:  # PyTorch 1 knows no bool in DLPack
            with warnings.catch_warnings():  # it says that NumPy's array is read-only
                warnings.simplefilter("ignore")
                return self.xp.as_tensor(np.asarray(array) if self.device == "cpu" else array)

    def own(self, values: Any) -> Any:
        """A copy of an array of NumPy."""
        return self.xp.tensor(values, device=self.device) if self.is_torch else np.array(values)

    def given(self, values: Any, dtype: Any) -> Any:
        """What a caller gave, which may be an array, a tensor or a sequence."""
        if self.is_torch:
            return self.xp.as_tensor(values, dtype=dtype, device=self.device).detach()
        return np.asarray(values, dtype=dtype)

    def zeros(self, shape: tuple[int, ...], dtype: Any) -> Any:
        return self.xp.zeros(shape, dtype=dtype, device=self.device) if self.is_torch else np.zeros(shape, dtype)

    def joined(self, parts: list[Any]) -> Any:
        """Arrays of the shape (n, anything) side by side."""
        return self.xp.cat(parts, 1) if self.is_torch else np.concatenate(parts, 1)

    def single(self, values: Any) -> Any:
        """In single precision."""
        return values.to(self.xp.float32) if self.is_torch else values.astype(np.float32)

    def stream(self) -> int | None:
        """The stream in which torch works now; None = the default stream, or no GPU."""
        if not self.device.startswith("cuda"):
            return None
        return self.xp.cuda.current_stream(self.device).cuda_stream or None
