# SPDX-License-Identifier: Apache-2.0
"""An eel learns to swim to random targets, by proximal policy optimization (Schulman et al. 2017), in PyTorch.

    python ppo.py --robots 1024 --iterations 1000 > learning.csv    # on a GPU; bench/plot_learning.py draws it
"""
import argparse
import time

import torch
from torch import nn

from mercurysim.gym import SwimEnv, eel

parser = argparse.ArgumentParser()
parser.add_argument("--robots", type=int, default=1024)
parser.add_argument("--iterations", type=int, default=1000)
options = parser.parse_args()
torch.manual_seed(1)
env = SwimEnv(eel(), options.robots, torch=True, frame_skip=50)  # an action lasts 0.1 s
seen, infos = env.reset(seed=1)


def network(outputs, gain, width=64):
    last = nn.Linear(width, outputs)
    nn.init.orthogonal_(last.weight, gain)
    return nn.Sequential(nn.Linear(seen.shape[1], width), nn.Tanh(), nn.Linear(width, width), nn.Tanh(), last)


def policy(seen):
    return torch.distributions.Normal(mean(seen), log_std.exp(), validate_args=False)


def advantages(value, reward, terminated, over, discount=0.99, decay=0.95):
    """Generalized advantage estimation (Schulman et al. 2016). value: of one step more than the others."""
    error = reward + discount * value[1:] * ~terminated - value[:-1]
    for t in reversed(range(len(error) - 1)):
        error[t] += discount * decay * error[t + 1] * ~over[t]
    return error


def improve(seen, action, before, target, advantage, weight, epochs=8, parts=8, clip=0.2):
    for _ in range(epochs):
        for part in torch.randperm(len(seen), device=seen.device).chunk(parts):
            ratio = (policy(seen[part]).log_prob(action[part]).sum(1) - before[part]).exp()
            gain = torch.min(ratio * advantage[part], ratio.clip(1 - clip, 1 + clip) * advantage[part])
            optimizer.zero_grad()
            ((0.5 * (value(seen[part])[:, 0] - target[part]) ** 2 - gain) * weight[part]).mean().backward()
            nn.utils.clip_grad_norm_(optimizer.param_groups[0]["params"], 0.5)
            optimizer.step()


mean, value = network(env.single_action_space.shape[0], 0.01).to(seen.device), network(1, 1).to(seen.device)
log_std = nn.Parameter(torch.full_like(mean[-1].bias.detach(), -0.5))
optimizer = torch.optim.Adam([*mean.parameters(), *value.parameters(), log_std], 1e-3)
earned, idle = torch.zeros(len(seen), device=seen.device), torch.zeros(len(seen), dtype=torch.bool, device=seen.device)
center, scale, steps, start = torch.zeros(()), torch.ones(()), 32, time.time()  # of observations (2); per robot and iteration
print("seconds,steps,episodes,reached,return")
for iteration in range(1, options.iterations + 1):
    rows, sums = [], torch.zeros(3, device=seen.device)
    with torch.no_grad():
        for _ in range(steps):
            choice = policy(seen)
            action = choice.sample()
            after, reward, terminated, truncated, infos = env.step(action)
            over, earned = terminated | truncated, earned + reward
            sums += torch.stack([over.sum(), infos["reached"].sum(), (earned * over).sum()])
            rows.append((seen, action, choice.log_prob(action).sum(1), reward, terminated, over, ~idle))
            seen, idle, earned = (after - center) / scale, over, earned * ~over  # an idle step begins an episode
        all_seen, action, before, reward, terminated, over, weight = (torch.stack(column) for column in zip(*rows))
        values = value(torch.cat([all_seen, seen[None]]))[..., 0]
        advantage = advantages(values, reward, terminated, over)
        scaled = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
    improve(*(part.flatten(0, 1) for part in (all_seen, action, before, values[:-1] + advantage, scaled, weight)))
    if iteration == 1:
        center, scale = all_seen.mean((0, 1)), all_seen.std((0, 1)) + 0.01
    episodes, reached, total = sums.tolist()  # the only wait for the device
    if episodes:
        seconds, count = time.time() - start, iteration * steps * options.robots
        print(f"{seconds:.1f},{count},{episodes:.0f},{reached / episodes:.3f},{total / episodes:.3f}", flush=True)
