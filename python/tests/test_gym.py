# SPDX-License-Identifier: Apache-2.0
import math
import subprocess
import sys

import numpy as np
import pytest

import mercurysim
from mercurysim import InputError
from mercurysim.bodies import eel, quadruped

gymnasium = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from mercurysim.gym import RobotEnv, SwimEnv, WalkEnv

EEL = eel()


def torch_or_skip():
    return pytest.importorskip("torch")


def actions(env, steps, seed=0):
    return np.random.default_rng(seed).uniform(-1, 1, (steps, *env.action_space.shape)).astype(np.float32)


def on_host(array):
    return np.asarray(array.cpu() if hasattr(array, "cpu") else array)


def play(env, steps, seed=5):
    """Observations, rewards and flags of an episode with random actions, as NumPy arrays."""
    frames = [[on_host(env.reset(seed=seed)[0])]]
    for action in actions(env, steps):
        frames.append([on_host(part) for part in env.step(action)[:4]])
    return frames


def same(a, b):
    return all(np.array_equal(x, y) for left, right in zip(a, b, strict=True) for x, y in zip(left, right, strict=True))


def moved(positions, angle, by):
    """Turned about z and shifted."""
    c, s = math.cos(angle), math.sin(angle)
    return positions @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + by


@pytest.mark.parametrize("kind", [SwimEnv, WalkEnv])
@pytest.mark.filterwarnings("error")
def test_check_env_of_gymnasium_finds_nothing(kind):
    check_env(kind.single(), skip_render_check=True)


def test_make_and_make_vec_know_the_environments():
    env = gymnasium.make("mercurysim/Swim-v0", episode_seconds=1)
    assert env.reset(seed=1)[0] in env.observation_space
    vector = gymnasium.make_vec("mercurysim/Walk-v0", num_envs=3)
    assert isinstance(vector, WalkEnv) and vector.reset(seed=1)[0] in vector.observation_space
    assert vector.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_observations_are_of_one_size_for_different_robots():
    env = SwimEnv([EEL, eel(6, 3, segments=2), quadruped()], 7)
    observations, _ = env.reset(seed=1)
    assert observations.dtype == np.float32 and observations in env.observation_space
    assert env.single_action_space.shape == (8,)
    for action in actions(env, 20):
        observations, rewards, *flags, infos = env.step(action)
    assert observations in env.observation_space
    assert rewards.dtype == np.float32 and all(flag.dtype == bool and flag.shape == (7,) for flag in flags)


@pytest.mark.parametrize("torch", [False, True])
def test_a_seed_gives_the_same_episodes_bit_for_bit(torch):
    if torch:
        torch_or_skip()
    env = SwimEnv(EEL, 3, episode_seconds=1, torch=torch)
    first = play(env, 60)
    assert same(first, play(env, 60))
    assert same(first, play(SwimEnv(EEL, 3, episode_seconds=1, torch=torch), 60))
    assert not same(first, play(env, 60, seed=6))
    assert not np.array_equal(on_host(env.reset()[0]), on_host(env.reset()[0]))  # without a seed, episodes go on


def test_a_robot_does_the_same_alone_and_among_others():
    alone, among = (SwimEnv(robots, targets=False) for robots in ([EEL], [quadruped(), EEL]))
    alone.reset(seed=1)
    among.reset(seed=1)
    for action in actions(among, 30):
        one, many = alone.step(action[1:, :5]), among.step(action)
        assert np.array_equal(one[0][0, :61], many[0][1, :61])  # all but the drive, which is wider, and the clock
        np.testing.assert_allclose(one[1][0], many[1][1], atol=1e-6)  # a mean over more actuators rounds in another way
    assert alone.batch.hash(0) == among.batch.hash(1)


def test_numpy_and_torch_agree():
    torch_or_skip()
    left, right = (play(SwimEnv(EEL, 4, torch=torch, device="cpu"), 20) for torch in (False, True))
    for a, b in zip(left, right):
        for x, y in zip(a, b):
            np.testing.assert_allclose(x, y, atol=2e-5)


def test_torch_writes_the_drive_into_the_memory_of_the_batch():
    torch = torch_or_skip()
    env = SwimEnv(EEL, 4, torch=True)
    env.reset(seed=1)
    observations = env.step(torch.ones(4, 5))[0]
    assert observations.device.type == ("cpu" if env.batch.device == "cpu" else "cuda")
    drive = env.batch.actuation.drive.numpy()
    np.testing.assert_allclose(drive, 1 - math.exp(-0.04 / 0.1), rtol=1e-6)


