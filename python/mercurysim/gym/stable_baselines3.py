# SPDX-License-Identifier: Apache-2.0
"""Environments of mercurysim.gym for Stable-Baselines3 (pip install stable-baselines3).

    from stable_baselines3 import PPO
    from mercurysim.gym import SwimEnv, eel
    from mercurysim.gym.stable_baselines3 import SB3VecEnv

    model = PPO("MlpPolicy", SB3VecEnv(SwimEnv(eel(), 64, autoreset_mode="SameStep")))
    model.learn(100_000)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

try:
    from stable_baselines3.common.vec_env import VecEnv  # type: ignore[import-not-found, unused-ignore]
except ImportError:
    raise ImportError("mercurysim.gym.stable_baselines3 needs Stable-Baselines3: pip install stable-baselines3") from None

from .._mercury import InputError
from ._environment import RobotEnv

__all__ = ["SB3VecEnv"]


class SB3VecEnv(VecEnv):  # type: ignore[misc, unused-ignore]  # of a package that may be absent
    """All robots of an environment of mercurysim.gym, which is stepped in one batch, as a VecEnv.

    env: with autoreset_mode="SameStep", as Stable-Baselines3 wants it, and arrays of NumPy. Infos of a step that ended an
    episode have "terminal_observation", and "TimeLimit.truncated" where time was over.
    """

    def __init__(self, env: RobotEnv) -> None:
        if env.autoreset_mode is not AutoresetMode.SAME_STEP or env.xp is not np:
            raise InputError('env: give an environment with autoreset_mode="SameStep" and without torch=True')
        self.env = env
        self._actions: Any = None
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)

    def reset(self) -> Any:
        observations, infos = self.env.reset(seed=self._seeds[0])
        self.reset_infos = self._split(infos)
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: Any) -> None:
        self._actions = actions

    def step_wait(self) -> tuple[Any, Any, Any, list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, infos = self.env.step(self._actions)
        over = terminated | truncated
        final = infos.pop("final_obs")
        last = infos.pop("final_info")
        split = self._split(infos)
        for i in np.flatnonzero(over):
            split[i] = {name: value[i] for name, value in last.items() if not name.startswith("_")}
            split[i] |= {"terminal_observation": final[i], "TimeLimit.truncated": bool(truncated[i] and not terminated[i])}
        return observations, rewards, over, split

    def _split(self, infos: dict[str, Any]) -> list[dict[str, Any]]:
        arrays = {name: value for name, value in infos.items() if not name.startswith("_")}
        return [{name: value[i] for name, value in arrays.items()} for i in range(self.num_envs)]

    def close(self) -> None:
        self.env.close()

    def get_images(self) -> Sequence[Any]:
        return list(self.env.render())

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self.env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        setattr(self.env, attr_name, value)

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **keywords: Any) -> list[Any]:
        """Calls the method once: the environment is one for all robots."""
        return [getattr(self.env, method_name)(*arguments, **keywords)] * len(list(self._get_indices(indices)))

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False] * len(list(self._get_indices(indices)))

    def _get_indices(self, indices: None | int | Iterable[int]) -> Iterable[int]:
        if indices is None:
            return range(self.num_envs)
        return [indices] if isinstance(indices, int) else indices
