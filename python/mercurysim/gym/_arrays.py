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
            import torch as xp  # type: ignore[import-not-found, unused-ignore]

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

    def recorded(self, function: Any, carried: int) -> Any:
        """The function, on a GPU as one CUDA graph: Python then starts its operations, some hundred, by a single call.

        It takes and returns tensors, waits for nothing, and reads nothing else that is replaced between calls. The
        first `carried` results are the first arguments of the next call; until then they may not be kept elsewhere.
        """
        return Graph(self.xp, function, carried) if self.device.startswith("cuda") else function

    def stream(self) -> int | None:
        """The stream in which torch works now; None = the default stream, or no GPU."""
        if not self.device.startswith("cuda"):
            return None
        return self.xp.cuda.current_stream(self.device).cuda_stream or None


class Graph:
    """What Arrays.recorded() returns. The first call records."""

    def __init__(self, torch: Any, function: Any, carried: int) -> None:
        self.torch, self.function, self.carried = torch, function, carried
        self.graph: Any = None

    def __call__(self, *arguments: Any) -> tuple[Any, ...]:
        if self.graph is None:
            self._record(arguments)
        for own, given in zip(self.arguments, arguments):
            if given is not own:
                own.copy_(given)
        self.graph.replay()
        return *self.arguments[: self.carried], *(result.clone() for result in self.results)

    def _record(self, arguments: tuple[Any, ...]) -> None:
        cuda = self.torch.cuda
        self.arguments = [argument.clone() for argument in arguments]
        aside = cuda.Stream()
        aside.wait_stream(cuda.current_stream())
        with cuda.stream(aside):  # libraries that the operations use make their workspaces before the recording
            self.function(*self.arguments)
        cuda.current_stream().wait_stream(aside)
        self.graph = cuda.CUDAGraph()
        with cuda.graph(self.graph, capture_error_mode="thread_local"):
            results = self.function(*self.arguments)
            for own, result in zip(self.arguments[: self.carried], results):
                own.copy_(result)
        self.results = results[self.carried :]