def test_actions_may_come_straight_from_a_network():
    torch = torch_or_skip()
    env = SwimEnv(EEL, 2, torch=True)
    observations, _ = env.reset(seed=1)
    network = torch.nn.Linear(observations.shape[1], 5).to(observations.device)
    observations, rewards, *_ = env.step(network(observations))
    assert not observations.requires_grad and not rewards.requires_grad


def test_the_drive_follows_the_action_with_its_time_constant():
    env = SwimEnv(EEL, 2, smoothing=0.2, frame_skip=25, dt=2e-3)
    env.reset(seed=1)
    for _ in range(7):
        observations = env.step(np.full((2, 5), 2.0))[0]  # cut off at 1
    expected = 1 - math.exp(-7 * 0.05 / 0.2)
    np.testing.assert_allclose(env.batch.actuation.drive, expected, rtol=1e-5)
    np.testing.assert_allclose(observations[:, -7:-2], expected, rtol=1e-5)


@pytest.mark.parametrize("torch", [False, True])
def test_a_robot_whose_policy_has_diverged_explodes(torch):
    if torch:
        torch_or_skip()
    env, other = (SwimEnv(EEL, 2, torch=torch, device="auto" if torch else "cpu") for _ in range(2))
    for each in (env, other):
        each.reset(seed=1)
        each.step(np.zeros((2, 5), np.float32))
    observations, rewards, terminated, truncated, infos = (
        part if isinstance(part, dict) else on_host(part)
        for part in env.step(np.array([[0, np.nan, 0, 0, 0], [0.5] * 5], np.float32))
    )
    expected = on_host(other.step(np.full((2, 5), 0.5, np.float32))[0])
    assert terminated.tolist() == [True, False] and on_host(infos["exploded"]).tolist() == [True, False]
    assert rewards[0] == -1 and np.isfinite(observations).all() and np.array_equal(observations[1], expected[1])
    env.step(np.zeros((2, 5), np.float32))  # begins its next episode
    observations, rewards, terminated, *_ = env.step(np.ones((2, 5), np.float32))
    assert not on_host(terminated).any() and np.isfinite(on_host(rewards)).all()


def test_a_value_of_nan_for_an_actuator_that_a_robot_lacks_has_no_effect():
    env = SwimEnv([EEL, quadruped()])
    env.reset(seed=1)
    actions = np.zeros(env.action_space.shape, np.float32)
    actions[0, 5:] = np.nan
    observations, rewards, terminated, *_ = env.step(actions)
    assert not terminated.any() and np.isfinite(observations).all() and np.isfinite(rewards).all()


def test_actions_of_actuators_that_a_robot_lacks_have_no_effect():
    env = SwimEnv([EEL, EEL, quadruped()])
    env.reset(seed=1)
    for action in actions(env, 5):
        action[1, :5] = action[0, :5]
        observations = env.step(action)[0]
    assert env.batch.hash(0) == env.batch.hash(1)
    assert np.array_equal(observations[0, 13:], observations[1, 13:])


def test_observations_turn_with_the_body():
    env = SwimEnv(EEL, 2, frame_skip=1)
    env.reset(seed=3)
    for action in actions(env, 40):
        env.step(action)
    count, angle, by = len(EEL.masses), 2.0, np.array([0.3, -0.2, 0.1])
    positions = np.asarray(env.batch.positions, float)[:count]
    velocities = np.asarray(env.batch.velocities, float)[:count]
    env.batch.set_state(1, moved(positions, angle, by), moved(velocities, angle, 0))
    env._targets.points[1] = moved(env._targets.points[0].astype(float), angle, by)
    env.batch.set_state(0, positions, velocities)
    observations = env._observe(env._bodies.motion())
    np.testing.assert_allclose(observations[0, :61], observations[1, :61], atol=1e-5)  # all but the drive and the clock


