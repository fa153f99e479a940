# SPDX-License-Identifier: Apache-2.0
"""Robots that learn: vector environments of Gymnasium over a batch.

    from mercurysim.gym import SwimEnv, eel

    env = SwimEnv(eel(), num_envs=64)
    observations, infos = env.reset(seed=1)
    observations, rewards, terminations, truncations, infos = env.step(env.action_space.sample())

SwimEnv and WalkEnv take one robot, copied as often as wanted, or thousands of different ones. gymnasium.make_vec()
knows them as "mercurysim/Swim-v0" and "mercurysim/Walk-v0", gymnasium.make() as environments of one robot. Tasks of
your own derive from RobotEnv.
"""

try:
    import gymnasium
except ImportError:
    raise ImportError("mercurysim.gym needs Gymnasium: pip install 'mercurysim[gym]'") from None

from ..bodies import eel, quadruped
from ._bodies import Motion
from ._environment import RobotEnv, Step
from ._single import SingleEnv
from ._tasks import SwimEnv, WalkEnv

for _name, _kind in (("Swim", SwimEnv), ("Walk", WalkEnv)):
    gymnasium.register(
        f"mercurysim/{_name}-v0",
        entry_point=_kind.single,
        vector_entry_point=_kind,
        disable_env_checker=True,  # it warns about dtypes of rewards; the tests run check_env() instead
    )

__all__ = ["Motion", "RobotEnv", "SingleEnv", "Step", "SwimEnv", "WalkEnv", "eel", "quadruped"]
