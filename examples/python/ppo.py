# SPDX-License-Identifier: Apache-2.0
"""An eel learns to swim to random targets, by proximal policy optimization (Schulman et al. 2017), in PyTorch.

    python examples/python/ppo.py --robots 1024 --minutes 4 --csv learning.csv    # one GPU
    python examples/python/ppo.py --robots 64 --minutes 10                        # the cores of a CPU

Nothing leaves the device except four numbers per iteration. bench/plot_learning.py draws them.
"""
import argparse
import csv
import time

import torch
from torch import nn

from mercurysim.gym import SwimEnv, eel


def network(inputs, outputs, scale, width=64):
    last = nn.Linear(width, outputs)
    nn.init.orthogonal_(last.weight, scale)
    return nn.Sequential(nn.Linear(inputs, width), nn.Tanh(), nn.Linear(width, width), nn.Tanh(), last)


class Policy(nn.Module):
    def __init__(self, inputs, outputs):
        super().__init__()
        self.mean, self.value = network(inputs, outputs, 0.01), network(inputs, 1, 1)
        self.log_std = nn.Parameter(torch.full((outputs,), -0.5))

    def forward(self, seen):
        return torch.distributions.Normal(self.mean(seen), self.log_std.exp(), validate_args=False)


@torch.no_grad()
def collect(env, policy, seen, idle, steps):
    """What all robots experience in some steps, (steps, robots, ...). idle: the action has no effect, see NEXT_STEP."""
    rows = []
    for _ in range(steps):
        chosen = policy(seen)
        action = chosen.sample()
        after, reward, terminated, truncated, infos = env.step(action)
        over = terminated | truncated
        rows.append((seen, action, chosen.log_prob(action).sum(1), reward, terminated, over, idle, infos["reached"]))
        seen, idle = after, over
    return [torch.stack(column) for column in zip(*rows)], seen, idle


@torch.no_grad()
def advantages(policy, seen, last, reward, terminated, over, discount=0.99, decay=0.95):
    """Generalized advantage estimates (Schulman et al. 2016) and the values that they are relative to."""
    value = policy.value(torch.cat([seen, last[None]]))[..., 0]
    error = reward + discount * value[1:] * ~terminated - value[:-1]
    advantage, total = torch.empty_like(error), 0
    for t in reversed(range(len(error))):
        advantage[t] = total = error[t] + discount * decay * ~over[t] * total
    return advantage, value[:-1]


def improve(policy, optimizer, seen, action, before, advantage, target, weight, epochs=4, parts=4, clip=0.2):
    for _ in range(epochs):
        for part in torch.randperm(len(seen), device=seen.device).chunk(parts):
            ratio = (policy(seen[part]).log_prob(action[part]).sum(1) - before[part]).exp()
            gain = torch.min(ratio * advantage[part], ratio.clip(1 - clip, 1 + clip) * advantage[part])
            error = (policy.value(seen[part])[:, 0] - target[part]) ** 2
            loss = ((0.5 * error - gain) * weight[part]).mean() - 0.002 * policy.log_std.sum()
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(policy.parameters(), 0.5)
            optimizer.step()


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=1024)
    parser.add_argument("--minutes", type=float, default=4)
    parser.add_argument("--iterations", type=int, default=10**9)
    parser.add_argument("--steps", type=int, default=32, help="of each robot per iteration")
    parser.add_argument("--device", default="auto")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--csv", default="learning.csv")
    options = parser.parse_args(arguments)
    torch.manual_seed(options.seed)
    env = SwimEnv(eel(), options.robots, device=options.device, torch=True, frame_skip=50)
    seen, _ = env.reset(seed=options.seed)
    policy = Policy(seen.shape[1], env.single_action_space.shape[0]).to(seen.device)
    optimizer = torch.optim.Adam(policy.parameters(), 1e-3)
    idle, returns, start = torch.zeros(len(seen), dtype=torch.bool, device=seen.device), 0, time.perf_counter()
    with open(options.csv, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["seconds", "steps", "return", "reached", "episodes"])
        for iteration in range(1, options.iterations + 1):
            data, seen, idle = collect(env, policy, seen, idle, options.steps)
            ...