def test_markers_and_turning_of_a_rigid_rotation():
    env = SwimEnv(EEL, 1, targets=False)
    env.reset(seed=1)
    rest, rate, drift = EEL.masses.astype(float), 0.7, np.array([0.2, 0.1, -0.3])
    spin = np.cross([0, 0, rate], rest)
    env.batch.set_state(0, rest, spin + drift)
    motion = env._bodies.motion()
    markers = rest[env._bodies.marker_index[0]]
    markers -= markers.mean(axis=0)
    np.testing.assert_allclose(motion.markers[0], markers, atol=1e-6)
    np.testing.assert_allclose(motion.velocity[0], drift, atol=1e-6)
    momentum = np.cross(markers, np.cross([0, 0, rate], markers)).sum(axis=0)
    np.testing.assert_allclose(motion.turning[0], momentum / (markers**2).sum(), atol=1e-6)
    assert motion.turning[0, 2] > 0.8 * rate  # the eel is long and thin, so it is almost the angular velocity itself


def test_markers_are_spread_over_the_body():
    env = SwimEnv(EEL, 1, markers=8)
    chosen = EEL.masses[env._bodies.marker_index[0]].astype(float)
    distances = np.linalg.norm(chosen[:, None] - chosen, axis=2) + np.eye(8)
    assert distances.min() > 0.15  # closer neighbors are 0.1 m apart
    assert (np.diff(chosen[:, 0]) >= 0).all()
    to_nearest = np.linalg.norm(EEL.masses[:, None] - chosen, axis=2).min(axis=1)
    assert to_nearest.max() <= distances.min() + 1e-6  # as farthest-point sampling promises


def test_the_reward_is_progress_less_energy():
    env = SwimEnv(EEL, 3, energy_cost=0.5)
    env.reset(seed=2)
    before = np.array(env.batch.centers, float)
    for action in actions(env, 10):
        u = np.array(env._u, float)
        _, rewards, *_ = env.step(action)
        u += (action - u) * (1 - math.exp(-0.04 / 0.1))
        center = np.array(env.batch.centers, float)
        far, near = (np.linalg.norm(env._targets.points - place, axis=1) for place in (before, center))
        np.testing.assert_allclose(rewards, (far - near) / 1.0 - 0.5 * 0.04 * (u**2).mean(axis=1), atol=1e-6)
        before = center


def test_walking_upside_down_costs_what_the_formula_says():
    env = WalkEnv(quadruped(), 2, energy_cost=0, tilt_cost=3, frame_skip=1)
    env.reset(seed=1)
    rest = np.asarray(env.batch.positions, float)[: len(quadruped().masses)]
    env.batch.set_state(1, rest * [1, -1, -1] + [0, 0, 1], 0 * rest)
    rewards = env.step(np.zeros((2, 8)))[1]
    np.testing.assert_allclose(rewards, [0, -3 * 1e-3 * 2], atol=1e-4)


def trot(direction, seconds=10):
    """How far the quadruped walks along x [m], and its return. Opposite legs swing and lift together."""
    env = WalkEnv(quadruped(), 1, energy_cost=0, tilt_cost=0)
    env.reset(seed=1)
    start, total = env.batch.centers[0, 0], 0
    for step in range(round(seconds / env.action_seconds)):
        swing = np.sin(2 * np.pi * step * env.action_seconds + np.array([0, np.pi, np.pi, 0]))
        total += env.step(np.stack([swing, direction * swing], axis=1).reshape(1, 8))[1][0]
    return env.batch.centers[0, 0] - start, total


def test_a_trot_walks_ahead_and_its_mirror_image_back():
    (ahead, earned), (back, lost) = trot(1), trot(-1)
    assert ahead > 0.3 and back < -0.3
    assert ahead + back == pytest.approx(0, abs=0.1 * ahead)  # the robot is the same from the front and from behind
    length = 0.6  # of the robot [m]
    assert [earned, lost] == pytest.approx([ahead / length, back / length], rel=1e-4)


def test_targets_are_where_the_settings_say():
    env = SwimEnv(EEL, 200, target_distance=(0.8, 1.5), target_angle=0.5)
    env.reset(seed=1)
    way = np.asarray(env._targets.points) - np.asarray(env.batch.centers)
    distance, angle = np.hypot(way[:, 0], way[:, 1]), np.arctan2(way[:, 1], way[:, 0])
    assert 0.8 <= distance.min() < 0.85 and 1.45 < distance.max() <= 1.5
    assert -0.5 <= angle.min() < -0.45 and 0.45 < angle.max() <= 0.5
    np.testing.assert_allclose(way[:, 2], 0, atol=1e-6)


