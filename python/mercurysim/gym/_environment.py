# SPDX-License-Identifier: Apache-2.0
"""A vector environment over one batch: the base of swimming, walking and tasks of a user's own."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

import mercurysim

from .. import Batch, InputError, Robot
from ._arrays import Arrays
from ._bodies import Bodies, Motion
from ._randomized import Randomized, Range
from ._single import SingleEnv
from ._targets import Targets

LIMIT = 10.0  # observations are cut off here


@dataclass
class Step:
    """What a step did, to n robots: what RobotEnv.reward() and is_over() are given. Arrays of float32 unless said."""

    motion: Motion  # where the robots are now and how they move
    progress: Any  # (n,), how much nearer the robots came to their targets, or how far along x [body lengths]
    reached: Any  # (n,) bool, whether they are at their targets
    exploded: Any  # (n,) bool
    drive: Any  # (n, actuators), the drive signal; 0 for actuators that a robot does not have
    effort: Any  # (n,), mean of drive^2 over a robot's actuators, times the seconds that an action lasts [s]
    elapsed: Any  # (n,), since the episode began [s]


class RobotEnv(gymnasium.vector.VectorEnv):
    """Robots that are driven by their actuators; the base of SwimEnv, WalkEnv and tasks of your own.

        class JumpEnv(RobotEnv):
            def reward(self, step):
                return step.motion.velocity[:, 2] - 0.01 * step.effort

        env = JumpEnv(quadruped(), 16, environment=Land(), dt=1e-3, targets=False)

    A task overrides reward(), and may override is_over(), observe() with observed_numbers, and default_robot(). They
    take and return arrays of n robots, of `xp`, which is numpy, or torch with torch=True. On a GPU they are recorded as a
    CUDA graph: there they use operations of torch alone, no `if` on values, and nothing that is replaced between calls.

    robots           a Robot or a sequence of them; robot i of the batch is robots[i % len(robots)]
    num_envs         default: one environment per robot
    device           of the batch, as in Batch. "auto" is the CPU unless torch=True
    frame_skip, dt   an action lasts frame_skip time steps of dt [s]
    episode_seconds  after this simulated time an episode is truncated
    targets          True: each episode has a target of its own. False: the task is to go on along x
    target_distance  from the center at rest to targets, at least and at most [body lengths]
    target_angle     the greatest angle between x and the direction to a target [rad]
    reach            a target counts as reached at this distance [body lengths]
    smoothing        time constant of the drive signal [s], see below
    markers          how many masses of each robot are observed
    max_actuators    size of an action; default: the most that one of the robots has
    autoreset_mode   an AutoresetMode of gymnasium.vector, or its value
    torch            True: observations, rewards and flags are tensors on the device, and actions may be. No call waits
                     for the device, but for the first step(), which records CUDA graphs.
    randomize        what differs between episodes, see below
    seed             of the targets and of `randomize`, as if given to the first reset()
    render_mode      None or "rgb_array": render() returns a frame per robot
    render_size      of a frame, (width, height) [pixels]
    batch            further arguments of Batch, such as environment, solver, damping, threads

    The body length of a robot is its longest side at rest. Its body frame is forward, left and up (x, y, z of the robot
    as it was made), fitted to its markers, which are spread over the body in the same way for every robot.

    `randomize` names parameters of the environment that each episode has for its robot alone: gravity, and those of
    water and ground. A value is a range (least, most), from which numbers are drawn evenly, or a function of a
    numpy.random.Generator and n that returns n numbers, or (n, 3) for a vector. Infos hold what was drawn. On a GPU
    every step then waits for the device.

        WalkEnv(robot, 64, randomize={"friction": (0.4, 1.2), "gravity": lambda random, n: [[0, 0, -9.81]] * n})

    An action a has one number in [-1, 1] per actuator; those that a robot does not have are ignored. The drive signal u
    follows it as u += (a - u) (1 - exp(-frame_skip dt / smoothing)), because a muscle whose length jumps throws masses
    of 1 kg about. A robot whose action has a NaN explodes: its policy has diverged.

    An observation is, in the body frame, lengths in body lengths, float32, cut off at 10:

    direction to the target (3), distance (1; 0 without targets), velocity of the center of mass per second (3), angular
    momentum of the markers over their moment of inertia [rad/s] (3), up of the world (3), positions of the markers from
    their middle (3 each), their velocities per second (3 each), u, sine and cosine of a clock of one period per
    second (2), and what observe() adds.

    An episode terminates when the robot reaches its target or explodes, or when is_over() says so. Infos: "distance"
    still to go [m] (without targets, the way along x with a minus), "reached" and "exploded". With
    AutoresetMode.SAME_STEP, "final_obs" and "final_info" are those of the step that ended an episode. With
    AutoresetMode.DISABLED, reset(options={"reset_mask": mask}) resets some robots.
    """

    observed_numbers = 0  # how many observe() adds per robot
    single_observation_space: gymnasium.spaces.Box
    single_action_space: gymnasium.spaces.Box
    observation_space: gymnasium.spaces.Box
    action_space: gymnasium.spaces.Box

    def __init__(
        self,
        robots: Robot | Sequence[Robot] | None = None,
        num_envs: int | None = None,
        *,
        device: str = "auto",
        frame_skip: int = 20,
        dt: float = 2e-3,
        episode_seconds: float = 20,
        targets: bool = True,
        target_distance: tuple[float, float] = (0.8, 1.5),
        target_angle: float = math.pi,
        reach: float = 0.25,
        smoothing: float = 0.1,
        markers: int = 8,
        max_actuators: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        torch: bool = False,
        randomize: Mapping[str, Range] | None = None,
        seed: int | None = None,
        render_mode: str | None = None,
        render_size: tuple[int, int] = (320, 240),
        **batch: Any,
    ) -> None:
        if not torch and device not in ("auto", "cpu"):
            raise InputError(f"device: {device} needs torch=True, since NumPy has no arrays in the memory of a GPU")
        if render_mode not in (None, "rgb_array"):
            raise InputError(f'render_mode: "{render_mode}" is not accepted; give None or "rgb_array"')
        if frame_skip < 1 or markers < 1 or not smoothing >= 0 or not episode_seconds > 0:
            raise InputError("frame_skip and markers are at least 1, smoothing at least 0, episode_seconds above 0")
        if robots is None:
            robots = self.default_robot()
        given = [robots] if isinstance(robots, Robot) else list(robots)
        if not given:
            raise InputError("robots: there is none; give at least one")
        self.num_envs = len(given) if num_envs is None else num_envs
        if self.num_envs < len(given):
            raise InputError(f"num_envs: {num_envs} is less than {len(given)}, the number of robots")
        all_robots = [given[i % len(given)] for i in range(self.num_envs)]
        self.batch = Batch(all_robots, dt=dt, device=device if torch else "cpu", **batch)
        self.frame_skip, self.action_seconds = frame_skip, frame_skip * dt
        self.episode_steps = max(1, round(episode_seconds / self.action_seconds))
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.render_mode, self.render_size = render_mode, render_size
        self.metadata = {
            "autoreset_mode": self.autoreset_mode,
            "render_modes": ["rgb_array"],
            "render_fps": max(1, round(1 / self.action_seconds)),
        }
        self._arrays = Arrays(torch, self.batch.device)
        self._xp = self._arrays.xp
        self._bodies = Bodies(self._arrays, self.batch, all_robots, markers)
        self._exploded = self._arrays.view(self.batch.exploded)
        self._follow = 1 - math.exp(-self.action_seconds / smoothing) if smoothing > 0 else 1.0
        self._targets = Targets(self._arrays, self._bodies, targets, target_distance, target_angle)
        self._randomized = Randomized(self._arrays, self.batch, randomize or {})
        self._reach = reach * self._bodies.lengths
        self._find_actuators(given, max_actuators)
        self._make_spaces(markers)
        self._first_seed, self._started = seed, False
        n, float32 = self.num_envs, self._xp.float32
        self._u = self._arrays.zeros(tuple(self._has_actuator.shape), float32)  # the drive signal
        self._elapsed = self._arrays.zeros((n,), float32)  # steps in this episode
        self._remaining = self._arrays.zeros((n,), float32)  # Targets.remaining() after the last step
        self._episode = self._arrays.zeros((n,), self._xp.int64)
        self._done = self._elapsed < 0  # the episode is over
        self._drive_actuators = self._arrays.recorded(self._follow_actions, carried=1)
        self._find_outcome = self._arrays.recorded(self._outcome, carried=len(self._state()))
        self._begin_over = self._arrays.recorded(self._begin_done, carried=len(self._state()))

    def _find_actuators(self, given: list[Robot], most: int | None) -> None:
        counts = np.array([len(robot.actuators) for robot in given])
        if counts.min() == 0:
            robot = int(counts.argmin())
            raise InputError(f"robot {robot} ({given[robot].name}) has no actuators; give it some: with_actuators()")
        if most is not None and counts.max() > most:
            robot = int(counts.argmax())
            raise InputError(
                f"max_actuators: {most} is not enough, robot {robot} ({given[robot].name}) has {counts[robot]}"
            )
        self._drive = self._arrays.view(self.batch.actuation.drive)
        size = int(counts.max()) if most is None else most
        own = np.arange(size) < counts[np.arange(self.num_envs) % len(given), None]
        self._has_actuator = self._arrays.own(own.astype(np.float32))

    def _make_spaces(self, markers: int) -> None:
        actuators = self._has_actuator.shape[1]
        size = 13 + 6 * markers + actuators + 2 + self.observed_numbers
        self.single_observation_space = gymnasium.spaces.Box(-LIMIT, LIMIT, (size,), np.float32)
        self.single_action_space = gymnasium.spaces.Box(-1, 1, (actuators,), np.float32)
        self.observation_space = gymnasium.spaces.Box(-LIMIT, LIMIT, (self.num_envs, size), np.float32)
        self.action_space = gymnasium.spaces.Box(-1, 1, (self.num_envs, actuators), np.float32)

    @property
    def xp(self) -> Any:
        """The module of the arrays: numpy, or torch."""
        return self._xp

    @property
    def actuator_mask(self) -> Any:
        """Which actuators each robot has, (num_envs, actuators) bool. What an action says of the others has no effect."""
        return self._has_actuator > 0

    @classmethod
    def default_robot(cls) -> Robot:
        """The robot of an environment that is made without one."""
        raise InputError(f"robots: {cls.__name__} has no robot of its own; give at least one")

    @classmethod
    def single(cls, robot: Robot | None = None, **settings: Any) -> SingleEnv:
        """The same with one robot, as a gymnasium.Env."""
        return SingleEnv(cls(robot, 1, autoreset_mode=AutoresetMode.DISABLED, **settings))

    def reward(self, step: Step) -> Any:
        """The reward of a step, (n,) float32."""
        raise NotImplementedError(f"{type(self).__name__} has no reward(): a task of your own needs one")

    def is_over(self, step: Step) -> Any:
        """Which episodes end, besides those of robots that reach their targets or explode, (n,) bool; None = no other."""
        return None

    def observe(self, motion: Motion) -> Any:
        """More to observe, (n, observed_numbers) float32."""
        return None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Puts the robots at rest where they start. A seed decides the targets of this and all later episodes."""
        mask = (options or {}).get("reset_mask")
        if mask is not None and self._started:
            self._restart(self._mask(mask))
            return self._now()
        if not self._started and seed is None:
            seed = self._first_seed
        if not self._started or seed is not None:
            super().reset(seed=seed)
            self._targets.draw(self.np_random)
            self._randomized.draw(self.np_random)
            self._episode = 0 * self._episode - 1
        self._started = True
        self._randomized.assign(self._elapsed >= 0, self._episode + 1)
        self.batch.reset()
        self._begin(self._elapsed >= 0)
        return self._now()

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        if not self._started:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        (self._u,) = self._drive_actuators(self._u, self._usable(actions))
        self.batch.step(self.frame_skip, stream=self._arrays.stream())
        if self.autoreset_mode is AutoresetMode.NEXT_STEP:
            self._reset_robots(self._done)
        size = len(self._state())
        results = self._find_outcome(*self._state())
        self._set_state(results[:size])
        observations, rewards, terminated, truncated, *report = results[size:]
        infos = self._infos(*report)
        if self.autoreset_mode is AutoresetMode.SAME_STEP:
            over = terminated | truncated
            final = {name: over if name.startswith("_") else value for name, value in infos.items()}
            final_obs = observations
            self._reset_robots(self._done)
            results = self._begin_over(*self._state())
            self._set_state(results[:size])
            observations = results[size]
            infos = self._infos(self._remaining + 0, report[1] & ~over, report[2] & ~over)
            infos |= {"final_obs": final_obs, "_final_obs": over, "final_info": final, "_final_info": over}
        return observations, rewards, terminated, truncated, infos

    def _state(self) -> tuple[Any, ...]:
        """What a step changes, besides the batch."""
        return self._u, self._elapsed, self._remaining, self._episode, self._done, self._targets.points

    def _set_state(self, state: Any) -> None:
        self._u, self._elapsed, self._remaining, self._episode, self._done, self._targets.points = state

    def _follow_actions(self, u: Any, actions: Any) -> tuple[Any, ...]:
        """Writes the new drive signal for the batch."""
        actions = self._xp.where(self._has_actuator > 0, self._xp.clip(actions, -1, 1), 0 * self._u)
        u = u + (actions - u) * self._follow
        self._drive[:] = u[:, : self._drive.shape[1]]
        return (self._xp.nan_to_num(u),)

    def _outcome(self, *state: Any) -> tuple[Any, ...]:
        """The state after a step, observations, rewards, two flags, and what _infos() takes."""
        self._set_state(state)
        self._elapsed = self._elapsed + 1
        over = self._done
        if self.autoreset_mode is AutoresetMode.NEXT_STEP:
            self._begin(over)
        motion = self._bodies.motion()
        remaining = self._targets.remaining(motion.center)
        exploded = self._exploded != 0
        reached = (remaining < self._reach) & ~exploded & self._targets.wanted
        progress = self._xp.where(exploded, 0 * remaining, (self._remaining - remaining) / self._bodies.lengths)
        step = Step(motion, progress, reached, exploded, self._u, self._effort(), self._elapsed * self.action_seconds)
        rewards = self._arrays.single(self.reward(step))
        ended = self.is_over(step)
        if self.autoreset_mode is AutoresetMode.NEXT_STEP:
            rewards = self._xp.where(over, 0 * rewards, rewards)
        terminated = reached | exploded
        if ended is not None:
            terminated = terminated | (ended != 0)
        truncated = (self._elapsed >= self.episode_steps) & ~terminated
        self._remaining, self._done = remaining, terminated | truncated
        observations = self._observe(motion)
        return *self._state(), observations, rewards, terminated, truncated, remaining + 0, reached, exploded

    def _begin_done(self, *state: Any) -> tuple[Any, ...]:
        """The state after the next episodes have begun, and observations."""
        self._set_state(state)
        self._begin(self._done)
        return *self._state(), self._observe(self._bodies.motion())

    def render(self) -> Any:
        """A picture of each robot, (h, w, 3) uint8. None without a render_mode."""
        if not self.render_mode:
            return None
        return tuple(mercurysim.picture(self.batch, self.render_size, robot=i) for i in range(self.num_envs))

    def _restart(self, mask: Any) -> None:
        """Ends the episodes of some robots and begins their next ones."""
        self._reset_robots(mask)
        self._begin(mask)

    def _reset_robots(self, mask: Any) -> None:
        self._randomized.assign(mask, self._episode + 1)
        self.batch.reset(mask, stream=self._arrays.stream())

    def _begin(self, mask: Any) -> None:
        where = self._xp.where
        self._episode = self._episode + mask
        self._targets.assign(mask, self._episode)
        self._u = where(mask[:, None], 0 * self._u, self._u)
        self._elapsed = where(mask, 0 * self._elapsed, self._elapsed)
        self._remaining = where(mask, self._targets.remaining(self._targets.starts), self._remaining)
        self._done = self._done & ~mask

    def _now(self) -> tuple[Any, dict[str, Any]]:
        infos = self._infos(self._remaining + 0, self._done & True, self._exploded != 0)
        return self._observe(self._bodies.motion()), infos

    def _effort(self) -> Any:
        """Mean of u^2 over the actuators of each robot, times the seconds that an action lasts."""
        effort = self._xp.sum(self._u * self._u, 1) / self._xp.sum(self._has_actuator, 1)
        return self.action_seconds * effort

    def _usable(self, actions: Any) -> Any:
        actions = self._arrays.given(actions, self._xp.float32)
        if tuple(actions.shape) != self.action_space.shape:
            raise InputError(f"actions: shape {tuple(actions.shape)} is not accepted; give {self.action_space.shape}")
        return actions

    def _mask(self, mask: Any) -> Any:
        mask = self._arrays.given(mask, bool if self._xp is np else self._xp.bool)
        if tuple(mask.shape) != (self.num_envs,):
            raise InputError(f"reset_mask: shape {tuple(mask.shape)} is not accepted; give ({self.num_envs},)")
        return mask

    def _observe(self, motion: Motion) -> Any:
        xp, n = self._xp, self.num_envs
        scale = (1 / self._bodies.lengths)[:, None]
        direction = (motion.axes @ self._targets.direction(motion.center)[:, :, None])[:, :, 0]
        distance = self._targets.remaining(motion.center)[:, None] * scale * self._targets.wanted
        phase = self._elapsed[:, None] * (2 * math.pi * self.action_seconds)
        parts = [
            direction,
            distance,
            motion.velocity * scale,
            motion.turning,
            motion.axes[:, :, 2],
            motion.markers.reshape(n, -1) * scale,
            motion.marker_velocities.reshape(n, -1) * scale,
            self._u,
            xp.sin(phase),
            xp.cos(phase),
        ]
        if self.observed_numbers:
            parts.append(self._arrays.single(self.observe(motion)))
        return xp.clip(self._arrays.joined(parts), -LIMIT, LIMIT)

    def _infos(self, remaining: Any, reached: Any, exploded: Any) -> dict[str, Any]:
        infos = {"distance": remaining, "reached": reached, "exploded": exploded} | self._randomized.infos()
        everyone = self._elapsed >= 0
        return infos | {f"_{name}": everyone for name in infos}  # who has this info, as Gymnasium wants it
