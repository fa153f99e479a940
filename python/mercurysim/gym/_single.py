# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np


class SingleEnv(gymnasium.Env):
    """One robot as a gymnasium.Env. `vector` is an environment of one robot, in NumPy, without autoreset."""

    def __init__(self, vector: Any) -> None:
        self.vector = vector
        self.observation_space = vector.single_observation_space
        self.action_space = vector.single_action_space
        self.render_mode = vector.render_mode
        self.metadata = {key: value for key, value in vector.metadata.items() if key != "autoreset_mode"}

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        observations, infos = self.vector.reset(seed=seed)
        return observations[0], {key: value[0] for key, value in infos.items()}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        observations, rewards, terminations, truncations, infos = self.vector.step(np.asarray(action)[None])
        first = {key: value[0] for key, value in infos.items()}
        return observations[0], float(rewards[0]), bool(terminations[0]), bool(truncations[0]), first

    def render(self) -> Any:
        frames = self.vector.render()
        return frames[0] if frames else None

    def close(self) -> None:
        self.vector.close()