def test_a_reached_target_ends_the_episode_with_a_bonus():
    env = SwimEnv(EEL, 2, target_distance=(0.2, 0.2), energy_cost=0)
    env.reset(seed=1)
    _, rewards, terminated, truncated, infos = env.step(np.zeros((2, 5)))
    assert terminated.all() and not truncated.any() and infos["reached"].all()
    np.testing.assert_allclose(rewards, 1, atol=1e-6)


def exploding():
    """Springs so stiff that a step of 2 ms is far beyond the stability of the force solver."""
    return eel(4, 1, segments=2, stiffness=1e8)


def test_an_explosion_ends_the_episode_with_a_penalty_and_leaves_the_others_alone():
    robots = [EEL, exploding()]
    env, alone = SwimEnv(robots, energy_cost=0, targets=False), SwimEnv(EEL, targets=False)
    env.reset(seed=1)
    alone.reset(seed=1)
    exploded = False
    for action in actions(env, 100):
        observations, rewards, terminated, _, infos = env.step(action)
        alone.step(action[:1])
        assert observations in env.observation_space
        exploded = exploded or terminated[1]
        if terminated[1]:
            assert infos["exploded"].tolist() == [False, True] and rewards[1] == -1
    assert exploded
    assert env.batch.hash(0) == alone.batch.hash(0)


def test_next_step_autoreset_begins_an_episode_with_the_step_after_the_last():
    env = SwimEnv(EEL, 2, episode_seconds=0.4)  # 10 actions
    begin, _ = env.reset(seed=1)
    for count, action in enumerate(actions(env, 10), 1):
        _, _, terminated, truncated, _ = env.step(action)
        assert truncated.all() == (count == 10) and not terminated.any()
    last = np.array(env.batch.positions)
    observations, rewards, terminated, truncated, _ = env.step(np.ones((2, 5)))
    assert not rewards.any() and not terminated.any() and not truncated.any()
    np.testing.assert_array_equal(env.batch.positions, np.concatenate([EEL.masses] * 2))
    assert np.abs(last - env.batch.positions).max() > 1e-3
    assert np.array_equal(observations[:, 4:], begin[:, 4:])  # all but the way to the target, which is another
    assert not np.array_equal(observations[:, :4], begin[:, :4])
    assert not env.step(np.ones((2, 5)))[3].any()


def test_same_step_autoreset_returns_the_last_observation_in_the_infos():
    settings = {"episode_seconds": 0.2, "targets": False}
    env = SwimEnv(EEL, 2, autoreset_mode="SameStep", **settings)
    other = SwimEnv(EEL, 2, autoreset_mode="NextStep", **settings)
    begin, _ = env.reset(seed=1)
    other.reset(seed=1)
    for action in actions(env, 5):
        observations, _, _, truncated, infos = env.step(action)
        expected = other.step(action)[0]
        if not truncated.any():
            assert "final_info" not in infos or not infos["_final_info"].any()
    assert truncated.all() and infos["_final_obs"].all() and infos["_final_info"].all()
    assert np.array_equal(infos["final_obs"], expected)
    final = infos["final_info"]
    np.testing.assert_allclose(final["distance"], -np.asarray(other.batch.centers)[:, 0] + EEL.masses[:, 0].mean(), atol=1e-6)
    assert final["_distance"].all() and not infos["distance"].any()
    assert np.array_equal(observations, begin)


def test_without_autoreset_a_mask_resets_some_robots():
    env = SwimEnv(EEL, 3, autoreset_mode=AutoresetMode.DISABLED, episode_seconds=0.2)
    env.reset(seed=1)
    for action in actions(env, 7):
        truncated = env.step(action)[3]
    assert truncated.all()
    before = env.batch.hashes()
    env.reset(options={"reset_mask": np.array([False, True, False])})
    after = env.batch.hashes()
    assert (before == after).tolist() == [True, False, True]
    assert env.step(np.zeros((3, 5)))[3].tolist() == [True, False, True]


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: SwimEnv([EEL] * 3, 2), "num_envs: 2"),
        (lambda: SwimEnv([]), "at least one"),
        (lambda: SwimEnv(EEL, 2, max_actuators=4), "max_actuators: 4"),
        (lambda: SwimEnv(EEL, 2, device="cuda"), "torch=True"),
        (lambda: SwimEnv(EEL, 2, render_mode="human"), "render_mode"),
        (lambda: SwimEnv(EEL, 2, frame_skip=0), "frame_skip"),
        (lambda: SwimEnv(EEL, 2, smoothing=math.nan), "smoothing"),
        (lambda: SwimEnv(mercurysim.Robot([[0, 0, 0], [1, 0, 0]], [[0, 1, 21]])), "has no actuators"),
    ],
)
def test_settings_that_cannot_be_used_are_refused_in_one_line(make, message):
    with pytest.raises(InputError, match=message) as error:
        make()
    assert "\n" not in str(error.value)


