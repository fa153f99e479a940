# SPDX-License-Identifier: Apache-2.0
"""Environments of mercurysim.gym in Stable-Baselines3. Its PyTorch is large, so it is tested where it is installed."""

import numpy as np
import pytest

pytest.importorskip("gymnasium")
stable_baselines3 = pytest.importorskip("stable_baselines3", reason="there is no stable_baselines3")

from stable_baselines3 import PPO  # noqa: E402
from stable_baselines3.common.vec_env import VecMonitor  # noqa: E402

from mercurysim import InputError  # noqa: E402
from mercurysim.gym import SwimEnv, eel  # noqa: E402
from mercurysim.gym.stable_baselines3 import SB3VecEnv  # noqa: E402


def swimmers(count=4, **settings):
    return SwimEnv(eel(), count, device="cpu", autoreset_mode="SameStep", **settings)


def test_its_steps_are_those_of_the_environment():
    env, wrapped = swimmers(episode_seconds=0.2), SB3VecEnv(swimmers(episode_seconds=0.2))
    wrapped.seed(3)
    observations, _ = env.reset(seed=3)
    assert np.array_equal(wrapped.reset(), observations)
    for step in range(11):
        actions = env.action_space.sample()
        observations, rewards, terminated, truncated, infos = env.step(actions)
        seen, given, over, split = wrapped.step(actions)
        assert np.array_equal(seen, observations) and np.array_equal(given, rewards)
        assert over.tolist() == (terminated | truncated).tolist() == [step in (4, 9)] * 4
        for i, info in enumerate(split):
            assert ("terminal_observation" in info) == over[i] == info.get("TimeLimit.truncated", False)
            if over[i]:
                assert np.array_equal(info["terminal_observation"], infos["final_obs"][i])
                assert info["distance"] == infos["final_info"]["distance"][i]
            else:
                assert info["distance"] == infos["distance"][i]


def test_ppo_learns_and_is_saved_and_loaded(tmp_path):
    env = VecMonitor(SB3VecEnv(swimmers(8, episode_seconds=1)))
    model = PPO("MlpPolicy", env, n_steps=32, batch_size=64, n_epochs=2, seed=1, device="cpu")
    model.learn(512)
    assert model.num_timesteps == 512 and len(model.ep_info_buffer) > 0
    assert all(info["l"] == 25 for info in model.ep_info_buffer)  # 1 s in steps of 0.04 s
    model.save(tmp_path / "swim")
    observations = env.reset()
    actions, _ = PPO.load(tmp_path / "swim", device="cpu").predict(observations, deterministic=True)
    assert np.array_equal(actions, model.predict(observations, deterministic=True)[0]) and actions.shape == (8, 5)
    again = PPO.load(tmp_path / "swim", env=env, device="cpu")
    again.learn(256, reset_num_timesteps=False)
    assert again.num_timesteps == 768


def test_the_same_seed_learns_the_same():
    weights = []
    for _ in range(2):
        model = PPO("MlpPolicy", SB3VecEnv(swimmers()), n_steps=16, batch_size=64, n_epochs=1, seed=2, device="cpu")
        weights.append([value.numpy() for value in model.learn(64).policy.state_dict().values()])
    assert all(np.array_equal(a, b) for a, b in zip(*weights))


def test_environments_that_reset_otherwise_are_refused():
    with pytest.raises(InputError, match="SameStep"):
        SB3VecEnv(SwimEnv(eel(), 2, device="cpu"))
