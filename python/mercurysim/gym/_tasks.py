# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from typing import Any

from .. import Land, Ocean, Robot
from ..bodies import eel, quadruped
from ._environment import RobotEnv, Step


class SwimEnv(RobotEnv):
    """Robots that swim to targets at the height where they start, each in an ocean of its own.

    The reward of a step is

        progress - energy_cost seconds mean(u^2) + 1 if the target is reached - 1 if the robot explodes

    where progress is how much nearer the robot has come to its target, or how far it has moved along x without targets
    [body lengths], seconds is how long the action lasts, and the mean is over its actuators. RobotEnv has the other
    arguments, and says what is observed.
    """

    def __init__(self, robots: Any = None, num_envs: int | None = None, *, energy_cost: float = 0.01, **settings: Any):
        settings.setdefault("environment", Ocean())
        super().__init__(robots, num_envs, **settings)
        self._energy_cost = energy_cost

    @classmethod
    def default_robot(cls) -> Robot:
        return eel()

    def reward(self, step: Step) -> Any:
        return step.progress - self._energy_cost * step.effort + 1.0 * step.reached - 1.0 * step.exploded


class WalkEnv(RobotEnv):
    """Robots that walk along x, or to targets, each on land of its own.

    The reward of a step is

        progress - energy_cost seconds mean(u^2) - tilt_cost seconds (1 - up) + 1 if reached - 1 if the robot explodes

    as in SwimEnv, where up is the cosine of the angle between the robot's upward axis and the vertical.
    """

    def __init__(
        self,
        robots: Any = None,
        num_envs: int | None = None,
        *,
        energy_cost: float = 0.01,
        tilt_cost: float = 0.1,
        **settings: Any,
    ):
        settings.setdefault("environment", Land())
        settings.setdefault("targets", False)
        settings.setdefault("dt", 1e-3)
        super().__init__(robots, num_envs, **settings)
        self._energy_cost, self._tilt_cost = energy_cost, tilt_cost

    @classmethod
    def default_robot(cls) -> Robot:
        return quadruped()

    def reward(self, step: Step) -> Any:
        tilt = self._tilt_cost * self.action_seconds * (1 - step.motion.axes[:, 2, 2])
        return step.progress - self._energy_cost * step.effort - tilt + 1.0 * step.reached - 1.0 * step.exploded