def test_actions_and_masks_of_a_wrong_shape_are_refused():
    env = SwimEnv(EEL, 2)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(np.zeros((2, 5)))
    env.reset(seed=1)
    with pytest.raises(InputError, match=r"actions: shape \(2, 4\) is not accepted; give \(2, 5\)"):
        env.step(np.zeros((2, 4)))
    with pytest.raises(InputError, match="reset_mask"):
        env.reset(options={"reset_mask": np.array([True])})


def test_without_gymnasium_the_import_says_what_to_install():
    program = "import sys; sys.modules['gymnasium'] = None; import mercurysim.gym"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.returncode == 1
    expected = "ImportError: mercurysim.gym needs Gymnasium: pip install 'mercurysim[gym]'"
    assert result.stderr.splitlines()[-1] == expected


def test_on_a_gpu_no_step_waits_for_the_device():
    torch = torch_or_skip()
    if not torch.cuda.is_available():
        pytest.skip("there is no GPU")
    env = SwimEnv(EEL, 64, torch=True, episode_seconds=0.5)
    observations, _ = env.reset(seed=1)
    assert observations.is_cuda
    plan = torch.as_tensor(actions(env, 30), device=observations.device)
    for action in plan[:3]:
        env.step(action)
    torch.cuda.set_sync_debug_mode("error")
    try:
        for action in plan:
            observations, *_ = env.step(action)
    finally:
        torch.cuda.set_sync_debug_mode("default")
    assert torch.isfinite(observations).all()
    cpu = SwimEnv(EEL, 64, torch=True, device="cpu", episode_seconds=0.5)
    left, right = (play_on(env, plan[:5]) for env in (SwimEnv(EEL, 64, torch=True), cpu))
    np.testing.assert_allclose(left, right, atol=1e-3)


def play_on(env, plan):
    env.reset(seed=1)
    return np.array([env.step(action)[0].cpu().numpy() for action in plan])


class Rise(RobotEnv):
    """A task of one's own: rise, and stop at a height."""

    observed_numbers = 1

    def reward(self, step):
        return step.motion.velocity[:, 2] - step.effort

    def is_over(self, step):
        return step.elapsed > 0.1

    def observe(self, motion):
        return motion.center[:, 2:]


@pytest.mark.parametrize("torch", [False, True])
def test_a_task_of_ones_own_gives_reward_end_and_observations(torch):
    if torch:
        torch_or_skip()
    env = Rise([EEL, quadruped()], 4, targets=False, torch=torch, device="cpu")
    observations, _ = env.reset(seed=1)
    assert observations.shape == (4, 13 + 6 * 8 + 8 + 2 + 1) and env.observation_space.shape == observations.shape
    for step in range(1, 4):
        observations, rewards, terminated, truncated, _ = (
            on_host(part) if not isinstance(part, dict) else part for part in env.step(actions(env, 1, step)[0])
        )
        height = env.batch.centers.numpy()[:, 2]
        np.testing.assert_allclose(observations[:, -1], height, atol=1e-6)
        velocity = on_host(env._bodies.motion().velocity)[:, 2]
        drive = env.batch.actuation.drive.numpy()
        effort = 0.04 * (np.nan_to_num(drive) ** 2).sum(axis=1) / [5, 8, 5, 8]
        np.testing.assert_allclose(rewards, velocity - effort, atol=1e-6)
        assert terminated.all() == (step * 0.04 > 0.1) and not truncated.any()


def test_a_task_without_a_reward_says_so():
    env = RobotEnv(EEL, 2)
    env.reset(seed=1)
    with pytest.raises(NotImplementedError, match="RobotEnv has no reward"):
        env.step(np.zeros((2, 5)))
    with pytest.raises(InputError, match="RobotEnv has no robot of its own"):
        RobotEnv()


