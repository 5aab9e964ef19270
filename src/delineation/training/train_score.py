"""Trains the score of nodes on simulated photos.

    python3 train.py TRAIN,MORE VALID --to PATCHES --patches 360
    cargo run --release -p fragscale-opening --example develop -- features ENGINE PATCHES FEATURES
    python3 train_score.py FEATURES --to assets/delineation/score_ENGINE.txt --without 13 15

score_unvoted.txt, for networks that give no votes: ENGINE `learned`, --without 13 15 18 19 20 21.

Without the area and the deviation of the gray (13, 15): they say what simulated piles are like, not what a
fragment is; on photos of the world it is a little better without them.

What is learned of a node is how much it shares with a true fragment, where that is more than half: the sum
of it over the chosen nodes is what the choice makes the most of.
"""
import argparse

import numpy as np
import torch
import torch.nn as nn

FEATURES = 22
HIDDEN = 24


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("features")
    ask.add_argument("--to", required=True)
    ask.add_argument("--seed", type=int, default=1)
    ask.add_argument("--epochs", type=int, default=12)
    ask.add_argument("--without", type=int, nargs="*", default=[], help="features that are not to be used")
    ask = ask.parse_args()
    torch.manual_seed(ask.seed)
    rows = np.fromfile(ask.features, np.float32).reshape(-1, 4 + FEATURES)
    photo, shared, x = rows[:, 0].astype(int), rows[:, 3], rows[:, 4:].copy()
    x[:, ask.without] = 0
    wanted = np.where(shared > 0.5, 2 * shared - 1, 0).astype(np.float32)
    held = photo % 8 == 0
    mean, deviation = x.mean(0), x.std(0) + 1e-6
    z = torch.from_numpy((x - mean) / deviation)
    y = torch.from_numpy(wanted)
    net = nn.Sequential(nn.Linear(FEATURES, HIDDEN), nn.Tanh(), nn.Linear(HIDDEN, 1))
    count = int((~held).sum())
    steps = ask.epochs * count // 2048
    optimiser = torch.optim.AdamW(net.parameters(), lr=1e-2, weight_decay=1e-4)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, 1e-2, total_steps=max(steps, 10))
    train, other = torch.from_numpy(np.flatnonzero(~held)), torch.from_numpy(np.flatnonzero(held))
    loss_of = nn.BCEWithLogitsLoss()
    for step in range(max(steps, 10)):
        some = train[torch.randint(count, (2048,))]
        optimiser.zero_grad()
        loss = loss_of(net(z[some])[:, 0], y[some])
        loss.backward()
        optimiser.step()
        schedule.step()
    with torch.no_grad():
        unseen = loss_of(net(z[other])[:, 0], y[other]).item()
        base = y[~torch.from_numpy(held)].mean()
        none = loss_of(torch.full_like(y[other], float(torch.logit(base))), y[other]).item()
    print(f"{len(rows)} nodes of {photo.max() + 1} patches; loss on others {unseen:.4f}, knowing nothing {none:.4f}")
    first, last = net[0], net[2]
    # The normalisation goes into the weights.
    weight = first.weight.detach().numpy() / deviation
    weight[:, ask.without] = 0
    offset = first.bias.detach().numpy() - weight @ mean
    with open(ask.to, "w") as out:
        print("# The score of a node: weights and offset of each neuron, then of the last. Made by train_score.py:", file=out)
        print(f"# {len(rows)} nodes of {photo.max() + 1} simulated patches; loss on others {unseen:.4f}, knowing nothing {none:.4f}; seed {ask.seed}", file=out)
        for row, own in zip(weight, offset):
            print(*(f"{value:.6g}" for value in [*row, own]), file=out)
        print(*(f"{value:.6g}" for value in [*last.weight.detach().numpy()[0], last.bias.item()]), file=out)


if __name__ == "__main__":
    main()