def test_the_mask_says_which_actuators_a_robot_has():
    env = SwimEnv([EEL, quadruped()])
    assert env.actuator_mask.tolist() == [[True] * 5 + [False] * 3, [True] * 8]


def pictures_or_skip():
    try:
        mercurysim.picture(EEL, size=(16, 16))
    except mercurysim.DeviceError as error:
        pytest.skip(str(error))


def test_render_returns_a_frame_per_environment():
    pictures_or_skip()
    env = SwimEnv(EEL, 3, render_mode="rgb_array", render_size=(64, 48), targets=False)
    env.reset(seed=1)
    plan = np.zeros((3, 5), np.float32)
    plan[2] = [1, 1, 0, -1, -1]
    for _ in range(25):
        env.step(plan)
    frames = env.render()
    assert [frame.shape for frame in frames] == [(48, 64, 3)] * 3
    assert np.array_equal(frames[0], frames[1]) and not np.array_equal(frames[0], frames[2])
    assert SwimEnv(EEL, 3).render() is None


def test_record_video_of_gymnasium_films_all_environments(tmp_path):
    pictures_or_skip()
    pytest.importorskip("moviepy")
    from gymnasium.wrappers.vector import RecordVideo

    env = RecordVideo(SwimEnv(EEL, 4, render_mode="rgb_array", render_size=(64, 48)), str(tmp_path), video_length=5,
                      step_trigger=lambda step: step == 0)
    env.reset(seed=1)
    for _ in range(6):
        env.step(env.action_space.sample())
    env.close()
    (film,) = tmp_path.glob("*.mp4")
    assert film.stat().st_size > 1000


@pytest.mark.parametrize("torch", [False, True])
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_each_episode_has_an_environment_of_its_own(torch, mode):
    if torch:
        torch_or_skip()

    def upward(random, n):
        return np.stack([np.zeros(n), np.zeros(n), random.uniform(-9, -8, n)], 1)

    env = WalkEnv(quadruped(), 3, episode_seconds=0.08, torch=torch, autoreset_mode=mode, device="cpu",
                  randomize={"friction": (0.2, 1.2), "gravity": upward})
    assert env.episode_steps == 4

    def now():
        return [env.batch.environment_of(i) for i in range(3)]

    def said(infos):
        friction, gravity = on_host(infos["friction"]), on_host(infos["gravity"])
        return [mercurysim.Land(friction=float(f), gravity=tuple(map(float, g))) for f, g in zip(friction, gravity)]

    seen = []
    for seed in (7, 7, 8):
        infos = env.reset(seed=seed)[1]
        assert now() == said(infos)
        for _ in range(40):
            before = now()
            _, _, terminated, truncated, infos = env.step(np.zeros(env.action_space.shape, np.float32))
            over = on_host(terminated | truncated)
            if mode is AutoresetMode.SAME_STEP and over.any():
                assert said(infos["final_info"]) == before
            assert now() == said(infos)
            seen.append(now())
    assert seen[:40] == seen[40:80] and seen[:40] != seen[80:]
    frictions = {environment.friction for step in seen for environment in step}
    assert len(frictions) > 30 and 0.2 <= min(frictions) < 0.4 and 1.0 < max(frictions) <= 1.2
    assert all(-9 <= environment.gravity[2] <= -8 for step in seen for environment in step)


def test_a_robot_that_begins_alone_gets_an_environment_alone():
    env = WalkEnv(quadruped(), 3, autoreset_mode=AutoresetMode.DISABLED, randomize={"friction": (0.2, 1.2)})
    before = [env.reset(seed=1)[1]["friction"][i] for i in range(3)]
    after = env.reset(options={"reset_mask": [False, True, False]})[1]["friction"]
    assert [after[i] == before[i] for i in range(3)] == [True, False, True]


@pytest.mark.parametrize(
    "ranges, message",
    [({"friction": (1, 0)}, "friction: give a range"), ({"density": (0, 1)}, "no parameter density"),
     ({"friction": lambda random, n: [1, 2]}, "friction: shape")],
)
def test_ranges_that_cannot_be_used_are_refused(ranges, message):
    with pytest.raises((InputError, TypeError), match=message):
        WalkEnv(quadruped(), 2, randomize=ranges)
